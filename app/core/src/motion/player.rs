//! Plays the legs of a profile as a job, and judges its steps.
//!
//! The job reads the encoders itself, every few milliseconds, since ten readings a second of the window say little about
//! a step. A step of duty has no setpoint in the unit of its response, so it is judged against the speed it ends at. Its figures are those of a model that
//! is fitted to the counts with their times: of single speeds the greatest is noise.

use crate::messages::{CoreActMessage, CoreCauseMessage, CoreRemedyMessage};
use std::time::Duration;

use brushwork_link::device::JobContext;
use brushwork_link::{Drive, DriveCommand, ExchangeError, Failure, Job};
use brushwork_tuning::StepFigures;
use brushwork_tuning::response::{Quantity, Spread, Stamped, response};
use brushwork_values::Motor;

use super::profile::{Leg, Mode, WAY_LIMIT, setpoint_text};
use super::reader::{Encoders, INTERVAL};
use super::speed::{Reading, present_speed};

/// Beyond what the legs take by themselves: exchanges, and the pace of a slow line.
const SLACK: Duration = Duration::from_secs(30);
/// Readings so much further apart than most, and so far apart at all, were late.
const LATE_TIMES: f64 = 4.0;
const LATE_S: f64 = 0.03;
/// How much of the record before a step says where it began.
const BEFORE_S: f64 = 0.1;
/// A motor stands when it moves less than this in [`super::speed::PART_S`].
const STANDS_COUNTS: f64 = 2.0;
/// How long a motor is watched before it is said to stand.
const WATCHED: Duration = Duration::from_millis(300);
/// Counts that a motor may go the wrong way before it is believed, beyond a share of its way.
const WRONG_WAY_COUNTS: f64 = 200.0;
const WRONG_WAY_SHARE: f64 = 0.2;

/// What is to be played.
#[derive(Clone, Debug)]
pub struct Task {
    pub mode: Mode,
    pub motors: Vec<Motor>,
    pub legs: Vec<Leg>,
}

/// One step of one motor.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedStep {
    pub motor: Motor,
    /// "50.0 %", "8000 counts/s".
    pub text: String,
    /// Where the response began and where it was to go, in the unit of the response.
    pub start: f64,
    pub end: f64,
    /// None where the readings say nothing of it.
    pub figures: Option<StepFigures>,
    /// Standard deviations of the figures.
    pub spread: Spread,
    /// The longest time within the step for which nothing was read, if the computer or the line was late.
    pub late_s: Option<f64>,
}

/// What a profile that was played to its end hands back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Played {
    pub steps: Vec<JudgedStep>,
}

/// The job that plays `task`.
pub fn job(task: Task) -> Job<Played> {
    let own_time = |leg: &Leg| match leg {
        Leg::Hold { time, .. } => *time,
        Leg::Settle { dwell, .. } | Leg::GoTo { dwell, .. } => *dwell + WAY_LIMIT,
    };
    let limit = task.legs.iter().map(own_time).sum::<Duration>() + SLACK;
    Job::moving(CoreActMessage::PlayProfile, limit, move |context| {
        let mut player =
            Player { task: task.clone(), encoders: Encoders::default(), record: [const { Vec::new() }; 2] };
        player.play(context)
    })
}

struct Player {
    task: Task,
    encoders: Encoders,
    /// Readings of both motors since shortly before the present leg.
    record: [Vec<Reading>; 2],
}

impl Player {
    fn play(&mut self, context: &mut JobContext<'_>) -> Result<Played, Failure> {
        let mut played = Played::default();
        let legs = self.task.legs.clone();
        for (index, leg) in legs.iter().enumerate() {
            let text = format!("{} of {}: {}", index + 1, legs.len(), leg.text());
            context.progress(Some(index as f32 / legs.len() as f32), &text);
            self.forget_the_past();
            match *leg {
                Leg::Hold { command, time, is_step } => {
                    let begun_at = self.send(context, command)?;
                    self.watch(context, begun_at + time)?;
                    if is_step {
                        played.steps.extend(self.judge(command, begun_at));
                    }
                }
                Leg::Settle { command, dwell } => self.settle(context, command, dwell)?,
                Leg::GoTo { counts, forward, backward, rest, dwell } => {
                    self.go_to(context, counts, [backward, forward], rest)?;
                    let until = context.now() + dwell;
                    self.watch(context, until)?;
                }
            }
        }
        Ok(played)
    }

    /// Gives all motors a command; returns when that was confirmed.
    fn send(&mut self, context: &mut JobContext<'_>, command: DriveCommand) -> Result<Duration, Failure> {
        let motors = self.task.motors.clone();
        self.send_each(context, &motors, |_| command)
    }

    fn send_each(
        &mut self,
        context: &mut JobContext<'_>,
        motors: &[Motor],
        command: impl Fn(Motor) -> DriveCommand,
    ) -> Result<Duration, Failure> {
        let of = |motor| motors.contains(&motor).then(|| command(motor));
        let drive = Drive { m1: of(Motor::M1), m2: of(Motor::M2) };
        context.drive(&drive).map_err(|error| failed(context, &error))?;
        Ok(context.now())
    }

