//! Monitors a driven motor poll by poll: does it still do what a motor does?
//!
//! What was counted over a short stretch is compared with the least that a motor of this kind could have moved, given how fast it
//! was and which duty it had. The bounds are wide, since they come from the run itself: the speeds seen so far and a rough time
//! constant. A stretch outside them is a suspicion, which the diagnosis turns into a cause.

use crate::cause::Cause;
use crate::closed_loop_monitor::{Before, ClosedLoopMonitor, Decays};
use crate::current_silence::{CurrentSilence, SILENCE};
use crate::model::PlantModel;
use crate::open_loop_record::OPEN_LOOP;
use crate::poll::Point;
use crate::thresholds::thresholds;
use std::collections::VecDeque;

thresholds! {
    /// What a driven motor may do before it counts as stuck, reversed or lost.
    MONITOR: Thresholds {
        /// Lengths of the stretches that are looked at, in seconds.
        stretches_s: [f64; 4] = [0.045, 0.08, 0.12, 0.17],
        /// Longest time looked back at, in seconds.
        memory_s: f64 = 0.8,
        /// Time over which the speed before a stretch is taken, in seconds.
        speed_s: f64 = 0.03,
        /// Step in which the bounds are computed along a stretch, in seconds.
        step_s: f64 = 0.004,
        /// Least gain that is expected, as a share of the gain seen so far.
        least_gain: f64 = 0.75,
        /// Counts that a stretch may be short of its bound.
        margin_counts: f64 = 5.0,
        /// Way that it may be short on top, as a share of what the speed before it would make.
        margin_speed: f64 = 0.3,
        /// Share of its speed that a motor keeps at the least while its duty stays.
        kept_speed: f64 = 0.5,
        /// Shortest and longest time within which a motor that has started once starts again at a clearly higher duty, in seconds. A slow one that is turned round passes
        /// through rest with hardly a count for as long.
        start_s: (f64, f64) = (0.13, 0.22),
        /// A motor that has moved by more than so many counts has started.
        start_counts: f64 = 2.0,
        /// How far above the starting duty a duty is clearly higher, as a share of full.
        clearly_higher: f64 = 0.1,
        /// Least duty at which the current of a motor that gathers speed is remembered, as a share of full.
        telling_duty: f64 = 0.1,
        /// How long after a duty was given its current has settled, in seconds.
        settled_s: f64 = 0.3,
        /// How far beyond the motor's voltage a duty has to be for a current to be missed, as a share of the friction: the lower bound of the closed-loop monitor.
        least_push: f64 = 0.5,
        /// How far below the motor's voltage a duty has to be to brake with a current, as a share of full: beyond a gain that is 4 % off and half of a usual friction.
        braking: f64 = 0.05,
        /// How long after a push began it draws its current, in seconds.
        pushed_s: f64 = 0.02,
        /// How far readings of a loop's duty are from the truth between two polls, as a share of full duty.
        loop_duty: f64 = 0.14,
        /// How far the speed of a loop may be from what its duty readings say, as a share of the speed at full duty.
        loop_margin: f64 = 0.04,
        /// How long a loop that was given a new setpoint does what no poll sees, in seconds.
        unseen_setpoint_s: f64 = 0.07,
        /// Multiples of a time constant that was found between which the true one lies: a load behind a spring makes the motor alone quicker.
        tau_spread: (f64, f64) = (0.3, 1.6),
        /// Speed, as a share of that at full duty, below which a load may sway while the motor is off, and below which cogs make a turning motor uneven.
        swaying: f64 = 0.08,
        /// The same of a motor that goes on the way it went when it was braked, as a share of its speed then: its load may take it along. 0.38 was seen (steering gear,
        /// Motion Mind's plant 166 of seed 7).
        carried: f64 = 0.5,
        /// Time from a poll to the command that it leads to, in seconds.
        command_s: f64 = 0.012,
        /// Least share of a stopping distance that the motor's own slowing takes.
        least_turn: f64 = 0.25,
        /// Share of the current limit above which a current counts as limited.
        near_limit: f64 = 0.95,
        /// Time for a further start, as a multiple of what the first one took, within the bounds of `start_s`.
        starts: f64 = 1.5,
    }
}

