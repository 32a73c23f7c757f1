//! What is wrong with a motor that did not do what motors do: stopped, or its encoder lost or turned round?
//!
//! The duty is taken away first; what currents and counts do while it goes down, and did just before, tells the rest. The current
//! of a motor follows from its duty and its true speed, whatever the encoder says. So each hypothesis (the motor was stopped and the
//! encoder is right; the encoder is dead since then; it counts the other way since then) is held against the currents.

use crate::cause::Cause;
use crate::motor_monitor::MotorMonitor;
use crate::poll::Point;
use crate::thresholds::thresholds;

thresholds! {
    /// Which cause explains readings that the model does not.
    pub(crate) DIAGNOSIS: Thresholds {
        /// How long the motor is watched with its duty taken away, in seconds.
        diagnosis_s: f64 = 0.15,
        /// Stall current above which currents can be compared, in amperes.
        telling_stall_amps: f64 = 0.2,
        /// Current of a standing motor that readings tell from that of a turning one, in amperes.
        telling_amps: f64 = 0.15,
        /// Least duty at which readings tell the two apart, as a share of full.
        least_duty: f64 = 0.10,
        /// How long before the alarm a fault may have come, in seconds.
        before_s: f64 = 0.22,
        /// Counts that a dead encoder may give.
        dead_counts: f64 = 1.5,
        /// Largest error of a current that counts, as a share of the stall current: one that is off by more is just wrong.
        wrong: f64 = 0.3,
        /// Misfit of an explanation from which on the currents may speak against it, as a sum of squared shares of the stall current.
        objection: f64 = 0.05,
        /// Share of the misfit of a reversed encoder that an encoder as it is must stay below for the currents to object to a reversal.
        better: f64 = 0.6,
        /// Share of the misfit of an encoder as it is that a reversed one must stay below for the currents to speak for a reversal.
        agree: f64 = 0.9,
        /// Largest squared error of mirrored speeds over the squared speeds: by itself, and where the currents say the same.
        mirror_error: (f64, f64) = (0.12, 0.35),
        /// Share of the largest jump of the speed from which on another one may be a turned encoder.
        jump: f64 = 0.5,
        /// Multiples of the rough time constant that are tried: of a motor that is not known yet it may be far too long.
        mirror_taus: [f64; 5] = [0.05, 0.2, 0.5, 1.0, 2.0],
        /// By which factor a current has to grow while the duty is taken away.
        grown: f64 = 1.5,
        /// Polls at one duty from which the friction of a slow motor is read.
        steady: usize = 4,
        /// The most that it may be, as a multiple of the model's: cogs and Stribeck friction hold a slow motor.
        most_friction: f64 = 3.0,
        /// Least share by which the current of a turning motor is short of that of a standing one; a battery sags by less.
        short: f64 = 0.3,
        /// Duty above which the motor is driven, as a share of full.
        driven_duty: f64 = 0.03,
        /// How much faster against its duty a motor must be than it was with it, as a factor.
        outrun: f64 = 1.2,
        /// How much faster it must be on top of that, as a share of the speed at full duty.
        least_outrun: f64 = 0.02,
        /// Distance that it must have gone against its duty, in counts.
        least_outrun_counts: f64 = 4.5,
        /// Misfit that says nothing, as a sum of squared shares of the stall current.
        same: f64 = 3e-4,
        /// How long the duty takes to come down and the winding's current to follow, in seconds.
        braked_s: f64 = 0.066,
        /// The same where a duty is in force at once, in seconds: the command, a tick, and the winding's current.
        braked_at_once_s: f64 = 0.02,
        /// Current of the first readings of a braked motor that turns, as a share of the stall current.
        braked_share: f64 = 0.08,
        /// The same of all readings, where it is clear of their noise too.
        least_braked: f64 = 0.006,
    }
}

/// One poll with what a hypothesis needs.
struct Moment {
    t: f64,
    counts: f64,
    duty: f64,
    /// The duty of the poll before, which a current that is read just after a change may still be that of.
    duty_before: f64,
    /// Speed as counted, counts/s.
    speed: f64,
    /// Current over stall current.
    current: Option<f64>,
}

