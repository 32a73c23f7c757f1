//! What happened in a run, as a picture shows it: where the axis was, what it was commanded, and which gains held when.
//!
//! It grows call by call from a live axis, or comes whole from the raw record of a report. Nothing is computed from it here but
//! speeds, and the response that a model predicts for the same commands.

use crate::axis::{ABSOLUTE_COUNTS, AMPS_PER_RAW, EncoderClass, FULL_DUTY_RAW, Sample};
use crate::design::Task;
use crate::experiment_guard::{Drive, Input};
use crate::law::Law;
use crate::model::Gains;
use crate::record::Entry;
use crate::ticks::{Setpoint, TickLoop};

/// One poll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracePoint {
    /// Middle of the exchange, s.
    pub t: f64,
    /// Counts from the start of the run.
    pub counts: f64,
    /// Duty, -1 to 1, where it was read.
    pub duty: Option<f64>,
    /// Motor current, A, where it was read.
    pub amps: Option<f64>,
}

/// A run so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace<L: Law> {
    /// Every poll that was answered, in order.
    pub points: Vec<TracePoint>,
    /// Every command, in order.
    pub drives: Vec<Drive>,
    /// Every write of registers, in order.
    pub writes: Vec<(f64, L::Write)>,
    motor: usize,
    encoder: EncoderClass,
    epoch_s: Option<f64>,
    last_raw: Option<i64>,
    first_raw: i64,
    travelled: i64,
}

/// A stretch of a run in which a loop held the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Its first command, s.
    pub from_s: f64,
    /// The command that ended it, or the last poll, s.
    pub to_s: f64,
    /// Whether positions were commanded; otherwise speeds.
    pub is_position: bool,
}

/// A point of a predicted response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// Time in the trace, s.
    pub t: f64,
    /// Counts from the start of the run.
    pub counts: f64,
    /// Counts/s.
    pub speed: f64,
    /// Duty, -1 to 1.
    pub duty: f64,
}

impl<L: Law> Default for Trace<L> {
    fn default() -> Self {
        Self::new(0, EncoderClass::default())
    }
}

impl<L: Law> Trace<L> {
    /// An empty trace of motor 0 or 1.
    #[must_use]
    pub fn new(motor: usize, encoder: EncoderClass) -> Self {
        Self {
            points: Vec::new(),
            drives: Vec::new(),
            writes: Vec::new(),
            motor: motor.min(1),
            encoder,
            epoch_s: None,
            last_raw: None,
            first_raw: 0,
            travelled: 0,
        }
    }