/// The monitor of one motor.
#[derive(Clone, Debug, Default)]
pub struct MotorMonitor {
    /// Time from braking to rest, s: how long a speed runs on.
    pub stopping_s: f64,
    /// Amperes at full duty with the shaft at rest; `None` before the probe.
    pub stall_amps: Option<f64>,
    /// Noise of the readings of the current at rest, root mean square, A; 0 before the probe.
    pub(crate) noise_amps: f64,
    /// The highest of these readings, A; 0 before the probe.
    pub(crate) highest_rest_amps: f64,
    /// The current limit over the stall current, where there is one.
    pub drive_limit: Option<f64>,
    /// Duty at which the motor began to move; 0 before the probe.
    pub start_duty: f64,
    /// Speed at full duty, counts/s, as far as it is known; 0 before.
    pub full_speed: f64,
    /// Whether a duty is in force at once, without a ramp.
    pub is_abrupt: bool,
    /// Ramp of a duty that is given, over the one that was asked for, once it was fitted.
    pub(crate) ramp: Option<f64>,
    /// Between which values the time constant lies, s; `None` as long as nothing is known.
    pub tau_bounds_s: Option<(f64, f64)>,
    /// How much more than usual the stamp of the last command may be off, s.
    pub(crate) doubt_s: f64,
    /// Time constant that the stopping distances so far speak of, s.
    turning_tau_s: Option<f64>,
    /// Duties given and when, oldest first; the first is older than the memory.
    duties: VecDeque<(f64, f64)>,
    /// Whether a loop has the motor, until when one had it, and when it was given the motor or a new setpoint, or lost it.
    in_loop: bool,
    loop_until_s: f64,
    changed_s: f64,
    /// When the duty last changed, and whether it went up or round: a speed that still falls says nothing about the gain.
    since_s: f64,
    rising: bool,
    /// When the motor was first driven at a duty that it starts with.
    first_s: f64,
    /// Duty that a constant load eats, positive when it pulls towards lower counts; 0 as long as it is not known.
    pub(crate) load_duty: f64,
    /// How long the first few counts took under the first duty of a run from rest, s.
    start_took_s: Option<f64>,
    /// Highest speed over duty seen, counts/s.
    gain: f64,
    /// The same by speed and current.
    emf_gain: f64,
    /// What an identification has found, for the closed-loop monitor.
    closed_loop: Option<ClosedLoopMonitor>,
    current: CurrentSilence,
    /// Highest current over duty of the motor while it gathered speed, A: that of a standing one is more.
    least_stall_amps: f64,
    recent: VecDeque<Point>,
    /// Duties read and when, oldest first.
    readings: VecDeque<(f64, f64)>,
}

/// What one looks like from its counts and its duty over a time.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    from: Point,
    to: Point,
    speed_before: f64,
}

impl MotorMonitor {
    /// A duty was given.
    pub fn drive(&mut self, t: f64, duty: f64) {
        if self.in_loop {
            // The ramp begins at the duty that the loop had.
            let last = self.duty_at(t);
            self.duties.clear();
            self.duties.push_back((t - 2.0 / self.slew_per_s(), last));
            self.in_loop = false;
            self.loop_until_s = t;
            // A derivative of a few counts gives pulses, so that it may have had another one than was read last, until the longest ramp is over.
            self.changed_s = t + if self.is_abrupt { 0.0 } else { self.slew_per_s().recip() };
        }
        let before = self.duties.back().map_or(0.0, |given| given.1);
        self.rising = before * duty <= 0.0 || duty.abs() >= before.abs();
        self.duties.push_back((t, duty));
        if self.tau_bounds_s.is_none() && duty != 0.0 {
            self.first_s = t;
        }
        self.since_s = t;
        while self.duties.get(1).is_some_and(|next| t - next.0 > MONITOR.memory_s) {
            self.duties.pop_front();
        }
    }

    /// The motor was driven elsewhere and braked at last: what was seen before says nothing about what comes.
    pub(crate) fn forget(&mut self, t: f64) {
        self.recent.clear();
        self.duties.clear();
        self.drive(t, 0.0);
        self.changed_s = t;
    }

    /// Takes over what an identification found.
    pub fn know(&mut self, model: &PlantModel) {
        self.load_duty = model.load_duty;
        self.gain = model.gain_counts_per_s * (1.0 - model.coulomb_duty);
        self.tau_bounds_s = Some((MONITOR.tau_spread.0 * model.tau_s, MONITOR.tau_spread.1 * model.tau_s));
        // A limit that never acted in the identification may act in a trial.
        let drive_limit = model.drive_limit.or(self.drive_limit);
        self.closed_loop =
            Some(ClosedLoopMonitor::new(PlantModel { drive_limit, ..*model }, self.start_duty));
    }

    /// The speed at full duty as far as it is known, counts/s; 0 before anything is.
    #[must_use]
    pub fn no_load_speed(&self) -> f64 {
        self.gain
    }

    /// The loop is given other gains.
    pub(crate) fn hold(&mut self, step_duty: f64) {
        if let Some(closed_loop) = &mut self.closed_loop {
            closed_loop.hold(step_duty);
        }
    }

    /// Counts that the motor runs on from a speed while it is driven the other way at a duty, and the time until that duty acts
    /// aside; `None` before anything is known.
    pub(crate) fn stopping_counts(&self, speed: f64, duty: f64) -> Option<f64> {
        let (gain, rough_s) = self.rough_model(0.0);
        let tau_s = self.turning_tau_s.unwrap_or(rough_s);
        (self.tau_bounds_s.is_some() && gain * duty > 0.0)
            .then(|| tau_s * self.stopping_distance_per_tau(gain, speed, duty))
    }

