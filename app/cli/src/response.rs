//! How a speed or position command was answered, in figures: said when `brushwork drive` has run its time.

use std::time::Duration;

use brushwork_link::device::{Channel, Drive, DriveCommand, Sample};
use brushwork_tuning::{Point, StepFigures};
use brushwork_values::Motor;

/// The response of one motor, from the first sample before the command on.
pub struct Response {
    motor: Motor,
    channel: Channel,
    setpoint: f64,
    start: Option<f64>,
    points: Vec<Point>,
}

impl Response {
    /// One for each motor that follows a setpoint; duty has no response to be judged.
    pub fn of(drive: &Drive) -> Vec<Self> {
        Motor::BOTH.into_iter().filter_map(|motor| Self::new(motor, drive.of(motor)?)).collect()
    }

    fn new(motor: Motor, command: DriveCommand) -> Option<Self> {
        let channel = match (command, motor) {
            (DriveCommand::Speed { .. }, Motor::M1) => Channel::M1_VELOCITY,
            (DriveCommand::Speed { .. }, Motor::M2) => Channel::M2_VELOCITY,
            (DriveCommand::Position { .. }, Motor::M1) => Channel::M1_POSITION,
            (DriveCommand::Position { .. }, Motor::M2) => Channel::M2_POSITION,
            _ => return None,
        };
        Some(Self { motor, channel, setpoint: command.setpoint(), start: None, points: Vec::new() })
    }

    /// Takes over a sample; `commanded_at` is by the same clock as the sample's times.
    pub fn take(&mut self, sample: &Sample, commanded_at: Duration) {
        let (Some(value), Some(at)) = (sample.get(self.channel), sample.read_at(self.channel)) else {
            return;
        };
        let start = *self.start.get_or_insert(value);
        if let (Some(since), true) = (at.checked_sub(commanded_at), start.is_finite()) {
            self.points.push(Point { time_s: since.as_secs_f64(), value });
        }
    }

    /// The figures as a sentence; `None` where there is nothing to judge.
    pub fn sentence(&self) -> Option<String> {
        let figures = StepFigures::of(&self.points, self.start?, self.setpoint)?;
        let time =
            |time: Option<f64>| time.map_or_else(|| "not reached".to_owned(), |time| format!("{time:.2} s"));
        Some(format!(
            "{}: rise time (10 to 90 %) {}, overshoot {:.1} %, settling time (5 %) {}, final error {:.0} {}.",
            self.motor,
            time(figures.rise_time_s),
            figures.overshoot * 100.0,
            time(figures.settling_time_s),
            figures.final_error,
            self.channel.unit,
        ))
    }
}
