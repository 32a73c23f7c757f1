//! Monitors a motor that a loop drives: has it gone where its duty must have taken it, by the identified model?
//!
//! What a loop does between two polls is not seen, so that the duty is known within bounds only: those of the readings around, as wide
//! again as readings scatter of late, and anything at all where a new setpoint fell between them. From these, and from bounds of the
//! model, follow the least and the most that can have been counted over a stretch.

use crate::model::{Decay, PlantModel};
use crate::poll::Point;
use crate::thresholds::{Scaled, thresholds};
use std::collections::VecDeque;

thresholds! {
    /// What a motor under a speed or position loop may do before it counts as stuck, jammed or lost.
    CLOSED_LOOP: Thresholds {
        /// Lengths of the stretches that are looked at, in seconds. The long ones are for heavy motors, which show a fault late.
        stretches_s: [f64; 7] = [0.045, 0.08, 0.12, 0.17, 0.23, 0.30, 0.45],
        /// Shortest time over which the speed before a stretch is taken, in seconds.
        speed_s: f64 = 0.03,
        /// The same time as a share of the stretch, which counts where it is longer.
        speed_share: f64 = 0.3,
        /// Shortest step in which the bounds are computed along a stretch, in seconds.
        step_s: f64 = 0.004,
        /// Most such steps in a stretch: a long one has longer steps.
        steps: f64 = 40.0,
        /// How far the true gain may be from that of the model, as a share of it.
        gain_doubt: f64 = 0.12,
        /// Multiples of the model's time constant between which the true one lies: a load behind a spring or within its backlash leaves the motor alone, which is
        /// quicker.
        tau_spread: (f64, f64) = (0.3, 1.6),
        /// How far a constant load may be from that of the model, as a share of it.
        load_doubt: f64 = 0.25,
        /// Lowest and highest friction, as multiples of that of the model.
        friction: (f64, f64) = (0.5, 1.5),
        /// Least friction that the highest one is taken from, as a share of the duty at which the probe saw the motor start: where friction falls with the speed, a model of
        /// one friction for all speeds may have none. Of 720 loops on the position of another make (seeds 1009 and 1010) five motors stood or crept below that duty and were called jammed.
        of_start: f64 = 0.5,
        /// Duty on top of the highest friction, as a share of full.
        more_friction: f64 = 0.02,
        /// Most that holds a motor at rest, as a multiple of the model's friction.
        stiction: f64 = 2.2,
        /// Duty on top of that, as a share of full.
        more_stiction: f64 = 0.04,
        /// Lowest and highest current limit, as multiples of what was set.
        limit: (f64, f64) = (0.85, 1.2),
        /// How far readings of the duty may be from the truth between two polls, as a share of full duty, before their scatter is added.
        duty_doubt: f64 = 0.02,
        /// How many times the median scatter of the readings is added to that.
        scatters: f64 = 2.0,
        /// Steps of the duty that readings may miss, each of them as high as one count in a tick makes it.
        steps_unseen: f64 = 0.5,
        /// How far readings of the duty may be from the truth, as a share of full duty, when they are too few to tell a scatter.
        unknown_doubt: f64 = 0.14,
        /// Fewest readings from which a scatter is told; each of them lies between two others.
        few_readings: usize = 5,
        /// How uncertain it is when a setpoint acts, in seconds: so long before it was first sent, and so long after it was acknowledged.
        setpoint_acts_s: (f64, f64) = (0.006, 0.012),
        /// How long setpoints are remembered, in seconds: longer than the polls.
        memory_s: f64 = 2.0,
        /// Least load that may keep a motor going, as a share of the friction.
        helping: f64 = 0.4,
        /// Counts by which an encoder that stands still may flicker.
        standing_counts: f64 = 1.0,
        /// How far a stretch may be outside its bounds: counts, seconds that the stamps of its ends and of the speed before it may be off, and shares of the speed before
        /// it and of the speed at full duty.
        margin: Margin = Margin { counts: 4.0, stamp_s: 0.0025, speed: 0.06, full: 0.012 },
        /// Longest tick for which that time of the stamps is enough, in seconds: counts are up to a tick old when they are read. A longer tick makes it longer. Of 2,880
        /// runs on motors of another make three drums at 200 Hz were called jammed for it.
        stamp_tick_s: f64 = 1.0 / 300.0,
        /// The same where the counts stand still: no roughness and no late stamp makes them stand.
        standing_margin: Margin = Margin { counts: 4.0, stamp_s: 0.0, speed: 0.1, full: 0.005 },
    }
}