    /// A motor at a speed was driven the other way at a duty and ran on for so many counts from the poll before: later stopping distances
    /// are computed from that.
    pub(crate) fn turned(&mut self, speed: f64, duty: f64, counts: f64) {
        let per_tau = self.stopping_distance_per_tau(self.rough_model(0.0).0, speed, duty);
        if per_tau <= 0.0 || speed <= 0.0 {
            return;
        }
        // The command comes late, then the duty takes its time to turn its sign and to come up.
        let acts_s = MONITOR.command_s + 1.5 * duty / self.slew_per_s();
        let found_s = (counts - acts_s * speed).max(MONITOR.least_turn * counts) / per_tau;
        self.turning_tau_s = Some(self.turning_tau_s.map_or(found_s, |known| 0.5 * (known + found_s)));
    }

    /// The stopping distance over the time constant. The current limit holds the motor back at one rate as long as it acts; below it, duty
    /// and back-EMF do.
    fn stopping_distance_per_tau(&self, gain: f64, speed: f64, duty: f64) -> f64 {
        let pull = gain * duty;
        let most = gain * self.drive_limit.unwrap_or(f64::INFINITY);
        let free = speed.min((most - pull).max(0.0));
        let held =
            if most.is_finite() && speed > free { (speed * speed - free * free) / (2.0 * most) } else { 0.0 };
        if pull <= 0.0 || free <= 0.0 { held } else { held + free - pull * (free / pull).ln_1p() }
    }

    /// A loop of a tick has the motor: its duty is what is read. It was commanded so first at `first_s`, and answered the try of `t`.
    pub fn release(&mut self, (first_s, t): (f64, f64), tick_s: f64) {
        let ramp_s = 2.0 / self.slew_per_s();
        if !self.in_loop {
            // What a loop read before says nothing about the time since it lost the motor.
            self.readings.clear();
        }
        if let Some(closed_loop) = &mut self.closed_loop {
            let before = match self.duties.back() {
                _ if self.in_loop => Before::ClosedLoop,
                Some((off_s, 0.0)) => Before::Off(off_s + ramp_s),
                _ => Before::Driven,
            };
            closed_loop.command((first_s, t), tick_s, before);
        }
        self.in_loop = true;
        self.changed_s = t;
        self.since_s = t;
        self.duties.clear();
    }

    /// The polls it remembers, oldest first.
    pub(crate) fn recent(&self) -> impl DoubleEndedIterator<Item = &Point> {
        self.recent.iter()
    }

    /// Takes the duty that a poll read, where its counts came too late to say anything.
    pub(crate) fn read_duty(&mut self, point: &Point) {
        self.readings.extend(point.duty);
        while self.readings.front().is_some_and(|old| point.t - old.0 > MONITOR.memory_s) {
            self.readings.pop_front();
        }
    }

    /// Looks at a poll. The cause of an error is a first guess.
    pub fn see(&mut self, point: &Point) -> Result<(), Cause> {
        self.read_duty(point);
        self.recent.push_back(*point);
        while self.recent.front().is_some_and(|old| point.t - old.t > MONITOR.memory_s) {
            self.recent.pop_front();
        }
        if self.start_duty == 0.0 {
            return Ok(());
        }
        self.check_current(point)?;
        self.learn_stall(point);
        self.learn_start(point);
        self.check_start(point)?;
        if self.in_loop
            && let Some(closed_loop) = &self.closed_loop
        {
            let agrees = closed_loop.agrees(&self.recent, &self.readings);
            return if agrees { Ok(()) } else { Err(Cause::Stalled) };
        }
        for seconds in MONITOR.stretches_s {
            if let Some(stretch) = self.stretch(seconds) {
                self.check_stretch(&stretch)?;
            }
        }
        self.learn();
        Ok(())
    }

    /// The duty in force at a time, ramps included.
    pub(crate) fn duty_at(&self, t: f64) -> f64 {
        if self.in_loop || t < self.loop_until_s {
            let read = self.readings.iter().rev().find(|duty| duty.0 <= t);
            return read.map_or(0.0, |duty| duty.1);
        }
        let mut duty = 0.0;
        let mut at = f64::NEG_INFINITY;
        let mut goal = 0.0;
        for &(next, new_goal) in self.duties.iter().take_while(|given| given.0 <= t) {
            duty = self.slewed(duty, goal, next - at);
            (at, goal) = (next, new_goal);
        }
        self.slewed(duty, goal, t - at)
    }

