//! Measures QPPS, the speed at full duty, as a job (MCP manual 2.4.5, steps 1 to 4).
//!
//! First a little duty shows that the encoder counts up when the motor goes forward. Then the motor runs at full duty in
//! both directions until its speed has settled, within limits of time and travel. What came of it is a [`Measured`], or a
//! failure that says what is wrong with the machine.

use crate::messages::{CoreActMessage, CoreCauseMessage, CoreRemedyMessage};
use std::time::Duration;

use brushwork_link::device::{JobContext, Power};
use brushwork_link::{Drive, DriveCommand, ExchangeError, Failure, Job};
use brushwork_values::Motor;

use super::reader::{Encoders, INTERVAL};
use super::speed::{HeldSpeed, PART_S, Reading, has_settled, held_speed, present_speed};

/// Duty at which the direction is looked for: it goes up until the motor moves.
const DIRECTION_DUTY: f64 = 0.30;
const DIRECTION_STEP: f64 = 0.01;
const DIRECTION_INTERVAL: Duration = Duration::from_millis(60);
/// Counts that show a direction.
const DIRECTION_COUNTS: f64 = 10.0;
/// At this share of the best speed so far a motor that ran has been caught by something.
const CAUGHT_SHARE: f64 = 0.2;
/// Output below which the controller is holding back.
const FULL_DUTY: f64 = 0.99;
/// The same of the little duty of the direction check, which is read with some delay.
const HELD_BACK: f64 = 0.8;
/// How long a motor is given to come to rest.
const REST_LIMIT: Duration = Duration::from_secs(20);
/// A motor that goes slower than this share of its best speed has come to rest.
const REST_SHARE: f64 = 0.02;
/// Current, A, below which no motor is connected.
const NO_AMPS: f64 = 0.03;
/// A blocked motor draws in proportion to its duty; one that turns draws hardly more with more duty.
const BLOCKED_RATIO: f64 = 1.5;

/// What is to be measured, and within what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    pub motor: Motor,
    /// How far the motor may go in one direction, counts.
    pub travel_limit_counts: f64,
    /// How long it may run in one direction.
    pub time_limit: Duration,
    /// How fast the duty goes up and down, as a fraction of full duty per second.
    pub accel_duty_per_s: f64,
}

/// One direction at full duty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    pub speed: HeldSpeed,
    pub power: Power,
    /// How far it went until the speed was known, counts.
    pub travel_counts: f64,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    pub motor: Motor,
    pub forward: Run,
    pub reverse: Run,
    /// Battery with the motor at rest, V.
    pub rest_volts: f64,
}

impl Measured {
    /// What QPPS should be: the mean of both directions, counts/s.
    pub fn qpps(&self) -> f64 {
        let speed = |run: &Run| run.speed.counts_per_s.abs();
        ((speed(&self.forward) + speed(&self.reverse)) / 2.0).round()
    }

    /// Greatest difference of any two of its speeds in one direction, as a share.
    pub fn spread(&self) -> f64 {
        self.forward.speed.spread.max(self.reverse.speed.spread)
    }

    /// Difference between the directions, as a share.
    pub fn asymmetry(&self) -> f64 {
        let [forward, reverse] = [self.forward, self.reverse].map(|run| run.speed.counts_per_s.abs());
        (forward - reverse).abs() / self.qpps().max(1.0)
    }
}

/// The job that measures.
pub fn job(task: Task) -> Job<Measured> {
    let ramps = Duration::from_secs_f64(4.0 / task.accel_duty_per_s.max(0.05));
    let limit = (task.time_limit + REST_LIMIT) * 2 + ramps + Duration::from_secs(10);
    Job::moving(CoreActMessage::MeasureQpps, limit, move |context| {
        let mut bench = Bench { task, encoders: Encoders::default() };
        bench.measure(context)
    })
}

struct Bench {
    task: Task,
    encoders: Encoders,
}

impl Bench {
    fn measure(&mut self, context: &mut JobContext<'_>) -> Result<Measured, Failure> {
        let motor = self.task.motor;
        context.progress(Some(0.0), "Looking whether L and R are set");
        self.refuse_torque_control(context)?;
        let rest_volts = power(context, motor)?.volts;
        context.progress(Some(0.05), "Checking the direction");
        self.check_direction(context)?;
        context.progress(Some(0.15), "Forward at full duty");
        let forward = self.run(context, 1.0)?;
        context.progress(Some(0.5), "Coming to rest");
        self.come_to_rest(context)?;
        context.progress(Some(0.6), "Backward at full duty");
        let reverse = self.run(context, -1.0)?;
        context.progress(Some(0.95), "Coming to rest");
        self.come_to_rest(context)?;
        Ok(Measured { motor, forward, reverse, rest_volts })
    }

