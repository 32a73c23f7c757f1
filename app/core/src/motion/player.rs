//! Plays the legs of a profile as a job, and judges its steps.
//!
//! The job reads the encoders itself, every few milliseconds, since ten readings a second of the window say little about
//! a step. A step of duty has no setpoint in the unit of its response, so it is judged against the speed it ends at.

use crate::messages::{CoreActMessage, CoreCauseMessage, CoreRemedyMessage};
use std::time::Duration;

use brushwork_link::device::JobContext;
use brushwork_link::{Drive, DriveCommand, ExchangeError, Failure, Job};
use brushwork_tuning::{Point, StepFigures};
use brushwork_values::Motor;

use super::profile::{Leg, Mode, WAY_LIMIT, setpoint_text};
use super::reader::{Encoders, INTERVAL};
use super::speed::{Reading, present_speed, speeds};

/// Beyond what the legs take by themselves: exchanges, and the pace of a slow line.
const SLACK: Duration = Duration::from_secs(30);
/// Half the window that a speed is taken from.
const HALF_WINDOW_S: f64 = 0.015;
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
    /// None where the response says nothing.
    pub figures: Option<StepFigures>,
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
        let judge = |motor: &Motor| {
            let setpoint = (self.task.mode != Mode::Duty).then(|| command.setpoint());
            judge_step(&self.response(*motor), begun_at.as_secs_f64(), setpoint).map(
                |(start, end, figures)| JudgedStep {
                    motor: *motor,
                    text: setpoint_text(&command),
                    start,
                    end,
                    figures,
                },
            )
        };
        self.task.motors.iter().filter_map(judge).collect()
    }

    /// What is judged: positions, or speeds.
    fn response(&self, motor: Motor) -> Vec<Point> {
        let record = &self.record[motor.index()];
        match self.task.mode {
            Mode::Position => {
                record.iter().map(|reading| Point { time_s: reading.at_s, value: reading.counts }).collect()
            }
            Mode::Duty | Mode::Speed => speeds(record, HALF_WINDOW_S),
        }
    }
}

/// Start, end and figures of a step at `begun_at_s`; without a setpoint the end is where the response ends.
fn judge_step(
    response: &[Point],
    begun_at_s: f64,
    setpoint: Option<f64>,
) -> Option<(f64, f64, Option<StepFigures>)> {
    let split = response.partition_point(|point| point.time_s < begun_at_s);
    let (before, after) = response.split_at(split);
    let start = mean(before).or_else(|| after.first().map(|point| point.value))?;
    let end = setpoint.or_else(|| mean(&after[after.len() - after.len() / 5..]))?;
    let points: Vec<Point> =
        after.iter().map(|point| Point { time_s: point.time_s - begun_at_s, ..*point }).collect();
    Some((start, end, StepFigures::of(&points, start, end)))
}

fn mean(points: &[Point]) -> Option<f64> {
    let sum = points.iter().map(|point| point.value).sum::<f64>();
    (!points.is_empty()).then(|| sum / points.len() as f64)
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

    /// A lag of 50 ms to `end`, from 0.1 s before the step at 5 s.
    fn response(end: f64) -> Vec<Point> {
        let times = (-20..200).map(|index| f64::from(index) * 0.005);
        times
            .map(|time| Point { time_s: 5.0 + time, value: end * (1.0 - (-time.max(0.0) / 0.05).exp()) })
            .collect()
    }

    #[test]
    fn a_step_is_judged_from_its_command_on() {
        let (start, end, figures) = judge_step(&response(800.0), 5.0, Some(800.0)).unwrap();
        assert_eq!((start, end), (0.0, 800.0));
        let rise_s = figures.unwrap().rise_time_s.unwrap();
        assert!((rise_s - 0.05 * 9f64.ln()).abs() < 0.002, "{rise_s}");
    }

    #[test]
    fn without_a_setpoint_a_step_is_judged_against_where_it_ends() {
        let (_, end, figures) = judge_step(&response(-800.0), 5.0, None).unwrap();
        assert!((end + 800.0).abs() < 0.1, "{end}");
        assert!(figures.unwrap().final_error.abs() < 0.1);
    }

    #[test]
    fn a_step_without_readings_is_not_judged() {
        assert_eq!(judge_step(&[], 5.0, Some(1.0)), None);
    }
}
