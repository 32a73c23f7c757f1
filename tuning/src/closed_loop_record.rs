//! The record of a closed loop, and how far the loop of a model is off it.
//!
//! The firmware's ticks fall anywhere between polls. Simulated is what the loop does on average over all phases of its tick: a setpoint comes into force
//! over the length of one tick, and a register that is refreshed once in each is half a tick old when it is read.

use crate::experiment_guard::{ExperimentGuard, Input};
use crate::law::Law;
use crate::model::Gains;
use crate::thresholds::thresholds;
use crate::ticks::{Setpoint, TickLoop};

thresholds! {
    /// How exact a record is, and how exact the model of it.
    pub(crate) RECORD: Thresholds {
        /// How much longer than the shortest an exchange may take, in seconds: a longer one says too little about when its counts were read.
        late_s: f64 = 0.004,
        /// Standard deviation of a time stamp, in seconds.
        stamp_s: f64 = 0.0006,
        /// How far the counts drift off the model in a second, as a standard deviation over the counts that the motor makes in that second; it grows with the root of the
        /// time.
        drift: f64 = 0.003,
        /// Standard deviation to which the model of a quiet duty is trusted, as a share of full duty.
        duty: f64 = 0.004,
        /// How far the duty may be off, as a share of what it changes by in a tick: the phase of the tick, 1 / sqrt(12).
        flank: f64 = 0.3,
        /// Standard deviations from which on a residual counts less and less.
        knee: f64 = 3.0,
    }
}

/// The closed-loop record.
#[derive(Clone, Debug, Default)]
pub struct ClosedLoopRecord {
    /// (time, setpoint speed).
    pub setpoints: Vec<(f64, f64)>,
    /// (time, counts).
    pub counts: Vec<(f64, f64)>,
    /// (time, duty).
    pub duties: Vec<(f64, f64)>,
    /// Standard deviation of the times of counts, as far as a busy host or line makes it, s.
    pub stamp_s: f64,
    /// How old the counts may have been when they were read.
    pub age: CountAge,
}

/// How old counts are when they are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CountAge {
    /// Up to a tick: a register that is refreshed once in each.
    #[default]
    UpToATick,
    /// Not at all: the counter itself is read.
    Live,
    /// Each came with its own time, so that it is known to much less than a tick.
    Dated,
}

impl CountAge {
    /// The age on average, ticks. That of counts which came with their time is in it.
    fn ticks(self) -> f64 {
        if self == Self::Live { 0.0 } else { 0.5 }
    }

    /// Standard deviation of an age of up to a tick, s.
    pub(crate) fn spread_s(tick_s: f64) -> f64 {
        tick_s / 12.0_f64.sqrt()
    }
}

impl ClosedLoopRecord {
    /// What the experiment guard recorded between two times under speed commands.
    #[must_use]
    pub fn of<L: Law>(guard: &ExperimentGuard<'_, L>, from_s: f64, to_s: f64) -> Self {
        let inside = |t: f64| t >= from_s && t <= to_s;
        let setpoints = guard.drives.iter().filter(|d| inside(d.t)).filter_map(|d| match d.input {
            Input::Speed(speed) => Some((d.t, speed)),
            Input::Duty(_) | Input::Position(..) => None,
        });
        let points = || guard.points.iter().zip(&guard.exchanges).filter(|(p, _)| inside(p.t));
        // The quickest exchanges show what the line takes by itself; when in a longer one the counts were read is open.
        let shortest = points().map(|(_, took)| took.1).fold(f64::INFINITY, f64::min);
        let prompt = || points().filter(|(_, took)| took.1 - shortest <= RECORD.late_s);
        let n = prompt().count().max(1) as f64;
        let stamps = L::stamps(&guard.setup.held);
        let open = prompt().map(|(_, took)| (took.1 - shortest).powi(2)).sum::<f64>() / n;
        Self {
            setpoints: setpoints.collect(),
            counts: prompt().map(|(p, _)| (p.t, p.counts)).collect(),
            duties: points().filter_map(|(p, _)| p.duty).collect(),
            stamp_s: (open / 12.0).sqrt().hypot(stamps.open_s),
            age: if stamps.are_dated { CountAge::Dated } else { CountAge::UpToATick },
        }
    }
}