    /// Lowest and highest duty that may have been in force about a time.
    fn duty_range(&self, t: f64) -> (f64, f64) {
        if !self.in_loop {
            // The stamp of a command is off by a few milliseconds at the most, unless its reply came late.
            let (a, b) = (self.duty_at(t - 0.006 - self.doubt_s), self.duty_at(t + 0.002 + self.doubt_s));
            return (a.min(b), a.max(b));
        }
        let readings = || self.readings.iter();
        let before = readings().rev().find(|duty| duty.0 <= t);
        let after = readings().find(|duty| duty.0 > t);
        match (before, after) {
            (Some(a), Some(b)) => (a.1.min(b.1) - MONITOR.loop_duty, a.1.max(b.1) + MONITOR.loop_duty),
            (Some(a), None) | (None, Some(a)) => {
                (a.1 - 2.0 * MONITOR.loop_duty, a.1 + 2.0 * MONITOR.loop_duty)
            }
            (None, None) => (-1.0, 1.0),
        }
    }

    /// The last `seconds`, and the speed just before them.
    fn stretch(&self, seconds: f64) -> Option<Stretch> {
        let to = *self.recent.back()?;
        let from = self.recent.iter().rev().find(|old| to.t - old.t >= seconds)?;
        let earlier = self.recent.iter().rev().find(|old| from.t - old.t >= MONITOR.speed_s)?;
        let speed_before = (from.counts - earlier.counts) / (from.t - earlier.t);
        Some(Stretch { from: *from, to, speed_before })
    }

    /// Compares a stretch with what the motor can have done.
    fn check_stretch(&self, stretch: &Stretch) -> Result<(), Cause> {
        let Stretch { from, to, speed_before } = stretch;
        let unclear_s = self.changed_s + if self.in_loop { MONITOR.unseen_setpoint_s } else { 0.0 };
        if unclear_s > from.t - MONITOR.speed_s {
            return Ok(());
        }
        let span = to.t - from.t;
        let moved = to.counts - from.counts;
        let unseen = if self.in_loop { MONITOR.loop_margin * self.gain * span } else { 0.0 };
        let margin = MONITOR.margin_counts + MONITOR.margin_speed * speed_before.abs() * span + unseen;
        if self.sways(stretch) {
            return Ok(());
        }
        let duty = self.duty_at(to.t);
        // No duty has no direction, whatever the sign of its nought.
        let direction = if duty == 0.0 { 0.0 } else { duty.signum() };
        // A motor that hardly turns is held up and let go by each of its cogs.
        let crawls = self.tau_bounds_s.is_some() && speed_before.abs() < MONITOR.swaying * self.gain;
        if !crawls && self.keeps_its_speed(stretch, direction) {
            let least = MONITOR.kept_speed * speed_before.abs() * span - MONITOR.margin_counts;
            if least > 0.0 && moved * direction < least {
                return Err(Cause::Stalled);
            }
        }
        let Some(tau) = self.tau_bounds_s else { return Ok(()) };
        if self.gain <= 0.0 {
            return Ok(());
        }
        let [least, back] = self.least_distances(stretch, tau);
        let most = -back;
        if moved < least - margin || moved > most + margin {
            return Err(Cause::Stalled);
        }
        Ok(())
    }

    /// Whether the motor is off and all that is counted is slow: a load sways in the backlash of its gear, or takes the motor along a little. A duty that is given
    /// afterwards has stretches of its own later.
    fn sways(&self, stretch: &Stretch) -> bool {
        let Stretch { from, to, speed_before } = stretch;
        // One that is younger than the shortest stretch too.
        let old_s = to.t - MONITOR.stretches_s[0];
        let driven = self.duties.iter().find(|given| given.0 > from.t && given.0 < old_s && given.1 != 0.0);
        let before = |given: &(f64, f64)| self.recent.iter().rev().find(|old| old.t <= given.0);
        let (to, least) = driven.and_then(before).map_or((to, 0.0), |old| (old, MONITOR.margin_counts));
        let goal = self.duties.iter().rev().find(|given| given.0 <= from.t);
        // Not only once the ramp to nought is over: a load that was braked swings back before.
        let off = !self.in_loop
            && self.loop_until_s < from.t - MONITOR.speed_s
            && goal.is_none_or(|given| given.1 == 0.0);
        let moved = to.counts - from.counts;
        let carried = MONITOR.carried * (self.speed_when_off() * moved.signum()).max(0.0);
        let slow = carried.max(MONITOR.swaying * self.gain);
        off && speed_before.abs() < slow && moved.abs() >= least && moved.abs() < slow * (to.t - from.t)
    }

    /// The speed that it had when its duty was taken away, counts/s; 0 where nobody remembers.
    fn speed_when_off(&self) -> f64 {
        let off = self.duties.iter().rev().take_while(|given| given.1 == 0.0).last();
        let earlier = |t: f64| self.recent.iter().rev().find(move |old| old.t <= t);
        let at_off = off.and_then(|off| earlier(off.0));
        let before = at_off.and_then(|at_off| earlier(at_off.t - MONITOR.speed_s));
        at_off.zip(before).map_or(0.0, |(now, before)| (now.counts - before.counts) / (now.t - before.t))
    }