/// Names what is wrong. `after` are the polls since `alarm_s`, when the duty was taken away.
pub(crate) fn diagnose(monitor: &MotorMonitor, alarm_s: f64, after: &[Point]) -> Cause {
    let last = monitor.recent().next_back();
    let (last_s, last_counts) = last.map_or((f64::NEG_INFINITY, 0.0), |point| (point.t, point.counts));
    let later = after.iter().filter(|point| point.t > last_s);
    let polls: Vec<Point> = monitor.recent().chain(later).copied().collect();
    if is_open(monitor, &polls, alarm_s) {
        return Cause::MotorOpened;
    }
    let moments = moments(monitor, &polls, alarm_s - DIAGNOSIS.before_s);
    let stall = monitor.stall_amps.filter(|stall| *stall > DIAGNOSIS.telling_stall_amps);
    let (known, tau_s) = monitor.rough_model(alarm_s);
    let gain = if known > 0.0 { known } else { gain_seen(&moments, alarm_s) };
    let alive = after.iter().any(|point| (point.counts - last_counts).abs() > DIAGNOSIS.dead_counts);
    if gain > 0.0 && outruns(&moments, gain, monitor.load_duty, alarm_s) {
        return Cause::EncoderFlipped;
    }
    if !alive {
        let turns = match stall {
            Some(stall) => turns_unseen(monitor, stall, &moments, alarm_s),
            None => draws_as_turning(monitor, &polls, alarm_s),
        };
        return if turns { Cause::EncoderLost } else { Cause::Stalled };
    }
    if gain <= 0.0 {
        return Cause::Stalled;
    }
    let (friction, load) = monitor.opposing();
    let limit = limit_of(monitor);
    let hypotheses = Hypotheses { moments: &moments, gain, tau_s, friction, load, limit, alarm_s };
    if hypotheses.is_flipped(stall.is_some()) { Cause::EncoderFlipped } else { Cause::Stalled }
}

/// Names why a motor that was pushed of late has not moved, or was counted `backwards`.
pub(crate) fn why_unmoved(monitor: &MotorMonitor, backwards: bool) -> Cause {
    let stall = monitor.stall_amps.filter(|stall| *stall > DIAGNOSIS.telling_stall_amps);
    let pushed: Vec<(f64, f64)> = monitor
        .recent()
        .filter_map(|point| Some((monitor.duty_at(point.t).abs(), point.amps?.abs())))
        .filter(|(duty, _)| *duty > monitor.start_duty)
        .collect();
    if monitor.draws()
        && !pushed.is_empty()
        && pushed.iter().all(|(_, amps)| *amps <= monitor.no_current_amps())
    {
        return Cause::MotorOpened;
    }
    if backwards {
        return Cause::EncoderFlipped;
    }
    let limit = limit_of(monitor);
    let short =
        pushed.iter().map(|(duty, amps)| 1.0 - amps / stall.unwrap_or(f64::INFINITY) / duty.min(limit));
    let turns = stall.is_some() && middle(short.collect()).is_some_and(|short| short > DIAGNOSIS.short);
    if turns { Cause::EncoderLost } else { Cause::Stalled }
}

