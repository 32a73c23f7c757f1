//! What is shown of a SuprMotr, in words.

use brushwork_values::messages;

messages! {
    /// How the line of a SuprMotr is set.
    pub enum LineMessage {
        Set { echo: &'static str, numbers: &'static str } "{echo}, numbers {numbers}",
    }
}

messages! {
    /// What the screen of inputs and outputs says of its lines.
    pub enum LinesMessage {
        Pin { pin: u8 } "J3 pin {pin}",
        Input { channel: u8, state: &'static str } "Channel {channel} reads {state}",
        MakeInput { channel: u8 } "Make channel {channel} an input",
        MakeOutput { channel: u8 } "Make channel {channel} an output",
        SwitchOn { channel: u8 } "Switch channel {channel} on",
        SwitchOff { channel: u8 } "Switch channel {channel} off",
        Line { name: &'static str, state: &'static str } "{name}: {state}",
        Sets { steps: u8 } "SO {steps}",
        Volts { volts: f64, steps: u8 } "{volts:.2} V ({steps})",
        NotLive { reads: String } "{reads}, not live",
        Analog { name: &'static str, reads: String } "{name}: {reads}",
    }
}