    /// Whether nothing slows the motor down: its duty has stayed, and it was on its way there.
    fn keeps_its_speed(&self, stretch: &Stretch, direction: f64) -> bool {
        let settled_s = self.tau_bounds_s.map_or(0.0, |tau| 3.0 * tau.1);
        let steady = stretch.from.t - MONITOR.speed_s > self.since_s + 0.11 + settled_s;
        let rising = self.tau_bounds_s.is_none() && stretch.from.t - MONITOR.speed_s > self.since_s + 0.02;
        !self.in_loop && (steady || rising) && stretch.speed_before * direction > 0.0
    }

    /// The least distance that the motor can have gone forwards, and backwards: with the lowest duty, the most friction, and the time constant
    /// that suits it. One the other way is negative.
    fn least_distances(&self, stretch: &Stretch, tau: (f64, f64)) -> [f64; 2] {
        let mut ways = [1.0, -1.0].map(|direction| (direction, stretch.speed_before * direction, 0.0));
        let mut decays = Decays::default();
        // The speed before was that of the middle of its own time.
        let mut t = stretch.from.t - 0.5 * MONITOR.speed_s;
        while t < stretch.to.t {
            let step = MONITOR.step_s.min(stretch.to.t - t);
            let range = self.duty_range(t + 0.5 * step);
            for (direction, speed, distance) in &mut ways {
                let duty = if *direction > 0.0 { range.0 - self.load_duty } else { self.load_duty - range.1 };
                let next = self.least_speed(*speed, duty, step, tau, &mut decays);
                if t + step > stretch.from.t {
                    *distance += 0.5 * (*speed + next) * step.min(t + step - stretch.from.t);
                }
                *speed = next;
            }
            t += step;
        }
        ways.map(|way| way.2)
    }

    /// The lowest speed after a step.
    fn least_speed(&self, speed: f64, duty: f64, step: f64, tau: (f64, f64), decays: &mut Decays) -> f64 {
        let gain = if duty > 0.0 { MONITOR.least_gain * self.gain } else { self.gain / MONITOR.least_gain };
        let mut drive = gain * duty - speed;
        if let Some(limit) = self.drive_limit {
            let most = self.gain * limit;
            drive = drive.clamp(-1.3 * most, 0.7 * most);
        }
        let friction = self.gain * self.start_duty;
        let force = if speed > 0.0 { drive - friction } else { drive };
        let held = speed == 0.0 && force >= 0.0;
        let force = if held { (force - friction).max(0.0) } else { force };
        let (tau_s, decay) = if force > 0.0 { (tau.1, &mut decays.slow) } else { (tau.0, &mut decays.quick) };
        let next = speed + force * (1.0 - decay.of(-step / tau_s));
        // Friction stops a motor, but does not turn it.
        let stops = speed > 0.0 && next < 0.0 && gain * duty >= -friction;
        if stops { 0.0 } else { next }
    }

    /// Remembers what a motor drew that gathered speed. One that is braked, or still goes the other way, may draw more than a standing one.
    fn learn_stall(&mut self, point: &Point) {
        let (Some(amps), Some(given)) = (point.amps, self.duties.back()) else { return };
        let Some(before) = self.recent.iter().rev().nth(1) else { return };
        let gathers = self.rising && (point.counts - before.counts) * given.1 > 0.0;
        if !self.in_loop && gathers && given.1.abs() >= MONITOR.telling_duty {
            let clear = amps.abs() - self.no_current_amps();
            self.least_stall_amps = self.least_stall_amps.max(clear / given.1.abs());
        }
    }

    /// Amperes at full duty with the shaft at rest at the least, where the probe could not tell what they are; `None` where nothing told.
    pub(crate) fn least_stall_amps(&self) -> Option<f64> {
        Some(self.least_stall_amps).filter(|least| *least > 0.0)
    }

    fn learn_start(&mut self, point: &Point) {
        let driven = self.duties.back().is_some_and(|given| given.1 != 0.0);
        if self.start_took_s.is_some() || self.in_loop || !driven {
            return;
        }
        let from = self.recent.iter().rev().find(|old| old.t <= self.since_s);
        if from.is_some_and(|from| (point.counts - from.counts).abs() > MONITOR.start_counts) {
            self.start_took_s = Some(point.t - self.since_s);
        }
    }

