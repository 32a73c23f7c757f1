//! What each input pin of a model can be.

use brushwork_mcp_wire::models::Pin;

/// What a pin can be, worked out once from its label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PinFunctions {
    pub is_analog: bool,
    pub is_pulse: bool,
    /// Index of the encoder whose phase it is.
    pub encoder: Option<usize>,
    /// Index of the stream whose line it is.
    pub stream: Option<usize>,
}

impl PinFunctions {
    pub fn of(pin: Pin) -> Self {
        Self {
            is_analog: pin.is_analog(),
            is_pulse: pin.is_pulse(),
            encoder: pin.encoder_channel().and_then(|(number, _)| usize::from(number).checked_sub(1)),
            stream: pin.uart().map(|uart| usize::from(uart) + 1),
        }
    }
}