    /// With L and R set the sliders ask for a current, so that there is no full duty to measure at (MCP manual 1.2.11).
    fn refuse_torque_control(&self, context: &mut JobContext<'_>) -> Result<(), Failure> {
        let motor = self.task.motor;
        match context.address().family().readings().is_torque_mode(context, motor) {
            Ok(true) => Err(refusal(
                context,
                CoreCauseMessage::TorqueControl { motor },
                CoreRemedyMessage::ClearWinding,
            )),
            Ok(false) => Ok(()),
            Err(error) => Err(failed(context, &error)),
        }
    }

    /// Raises the duty until the motor moves, and looks which way it counts.
    fn check_direction(&mut self, context: &mut JobContext<'_>) -> Result<(), Failure> {
        let start = self.read(context)?.counts;
        let mut half_way = None;
        let mut last = Power::default();
        let mut duty = 0.0;
        while duty < DIRECTION_DUTY {
            duty += DIRECTION_STEP;
            self.drive(context, DriveCommand::duty(duty))?;
            let until = context.now() + DIRECTION_INTERVAL;
            while context.now() < until {
                let moved = self.read(context)?.counts - start;
                if moved >= DIRECTION_COUNTS {
                    return Ok(());
                }
                if moved <= -DIRECTION_COUNTS {
                    return Err(self.wrong_way(context, duty));
                }
                pause(context)?;
            }
            last = power(context, self.task.motor)?;
            if half_way.is_none() && duty >= DIRECTION_DUTY / 2.0 {
                half_way = Some(last);
            }
        }
        Err(self.no_counts(context, half_way.unwrap_or(last), last))
    }

    fn wrong_way(&self, context: &JobContext<'_>, duty: f64) -> Failure {
        refusal(
            context,
            CoreCauseMessage::CountsDown { motor: self.task.motor, percent: duty * 100.0 },
            CoreRemedyMessage::ChangeLeads,
        )
    }

    /// Why nothing was counted, by the current at half the duty and at all of it.
    fn no_counts(&self, context: &JobContext<'_>, half: Power, full: Power) -> Failure {
        let motor = self.task.motor;
        let amps = full.amps.abs();
        if full.duty.abs() < DIRECTION_DUTY * HELD_BACK {
            return held_back(context, full.duty / DIRECTION_DUTY);
        }
        let percent = DIRECTION_DUTY * 100.0;
        let (came_back, remedy) = if amps < NO_AMPS {
            (CoreCauseMessage::NoCurrent { motor, percent }, CoreRemedyMessage::CheckLeads)
        } else if amps > half.amps.abs() * BLOCKED_RATIO {
            (CoreCauseMessage::Blocked { motor, percent, amps }, CoreRemedyMessage::FreeShaft)
        } else {
            (CoreCauseMessage::EncoderUnseen { motor, percent, amps }, CoreRemedyMessage::CheckEncoder)
        };
        refusal(context, came_back, remedy)
    }

    /// Runs at full duty until the speed has settled.
    fn run(&mut self, context: &mut JobContext<'_>, duty: f64) -> Result<Run, Failure> {
        let accel_duty_per_s = Some(self.task.accel_duty_per_s);
        self.drive(context, DriveCommand::Duty { duty, accel_duty_per_s })?;
        let begun_at = context.now();
        let at_full_duty = begun_at + Duration::from_secs_f64(1.0 / self.task.accel_duty_per_s);
        let mut watch = Watch { start: self.read(context)?.counts, best: 0.0, record: Vec::new() };
        loop {
            // Judged once in each half part; reading goes on in between.
            let until = context.now() + Duration::from_secs_f64(PART_S / 2.0);
            while context.now() < until {
                let reading = self.read(context)?;
                watch.record.push(reading);
                self.watch_travel(context, &watch, reading, begun_at)?;
                pause(context)?;
            }
            self.watch_speed(context, &mut watch, duty)?;
            let since_full_s = at_full_duty.as_secs_f64();
            let full = watch.record.partition_point(|reading| reading.at_s < since_full_s);
            let at_full = &watch.record[full..];
            if has_settled(at_full)
                && let Some(speed) = held_speed(at_full)
            {
                return self.finish_run(context, &watch, speed);
            }
        }
    }

    fn finish_run(
        &mut self,
        context: &mut JobContext<'_>,
        watch: &Watch,
        speed: HeldSpeed,
    ) -> Result<Run, Failure> {
        let power = power(context, self.task.motor)?;
        if power.duty.abs() < FULL_DUTY {
            return Err(held_back(context, power.duty));
        }
        let travel_counts = watch.record.last().map_or(0.0, |last| (last.counts - watch.start).abs());
        Ok(Run { speed, power, travel_counts })
    }