    /// From rest, a duty clearly above the one that it started with moves it soon, and its own way.
    fn check_start(&self, point: &Point) -> Result<(), Cause> {
        let clearly = self.start_duty + MONITOR.clearly_higher;
        let duty = self.duty_at(point.t);
        if self.in_loop || duty.abs() < clearly || self.tau_bounds_s.is_some() {
            return Ok(());
        }
        // One that was driven the other way before may still run on.
        let is_from_rest = self.duties.iter().all(|given| given.1 * duty >= 0.0);
        if self.never_turned()
            && is_from_rest
            && let Some(stretch) = self.stretch(MONITOR.stretches_s[1])
            && self.duty_at(stretch.from.t) * duty.signum() >= clearly
            && (stretch.to.counts - stretch.from.counts) * duty.signum() < -MONITOR.margin_counts
        {
            return Err(Cause::EncoderFlipped);
        }
        let start_s = self.start_took_s.map_or(MONITOR.start_s.0, |took| {
            (MONITOR.starts * took).clamp(MONITOR.start_s.0, MONITOR.start_s.1)
        });
        if point.t - self.since_s < start_s + 0.05 {
            return Ok(());
        }
        // From the poll before that time on: polls that were lost, or too late to tell anything, are no standing motor.
        let Some(first) = self.recent.iter().rposition(|old| point.t - old.t >= start_s) else {
            return Ok(());
        };
        let within = self.recent.iter().skip(first).map(|old| old.counts);
        let (low, high) = within.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
        if high - low <= 1.0 { Err(Cause::Stalled) } else { Ok(()) }
    }

    /// Whether it was never seen to go the way that its duty drives it.
    pub(crate) fn never_turned(&self) -> bool {
        self.gain <= 0.0
    }

    /// Remembers the highest speed over duty.
    fn learn(&mut self) {
        let Some(stretch) = self.stretch(MONITOR.stretches_s[0]) else { return };
        let duty = self.duty_at(stretch.to.t);
        if self.in_loop
            || !self.rising
            || duty.abs() < self.start_duty + 0.03
            || stretch.from.t < self.since_s + 0.06
        {
            return;
        }
        let speed = (stretch.to.counts - stretch.from.counts) / (stretch.to.t - stretch.from.t);
        self.gain = self.gain.max(speed / duty);
        self.learn_emf(stretch.to, speed, duty);
    }

    /// Current is what the duty has over the voltage of the turning motor.
    fn learn_emf(&mut self, point: Point, speed: f64, duty: f64) {
        let (Some(amps), Some(stall)) = (point.amps, self.stall_amps) else { return };
        let current = amps.abs() / stall;
        let turning = duty.abs() - current;
        // What the limit holds back has less than the duty that was given.
        let limited =
            point.limited || self.drive_limit.is_some_and(|limit| current > MONITOR.near_limit * limit);
        if limited || turning < 0.15 || speed * duty <= 0.0 {
            return;
        }
        let gain = speed.abs() / turning;
        self.emf_gain = if self.emf_gain > 0.0 { self.emf_gain + 0.3 * (gain - self.emf_gain) } else { gain };
    }

    fn check_current(&mut self, point: &Point) -> Result<(), Cause> {
        let duty = self.duty_at(point.t).abs();
        if self.in_loop
            && let Some(amps) = point.amps
            && self.is_slow(duty)
        {
            self.current.see_held(duty, amps.abs(), self.no_current_amps());
        }
        // A loop holds a motor against its friction by less, and that draws a current too if it did before.
        let is_held = self.in_loop && self.current.is_drawn_at(duty);
        if duty < self.start_duty + 0.04 && !is_held {
            self.current.rest();
            return Ok(());
        }
        let Some(amps) = point.amps else { return Ok(()) };
        let is_settled = point.t - self.since_s > MONITOR.settled_s;
        self.current.see(point.t, amps.abs(), is_settled, self.no_current_amps());
        let since_s = point.t - SILENCE.open_s;
        let is_open = self.draws_clearly()
            && self.current.is_long(self.noise_amps)
            && self.has_to_draw(since_s)
            && !self.goes_on(since_s);
        if is_open { Err(Cause::MotorOpened) } else { Ok(()) }
    }

    /// Whether the voltage of the turning motor is less than half of a duty: what it draws then is that of a standing one, or nearly.
    fn is_slow(&self, duty: f64) -> bool {
        let gain = self.closed_loop.as_ref().map_or(self.gain, |known| known.model().gain_counts_per_s);
        let mut newest = self.recent.iter().rev();
        let (Some(to), Some(from)) = (newest.next(), newest.next()) else { return false };
        (to.counts - from.counts).abs() < 0.5 * duty * gain * (to.t - from.t)
    }

