//! The voltage clamp test of MCP manual 1.7.5 as a job: the motor runs up to 25 % and is slowed quickly, then 5 % more each
//! time, while the main battery's voltage is watched. It ends at 100 %, where the voltage reaches the limit, or where the
//! controller has to brake the motor by itself because its over-voltage lasts.
//!
//! Slowing down takes the duty back quickly but not at once: at once would short the motor, which brakes it and gives nothing
//! back. The motors are stopped by the device thread on every way out.

use crate::messages::{CoreActMessage, CoreCauseMessage, CoreRemedyMessage};
use std::time::Duration;

use brushwork_link::device::JobContext;
use brushwork_link::{Drive, DriveCommand, ExchangeError, Failure, Job};
use brushwork_values::Motor;
use crossbeam_channel::Sender;

/// The duties of the test, in percent (MCP manual 1.7.5).
const FIRST_PERCENT: u32 = 25;
const STEP_PERCENT: u32 = 5;
const LAST_PERCENT: u32 = 100;
/// How many steps there are.
pub const STEPS: usize = ((LAST_PERCENT - FIRST_PERCENT) / STEP_PERCENT + 1) as usize;
/// How fast the duty goes up, per second.
const UP_DUTY_PER_S: f64 = 1.0;
/// How long the voltage is watched after the duty has come down to zero.
const AFTER: Duration = Duration::from_millis(800);
/// Time between two readings.
const INTERVAL: Duration = Duration::from_millis(4);
/// Assumed: a clamp that works has the voltage below the controller's maximum again within this time.
const LONGEST_HIGH_S: f64 = 0.05;
/// How long a motor is given to come to rest between two steps, and when it counts as at rest.
const REST_LIMIT: Duration = Duration::from_secs(15);
const REST_INTERVAL: Duration = Duration::from_millis(20);
const REST_SHARE: f64 = 0.03;
const REST_COUNTS_PER_S: f64 = 20.0;
/// Readings that the voltage before slowing down is the mean of.
const BEFORE_READINGS: usize = 8;
/// What the exchanges and waits of a step may take beyond its own times.
const SLACK: Duration = Duration::from_secs(2);

/// What is to be tested, and within what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    pub motor: Motor,
    /// The test ends where the battery reaches this.
    pub limit_volts: f64,
    /// How fast the duty comes down, per second.
    pub down_duty_per_s: f64,
    /// How long the motor runs at each duty before it is slowed.
    pub hold: Duration,
}

/// One speed that was run up to and slowed down from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// 0 to 1.
    pub duty: f64,
    /// Battery while the motor ran, V.
    pub before_volts: f64,
    /// Highest battery voltage read while it slowed down, V.
    pub peak_volts: f64,
    /// How often it was read meanwhile.
    pub readings: usize,
    /// How long the controller reported an over-voltage meanwhile, seconds: so long it brakes by itself.
    pub high_s: f64,
    /// Whether the limit was reached, which ends the test.
    pub is_over: bool,
}

impl Step {
    /// Whether the controller had to brake the motor by itself, since nothing else took its energy. That ends the test too.
    pub fn is_braked(&self) -> bool {
        self.high_s > LONGEST_HIGH_S
    }
}

/// The duties of the test, 0 to 1.
pub fn duties() -> impl Iterator<Item = f64> {
    (FIRST_PERCENT..=LAST_PERCENT).step_by(STEP_PERCENT as usize).map(|percent| f64::from(percent) / 100.0)
}

impl Task {
    /// How long the whole test takes at most.
    pub fn time_limit(&self) -> Duration {
        let down_duty_per_s = self.down_duty_per_s.max(0.05);
        duties()
            .map(|duty| {
                let ramps = Duration::from_secs_f64(duty / UP_DUTY_PER_S + duty / down_duty_per_s);
                ramps + self.hold + AFTER + REST_LIMIT + SLACK
            })
            .sum()
    }
}

/// The job; each [`Step`] goes to `steps` as it ends, so that an interrupted test leaves what it has found.
pub fn job(task: Task, steps: Sender<Step>) -> Job<()> {
    Job::moving(CoreActMessage::TestClamp, task.time_limit(), move |context| {
        refuse_torque_control(context, task.motor)?;
        refuse_high_battery(context, &task)?;
        for (index, duty) in duties().enumerate() {
            let fraction = index as f32 / STEPS as f32;
            context
                .progress(Some(fraction), &format!("{:.0} %: running up, then slowing down", duty * 100.0));
            let step = one_step(context, &task, duty)?;
            // Nobody waits for it once the unit was left.
            let _ = steps.try_send(step);
            if step.is_over || step.is_braked() {
                break;
            }
            come_to_rest(context, task.motor)?;
        }
        Ok(())
    })
}

/// With L and R set a duty is a current, and no speed follows from it (MCP manual 1.2.11).
fn refuse_torque_control(context: &mut JobContext<'_>, motor: Motor) -> Result<(), Failure> {
    match context.address().family().readings().is_torque_mode(context, motor) {
        Ok(true) => {
            let came_back = CoreCauseMessage::TorqueControl { motor };
            Err(refusal(context, came_back, CoreRemedyMessage::ClearWindingForTest))
        }
        Ok(false) => Ok(()),
        Err(error) => Err(failed(context, &error)),
    }
}

