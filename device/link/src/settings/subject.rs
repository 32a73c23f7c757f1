//! The controller that a settings table is made for.

use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::{Family, Model};

use crate::unit::FirmwareGeneration;

/// What the table has to know about the controller in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject {
    /// The model: ratings, pin names.
    pub model: &'static Model,
    /// The firmware generation: which settings there are, and in which form.
    pub generation: FirmwareGeneration,
    /// Number of input pins, as command 144 counts them.
    pub pins: usize,
    /// Number of serial streams, as command 146 counts them.
    pub streams: usize,
    /// Number of digital outputs, as command 138 counts them.
    pub douts: usize,
}

impl Subject {
    /// A controller with the pins, streams and outputs its model is listed with.
    pub fn new(model: &'static Model, generation: impl Into<FirmwareGeneration>) -> Self {
        Self {
            model,
            generation: generation.into(),
            pins: model.pins.len(),
            streams: model.streams,
            douts: model.douts,
        }
    }

    /// The label of pin `index` (from 0), or "Pin 7" when the unit has more pins than its model is listed
    /// with.
    pub fn pin_name(&self, index: usize) -> String {
        self.model.pins.get(index).map_or_else(|| format!("Pin {}", index + 1), |pin| pin.label.to_owned())
    }

    /// The signal number of phase A of a motor's own encoder; on a RoboClaw, encoder mode 0.
    pub(super) fn encoder_pin(&self, motor: usize) -> i64 {
        let own = |pin: &brushwork_mcp_wire::models::Pin| {
            pin.encoder_channel()
                .is_some_and(|(number, phase)| usize::from(number) == motor + 1 && phase == 'A')
        };
        match self.model.family {
            Family::RoboClaw | Family::MotionMind => 0,
            Family::Mcp => {
                let index = self.model.pins.iter().position(own).and_then(|index| i64::try_from(index).ok());
                index.unwrap_or(ENCODER_PIN_NONE)
            }
        }
    }
}
