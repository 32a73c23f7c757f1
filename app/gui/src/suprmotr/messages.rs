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
        Pattern { word: u16, bits: String } "CP {word}: channels 16 to 1 give {bits}. Tick the box to set them; the form of CP is assumed",
        Volts { volts: f64, steps: u8 } "{volts:.2} V ({steps})",
        NotLive { reads: String } "{reads}, not live",
        Analog { name: &'static str, reads: String } "{name}: {reads}",
    }
}

messages! {
    /// What is said of gains that were edited.
    pub enum GainsMessage {
        NotApplied { edits: usize } "Edited and not applied: {edits}.",
    }
}

messages! {
    /// What the home guide says.
    pub enum HomeMessage {
        Step { text: String, state: &'static str } "Home step {text}: {state}",
        Velocity { counts_per_s: f64 } "DV {counts_per_s:.0}",
        Refused { why: String } "Home was not found: {why}",
    }
}

messages! {
    /// What is said of the macros of a board.
    pub enum MacrosMessage {
        Storing { stored: usize, of: usize } "Storing macros: {stored} of {of} are stored …",
        Stored { macros: String } "Stored and read back: {macros}. Macros of other numbers stay as they were.",
        NotStored { number: u8 } "Macro {number} did not come back as it was sent: it was not stored, or not whole. Nothing more was sent.",
        Calling { number: u8 } "Calling macro {number} …",
        Called { number: u8 } "Macro {number} was called. Stop All ends it.",
        Read { macros: String } "Read from the board: {macros}.",
        Same { macros: String } "The board and the file have the same: {macros}.",
        Differ { names: String } "Other commands on the board: {names}.",
        NotThere { names: String } "Not on the board: {names}.",
        OnlyThere { numbers: String } "On the board alone: {numbers}.",
        One "1 macro",
        Many { count: usize } "{count} macros",
        Said { text: String } "Macros: {text}",
        Stepped { place: String, command: String, counts: i64, seconds: f64 } "Simulated: {place} {command}, at {counts} counts after {seconds:.3} s",
        SteppedOver { how: &'static str, counts: i64, seconds: f64 } "Simulated: {how} at {counts} counts after {seconds:.3} s",
        Says { text: String } "says {text}",
        Gives { bits: String } "outputs {bits}",
        NotSimulated { why: String } "It cannot be simulated: {why}",
        Entry { number: u8, name: String } "{number} {name}",
    }
}

messages! {
    /// What edits of settings do once they are written.
    pub enum EditMessage {
        NoLimits "As soon as this is written, no limit switch stops the motor.",
        SwitchesUnread "How the limit switches stand is not read yet: one that is on stops the motor on its way as soon as this is written.",
        StopsNegative "The negative limit switch counts as on now: as soon as this is written, the motor does not move in the negative direction.",
        StopsPositive "The positive limit switch counts as on now: as soon as this is written, the motor does not move in the positive direction.",
        SwitchesOff "Both limit switches will count as off as they stand now: nothing stops before one is reached.",
        LetGo { lag: f64, limit: f64 } "The position lags by {lag:.0} counts now, more than {limit:.0}: as soon as this is written, the motor is let go.",
        AddressKept "The address is kept in EEPROM as soon as this is written; every unit that is selected takes it.",
    }
}
