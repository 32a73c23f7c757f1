//! The guided measurement of QPPS on the PWM screen: what is set, what runs, and what was found.

use crate::model::messages::MeasuredMessage;
use brushwork_link::Message;
use std::time::Duration;

use brushwork_link::device::{Event, QueuedJob};
use brushwork_values::Motor;

use super::watched::{Unfinished, Watched};
use brushwork_core::motion::qpps::{self, Measured, Task};

/// Directions that differ by more than this share are told.
const ASYMMETRY: f64 = 0.05;

/// The measurement of one link.
#[derive(Debug)]
pub struct QppsPanel {
    pub motor: Motor,
    pub travel_limit_counts: f64,
    pub time_limit_s: f64,
    pub job: Watched<Measured>,
    pub measured: Option<Measured>,
    /// Why nothing was found the last time.
    pub refusal: Option<Message>,
}

impl Default for QppsPanel {
    fn default() -> Self {
        Self {
            motor: Motor::M1,
            travel_limit_counts: 2_000_000.0,
            time_limit_s: 15.0,
            job: Watched::default(),
            measured: None,
            refusal: None,
        }
    }
}

impl QppsPanel {
    /// What to ask of the device thread; none while a measurement runs. The duty changes at `accel_percent_per_s`, where
    /// 0 is at once.
    pub fn begin(&mut self, accel_percent_per_s: f64) -> Option<QueuedJob> {
        let accel_duty_per_s = if accel_percent_per_s > 0.0 { accel_percent_per_s / 100.0 } else { 20.0 };
        let task = Task {
            motor: self.motor,
            travel_limit_counts: self.travel_limit_counts,
            time_limit: Duration::from_secs_f64(self.time_limit_s.clamp(1.0, 600.0)),
            accel_duty_per_s: accel_duty_per_s.clamp(0.05, 20.0),
        };
        let job = self.job.begin(qpps::job(task))?;
        (self.measured, self.refusal) = (None, None);
        Some(job)
    }

    /// Another unit, or none.
    pub fn forget(&mut self) {
        self.job.forget();
        (self.measured, self.refusal) = (None, None);
    }

    /// Takes in an event of its job; at the end whether something was found.
    pub fn take(&mut self, event: Event) -> Option<Result<(), Unfinished>> {
        let result = self.job.take_result(event)?;
        self.refusal = result.as_ref().err().map(|unfinished| unfinished.sentence.clone());
        Some(result.map(|measured| self.measured = Some(measured)))
    }
}

/// What was found, line by line.
pub fn lines(measured: &Measured) -> Vec<String> {
    let mut lines = vec![
        MeasuredMessage::Qpps {
            motor: measured.motor,
            qpps: measured.qpps(),
            forward: measured.forward.speed.counts_per_s.abs(),
            reverse: measured.reverse.speed.counts_per_s.abs(),
            spread_percent: measured.spread() * 100.0,
        }
        .to_string(),
    ];
    let volts = (measured.forward.power.volts + measured.reverse.power.volts) / 2.0;
    let amps = measured.forward.power.amps.abs().max(measured.reverse.power.amps.abs());
    lines.push(
        MeasuredMessage::Power {
            volts,
            rest_volts: measured.rest_volts,
            amps,
            forward: measured.forward.travel_counts,
            reverse: measured.reverse.travel_counts,
        }
        .to_string(),
    );
    if measured.asymmetry() > ASYMMETRY {
        lines.push(MeasuredMessage::Asymmetry { percent: measured.asymmetry() * 100.0 }.to_string());
    }
    lines
}
