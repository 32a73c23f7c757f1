//! The gains that the controller of a desk holds.

use brushwork_values::Motor;

use super::registers::Registers;
use crate::model::desk::Desk;

impl Desk {
    /// The gains that the controller holds, as last read; of a position loop of its own where that is asked for.
    pub fn held_gains(&self, motor: Motor, with_position: bool) -> Option<Registers> {
        let unit = self.settings.unit()?;
        if self.family().has_loops() {
            return Registers::held(unit, motor, with_position);
        }
        Registers::of_settings(|key| unit.confirmed(key))
    }
}
