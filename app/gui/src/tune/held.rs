//! The gains that the controller of a connection holds.

use brushwork_core::tune::law::AnyRegisters;
use brushwork_tuning::registers::RegisterField;
use brushwork_values::Motor;

use super::registers::of_settings;
use crate::model::connection::Connection;

impl Connection {
    /// The gains that the controller holds, as last read; of a position loop of its own where that is asked for.
    pub fn held_gains(&self, motor: Motor, with_position: bool) -> Option<AnyRegisters> {
        let unit = self.settings.unit()?;
        // Registers that are one set are written all at once, so that none of them may be in doubt.
        let value = |field: &RegisterField, key: &str| match field.of_motor {
            true => unit.on_controller(key),
            false => unit.confirmed(key),
        };
        of_settings(value, motor, with_position)
    }
}
