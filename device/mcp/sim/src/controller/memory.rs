//! What a unit keeps without power: the EEPROM, the script memory and the flash memory of the firmware.

use super::loader::Flash;
use super::script::ScriptMemory;
use crate::settings::{Eeprom, Image, Settings, Shape};
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::Address;

/// Non-volatile memories.
#[derive(Clone, Debug)]
pub(super) struct Memory {
    pub eeprom: Eeprom,
    pub script: ScriptMemory,
    pub flash: Flash,
}

impl Memory {
    /// A unit as it leaves the factory, with these settings stored.
    pub fn holding(settings: &Settings) -> Self {
        Self {
            eeprom: Eeprom::holding(&Image::of(settings)),
            script: ScriptMemory::default(),
            flash: Flash::default(),
        }
    }

    /// The stored settings, or factory settings where nothing valid is stored.
    pub fn load(&self, model: &Model, address: Address) -> Settings {
        let factory = Settings::factory(model, address.get());
        let stored = self.eeprom.image().settings(Shape::of(model), factory.clone());
        stored.unwrap_or(factory)
    }
}
