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
        mirror_error: (f64, f64) = (0.12, 0.6),
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
    }
}

/// One poll with what a hypothesis needs.
struct Moment {
    t: f64,
    counts: f64,
    duty: f64,
    /// Speed as counted, counts/s.
    speed: f64,
    /// Current over stall current.
    current: Option<f64>,
}

/// Names what is wrong. `after` are the polls since `alarm_s`, when the duty was taken away.
pub(crate) fn diagnose(monitor: &MotorMonitor, alarm_s: f64, after: &[Point]) -> Cause {
    let polls: Vec<Point> = monitor.recent().copied().chain(after.iter().copied()).collect();
    if is_open(monitor, &polls, alarm_s) {
        return Cause::MotorOpened;
    }
    let moments = moments(monitor, &polls, alarm_s - DIAGNOSIS.before_s);
    let stall = monitor.stall_amps.filter(|stall| *stall > DIAGNOSIS.telling_stall_amps);
    let (gain, tau_s) = monitor.rough_model(alarm_s);
    let last = monitor.recent().next_back().map_or(0.0, |point| point.counts);
    let alive = after.iter().any(|point| (point.counts - last).abs() > DIAGNOSIS.dead_counts);
    if gain > 0.0 && outruns(&moments, gain, monitor.load_duty, alarm_s) {
        return Cause::EncoderFlipped;
    }
    if stall.is_some() && !alive {
        return if turns_unseen(monitor, &moments, alarm_s) { Cause::EncoderLost } else { Cause::Stalled };
    }
    if !alive || gain <= 0.0 {
        return Cause::Stalled;
    }
    let hypotheses = Hypotheses { moments: &moments, gain, tau_s, limit: limit_of(monitor), alarm_s };
    let (stopped, flipped) = (hypotheses.as_counted().min(hypotheses.stands()), hypotheses.flipped());
    let likeness = hypotheses.likeness_of_mirror();
    let currents_agree =
        stall.is_some() && stopped > DIAGNOSIS.objection && flipped < DIAGNOSIS.agree * stopped;
    let currents_object =
        stall.is_some() && flipped > DIAGNOSIS.objection && stopped < DIAGNOSIS.better * flipped;
    let goes_on = likeness < if currents_agree { DIAGNOSIS.mirror_error.1 } else { DIAGNOSIS.mirror_error.0 };
    if goes_on && !currents_object { Cause::EncoderFlipped } else { Cause::Stalled }
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
        speed: around(n),
        current: point.amps.zip(stall).map(|(amps, stall)| amps.abs() / stall),
    })
    .collect()
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
fn turns_unseen(monitor: &MotorMonitor, moments: &[Moment], alarm_s: f64) -> bool {
    let limit = limit_of(monitor);
    let still = moments.iter().rposition(|moment| moment.speed != 0.0).map_or(0, |last| last + 1);
    let still = &moments[still..];
    let least_duty =
        (DIAGNOSIS.telling_amps / monitor.stall_amps.unwrap_or(f64::INFINITY)).max(DIAGNOSIS.least_duty);
    let off: Vec<f64> = still
        .iter()
        .filter(|moment| moment.duty.abs() >= least_duty)
        .filter_map(|moment| Some(1.0 - moment.current? / moment.duty.abs().min(limit)))
        .collect();
    let driven_off = middle(off).is_some_and(|middle| middle > DIAGNOSIS.short);
    let stall = monitor.stall_amps.unwrap_or(f64::INFINITY);
    let braked = still.iter().filter(|moment| moment.duty == 0.0 && moment.t > alarm_s + DIAGNOSIS.braked_s);
    let braked: Vec<f64> = braked.filter_map(|moment| moment.current).collect();
    let first = braked.iter().take(2).sum::<f64>() / braked.len().clamp(1, 2) as f64;
    // What rings on a spring comes by nought again and again.
    let least = braked.into_iter().reduce(f64::min).unwrap_or(0.0);
    driven_off || first > 0.08 || least > (2.0 * monitor.no_current_amps() / stall).max(0.02)
}

/// What may have happened, held against the currents.
struct Hypotheses<'a> {
    moments: &'a [Moment],
    gain: f64,
    tau_s: f64,
    limit: f64,
    alarm_s: f64,
}

impl Hypotheses<'_> {
    fn miss(&self, moment: &Moment, speed: f64) -> f64 {
        let Some(current) = moment.current else { return 0.0 };
        let expected = (moment.duty - speed / self.gain).abs().min(self.limit);
        (expected - current).abs().min(DIAGNOSIS.wrong).powi(2)
    }

    fn misfit(&self, speed: impl Fn(&Moment) -> f64) -> f64 {
        self.moments.iter().map(|moment| self.miss(moment, speed(moment))).sum::<f64>() + DIAGNOSIS.same
    }

    /// The best misfit with the speed changed by `change` from some moment before the alarm on.
    fn since_best(&self, change: impl Fn(f64) -> f64) -> f64 {
        let starts = self.moments.iter().map(|moment| moment.t).filter(|t| *t <= self.alarm_s);
        let of = |from: f64| {
            self.misfit(|moment| if moment.t >= from { change(moment.speed) } else { moment.speed })
        };
        starts.map(of).fold(f64::INFINITY, f64::min)
    }

    /// The encoder is right.
    fn as_counted(&self) -> f64 {
        self.misfit(|moment| moment.speed)
    }

    /// The motor stands while a load oscillates that the encoder sees.
    fn stands(&self) -> f64 {
        self.since_best(|_| 0.0)
    }

    /// The encoder counts the other way.
    fn flipped(&self) -> f64 {
        self.since_best(|speed| -speed)
    }

    /// How far the motor is from going on as such a motor does, counted the other way from some moment before the alarm on.
    fn likeness_of_mirror(&self) -> f64 {
        let starts = (1..self.moments.len()).take_while(|n| self.moments[n - 1].t < self.alarm_s);
        let tries = starts.flat_map(|n| [0.5, 1.0, 2.0].map(|scale| (n, scale * self.tau_s)));
        tries.map(|(start, tau_s)| self.mirrored(start, tau_s)).fold(f64::INFINITY, f64::min)
    }

    /// Squared error of the mirrored speeds over the squared speeds.
    fn mirrored(&self, start: usize, tau_s: f64) -> f64 {
        let before = &self.moments[start - 1];
        let (mut speed, mut t) = (before.speed, before.t);
        let (mut error, mut height) = (0.0, 0.0);
        for (n, moment) in self.moments[start..].iter().enumerate() {
            let most = self.gain * self.limit;
            let drive = (self.gain * moment.duty - speed).clamp(-most, most);
            speed += drive * (1.0 - (-(moment.t - t) / tau_s).exp());
            t = moment.t;
            // About the change itself a speed is a mixture.
            if n >= 1 {
                error += (speed + moment.speed).powi(2);
                height += speed.powi(2);
            }
        }
        error / f64::max(height, 1e-9)
    }
}
