//! The input pins of a unit: mode, shaping, and what the live signal says of the reading behind it.

use brushwork_link::device::PinSignal;
use brushwork_mcp_client::settings::{Behind, Conflict, PinMode, SignalShape, change_mode, conflicts, modes};
use brushwork_mcp_wire::packet_serial::scale;

use crate::model::settings::UnitSettings;

impl UnitSettings {
    /// What a pin (from 1) is wanted to be used as.
    pub fn pin_mode(&self, pin: usize) -> Option<PinMode> {
        PinMode::of(&|key| self.wanted(key), pin)
    }

    /// What a pin is used as at present.
    pub fn pin_mode_on_controller(&self, pin: usize) -> Option<PinMode> {
        PinMode::of(&|key| self.on_controller(key), pin)
    }

    /// The modes of a pin, each with the reason where it cannot be chosen.
    pub fn pin_modes(&self, pin: usize) -> Vec<(PinMode, Option<&'static str>)> {
        modes(self.table(), pin, self.is_simulated)
    }

    /// Chooses a pin's mode; everything else of the pin goes to its default.
    pub fn set_pin_mode(&mut self, pin: usize, mode: PinMode) {
        if self.pin_mode(pin) != Some(mode) {
            self.set_all(&change_mode(self.table(), pin, mode, self.is_simulated));
        }
    }

    /// How a pin is wanted to shape its reading.
    pub fn shape(&self, pin: usize) -> Option<SignalShape> {
        SignalShape::of(&|key| self.wanted(key), pin)
    }

    /// The reading behind a live signal, by the settings that the controller shapes it with.
    pub fn reading(&self, pin: usize, signal: PinSignal) -> Option<Behind> {
        self.pin_mode_on_controller(pin).filter(|mode| *mode != PinMode::None)?;
        let shape = SignalShape::of(&|key| self.on_controller(key), pin)?;
        Some(shape.behind(f64::from(signal.position)))
    }

    /// Makes a pin's command range as wide as its input range around the center (MCP manual 1.9.11).
    pub fn match_input(&mut self, pin: usize) {
        let Some(shape) = self.shape(pin) else { return };
        let full = scale::FULL_DUTY_RAW as f64;
        for (field, end) in [("min_output", shape.min), ("max_output", shape.max)] {
            let command = (end - shape.center).clamp(-full, full);
            self.set_number(&format!("pin.{pin}.{field}"), command);
        }
    }

    /// What contradicts itself in what is wanted.
    pub fn conflicts(&self) -> Vec<Conflict> {
        conflicts(self.table(), &|key| self.wanted(key))
    }
}