    /// The trace of a raw record.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn of(motor: usize, record: &[Entry<L>]) -> Self {
        let encoder = record.iter().find_map(|entry| match entry {
            Entry::Setup(Ok(setup)) => Some(setup.encoder),
            _ => None,
        });
        let mut trace = Self::new(motor, encoder.unwrap_or_default());
        record.iter().for_each(|entry| trace.take(entry));
        trace
    }

    /// Takes over a call and its answer.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn take(&mut self, entry: &Entry<L>) {
        match entry {
            Entry::Now(now) => {
                self.since_start(now.as_secs_f64());
            }
            Entry::Sampled(Ok(sample)) => self.sample(sample),
            Entry::Duty(raw, Ok(at)) => {
                let duty = f64::from(*raw) / f64::from(FULL_DUTY_RAW);
                self.drive(at.middle_s(), Input::Duty(duty));
            }
            Entry::Speed(speed, Ok(at)) => self.drive(at.middle_s(), Input::Speed(f64::from(*speed))),
            Entry::Position(counts, speed, Ok(at)) => {
                let from_start = f64::from(*counts) - self.first_raw as f64;
                self.drive(at.middle_s(), Input::Position(from_start, f64::from(*speed)));
            }
            Entry::Registers(note) => {
                if let (write, Ok(())) = L::noted(note) {
                    self.writes.push((self.end_s(), write));
                }
            }
            _ => {}
        }
    }

    /// Seconds since the first time that was reported.
    fn since_start(&mut self, at_s: f64) -> f64 {
        at_s - *self.epoch_s.get_or_insert(at_s)
    }

    fn sample(&mut self, sample: &Sample) {
        let t = self.since_start(sample.counts_at.middle_s());
        let counts = self.unwrap(sample.counts[self.motor]) as f64;
        let duty = sample.duty_raw.map(|(_, raw)| f64::from(raw) / f64::from(FULL_DUTY_RAW));
        let amps = sample.current_raw.map(|raw| f64::from(raw) * AMPS_PER_RAW);
        self.points.push(TracePoint { t, counts, duty, amps });
    }

    fn drive(&mut self, at_s: f64, input: Input) {
        let t = self.since_start(at_s);
        self.drives.push(Drive { t, input });
    }

    /// Time of the newest poll or command, s.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        let polled = self.points.last().map_or(0.0, |point| point.t);
        polled.max(self.drives.last().map_or(0.0, |drive| drive.t))
    }

    /// Counts from the start, over the ends of the register or of the turn.
    fn unwrap(&mut self, raw: i32) -> i64 {
        let raw = i64::from(raw);
        let Some(last) = self.last_raw.replace(raw) else {
            self.first_raw = raw;
            return 0;
        };
        let turn = match self.encoder {
            EncoderClass::Quadrature => 1_i64 << 32,
            EncoderClass::AbsoluteWrapping => ABSOLUTE_COUNTS,
            EncoderClass::Absolute => i64::MAX,
        };
        let mut step = raw - last;
        if step > turn / 2 {
            step -= turn;
        } else if step < -(turn / 2) {
            step += turn;
        }
        self.travelled += step;
        self.travelled
    }

    /// Speeds between polls that lie at least `over_s` apart: (time in the middle, counts/s).
    #[must_use]
    pub fn speeds(&self, over_s: f64) -> Vec<(f64, f64)> {
        let mut from = 0;
        let mut speeds = Vec::with_capacity(self.points.len());
        for to in 1..self.points.len() {
            while from + 1 < to && self.points[to].t - self.points[from + 1].t >= over_s {
                from += 1;
            }
            let (a, b) = (self.points[from], self.points[to]);
            if b.t > a.t {
                speeds.push((0.5 * (a.t + b.t), (b.counts - a.counts) / (b.t - a.t)));
            }
        }
        speeds
    }

    /// The stretches in which a loop held the motor, oldest first.
    #[must_use]
    pub fn stretches(&self) -> Vec<Stretch> {
        let mut found: Vec<Stretch> = Vec::new();
        let mut open: Option<Stretch> = None;
        for drive in &self.drives {
            let is_position = matches!(drive.input, Input::Position(..));
            match (&drive.input, &mut open) {
                (Input::Duty(_), _) => found.extend(open.take().map(|s| Stretch { to_s: drive.t, ..s })),
                (_, Some(stretch)) if stretch.is_position == is_position => stretch.to_s = drive.t,
                _ => {
                    found.extend(open.take());
                    open = Some(Stretch { from_s: drive.t, to_s: drive.t, is_position });
                }
            }
        }
        found.extend(open.map(|stretch| Stretch { to_s: self.end_s(), ..stretch }));
        found
    }

    /// What a model predicts for the commands of a stretch, from where the axis stood, tick by tick.
    #[must_use]
    pub fn predict(&self, task: &Task<L>, gains: &Gains, stretch: &Stretch) -> Vec<Predicted> {
        let tick_s = task.law.tick_s();
        let start = self.points.iter().rev().find(|point| point.t <= stretch.from_s);
        let origin = start.or(self.points.first()).map_or(0.0, |point| point.counts);
        let mut twin = TickLoop::new(task.plant, task.law, task.lag, *gains, task.qpps);
        let mut response = Vec::new();
        let ticks = ((stretch.to_s - stretch.from_s) / tick_s).clamp(0.0, 60_000.0) as usize;
        let commands: Vec<&Drive> =
            self.drives.iter().filter(|drive| drive.t >= stretch.from_s && drive.t <= stretch.to_s).collect();
        let mut next = 0;
        let mut goal = None;
        for n in 0..ticks {
            let t = stretch.from_s + n as f64 * tick_s;
            while let Some(drive) = commands.get(next)
                && drive.t <= t + 1e-9
            {
                goal = match drive.input {
                    Input::Speed(speed) => Some(Setpoint::Speed(speed)),
                    Input::Position(position, bound) => Some(Setpoint::Position(position - origin, bound)),
                    Input::Duty(_) => goal,
                };
                next += 1;
            }
            if let Some(goal) = goal {
                twin.tick(goal, 0.0);
            }
            let (counts, speed, duty) = (origin + twin.motion.position, twin.motion.speed, twin.duty);
            response.push(Predicted { t: t + tick_s, counts, speed, duty });
        }
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::{Exchange, Status};
    use crate::plain_law::PlainLaw;
    use std::time::Duration;

    fn at(ms: u64) -> Exchange {
        Exchange { sent: Duration::from_millis(ms), received: Duration::from_millis(ms + 2) }
    }

    fn sampled(ms: u64, counts: i32) -> Entry<PlainLaw> {
        Entry::Sampled(Ok(Sample {
            counts_at: at(ms),
            counts: [counts, 0],
            status: Status::default(),
            duty_raw: Some((at(ms), 16_384)),
            current_raw: Some(150),
            volts_raw: None,
        }))
    }

    #[test]
    fn counts_go_on_over_the_end_of_the_register_and_speeds_are_between_polls() {
        let record = [
            Entry::Now(Duration::from_millis(1000)),
            sampled(1000, i32::MAX - 50),
            sampled(1100, i32::MIN + 49),
            sampled(1200, i32::MIN + 249),
        ];
        let trace = Trace::of(0, &record);
        let counts: Vec<f64> = trace.points.iter().map(|point| point.counts).collect();
        assert_eq!(counts, [0.0, 100.0, 300.0]);
        assert!((trace.points[0].t - 0.001).abs() < 1e-12);
        assert_eq!(trace.points[0].amps, Some(1.5));
        let speeds = trace.speeds(0.05);
        assert!((speeds[0].1 - 1000.0).abs() < 1e-6 && (speeds[1].1 - 2000.0).abs() < 1e-6, "{speeds:?}");
    }

    #[test]
    fn a_stretch_is_from_the_first_command_of_a_loop_to_the_duty_that_ends_it() {
        let record = [
            Entry::Now(Duration::ZERO),
            Entry::Duty(9000, Ok(at(10))),
            Entry::Speed(500, Ok(at(100))),
            Entry::Speed(900, Ok(at(300))),
            Entry::Duty(0, Ok(at(600))),
            Entry::Position(1000, 2000, Ok(at(700))),
            sampled(900, 0),
        ];
        let found = Trace::<PlainLaw>::of(0, &record).stretches();
        assert_eq!(found.len(), 2);
        assert!((found[0].from_s - 0.101).abs() < 1e-9 && (found[0].to_s - 0.601).abs() < 1e-9);
        assert!(!found[0].is_position && found[1].is_position);
        assert!((found[1].to_s - 0.901).abs() < 1e-9);
    }
}
