//! The settings of one controller: what its RAM holds, how they are laid out in its EEPROM, and the EEPROM itself.
//!
//! Values are kept raw, as they travel on the wire, so that a read returns exactly what was written. Scaling into
//! physical units is the business of whoever uses a value. What is not kept here: run-time state (encoder counts,
//! latched faults, buffers).

mod defaults;
mod eeprom;
mod groups;
mod hidden;
mod persist;
#[cfg(test)]
mod tests;

pub use eeprom::{Eeprom, ROW_BYTES, ROW_WRITE_TIME, USER_WORDS};
pub use groups::{
    BatterySettings, ControlInput, MotorRegisters, OutputSettings, RoboclawSettings, Settings, Shape,
    SignalSettings, StreamSettings, UnitSettings,
};
pub use hidden::UnknownKey;
pub use persist::{Image, Persist};
