//! Register numbers that the screens ask for by name, and where their values stand in the settings.

use brushwork_link::settings::SettingValue;
use brushwork_protocol::motion_mind::{Register, register};

use crate::gui::model::desk::Desk;

pub const POSITION: u8 = 0;
pub const FUNCTION: u8 = 3;
pub const MODE: u8 = 18;

/// The key of a register in the settings table.
pub fn key(register: &Register) -> String {
    format!("register.{}", register.name.to_lowercase())
}

impl Desk {
    /// The value of a register in the controller's RAM, as last read.
    pub fn register(&self, number: u8) -> Option<i64> {
        match self.general.unit()?.on_controller(&key(register(number)?))? {
            SettingValue::Int(value) => Some(value),
            _ => None,
        }
    }

    /// Whether a bit of a register is known to be set.
    pub fn has_bit(&self, number: u8, mask: u16) -> bool {
        self.register(number).is_some_and(|value| value & i64::from(mask) != 0)
    }
}
