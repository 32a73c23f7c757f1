//! What settings code and jobs see of a controller: commands to one unit, and the time.

use crate::exchange::ExchangeError;
use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_values::{Value, Values};
use std::fmt;
use std::time::Duration;

/// Commands to one unit, in the words of its family. Behind it stand deadlines, retries, the Stop flag and the arming rule.
///
/// After an error whose [`ExchangeError::interruption`] is set every further call fails the same way: whoever holds the
/// wire should return.
pub trait Wire {
    /// Sends a command with its values in wire order (constants such as keys may be left out) and returns the reply's
    /// values, none for an acknowledgement.
    fn transact_values(&mut self, command: u8, values: Vec<Value>) -> Result<Values, ExchangeError>;

    /// The unit's address.
    fn address(&self) -> UnitAddress;

    /// The generation of the unit's firmware.
    fn generation(&self) -> FirmwareGeneration;

    /// Whether the unit is simulated in this program, so that guesses about the wire may be sent to it.
    fn is_simulated(&self) -> bool;

    /// Time since the clock's epoch.
    fn now(&self) -> Duration;

    /// Waits; ends early, with an error, when something more urgent comes.
    fn sleep(&mut self, time: Duration) -> Result<(), ExchangeError>;

    /// The port as a person would name it.
    fn port(&self) -> String;

    /// Sends a command whose values are all numbers, raw and in wire order.
    fn transact(&mut self, command: u8, values: &[i64]) -> Result<Values, ExchangeError> {
        self.transact_values(command, values.iter().map(|&value| Value::Int(value)).collect())
    }

    /// Speaks to another address from now on: the unit has just been given it. `false` when this wire cannot follow.
    fn set_address(&mut self, _address: UnitAddress) -> bool {
        false
    }

    /// What a simulated controller lets its owner set past the wire; `None` on everything else.
    fn hidden_settings(&self) -> Option<&dyn HiddenSettings> {
        None
    }

    /// Whether the unit's firmware is known to lack what its capability map has under this number.
    fn lacks(&self, _number: u8) -> bool {
        false
    }

    /// Tells whoever waits how far the work is.
    fn report_progress(&mut self, _done: usize, _of: usize, _what: &str) {}

    /// Whether others may speak to the unit between this wire's exchanges. They may not while the unit restarts.
    fn set_quiet(&mut self, _quiet: bool) {}

    /// The unit and its port, for sentences: "0x80 at /dev/ttyACM0".
    fn describe(&self) -> String {
        format!("{} at {}", self.address(), self.port())
    }
}

/// Settings that no public command carries, as far as a simulated controller has them: read and set past the wire, in its
/// own world. A real controller has no such thing, so a guess cannot reach one.
pub trait HiddenSettings: fmt::Debug + Send + Sync {
    /// The raw value behind a key of the settings table; `None` if the unit has no such setting.
    fn get(&self, address: UnitAddress, key: &str) -> Option<i64>;

    /// Sets it; an error is a sentence.
    fn set(&self, address: UnitAddress, key: &str, raw: i64) -> Result<(), String>;
}
