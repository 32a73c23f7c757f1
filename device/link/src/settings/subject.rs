//! The controller that a settings table is made for.

use crate::family::{FamilyRef, Model};
use crate::unit::FirmwareGeneration;

/// What the table has to know about the controller in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject {
    /// The model: ratings, pin names.
    pub model: &'static Model,
    /// The firmware generation: which settings there are, and in which form.
    pub generation: FirmwareGeneration,
    /// Number of input pins.
    pub pins: usize,
    /// Number of serial streams.
    pub streams: usize,
    /// Number of digital outputs.
    pub douts: usize,
}

impl Subject {
    /// A controller with the pins, streams and outputs its model is listed with.
    #[must_use]
    pub fn new(model: &'static Model, generation: FirmwareGeneration) -> Self {
        Self { model, generation, pins: model.pins.len(), streams: model.streams, douts: model.douts }
    }

    /// The controller's family.
    #[must_use]
    pub fn family(&self) -> FamilyRef {
        self.model.family
    }

    /// The name of an input, as printed where the model's inputs are known.
    #[must_use]
    pub fn pin_name(&self, index: usize) -> String {
        self.model.pins.get(index).map_or_else(|| format!("Pin {}", index + 1), |label| (*label).to_owned())
    }
}