    /// Reads until `until`.
    fn watch(&mut self, context: &mut JobContext<'_>, until: Duration) -> Result<(), Failure> {
        while context.now() < until {
            self.read(context)?;
            let rest = until.saturating_sub(context.now()).min(INTERVAL);
            context.sleep(rest).map_err(|error| failed(context, &error))?;
        }
        Ok(())
    }

    fn read(&mut self, context: &mut JobContext<'_>) -> Result<[Reading; 2], Failure> {
        let readings = self.encoders.read(context).map_err(|error| failed(context, &error))?;
        for (record, reading) in self.record.iter_mut().zip(readings) {
            record.push(reading);
        }
        Ok(readings)
    }

    /// Holds a setpoint until every motor stands, and then for `dwell`.
    fn settle(
        &mut self,
        context: &mut JobContext<'_>,
        command: DriveCommand,
        dwell: Duration,
    ) -> Result<(), Failure> {
        let begun_at = self.send(context, command)?;
        self.watch(context, begun_at + WATCHED)?;
        while !self.task.motors.iter().all(|motor| self.stands(*motor)) {
            if context.now() > begun_at + WAY_LIMIT {
                let setpoint = setpoint_text(&command);
                let came_back = CoreCauseMessage::NotAtRest { setpoint, seconds: WAY_LIMIT.as_secs() };
                let remedy = CoreRemedyMessage::TuneLoop;
                return Err(Failure::new(CoreActMessage::PlayProfile, context.describe(), came_back, remedy));
            }
            let soon = context.now() + INTERVAL * 4;
            self.watch(context, soon)?;
        }
        let until = context.now() + dwell;
        self.watch(context, until)
    }

    fn stands(&self, motor: Motor) -> bool {
        let speed = present_speed(&self.record[motor.index()]);
        speed.is_some_and(|speed| speed.counts_per_s.abs() * super::speed::PART_S < STANDS_COUNTS)
    }

    /// Drives each motor towards a count until it has passed it. `commands` are backward and forward.
    fn go_to(
        &mut self,
        context: &mut JobContext<'_>,
        counts: f64,
        commands: [DriveCommand; 2],
        rest: DriveCommand,
    ) -> Result<(), Failure> {
        let from = self.read(context)?;
        let ways = Motor::BOTH.map(|motor| counts - from[motor.index()].counts);
        let mut under_way = self.task.motors.clone();
        under_way.retain(|motor| ways[motor.index()] != 0.0);
        if under_way.is_empty() {
            return Ok(());
        }
        let command = |motor: Motor| commands[usize::from(ways[motor.index()] > 0.0)];
        let begun_at = self.send_each(context, &under_way, command)?;
        while !under_way.is_empty() {
            let now = self.read(context)?;
            let left = |motor: &Motor| (counts - now[motor.index()].counts) * ways[motor.index()].signum();
            let arrived: Vec<Motor> = under_way.iter().copied().filter(|motor| left(motor) <= 0.0).collect();
            under_way.retain(|motor| !arrived.contains(motor));
            if !arrived.is_empty() {
                self.send_each(context, &arrived, |_| rest)?;
            }
            for motor in &under_way {
                let way = ways[motor.index()].abs();
                let is_late = context.now() > begun_at + WAY_LIMIT;
                if is_late || left(motor) > way * (1.0 + WRONG_WAY_SHARE) + WRONG_WAY_COUNTS {
                    return Err(lost_way(context, *motor, counts, is_late));
                }
            }
            context.sleep(INTERVAL).map_err(|error| failed(context, &error))?;
        }
        Ok(())
    }

    /// Keeps only what the next step begins from.
    fn forget_the_past(&mut self) {
        for record in &mut self.record {
            let from_s = record.last().map_or(0.0, |last| last.at_s - BEFORE_S);
            record.retain(|reading| reading.at_s >= from_s);
        }
    }

    fn judge(&self, command: DriveCommand, begun_at: Duration) -> Vec<JudgedStep> {
        let quantity = match self.task.mode {
            Mode::Position => Quantity::Position,
            Mode::Duty | Mode::Speed => Quantity::Speed,
        };
        let judge = |motor: &Motor| {
            let setpoint = (self.task.mode != Mode::Duty).then(|| command.setpoint());
            let record = &self.record[motor.index()];
            let text = setpoint_text(&command);
            judge_step(record, quantity, begun_at.as_secs_f64(), setpoint).map(|judged| JudgedStep {
                motor: *motor,
                text,
                ..judged
            })
        };
        self.task.motors.iter().filter_map(judge).collect()
    }
}

