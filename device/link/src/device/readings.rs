//! What a job reads of a unit by itself, whatever its family.

use super::job_context::JobContext;
use crate::exchange::{ExchangeError, Span};
use crate::messages::CauseMessage;
use brushwork_values::Motor;

/// What a motor gets and draws.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Power {
    /// Output, -1 to 1.
    pub duty: f64,
    /// Current, A.
    pub amps: f64,
    /// Main battery, V.
    pub volts: f64,
}

/// The readings of a family; those that it does not have are refused.
pub trait Readings: Send + Sync {
    /// Both encoder counts, as their 32 bits, and when they were read.
    fn encoders(&self, _context: &mut JobContext<'_>) -> Result<([i32; 2], Span), ExchangeError> {
        not_reported(CauseMessage::EncodersUntold)
    }

    /// What a motor gets and draws.
    fn power(&self, _context: &mut JobContext<'_>, _motor: Motor) -> Result<Power, ExchangeError> {
        not_reported(CauseMessage::PowerUntold)
    }

    /// The speed of a motor, counts/s.
    fn speed(&self, _context: &mut JobContext<'_>, _motor: Motor) -> Result<f64, ExchangeError> {
        not_reported(CauseMessage::SpeedUntold)
    }

    /// The main battery, V.
    fn battery(&self, _context: &mut JobContext<'_>) -> Result<f64, ExchangeError> {
        not_reported(CauseMessage::BatteryUntold)
    }

    /// Whether the unit reports an over-voltage of the main battery.
    fn is_battery_high(&self, _context: &mut JobContext<'_>) -> Result<bool, ExchangeError> {
        not_reported(CauseMessage::BatteryUntold)
    }

    /// Whether a duty is a current command, so that no speed follows from it.
    fn is_torque_mode(&self, _context: &mut JobContext<'_>, _motor: Motor) -> Result<bool, ExchangeError> {
        Ok(false)
    }
}

fn not_reported<T>(what: CauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}

/// Of a family that tells jobs nothing.
#[derive(Clone, Copy, Debug)]
pub struct NoReadings;

impl Readings for NoReadings {}