fn middle(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Whether no current flows: not at the duty that was given at last, nor while the motor is braked.
fn is_open(monitor: &MotorMonitor, polls: &[Point], alarm_s: f64) -> bool {
    let none = |amps: f64| amps.abs() <= monitor.no_current_amps();
    let least_duty = monitor.start_duty.max(DIAGNOSIS.driven_duty);
    let driven = |point: &&Point| point.t < alarm_s && monitor.duty_at(point.t).abs() > least_duty;
    let before = polls.iter().rev().filter(driven).find_map(|point| point.amps);
    let mut after = polls.iter().filter(|point| point.t >= alarm_s).filter_map(|point| point.amps);
    monitor.draws() && before.is_some_and(none) && after.all(none)
}

fn moments(monitor: &MotorMonitor, polls: &[Point], from_s: f64) -> Vec<Moment> {
    let stall = monitor.stall_amps.filter(|stall| *stall > 0.0);
    let around = |n: usize| {
        let (a, b) = (&polls[n - 1], &polls[(n + 1).min(polls.len() - 1)]);
        if b.t > a.t { (b.counts - a.counts) / (b.t - a.t) } else { 0.0 }
    };
    let late = polls.iter().enumerate().skip(1).filter(|(_, point)| point.t > from_s);
    late.map(|(n, point)| Moment {
        t: point.t,
        counts: point.counts,
        duty: monitor.duty_at(point.t),
        duty_before: monitor.duty_at(polls[n - 1].t),
        speed: around(n),
        current: point.amps.zip(stall).map(|(amps, stall)| amps.abs() / stall),
    })
    .collect()
}

/// Speed over duty of a motor that had not turned for long enough to be known, counts/s: what its current leaves of the duty turns it; 0 where it did not turn.
fn gain_seen(moments: &[Moment], alarm_s: f64) -> f64 {
    moments
        .iter()
        .filter(|moment| moment.t < alarm_s && moment.speed * moment.duty > 0.0)
        .map(|moment| (moment.speed.abs(), moment.duty.abs() - moment.current.unwrap_or(0.0)))
        .filter(|(_, turning)| *turning > DIAGNOSIS.least_duty)
        .fold(0.0, |most, (speed, turning)| f64::max(most, speed / turning))
}

fn limit_of(monitor: &MotorMonitor) -> f64 {
    monitor.drive_limit.unwrap_or(f64::INFINITY)
}

/// Whether the motor is counted against its duty faster than it was with it shortly before. What springs back, an end stop or a load
/// behind a shaft, gives back no more than it was given.
fn outruns(moments: &[Moment], gain: f64, load_duty: f64, alarm_s: f64) -> bool {
    // A load may turn the motor against its duty.
    let pull = |moment: &Moment| moment.duty - 1.5 * load_duty.abs() * moment.duty.signum();
    let before = || moments.iter().filter(|moment| moment.t < alarm_s);
    let Some(last) =
        before().next_back().filter(|last| pull(last) * last.duty.signum() > DIAGNOSIS.driven_duty)
    else {
        return false;
    };
    let direction = last.duty.signum();
    let driven = || before().rev().take_while(|moment| pull(moment) * direction > DIAGNOSIS.driven_duty);
    let against = driven().map(|moment| -moment.speed * direction).fold(0.0, f64::max);
    let with = before().map(|moment| moment.speed * direction).fold(0.0, f64::max);
    // Nor is one that is just being turned round.
    let began = driven().last().map_or(0.0, |first| -first.speed * direction);
    let with = with.max(began);
    let gone = driven().map(|moment| (moment.counts - last.counts) * direction).fold(0.0, f64::max);
    gone > DIAGNOSIS.least_outrun_counts
        && -last.speed * direction > 0.4 * against
        && against > DIAGNOSIS.outrun * with + DIAGNOSIS.least_outrun * gain
}

/// Whether currents are other than those of a motor that stands, while nothing is counted.
fn turns_unseen(monitor: &MotorMonitor, stall: f64, moments: &[Moment], alarm_s: f64) -> bool {
    let limit = limit_of(monitor);
    let still = moments.iter().rposition(|moment| moment.speed != 0.0).map_or(0, |last| last + 1);
    let still = &moments[still..];
    let least_duty = (DIAGNOSIS.telling_amps / stall).max(DIAGNOSIS.least_duty);
    let off: Vec<f64> = still
        .iter()
        .map(|moment| (moment.duty.abs().min(moment.duty_before.abs()), moment.current))
        .filter(|(duty, _)| *duty >= least_duty)
        .filter_map(|(duty, current)| Some(1.0 - current? / duty.min(limit)))
        .collect();
    let driven_off = middle(off).is_some_and(|middle| middle > DIAGNOSIS.short);
    let braked_s = if monitor.is_abrupt {
        DIAGNOSIS.braked_at_once_s
    } else if driven_off {
        DIAGNOSIS.braked_s
    } else {
        // A controller may ramp half as fast as it was asked to, which a heavy motor hides.
        DIAGNOSIS.braked_s + monitor.duty_at(alarm_s).abs() / monitor.slew_per_s()
    };
    let braked = still.iter().filter(|moment| moment.duty == 0.0 && moment.t > alarm_s + braked_s);
    let braked: Vec<f64> = braked.filter_map(|moment| moment.current).collect();
    let early = || braked.iter().take(2).copied();
    // A duty that is off at once leaves no current in a standing motor by then, so that one reading tells.
    let first = if monitor.is_abrupt {
        early().fold(0.0, f64::max)
    } else {
        early().sum::<f64>() / braked.len().clamp(1, 2) as f64
    };
    // What rings on a spring comes by nought again and again.
    let least = braked.iter().copied().reduce(f64::min).unwrap_or(0.0);
    driven_off
        || first > DIAGNOSIS.braked_share
        || least > (2.0 * monitor.no_current_amps() / stall).max(DIAGNOSIS.least_braked)
}

/// The same where the current of a standing motor is not known. That goes down with the duty, and what brakes a turning motor grows; and it is more than the motor ever
/// drew while it gathered speed.
fn draws_as_turning(monitor: &MotorMonitor, polls: &[Point], alarm_s: f64) -> bool {
    let amps = |point: &Point| point.amps.map(f64::abs);
    let mut driven =
        polls.iter().filter(|point| point.t < alarm_s).filter_map(|point| Some((point.t, amps(point)?)));
    let Some((t, driven)) = driven.next_back() else { return false };
    let braked = polls.iter().filter(|point| point.t > alarm_s).filter_map(amps).fold(0.0, f64::max);
    let least = monitor.least_stall_amps().map_or(0.0, |stall| stall * monitor.duty_at(t).abs());
    braked > DIAGNOSIS.grown * driven + monitor.no_current_amps()
        || least > DIAGNOSIS.telling_amps && driven < (1.0 - DIAGNOSIS.short) * least
}

/// What may have happened, held against the currents.
struct Hypotheses<'a> {
    moments: &'a [Moment],
    gain: f64,
    tau_s: f64,
    /// Duties that friction and the load take; 0 before they are known.
    friction: f64,
    load: f64,
    limit: f64,
    alarm_s: f64,
}