fn refuse_high_battery(context: &mut JobContext<'_>, task: &Task) -> Result<(), Failure> {
    let volts = read_volts(context)?;
    if volts < task.limit_volts {
        return Ok(());
    }
    let came_back = CoreCauseMessage::BatteryTooHigh { volts, limit: task.limit_volts };
    Err(refusal(context, came_back, CoreRemedyMessage::RaiseLimit))
}

fn one_step(context: &mut JobContext<'_>, task: &Task, duty: f64) -> Result<Step, Failure> {
    drive(context, task.motor, duty, UP_DUTY_PER_S)?;
    let run_up = Duration::from_secs_f64(duty / UP_DUTY_PER_S) + task.hold;
    let up = watch(context, task, run_up)?;
    let before_volts = up.mean_of_last(BEFORE_READINGS);
    if up.is_over {
        let (peak_volts, readings, high_s) = (up.peak(), up.volts.len(), up.high_s);
        return Ok(Step { duty, before_volts, peak_volts, readings, high_s, is_over: true });
    }
    drive(context, task.motor, 0.0, task.down_duty_per_s)?;
    let run_down = Duration::from_secs_f64(duty / task.down_duty_per_s) + AFTER;
    let down = watch(context, task, run_down)?;
    Ok(Step {
        duty,
        before_volts,
        peak_volts: down.peak(),
        readings: down.volts.len(),
        high_s: down.high_s,
        is_over: down.is_over,
    })
}

/// Voltages read one after the other.
struct Watched {
    volts: Vec<f64>,
    high_s: f64,
    is_over: bool,
}

impl Watched {
    fn peak(&self) -> f64 {
        self.volts.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    fn mean_of_last(&self, count: usize) -> f64 {
        let last = &self.volts[self.volts.len().saturating_sub(count)..];
        last.iter().sum::<f64>() / last.len().max(1) as f64
    }
}

/// Reads the battery for a time; at the limit it takes the motor's duty away at once and stops reading.
fn watch(context: &mut JobContext<'_>, task: &Task, time: Duration) -> Result<Watched, Failure> {
    let until = context.now() + time;
    let mut watched = Watched { volts: Vec::new(), high_s: 0.0, is_over: false };
    while watched.volts.is_empty() || context.now() < until {
        let volts = read_volts(context)?;
        watched.volts.push(volts);
        if volts >= task.limit_volts {
            watched.is_over = true;
            let stop = DriveCommand::duty(0.0);
            context.drive(&Drive::one(task.motor, stop)).map_err(|error| failed(context, &error))?;
            return Ok(watched);
        }
        let asked_at = context.now();
        let is_high = reports_high(context)?;
        context.sleep(INTERVAL).map_err(|error| failed(context, &error))?;
        if is_high {
            watched.high_s += context.now().saturating_sub(asked_at).as_secs_f64();
        }
    }
    Ok(watched)
}

fn drive(context: &mut JobContext<'_>, motor: Motor, duty: f64, duty_per_s: f64) -> Result<(), Failure> {
    let command = DriveCommand::Duty { duty, accel_duty_per_s: Some(duty_per_s) };
    context.drive(&Drive::one(motor, command)).map_err(|error| failed(context, &error))
}

fn read_volts(context: &mut JobContext<'_>) -> Result<f64, Failure> {
    let readings = context.address().family().readings();
    readings.battery(context).map_err(|error| failed(context, &error))
}

/// Whether the controller reports an over-voltage of the main battery, while which it brakes the motors (MCP manual 1.6.3).
fn reports_high(context: &mut JobContext<'_>) -> Result<bool, Failure> {
    let readings = context.address().family().readings();
    readings.is_battery_high(context).map_err(|error| failed(context, &error))
}

/// Waits until the motor hardly turns, as far as an encoder tells.
fn come_to_rest(context: &mut JobContext<'_>, motor: Motor) -> Result<(), Failure> {
    let readings = context.address().family().readings();
    let until = context.now() + REST_LIMIT;
    let mut first = None;
    while context.now() < until {
        let speed = readings.speed(context, motor).map_err(|error| failed(context, &error))?.abs();
        if speed <= *first.get_or_insert(speed) * REST_SHARE || speed < REST_COUNTS_PER_S {
            return Ok(());
        }
        context.sleep(REST_INTERVAL).map_err(|error| failed(context, &error))?;
    }
    Ok(())
}

fn refusal(context: &JobContext<'_>, came_back: CoreCauseMessage, remedy: CoreRemedyMessage) -> Failure {
    Failure::new(CoreActMessage::TestClamp, context.describe(), came_back, remedy)
}

fn failed(context: &JobContext<'_>, error: &ExchangeError) -> Failure {
    error.failure(CoreActMessage::TestClamp, context.describe())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_duties_go_from_25_percent_upwards_in_steps_of_5() {
        let percents: Vec<u32> = duties().map(|duty| (duty * 100.0).round() as u32).collect();
        assert_eq!((percents[0], percents[1], percents[15]), (25, 30, 100));
        assert_eq!(percents.len(), STEPS);
    }

    #[test]
    fn the_time_limit_covers_every_step() {
        let task =
            Task { motor: Motor::M1, limit_volts: 30.0, down_duty_per_s: 2.0, hold: Duration::from_secs(1) };
        // Sixteen steps of 0.625 s up, 1 s held, 0.3125 s down, 0.8 s after, 15 s of rest and 2 s of slack on average.
        assert!((task.time_limit().as_secs_f64() - 16.0 * 19.7375).abs() < 1e-6);
    }
}