    /// Whether the duty since then was so far from the voltage of the turning motor, beyond it or below, that a current had to flow, as far as that voltage is
    /// known. A motor that slows down draws none for a while, and a loop whose duty jumps from tick to tick may be polled in step with its lower half.
    fn has_to_draw(&self, since_s: f64) -> bool {
        let known = self.closed_loop.as_ref().map(ClosedLoopMonitor::model);
        // A duty so far from the voltage has no more than the current that counts as none.
        let none = self.stall_amps.map_or(0.0, |stall| self.no_current_amps() / stall);
        let (gain, driving, braking) = match known {
            Some(model) => (
                model.gain_counts_per_s,
                none.max(MONITOR.least_push * model.coulomb_duty),
                none.max(MONITOR.braking),
            ),
            None if self.emf_gain > 0.0 => (self.emf_gain, none, none),
            None => return true,
        };
        let polls: Vec<&Point> =
            self.recent.iter().filter(|point| point.t >= since_s - MONITOR.speed_s).collect();
        // Two polls see a tick's counts more or less, which at a coarse encoder are more than a friction.
        let mut beyond: Vec<f64> = (1..polls.len())
            .filter(|n| polls[*n].amps.is_some())
            .map(|n| {
                let (from, to) = (polls[n.saturating_sub(2)], polls[(n + 1).min(polls.len() - 1)]);
                let speed = (to.counts - from.counts) / (to.t - from.t).max(1e-3);
                let read = polls[n].duty.filter(|_| self.in_loop);
                let duty = read.map_or_else(|| self.duty_at(polls[n].t), |read| read.1);
                duty.abs() - speed * duty.signum() / gain
            })
            .collect();
        beyond.sort_by(f64::total_cmp);
        beyond.get(beyond.len() / 2).is_none_or(|beyond| *beyond > driving || *beyond < -braking)
    }

    /// Whether no current was read since a push began, of a motor that draws one.
    pub(crate) fn drew_nothing(&self, since_s: f64) -> bool {
        let mut since = self
            .recent
            .iter()
            .filter(|point| point.t > since_s + MONITOR.pushed_s)
            .filter_map(|point| point.amps)
            .peekable();
        self.draws_clearly()
            && since.peek().is_some()
            && since.all(|amps| amps.abs() <= self.no_current_amps())
    }

    /// Whether the motor has kept its speed since then, though its friction alone would have slowed it down.
    fn goes_on(&self, since_s: f64) -> bool {
        let Some(to) = self.recent.back() else { return false };
        let since = || self.recent.iter().filter(|point| point.t >= since_s - MONITOR.speed_s);
        let middle_s = 0.5 * (since_s + to.t);
        let (Some(from), Some(middle)) = (since().next(), since().find(|point| point.t >= middle_s)) else {
            return false;
        };
        let speed = |a: &Point, b: &Point| (b.counts - a.counts) / (b.t - a.t).max(1e-3);
        let (before, now) = (speed(from, middle), speed(middle, to));
        let passed_s = 0.5 * (to.t - from.t);
        let known = self.closed_loop.as_ref().and_then(|closed_loop| closed_loop.least_fall(passed_s));
        let rough = || {
            let tau_s = 2.0 * self.rough_model(to.t).1;
            0.5 * self.gain * self.start_duty * (passed_s / tau_s).min(1.0)
        };
        let fall = known.unwrap_or_else(rough);
        let clear = 4.0 / (to.t - middle.t).max(1e-3);
        fall > clear && before * now > 0.0 && before.abs() - now.abs() < 0.6 * fall.min(before.abs())
    }

    /// Highest reading that counts as no current, A.
    pub(crate) fn no_current_amps(&self) -> f64 {
        SILENCE.no_current_amps.max(SILENCE.noises * self.noise_amps)
    }

    /// Whether a turning motor was seen to draw a current that can be distinguished from none: enough to name what an alarm is about, not to raise one.
    pub(crate) fn draws(&self) -> bool {
        self.current.has_been_clear || self.stalls_clearly()
    }

    /// Whether it typically draws one: its silence raises an alarm.
    fn draws_clearly(&self) -> bool {
        self.current.is_clear(self.no_current_amps()) || self.stalls_clearly()
    }

    /// Whether already the current of a little friction could be distinguished from none.
    fn stalls_clearly(&self) -> bool {
        self.stall_amps.is_some_and(|stall| stall * 0.015 > 2.0 * self.no_current_amps())
    }

    /// How fast a duty is taken to change, 1/s.
    pub(crate) fn slew_per_s(&self) -> f64 {
        OPEN_LOOP.duty_slew_per_s * self.ramp.unwrap_or(1.0)
    }

    fn slewed(&self, duty: f64, goal: f64, seconds: f64) -> f64 {
        let most = self.slew_per_s() * seconds.max(0.0);
        if most.is_finite() && !self.is_abrupt { duty + (goal - duty).clamp(-most, most) } else { goal }
    }

    /// Duties that friction and the load take from a motor whose model is known; 0 before.
    pub(crate) fn opposing(&self) -> (f64, f64) {
        let known = self.closed_loop.as_ref().map(ClosedLoopMonitor::model);
        known.map_or((0.0, 0.0), |model| (model.coulomb_duty, model.load_duty))
    }