impl Hypotheses<'_> {
    fn miss(&self, moment: &Moment, speed: f64) -> f64 {
        let Some(current) = moment.current else { return 0.0 };
        let expected =
            [moment.duty, moment.duty_before].map(|duty| (duty - speed / self.gain).abs().min(self.limit));
        // What a blow makes of a current is over before the limit takes hold of it.
        let current = current.min(self.limit);
        let nearest = current.clamp(expected[0].min(expected[1]), expected[0].max(expected[1]));
        (nearest - current).abs().min(DIAGNOSIS.wrong).powi(2)
    }

    fn misfit(&self, speed: impl Fn(&Moment) -> f64) -> f64 {
        self.moments.iter().map(|moment| self.miss(moment, speed(moment))).sum::<f64>() + DIAGNOSIS.same
    }

    /// The encoder is right.
    fn as_counted(&self) -> f64 {
        self.misfit(|moment| moment.speed)
    }

    /// The motor stands while a load oscillates that the encoder sees.
    fn stands(&self) -> f64 {
        let starts = self.moments.iter().map(|moment| moment.t).filter(|t| *t <= self.alarm_s);
        let of = |from: f64| self.misfit(|moment| if moment.t >= from { 0.0 } else { moment.speed });
        starts.map(of).fold(f64::INFINITY, f64::min)
    }

    /// Whether the motor goes on as such a motor does, counted the other way from some moment before the alarm on, and its currents do not object.
    fn is_flipped(&self, has_currents: bool) -> bool {
        let stopped = self.as_counted().min(self.stands());
        self.starts().into_iter().any(|start| {
            let flipped = self.flipped(start);
            let agree = has_currents && stopped > DIAGNOSIS.objection && flipped < DIAGNOSIS.agree * stopped;
            let object =
                has_currents && flipped > DIAGNOSIS.objection && stopped < DIAGNOSIS.better * flipped;
            let (by_itself, with_currents) = DIAGNOSIS.mirror_error;
            let most = if agree { with_currents } else { by_itself };
            // A quick motor is told without what opposes it, which may have changed since it was measured; a slow one is not.
            let opposing = [(0.0, 0.0), (self.friction_before(start), self.load)];
            let is_mirrored = |scale: &f64| {
                opposing.into_iter().any(|opposing| self.mirrored(start, scale * self.tau_s, opposing) < most)
            };
            !object && DIAGNOSIS.mirror_taus.iter().any(is_mirrored)
        })
    }

    /// When the speed jumped before the alarm, by nearly as much as it ever did: an encoder that turns round makes as large a jump as there is, and what goes up and down by less
    /// is another motion.
    fn starts(&self) -> Vec<usize> {
        let last = self.moments.len().saturating_sub(1);
        let all = (2..last).take_while(|n| self.moments[n - 1].t < self.alarm_s);
        let jumps: Vec<(usize, f64)> =
            all.map(|n| (n, (self.moments[n + 1].speed - self.moments[n - 2].speed).abs())).collect();
        let largest = jumps.iter().map(|jump| jump.1).fold(0.0, f64::max);
        jumps.iter().filter(|jump| jump.1 > DIAGNOSIS.jump * largest).map(|jump| jump.0).collect()
    }

    /// The encoder counts the other way from a moment on. The speeds on either side of the change are a mixture of those before and after it.
    fn flipped(&self, start: usize) -> f64 {
        let speed = |n: usize| match n {
            n if n + 1 < start => self.moments[n].speed,
            n if n <= start => self.moments[start - 2].speed,
            n => -self.moments[n].speed,
        };
        let misses = self.moments.iter().enumerate().map(|(n, moment)| self.miss(moment, speed(n)));
        misses.sum::<f64>() + DIAGNOSIS.same
    }

    /// The friction of a motor that is known: what a steady duty left over before that moment, since a slow one may have more than the model says.
    fn friction_before(&self, start: usize) -> f64 {
        let before = &self.moments[start.saturating_sub(DIAGNOSIS.steady)..start - 1];
        let last = &self.moments[start - 2];
        let is_steady = before.len() + 1 >= DIAGNOSIS.steady
            && before.iter().all(|moment| moment.duty == last.duty && moment.speed * moment.duty > 0.0);
        if self.friction == 0.0 || !is_steady {
            return self.friction;
        }
        let speed = before.iter().map(|moment| moment.speed).sum::<f64>() / before.len() as f64;
        let left = (last.duty - self.load - speed / self.gain) * speed.signum();
        left.clamp(0.0, DIAGNOSIS.most_friction * self.friction)
    }

    /// Squared error of the mirrored speeds over the squared speeds, with duties that friction and the load take.
    fn mirrored(&self, start: usize, tau_s: f64, (friction, load): (f64, f64)) -> f64 {
        // The speeds on either side of the change are a mixture of those before and after it.
        let before = &self.moments[start - 2];
        let (mut speed, mut t) = (before.speed, before.t);
        let (mut error, mut height) = (0.0, 0.0);
        for (n, moment) in self.moments[start - 1..].iter().enumerate() {
            let most = self.gain * self.limit;
            let pull = moment.duty - load;
            let held = if speed == 0.0 { pull.clamp(-friction, friction) } else { friction * speed.signum() };
            let drive = (self.gain * (pull - held) - speed).clamp(-most, most);
            let next = speed + drive * (1.0 - (-(moment.t - t) / tau_s).exp());
            // Friction stops a motor, but does not turn it.
            speed = if speed * next < 0.0 && pull.abs() < friction { 0.0 } else { next };
            t = moment.t;
            if n >= 2 {
                error += (speed + moment.speed).powi(2);
                height += speed.powi(2);
            }
        }
        error / f64::max(height, 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::PlantModel;

    /// When the alarm is, s.
    const ALARM_S: f64 = 10.0;
    const TICK_S: f64 = 1.0 / 300.0;

    /// A poll `t` s from the alarm on.
    fn poll(t: f64, counts: f64, duty: Option<f64>, amps: Option<f64>) -> Point {
        let t = ALARM_S + t;
        Point { t, counts, duty: duty.map(|duty| (t, duty)), amps, volts: None, limited: false }
    }

    fn monitor(limit: Option<f64>) -> MotorMonitor {
        let mut monitor = MotorMonitor::default();
        (monitor.start_duty, monitor.stall_amps, monitor.drive_limit) = (0.1, Some(10.0), limit);
        monitor.is_abrupt = true;
        monitor
    }

    /// What it is called after the polls before the alarm, which stand by what they are called on their way, and those after it.
    fn named(mut monitor: MotorMonitor, polls: &[Point]) -> Cause {
        let (before, after): (Vec<Point>, Vec<Point>) = polls.iter().partition(|point| point.t < ALARM_S);
        for point in &before {
            let _ = monitor.see(point);
        }
        monitor.drive(ALARM_S, 0.0);
        diagnose(&monitor, ALARM_S, &after)
    }

    #[test]
    fn a_motor_that_stood_before_a_loop_had_it_is_not_held_against_the_duty_of_the_loop_before() {
        let mut monitor = monitor(None);
        monitor.know(&PlantModel {
            gain_counts_per_s: 80_000.0,
            tau_s: 0.014,
            coulomb_duty: 0.03,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        });
        monitor.drive(ALARM_S - 5.0, 0.0);
        monitor.release((ALARM_S - 1.0, ALARM_S - 1.0), TICK_S);
        assert_eq!(monitor.see(&poll(-0.7, 0.0, Some(0.32), Some(1.0))), Ok(()));
        monitor.drive(ALARM_S - 0.6, 0.0);
        for n in 0..10 {
            assert_eq!(monitor.see(&poll(-0.5 + 0.04 * f64::from(n), 0.0, None, Some(0.0))), Ok(()));
        }
        monitor.release((ALARM_S - 0.1, ALARM_S - 0.1), TICK_S);
        let held = [poll(-0.07, 0.0, Some(-0.58), None), poll(-0.036, 0.0, Some(-0.83), Some(8.35))];
        let off = [0.019, 0.058, 0.094].map(|t| poll(t, 0.0, None, Some(0.0)));
        assert_eq!(named(monitor.clone(), &[&held[..], &off].concat()), Cause::Stalled);
        // One whose encoder is dead brakes with a current.
        let turned = [poll(-0.07, 0.0, Some(-0.58), None), poll(-0.036, 0.0, Some(-0.83), None)];
        let braked =
            [(0.019, 4.0), (0.058, 1.0), (0.094, 0.0)].map(|(t, amps)| poll(t, 0.0, None, Some(amps)));
        assert_eq!(named(monitor, &[&turned[..], &braked].concat()), Cause::EncoderLost);
    }

    /// At full duty with `speed` counts/s until 55 ms before the alarm, and 1 A.
    fn driven(speed: f64) -> Vec<Point> {
        let at = |n: u32| -1.0 + 0.015 * f64::from(n);
        (0..64).map(|n| poll(at(n), speed * (at(n) + 0.055), None, Some(1.0))).collect()
    }

    fn named_in_mid_drive(limit: f64, speed: f64, later: &[(f64, f64, f64)]) -> Cause {
        let mut monitor = monitor(Some(limit));
        monitor.drive(ALARM_S - 1.2, 1.0);
        let later = later.iter().map(|(t, counts, amps)| poll(*t, *counts, None, Some(*amps)));
        named(monitor, &driven(speed).into_iter().chain(later).collect::<Vec<_>>())
    }

    #[test]
    fn an_encoder_that_turns_round_leaves_the_current_as_it_was_and_an_end_stop_does_not() {
        // A quick motor: its time constant of 25 ms is far below the rough one of a motor that turned for a second.
        let flipped = [
            (-0.035, 192.0, 1.0),
            (-0.010, -1406.0, 1.0),
            (0.005, -2365.0, 1.0),
            (0.025, -3279.0, 4.5),
            (0.050, -3721.0, 1.4),
            (0.070, -3813.0, 0.3),
            (0.090, -3816.0, 0.0),
            (0.130, -3816.0, 0.0),
        ];
        assert_eq!(named_in_mid_drive(1.16, 63_900.0, &flipped), Cause::EncoderFlipped);
        // A gear that is thrown back by its stop, and a current limit of 7 A that is late for the blow.
        let thrown_back = [
            (-0.033, 5.0, 11.4),
            (-0.023, 4.0, 12.2),
            (-0.008, -93.0, 7.0),
            (0.007, -139.0, 5.5),
            (0.017, -183.0, 4.6),
            (0.032, -231.0, 3.0),
            (0.042, -259.0, 4.1),
            (0.057, -304.0, 2.6),
            (0.072, -333.0, 3.2),
            (0.082, -363.0, 2.2),
            (0.117, -431.0, 2.1),
            (0.142, -469.0, 1.5),
        ];
        assert_eq!(named_in_mid_drive(0.74, 8_200.0, &thrown_back), Cause::Stalled);
    }

    /// A coreless motor that creeps: most of its duty goes into friction, and it draws next to nothing.
    #[test]
    fn an_encoder_that_turns_round_while_the_motor_creeps_is_told_by_its_counts_alone() {
        let mut monitor = monitor(None);
        monitor.start_duty = 0.06;
        monitor.know(&PlantModel {
            gain_counts_per_s: 150_000.0,
            tau_s: 0.02,
            coulomb_duty: 0.03,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        });
        monitor.drive(ALARM_S - 1.2, 0.09);
        let creep = |t: f64| if t < -0.055 { 8_500.0 * t } else { -8_500.0 * (t + 0.11) };
        let before = (0..67).map(|n| -1.0 + 0.015 * f64::from(n)).filter(|t| *t < 0.0);
        let off = [(0.012, -997.0), (0.025, -1006.0), (0.04, -1006.0), (0.055, -1006.0), (0.07, -1006.0)];
        let polls: Vec<Point> = before
            .map(|t| poll(t, creep(t), None, Some(0.1)))
            .chain(off.map(|(t, counts)| poll(t, counts, None, Some(0.02))))
            .collect();
        assert_eq!(named(monitor, &polls), Cause::EncoderFlipped);
    }

    #[test]
    fn counts_that_stop_are_told_from_a_stop_by_what_the_motor_draws_where_no_stall_current_is_known() {
        // At full duty from rest 3 A, once it turns 0.2 A.
        let seen = |braked: [f64; 4]| {
            let mut monitor = monitor(None);
            monitor.stall_amps = None;
            monitor.drive(ALARM_S - 0.5, 1.0);
            let at = |n: u32| -0.5 + 0.015 * f64::from(n);
            let turning = |t: f64| if t < -0.45 { 3.0 } else { 0.2 };
            let stands = braked[0];
            let amps = |t: f64| if t < -0.055 { turning(t) } else { stands };
            let driven =
                (0..34).map(|n| poll(at(n), 2e4 * (at(n).min(-0.055) + 0.5), None, Some(amps(at(n)))));
            let off = [0.01, 0.025, 0.04, 0.055].into_iter().zip(braked);
            let off = off.map(|(t, amps)| poll(t, 8_900.0, None, Some(amps)));
            named(monitor, &driven.chain(off).collect::<Vec<_>>())
        };
        assert_eq!(seen([0.2, 0.0, 0.0, 0.0]), Cause::EncoderLost, "it draws what it drew while it turned");
        assert_eq!(seen([3.2, 1.0, 0.1, 0.0]), Cause::Stalled);
    }

    #[test]
    fn a_motor_that_has_only_ever_gone_against_its_duty_has_a_turned_encoder() {
        let seen = |direction: f64| {
            let mut monitor = monitor(None);
            monitor.drive(ALARM_S, 1.0);
            let at = |n: u32| 0.015 * f64::from(n);
            (0..14)
                .try_for_each(|n| monitor.see(&poll(at(n), direction * 2e4 * at(n).powi(2), None, Some(5.0))))
        };
        assert_eq!(seen(1.0), Ok(()));
        assert_eq!(seen(-1.0), Err(Cause::EncoderFlipped));
        // One that runs on after it was driven the other way.
        let mut monitor = monitor(None);
        monitor.drive(ALARM_S - 0.3, -1.0);
        monitor.drive(ALARM_S, 1.0);
        for n in 0..7 {
            let t = 0.015 * f64::from(n);
            assert_eq!(monitor.see(&poll(t, -2e3 * t, None, Some(5.0))), Ok(()));
        }
    }
}