    fn watch_travel(
        &self,
        context: &JobContext<'_>,
        watch: &Watch,
        now: Reading,
        begun_at: Duration,
    ) -> Result<(), Failure> {
        let travel = (now.counts - watch.start).abs();
        let best = watch.best;
        if travel > self.task.travel_limit_counts {
            let came_back = CoreCauseMessage::TravelUsed { counts: self.task.travel_limit_counts, best };
            return Err(refusal(context, came_back, CoreRemedyMessage::AllowTravel));
        }
        if context.now() > begun_at + self.task.time_limit {
            let came_back = CoreCauseMessage::TimeUsed { seconds: self.task.time_limit.as_secs_f64(), best };
            return Err(refusal(context, came_back, CoreRemedyMessage::AllowTime));
        }
        Ok(())
    }

    /// A motor that ran and stands now has lost its encoder or was caught.
    fn watch_speed(&self, context: &mut JobContext<'_>, watch: &mut Watch, duty: f64) -> Result<(), Failure> {
        let Some(speed) = present_speed(&watch.record) else { return Ok(()) };
        let forward = speed.counts_per_s * duty.signum();
        if watch.best * PART_S > DIRECTION_COUNTS && forward < watch.best * CAUGHT_SHARE {
            let amps = power(context, self.task.motor)?.amps.abs();
            let (motor, best) = (self.task.motor, watch.best);
            let came_back = CoreCauseMessage::Caught { motor, best, now: forward, amps };
            return Err(refusal(context, came_back, CoreRemedyMessage::LookAtShaft));
        }
        watch.best = watch.best.max(forward);
        Ok(())
    }

    /// Takes the duty back and waits until the motor hardly moves.
    fn come_to_rest(&mut self, context: &mut JobContext<'_>) -> Result<(), Failure> {
        let accel_duty_per_s = Some(self.task.accel_duty_per_s);
        self.drive(context, DriveCommand::Duty { duty: 0.0, accel_duty_per_s })?;
        let until = context.now() + REST_LIMIT;
        let mut record = Vec::new();
        let mut best = 0.0_f64;
        while context.now() < until {
            record.push(self.read(context)?);
            let speed = present_speed(&record).map_or(f64::INFINITY, |speed| speed.counts_per_s.abs());
            let is_known = record.len() > 1 && record[record.len() - 1].at_s - record[0].at_s >= PART_S;
            if is_known {
                best = best.max(speed);
                if speed * PART_S < DIRECTION_COUNTS || speed < best * REST_SHARE {
                    break;
                }
            }
            pause(context)?;
        }
        Ok(())
    }

    fn drive(&self, context: &mut JobContext<'_>, command: DriveCommand) -> Result<(), Failure> {
        context.drive(&Drive::one(self.task.motor, command)).map_err(|error| failed(context, &error))
    }

    fn read(&mut self, context: &mut JobContext<'_>) -> Result<Reading, Failure> {
        let readings = self.encoders.read(context).map_err(|error| failed(context, &error))?;
        Ok(readings[self.task.motor.index()])
    }
}

/// One direction so far.
struct Watch {
    start: f64,
    /// Greatest speed so far in the direction asked for, counts/s.
    best: f64,
    record: Vec<Reading>,
}

/// `share` of the duty that was asked for is given.
fn held_back(context: &JobContext<'_>, share: f64) -> Failure {
    let came_back = CoreCauseMessage::HeldBack { percent: share.abs() * 100.0 };
    refusal(context, came_back, CoreRemedyMessage::SeeLimits)
}

fn power(context: &mut JobContext<'_>, motor: Motor) -> Result<Power, Failure> {
    context.address().family().readings().power(context, motor).map_err(|error| failed(context, &error))
}

fn pause(context: &mut JobContext<'_>) -> Result<(), Failure> {
    context.sleep(INTERVAL).map_err(|error| failed(context, &error))
}

fn refusal(context: &JobContext<'_>, came_back: CoreCauseMessage, remedy: CoreRemedyMessage) -> Failure {
    Failure::new(CoreActMessage::MeasureQpps, context.describe(), came_back, remedy)
}

fn failed(context: &JobContext<'_>, error: &ExchangeError) -> Failure {
    error.failure(CoreActMessage::MeasureQpps, context.describe())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(counts_per_s: f64, spread: f64) -> Run {
        let power = Power { duty: counts_per_s.signum(), amps: 0.2, volts: 23.9 };
        Run { speed: HeldSpeed { counts_per_s, spread }, power, travel_counts: 9000.0 }
    }

    #[test]
    fn qpps_is_the_mean_of_both_directions_and_the_worst_spread_is_told() {
        let measured = Measured {
            motor: Motor::M1,
            forward: run(10_100.0, 0.001),
            reverse: run(-9_900.0, 0.004),
            rest_volts: 24.0,
        };
        assert_eq!((measured.qpps(), measured.spread()), (10_000.0, 0.004));
        assert!((measured.asymmetry() - 0.02).abs() < 1e-9);
    }
}