/// Some seconds of a loop under known gains.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// What was polled.
    pub record: ClosedLoopRecord,
    /// The gains that were in force.
    pub gains: Gains,
    /// The speed that it was at when the record begins; `None` where it stood and had no setpoint yet.
    pub before: Option<f64>,
}

/// Which flanks of a record are judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flanks {
    All,
    /// Where the motor drives what turns with it.
    Rising,
    /// Where the motor slows down, so that what turns with it may run ahead.
    Falling,
}

impl Flanks {
    /// Whether the last setpoint before a time made one of these flanks.
    pub(crate) fn hold(self, stretch: &Stretch, t: f64) -> bool {
        if self == Self::All {
            return true;
        }
        let (mut last, mut rises) = (stretch.before.unwrap_or(0.0), true);
        for (_, speed) in stretch.record.setpoints.iter().take_while(|setpoint| setpoint.0 <= t) {
            (rises, last) = (speed.abs() > last.abs(), *speed);
        }
        rises == (self == Self::Rising)
    }
}

/// How badly a start fits a loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StartMisfit {
    /// Sum of squares, in variances of the duty.
    pub(crate) squares: f64,
    /// How many duties were read.
    pub(crate) readings: usize,
}

/// Deviation of the duty about its trend in the second halves of the plateaus: the median of those that have five readings.
pub(crate) fn noise(record: &ClosedLoopRecord) -> f64 {
    median(plateaus(record).into_iter().map(|plateau| plateau.1)).map_or(0.02, f64::sqrt)
}