/// A step at `begun_at_s`; without a setpoint the end is where the response ends.
fn judge_step(
    record: &[Reading],
    quantity: Quantity,
    begun_at_s: f64,
    setpoint: Option<f64>,
) -> Option<JudgedStep> {
    let stamped: Vec<Stamped> = record
        .iter()
        .map(|reading| Stamped {
            time_s: reading.at_s - begun_at_s,
            counts: reading.counts,
            // A reading may be of any moment between request and reply.
            spread_s: reading.half_s / 3f64.sqrt(),
        })
        .collect();
    stamped.last().filter(|last| last.time_s > 0.0)?;
    let found = response(&stamped, quantity, setpoint);
    let end = setpoint.or(found.map(|found| found.end)).unwrap_or_default();
    Some(JudgedStep {
        motor: Motor::M1,
        text: String::new(),
        start: found.map_or(0.0, |found| found.start),
        end,
        figures: found.map(|found| found.figures),
        spread: found.map(|found| found.spread).unwrap_or_default(),
        late_s: late(&stamped),
    })
}

/// The longest time between two readings of a step, if that was no usual one.
fn late(stamped: &[Stamped]) -> Option<f64> {
    let apart: Vec<(f64, f64)> =
        stamped.windows(2).map(|pair| (pair[1].time_s, pair[1].time_s - pair[0].time_s)).collect();
    let mut usual: Vec<f64> = apart.iter().map(|(_, apart_s)| *apart_s).collect();
    usual.sort_by(f64::total_cmp);
    let usual_s = usual.get(usual.len() / 2)?;
    let of_step = apart.iter().filter(|(at_s, _)| *at_s > 0.0).map(|(_, apart_s)| *apart_s);
    let longest_s = of_step.fold(0.0, f64::max);
    (longest_s > LATE_S && longest_s > LATE_TIMES * usual_s).then_some(longest_s)
}

fn failed(context: &JobContext<'_>, error: &ExchangeError) -> Failure {
    error.failure(CoreActMessage::PlayProfile, context.describe())
}

fn lost_way(context: &JobContext<'_>, motor: Motor, counts: f64, is_late: bool) -> Failure {
    let (came_back, remedy) = if is_late {
        let seconds = WAY_LIMIT.as_secs();
        (CoreCauseMessage::NotReached { motor, counts, seconds }, CoreRemedyMessage::GoFaster)
    } else {
        (CoreCauseMessage::GoesAway { motor, counts }, CoreRemedyMessage::TurnEncoder)
    };
    Failure::new(CoreActMessage::PlayProfile, context.describe(), came_back, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole counts of a motor that goes to a speed with a lag of 50 ms, from 0.1 s before the step at 5 s on, read but for a while.
    fn record(end: f64, unread: std::ops::Range<f64>) -> Vec<Reading> {
        let counts = |time: f64| {
            if time < 0.0 { 0.0 } else { end * (time - 0.05 * (1.0 - (-time / 0.05).exp())) }
        };
        let times = (-20..300).map(|index| f64::from(index) * 0.005);
        times
            .filter(|time| !unread.contains(time))
            .map(|time| Reading { at_s: 5.0 + time, counts: counts(time).floor(), half_s: 0.0004 })
            .collect()
    }

    #[test]
    fn a_step_is_judged_from_its_command_on_and_has_no_overshoot_that_the_motor_has_not() {
        let step = judge_step(&record(800.0, 9.0..9.0), Quantity::Speed, 5.0, Some(800.0)).unwrap();
        let (figures, spread) = (step.figures.unwrap(), step.spread);
        let off = (figures.rise_time_s.unwrap() - 0.05 * 9f64.ln()).abs();
        assert!(off < 2.0 * spread.rise_s.unwrap() && off < 0.03, "{figures:?} {spread:?}");
        assert!(figures.overshoot < 0.01 && step.start.abs() < 10.0, "{figures:?}");
        assert_eq!((step.end, step.late_s), (800.0, None));
    }

    #[test]
    fn without_a_setpoint_a_step_is_judged_against_where_it_ends() {
        let step = judge_step(&record(-8000.0, 9.0..9.0), Quantity::Speed, 5.0, None).unwrap();
        assert!((step.end + 8000.0).abs() < 80.0, "{step:?}");
        assert!(step.figures.unwrap().final_error.abs() < 80.0);
    }

    #[test]
    fn where_readings_were_late_that_is_told_and_the_figures_are_less_sure() {
        let prompt = judge_step(&record(8000.0, 9.0..9.0), Quantity::Speed, 5.0, None).unwrap();
        let late = judge_step(&record(8000.0, 0.002..0.25), Quantity::Speed, 5.0, None).unwrap();
        let apart_s = late.late_s.expect("nothing was read for a quarter of a second");
        assert!((apart_s - 0.25).abs() < 0.006, "{apart_s}");
        let sure = |step: &JudgedStep| step.spread.rise_s.unwrap_or(f64::INFINITY);
        assert!(sure(&late) > 2.0 * sure(&prompt), "{late:?} {prompt:?}");
        assert!(late.figures.is_none_or(|figures| figures.overshoot < 0.05), "{late:?}");
    }

    #[test]
    fn a_step_without_readings_is_not_judged() {
        assert_eq!(judge_step(&[], Quantity::Speed, 5.0, Some(1.0)), None);
    }
}