/// What a stretch may be beside its bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    counts: f64,
    stamp_s: f64,
    speed: f64,
    full: f64,
}

impl Scaled for Margin {
    fn scaled(self, by: f64) -> Self {
        Self {
            counts: self.counts * by,
            stamp_s: self.stamp_s * by,
            speed: self.speed * by,
            full: self.full * by,
        }
    }
}

impl Margin {
    /// In counts, for a stretch at a speed.
    fn of(&self, stretch: &Stretch, full_speed: f64, tick_s: f64) -> f64 {
        let span = stretch.to.t - stretch.from.t;
        let stamp_s = self.stamp_s * (tick_s / CLOSED_LOOP.stamp_tick_s).max(1.0);
        let of_speed = stamp_s * (1.0 + span / stretch.base_s) + self.speed * span;
        self.counts + of_speed * stretch.speed_before.abs() + self.full * span * full_speed
    }
}

/// What is known of a loop that has the motor.
#[derive(Clone, Debug)]
pub(crate) struct ClosedLoopMonitor {
    model: PlantModel,
    /// Duty at which the probe saw the motor start.
    start_duty: f64,
    /// Duty that one count more in a tick makes.
    step_duty: f64,
    /// Time between two ticks of the loop, s.
    tick_s: f64,
    /// From when on its duty is known, nought or that of the loop, and when it was first commanded anything, s.
    since_s: f64,
    commanded_s: f64,
    /// When it was given a new setpoint, from the first try on to the acknowledged one, oldest first, s.
    setpoints: VecDeque<(f64, f64)>,
}

/// What a motor had before a loop was given a setpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Before {
    /// The loop.
    ClosedLoop,
    /// No duty since then, s.
    Off(f64),
    /// Some duty.
    Driven,
}

/// The exponentials of a step with the longest and the shortest time constant.
#[derive(Default)]
pub(crate) struct Decays {
    pub(crate) slow: Decay,
    pub(crate) quick: Decay,
}

/// The polls of a stretch and the speed before it.
struct Stretch {
    from: Point,
    to: Point,
    speed_before: f64,
    before_s: f64,
    base_s: f64,
    stands: bool,
}

impl ClosedLoopMonitor {
    /// No setpoint has been given yet.
    pub(crate) fn new(model: PlantModel, start_duty: f64) -> Self {
        Self {
            model,
            start_duty,
            step_duty: 0.0,
            tick_s: 0.0,
            since_s: f64::INFINITY,
            commanded_s: f64::INFINITY,
            setpoints: VecDeque::new(),
        }
    }

    /// The loop is given the motor, or a new setpoint, at some time between two: a lost reply leaves open which try was heard.
    /// `before` is how it had the motor until then.
    pub(crate) fn command(&mut self, (from_s, to_s): (f64, f64), tick_s: f64, before: Before) {
        self.tick_s = tick_s;
        if before != Before::ClosedLoop {
            self.since_s = if let Before::Off(since_s) = before { since_s } else { to_s };
            self.commanded_s = from_s - CLOSED_LOOP.setpoint_acts_s.0;
            self.setpoints.clear();
        }
        self.setpoints
            .push_back((from_s - CLOSED_LOOP.setpoint_acts_s.0, to_s + CLOSED_LOOP.setpoint_acts_s.1));
        while self.setpoints.front().is_some_and(|old| to_s - old.1 > CLOSED_LOOP.memory_s) {
            self.setpoints.pop_front();
        }
    }

    /// The loop has these gains. Where a tick sees a count or none, the duty jumps between two values, and polls in step with
    /// the ticks may see the same one for long.
    pub(crate) fn hold(&mut self, step_duty: f64) {
        self.step_duty = step_duty;
    }

    /// The model by which it monitors.
    pub(crate) fn model(&self) -> &PlantModel {
        &self.model
    }

