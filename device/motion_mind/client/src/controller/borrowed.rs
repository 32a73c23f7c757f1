//! What a stop has changed of a unit and gives back, and how steep its ramp is.

use brushwork_link::settings::SettingValue;
use brushwork_motion_mind_wire::{function, register_number as number};
use std::time::Duration;

/// A ramp that lets full drive come down within this is quick enough as it is.
const QUICK: Duration = Duration::from_millis(250);
/// The steepest ramp: all at once.
pub const STEEPEST: i64 = 1023;

/// A register in RAM that a stop has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Borrowed {
    pub register: u8,
    /// What it held before.
    pub value: i64,
}

impl Borrowed {
    /// As a setting: its key and what it is to hold again. Of FUNCTION a stop changes one bit.
    pub fn setting(self) -> (String, SettingValue) {
        if self.register == number::FUNCTION {
            let is_off = self.value & i64::from(function::DISABLEPID) != 0;
            return (DISABLEPID.to_owned(), SettingValue::Bool(is_off));
        }
        (VELOCITYLIMIT.to_owned(), SettingValue::Int(self.value))
    }
}

/// Keys of the two settings that a stop changes.
pub const DISABLEPID: &str = "function.disablepid";
pub const VELOCITYLIMIT: &str = "register.velocitylimit";

/// How the drive of mode 3 changes, as last read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ramp {
    /// VELOCITYLIMIT; `None` while nobody knows.
    pub step: Option<i64>,
    /// TIMER, in 5 ms.
    pub timer: Option<i64>,
}

impl Ramp {
    pub fn note_write(&mut self, register: u8, value: i64) {
        match register {
            number::VELOCITYLIMIT => self.step = Some(value),
            number::TIMER => self.timer = Some(value),
            _ => {}
        }
    }

    /// How long full drive takes to come down; `None` while nobody knows, and for ever at a step of 0.
    pub fn time_to_zero(self) -> Option<Duration> {
        let (step, timer) = (self.step?, self.timer?.max(1));
        let updates = if step > 0 { (STEEPEST + step - 1) / step } else { i64::from(u32::MAX) };
        Some(Duration::from_millis(5) * u32::try_from(updates * timer).unwrap_or(u32::MAX))
    }

    pub fn is_slow(self) -> bool {
        self.time_to_zero().is_some_and(|time| time > QUICK)
    }
}