/// The root mean square of that of each setpoint.
pub(crate) fn noise_of_setpoints(record: &ClosedLoopRecord) -> f64 {
    let mut plateaus = plateaus(record);
    plateaus.sort_by(|a, b| a.0.total_cmp(&b.0));
    let squares: Vec<f64> = plateaus
        .chunk_by(|a, b| a.0 == b.0)
        .filter_map(|of_one| median(of_one.iter().map(|plateau| plateau.1)))
        .collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// The setpoint of each plateau that has five readings in its second half, and the variance of the duty about its trend there.
fn plateaus(record: &ClosedLoopRecord) -> Vec<(f64, f64)> {
    let end = record.duties.last().map_or(0.0, |last| last.0);
    let ends = record.setpoints.iter().skip(1).map(|setpoint| setpoint.0).chain([end]);
    let of_one = |(from, to): (&(f64, f64), f64)| {
        let half = 0.5 * (from.0 + to);
        let inside: Vec<(f64, f64)> =
            record.duties.iter().copied().filter(|duty| duty.0 > half && duty.0 < to).collect();
        (inside.len() >= 5).then(|| (from.1, about_line(&inside)))
    };
    record.setpoints.iter().zip(ends).filter_map(of_one).collect()
}

/// The upper one of the two in the middle; `None` of none.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// How many counts and how many duties of a record are judged.
pub(crate) fn readings(stretch: &Stretch, flanks: Flanks) -> [usize; 2] {
    let record = &stretch.record;
    let from_s = record.judged_from_s();
    let counts = record.counts.iter().filter(|count| count.0 >= from_s).skip(1);
    let duties = record.duties.iter().filter(|duty| duty.0 > from_s);
    [
        counts.filter(|count| flanks.hold(stretch, count.0)).count(),
        duties.filter(|duty| flanks.hold(stretch, duty.0)).count(),
    ]
}

/// Variance about the straight line that fits best.
fn about_line(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (t, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let (tt, ty) = (mean(&|p| (p.0 - t).powi(2)), mean(&|p| (p.0 - t) * (p.1 - y)));
    let slope = if tt > 0.0 { ty / tt } else { 0.0 };
    points.iter().map(|p| (p.1 - y - slope * (p.0 - t)).powi(2)).sum::<f64>() / (n - 2.0)
}

/// What a loop does under the setpoints of a record, tick by tick from its first poll on.
struct Followed {
    start: f64,
    tick_s: f64,
    positions: Vec<f64>,
    duties: Vec<f64>,
}

impl Followed {
    /// `before` is the setpoint before the first one of the record, where the loop is at work already. `offset_s` is how long after its stamp a setpoint
    /// takes effect, but for the wait for a tick.
    fn new<L: Law>(
        record: &ClosedLoopRecord,
        mut twin: TickLoop<L>,
        law: &L,
        offset_s: f64,
        before: Option<f64>,
    ) -> Option<Self> {
        let tick_s = law.tick_s();
        let start = record.counts.first()?.0;
        let end = record.duties.last().map_or(start, |last| last.0).max(record.counts.last()?.0);
        let ticks = ((end - start) / tick_s) as usize + 3;
        let (mut positions, mut duties) = (Vec::with_capacity(ticks), Vec::with_capacity(ticks));
        let (mut next, mut goal) = (0, before);
        for n in 0..ticks {
            let t = start + n as f64 * tick_s;
            // On average over the phases of the tick, a setpoint comes into force over the length of one.
            let share = |at: f64| ((t - at - offset_s) / tick_s + 0.5).clamp(0.0, 1.0);
            while let Some(&(at, speed)) = record.setpoints.get(next)
                && share(at) >= 1.0
            {
                goal = Some(speed);
                next += 1;
            }
            positions.push(twin.motion.position);
            let coming = record.setpoints.get(next).map(|&(at, speed)| (share(at), speed));
            let now = match (goal, coming) {
                (Some(old), Some((share, new))) => Some(old + share * (new - old)),
                (None, Some((share, new))) if share > 0.5 => Some(new),
                (old, _) => old,
            };
            if let Some(speed) = now {
                twin.tick(Setpoint::Speed(speed), 0.0);
            }
            duties.push(twin.duty);
        }
        Some(Self { start, tick_s, positions, duties })
    }

    fn at(&self, values: &[f64], t: f64, age: CountAge) -> f64 {
        let x = ((t - self.start) / self.tick_s - age.ticks()).max(0.0);
        let n = (x as usize).min(values.len() - 2);
        values[n] + (values[n + 1] - values[n]) * (x - n as f64).min(1.0)
    }

    fn position_at(&self, t: f64, age: CountAge) -> f64 {
        self.at(&self.positions, t, age)
    }

    fn duty_at(&self, t: f64) -> f64 {
        self.at(&self.duties, t, CountAge::UpToATick)
    }
}

/// The record that a loop, at work at the speed `before`, would have given under the same setpoints and polls.
pub(crate) fn predicted_record<L: Law>(
    record: &ClosedLoopRecord,
    twin: TickLoop<L>,
    law: &L,
    before: f64,
) -> Option<ClosedLoopRecord> {
    let followed = Followed::new(record, twin, law, 0.0, Some(before))?;
    let counts =
        record.counts.iter().map(|&(t, _)| (t, followed.position_at(t, record.age).floor())).collect();
    Some(ClosedLoopRecord { setpoints: record.setpoints.clone(), counts, ..ClosedLoopRecord::default() })
}

impl ClosedLoopRecord {
    /// How badly the duties of the start from rest fit a loop whose duty has that standard deviation at a steady speed; `None` where none was read.
    pub(crate) fn start_misfit<L: Law>(
        &self,
        twin: TickLoop<L>,
        law: &L,
        steady_duty: f64,
    ) -> Option<StartMisfit> {
        let until_s = if self.setpoints.len() > 1 { self.judged_from_s() } else { f64::INFINITY };
        let noise = steady_duty.hypot(RECORD.duty);
        let mut all = Vec::new();
        duty_misfits(self, &Followed::new(self, twin, law, 0.0, None)?, |t| t < until_s, noise, &mut all);
        let squares = all.iter().map(|rest| rest * rest).sum();
        (!all.is_empty()).then_some(StartMisfit { squares, readings: all.len() })
    }

    /// The start from rest is the business of friction and of the current limit, not of the lag: a record is judged from here on.
    fn judged_from_s(&self) -> f64 {
        self.setpoints.get(1).map_or(0.0, |second| second.0 - 0.01)
    }
}

/// The misfits of counts and duties, in standard deviations. Counts drift off slowly, which a scalar Kalman filter follows; the duty may be off by a
/// constant, which is friction.
pub(crate) fn misfits<L: Law>(
    stretch: &Stretch,
    (flanks, age): (Flanks, CountAge),
    twin: TickLoop<L>,
    law: &L,
    offset_s: f64,
    noise: f64,
    all: &mut Vec<f64>,
) {
    let record = &stretch.record;
    let Some(followed) = Followed::new(record, twin, law, offset_s, stretch.before) else { return };
    let from_s = record.judged_from_s();
    count_misfits(record, (&followed, age), from_s, |t| flanks.hold(stretch, t), all);
    duty_misfits(record, &followed, |t| t > from_s && flanks.hold(stretch, t), noise, all);
}

/// Those of the counts of some times, followed from a time on.
fn count_misfits(
    record: &ClosedLoopRecord,
    (followed, age): (&Followed, CountAge),
    from_s: f64,
    is_judged: impl Fn(f64) -> bool,
    all: &mut Vec<f64>,
) {
    let age_s = if age == CountAge::UpToATick { CountAge::spread_s(followed.tick_s) } else { 0.0 };
    let stamp_s = RECORD.stamp_s.hypot(record.stamp_s).hypot(age_s);
    let mut drift: Option<(f64, f64, f64, f64)> = None;
    for &(t, count) in record.counts.iter().filter(|count| count.0 >= from_s) {
        let position = followed.position_at(t, age);
        let error = count - position;
        drift = Some(match drift {
            None => (t, position, error, 1.0 / 12.0),
            Some((t0, position0, known, variance)) => {
                let dt = (t - t0).max(1e-4);
                let speed = (position - position0) / dt;
                let white = 1.0 / 12.0 + (stamp_s * speed).powi(2);
                let walked = variance + (RECORD.drift * speed).powi(2) * dt + 1e-3;
                let spread = walked + white;
                let innovation = error - known;
                if is_judged(t) {
                    all.push(soft(innovation / spread.sqrt()));
                }
                let share = walked / spread;
                (t, position, known + share * innovation, (1.0 - share) * walked)
            }
        });
    }
}

/// Those of the duties of some times.
fn duty_misfits(
    record: &ClosedLoopRecord,
    followed: &Followed,
    is_judged: impl Fn(f64) -> bool,
    noise: f64,
    all: &mut Vec<f64>,
) {
    let half_s = 0.5 * followed.tick_s + 0.001;
    let judged = record.duties.iter().filter(|duty| is_judged(duty.0));
    let compared: Vec<(f64, f64)> = judged
        .map(|&(t, duty)| {
            let flank = followed.duty_at(t + half_s) - followed.duty_at(t - half_s);
            (duty - followed.duty_at(t), noise.hypot(RECORD.flank * flank))
        })
        .collect();
    let weights: f64 = compared.iter().map(|(_, sigma)| sigma.powi(-2)).sum();
    let mean = compared.iter().map(|(rest, sigma)| rest * sigma.powi(-2)).sum::<f64>() / weights.max(1e-9);
    all.extend(compared.iter().map(|(rest, sigma)| soft((rest - mean) / sigma)));
}

/// A residual whose square grows only linearly beyond some standard deviations (soft L1, Huber 1964).
pub(crate) fn soft(r: f64) -> f64 {
    let x = r / RECORD.knee;
    RECORD.knee * (2.0 * ((1.0 + x * x).sqrt() - 1.0)).sqrt().copysign(x)
}