    /// The least that friction takes off the speed of an open motor in a time; `None` where a load pulls that could keep it going. Without a current nothing but friction
    /// slows it down, as much at any speed.
    pub(crate) fn least_fall(&self, seconds: f64) -> Option<f64> {
        let model = &self.model;
        let is_helped = model.load_duty.abs() > CLOSED_LOOP.helping * model.coulomb_duty;
        let taus = seconds / (CLOSED_LOOP.tau_spread.1 * model.tau_s);
        (!is_helped).then_some(CLOSED_LOOP.friction.0 * model.gain_counts_per_s * model.coulomb_duty * taus)
    }

    /// Whether the counts of every stretch lie within their bounds.
    pub(crate) fn agrees(&self, recent: &VecDeque<Point>, readings: &VecDeque<(f64, f64)>) -> bool {
        let doubt = self.doubt(readings);
        CLOSED_LOOP.stretches_s.iter().filter_map(|seconds| self.stretch(recent, *seconds)).all(|stretch| {
            // A loop that sees nothing move does nothing jerky: its duty goes from one reading to the next.
            let (doubt, calm_s) = if stretch.stands {
                (CLOSED_LOOP.duty_doubt, stretch.from.t)
            } else {
                (doubt, f64::INFINITY)
            };
            self.within(&stretch, &Duties { readings, monitor: self, doubt, calm_s })
        })
    }

    fn stretch(&self, recent: &VecDeque<Point>, seconds: f64) -> Option<Stretch> {
        let to = *recent.back()?;
        let from = recent.iter().rposition(|old| to.t - old.t >= seconds)?;
        let stands = {
            let counts = recent.iter().skip(from).map(|point| point.counts);
            let (low, high) =
                counts.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
            high - low <= CLOSED_LOOP.standing_counts
        };
        let from = recent[from];
        let base_s = CLOSED_LOOP.speed_s.max(CLOSED_LOOP.speed_share * seconds);
        let earlier = recent.iter().rev().find(|old| from.t - old.t >= base_s)?;
        let speed_before = (from.counts - earlier.counts) / (from.t - earlier.t);
        let before_s = 0.5 * (earlier.t + from.t);
        let base_s = from.t - earlier.t;
        (earlier.t >= self.since_s).then_some(Stretch { from, to, speed_before, before_s, base_s, stands })
    }

    fn within(&self, stretch: &Stretch, duties: &Duties<'_>) -> bool {
        let moved = stretch.to.counts - stretch.from.counts;
        let full = self.model.gain_counts_per_s;
        let margin = if stretch.stands { CLOSED_LOOP.standing_margin } else { CLOSED_LOOP.margin }.of(
            stretch,
            full,
            self.tick_s,
        );
        let [least, back] = self.least_distances(stretch, duties);
        let most = -back;
        moved >= least - margin && moved <= most + margin
    }

    /// How far the duty may be beside the readings: they scatter about the mean of their neighbours.
    fn doubt(&self, readings: &VecDeque<(f64, f64)>) -> f64 {
        let is_quiet = |from: f64, to: f64| {
            from >= self.commanded_s && !self.setpoints.iter().any(|given| given.1 > from && given.0 < to)
        };
        let triples = (2..readings.len()).map(|n| (readings[n - 2], readings[n - 1], readings[n]));
        let mut beside: Vec<f64> = triples
            .filter(|(a, _, c)| is_quiet(a.0, c.0))
            .map(|(a, b, c)| (b.1 - 0.5 * (a.1 + c.1)).abs())
            .collect();
        if beside.len() < CLOSED_LOOP.few_readings {
            return CLOSED_LOOP.unknown_doubt;
        }
        beside.sort_by(f64::total_cmp);
        CLOSED_LOOP.duty_doubt
            + CLOSED_LOOP.steps_unseen * self.step_duty
            + CLOSED_LOOP.scatters * beside[beside.len() / 2]
    }