    /// Speed per duty without any load, counts/s, and the time constant, as far as they are known.
    pub(crate) fn rough_model(&self, alarm_s: f64) -> (f64, f64) {
        // In the first run a motor that has come to some speed is not far from its time constant.
        let young_s = (0.5 * (alarm_s - self.first_s)).clamp(0.01, 0.5);
        let tau_s = self.tau_bounds_s.map_or(young_s, |tau| (tau.0 * tau.1).sqrt());
        (if self.emf_gain > 0.0 { self.emf_gain } else { self.gain }, tau_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The monitor of a motor that starts at a duty and was found to have a gain.
    fn knowing(start_duty: f64, gain_counts_per_s: f64) -> MotorMonitor {
        let mut monitor = MotorMonitor { start_duty, ..MotorMonitor::default() };
        monitor.know(&PlantModel {
            gain_counts_per_s,
            tau_s: 0.11,
            coulomb_duty: 0.03,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        });
        monitor
    }

    /// A motor braked at 0.31 since 0.95 s and turned off at 0.99 s, whose load swings back by `scale` times 29 counts when it should stand.
    fn seen_swinging(scale: f64) -> Result<(), Cause> {
        let mut monitor = knowing(0.06, 11_900.0);
        monitor.drive(0.0, 0.0);
        monitor.drive(0.95, 0.31);
        monitor.drive(0.99, 0.0);
        let counts = [-61.0, -64.0, -54.0, -48.0, -46.0, -45.0, -44.0, -27.0, -19.0, -15.0];
        counts.into_iter().enumerate().try_for_each(|(n, counts)| {
            let t = 0.96 + 0.015 * n as f64;
            monitor.see(&Point {
                t,
                counts: scale * counts,
                duty: None,
                amps: None,
                volts: None,
                limited: false,
            })
        })
    }

    #[test]
    fn a_braked_load_that_swings_back_while_the_duty_still_ramps_down_is_no_fault() {
        assert_eq!(seen_swinging(1.0), Ok(()));
        assert_eq!(seen_swinging(40.0), Err(Cause::Stalled), "no load swings back that fast");
    }

    /// A motor that was braked swings back through the backlash of its gear, by `scale` times 38 counts, and stands; then a little duty takes it on the same way.
    fn seen_driven_after_swinging(scale: f64, driven: f64) -> Result<(), Cause> {
        let mut monitor = knowing(0.04, 21_130.0);
        monitor.drive(0.0, 0.0);
        monitor.drive(0.164, -0.29);
        monitor.drive(0.194, 0.0);
        monitor.drive(0.355, -0.06);
        let counts =
            [20.0, 32.0, 36.0, 37.0, 37.0, 26.0, 16.0, 10.0, 6.0, 4.0, 2.0, 2.0, 2.0, 2.0, 1.0, -1.0, -1.0];
        let on = [0.0, -2.0, -7.0, -13.0, -20.0, -28.0];
        let swung = counts.map(|counts| scale * counts);
        let rest = swung[counts.len() - 1];
        swung.into_iter().chain(on.map(|counts| rest + driven * counts)).enumerate().try_for_each(
            |(n, counts)| {
                let t = 0.203 + 0.01 * n as f64;
                monitor.see(&Point { t, counts, duty: None, amps: None, volts: None, limited: false })
            },
        )
    }

    #[test]
    fn a_load_that_swung_back_before_a_duty_was_given_is_not_held_against_it() {
        assert_eq!(seen_driven_after_swinging(1.4, 1.0), Ok(()));
        assert_eq!(
            seen_driven_after_swinging(1.4, 12.0),
            Err(Cause::Stalled),
            "nothing goes so fast at that duty"
        );
    }

    /// A motor at 1,020 counts/s of 3,800 is braked and stands; then its load takes it along at so many counts/s.
    fn seen_taken_along(counts_per_s: f64) -> Result<(), Cause> {
        let mut monitor = knowing(0.04, 3_900.0);
        monitor.release((0.0, 0.0), 1.0 / 300.0);
        let mut counts = 0.0;
        let braked = [560.0, 310.0, 170.0, 90.0, 0.0, 0.0, 0.0, 0.0];
        (0..32_usize).try_for_each(|n| {
            let t = 0.01 * n as f64;
            if n == 16 {
                monitor.drive(t - 0.002, 0.0);
            }
            let speed = if n < 16 { 1_020.0 } else { braked.get(n - 16).copied().unwrap_or(counts_per_s) };
            counts += 0.01 * speed;
            let duty = (n < 16).then_some((t, 0.3));
            monitor.see(&Point { t, counts, duty, amps: None, volts: None, limited: false })
        })
    }

    #[test]
    fn a_load_that_takes_a_braked_motor_along_slower_than_it_was_is_no_fault() {
        assert_eq!(seen_taken_along(390.0), Ok(()));
        assert_eq!(seen_taken_along(800.0), Err(Cause::Stalled), "nothing has braked it");
        assert_eq!(seen_taken_along(-390.0), Err(Cause::Stalled), "the way back is no load that goes on");
    }
}