    /// The least distance that the motor can have gone forwards, and backwards; one the other way is negative.
    fn least_distances(&self, stretch: &Stretch, duties: &Duties<'_>) -> [f64; 2] {
        let mut ways = [1.0, -1.0].map(|direction| (direction, stretch.speed_before * direction, 0.0));
        let mut decays = Decays::default();
        let mut t = stretch.before_s;
        let longest = CLOSED_LOOP.step_s.max((stretch.to.t - t) / CLOSED_LOOP.steps);
        while t < stretch.to.t - 1e-9 {
            let step = longest.min(stretch.to.t - t);
            let range = duties.range(t + 0.5 * step);
            for (direction, speed, distance) in &mut ways {
                let duty = if *direction > 0.0 { range.0 } else { -range.1 };
                let next = self.least_speed(*speed, duty, *direction, step, &mut decays);
                if t + step > stretch.from.t {
                    *distance += 0.5 * (*speed + next) * step.min(t + step - stretch.from.t);
                }
                *speed = next;
            }
            t += step;
        }
        ways.map(|way| way.2)
    }

    /// The lowest speed after a step, in the direction looked at.
    fn least_speed(&self, speed: f64, duty: f64, direction: f64, step: f64, decays: &mut Decays) -> f64 {
        let model = &self.model;
        let full = model.gain_counts_per_s;
        let share = if duty > 0.0 { 1.0 - CLOSED_LOOP.gain_doubt } else { 1.0 + CLOSED_LOOP.gain_doubt };
        let mut push = share * duty
            - speed / full
            - model.load_duty * direction
            - CLOSED_LOOP.load_doubt * model.load_duty.abs();
        if let Some(limit) = model.drive_limit {
            let brake = model.brake_limit.unwrap_or(limit).max(limit);
            push = push.clamp(-CLOSED_LOOP.limit.1 * brake, CLOSED_LOOP.limit.0 * limit);
        }
        let coulomb = model.coulomb_duty.max(CLOSED_LOOP.of_start * self.start_duty);
        let friction = CLOSED_LOOP.friction.1 * coulomb + CLOSED_LOOP.more_friction;
        let stiction =
            self.start_duty.min(CLOSED_LOOP.stiction * coulomb + CLOSED_LOOP.more_stiction).max(friction);
        let force = if speed > 0.0 {
            push - friction
        } else if speed < 0.0 {
            push + CLOSED_LOOP.friction.0 * model.coulomb_duty
        } else if push > 0.0 {
            (push - stiction).max(0.0)
        } else {
            (push + CLOSED_LOOP.friction.0 * model.coulomb_duty).min(0.0)
        };
        let (spread, decay) = if force > 0.0 {
            (CLOSED_LOOP.tau_spread.1, &mut decays.slow)
        } else {
            (CLOSED_LOOP.tau_spread.0, &mut decays.quick)
        };
        let next = speed + full * force * (1.0 - decay.of(-step / (model.tau_s * spread)));
        // Friction stops a motor, but does not turn it.
        if speed > 0.0 && next < 0.0 && push >= -friction { 0.0 } else { next }
    }
}

/// The duty of a loop as far as it is known.
struct Duties<'a> {
    readings: &'a VecDeque<(f64, f64)>,
    monitor: &'a ClosedLoopMonitor,
    doubt: f64,
    /// From when on setpoints are followed without a jerk, s.
    calm_s: f64,
}

impl Duties<'_> {
    /// Lowest and highest duty that may have been in force at a time.
    fn range(&self, t: f64) -> (f64, f64) {
        if t >= self.monitor.since_s && t < self.monitor.commanded_s {
            return (0.0, 0.0);
        }
        let next = self.readings.partition_point(|reading| reading.0 <= t);
        let before =
            next.checked_sub(1).and_then(|n| self.readings.get(n)).filter(|a| a.0 >= self.monitor.since_s);
        let from_rest = (self.monitor.commanded_s, 0.0);
        let a = match before {
            Some(reading) => reading,
            None if self.monitor.since_s < self.monitor.commanded_s => &from_rest,
            None => return (-1.0, 1.0),
        };
        let b = self.readings.get(next);
        let until = b.map_or(t, |b| b.0);
        if t < self.calm_s && self.monitor.setpoints.iter().any(|given| given.1 > a.0 && given.0 < until) {
            return (-1.0, 1.0);
        }
        let (b, doubt) = b.map_or((a, 2.0 * self.doubt), |b| (b, self.doubt));
        ((a.1.min(b.1) - doubt).max(-1.0), (a.1.max(b.1) + doubt).min(1.0))
    }
}
