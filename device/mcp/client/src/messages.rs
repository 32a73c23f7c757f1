//! What this family says to people, in its words: one table for each theme.

use brushwork_link::Message;
use brushwork_link::transport::Stream;
use brushwork_link::unit::UnitAddress;
use brushwork_values::{Motor, messages};

messages! {
    /// What to know of settings before they are written, and why some cannot be.
    pub enum McpSettingsMessage {
        NoPin "none, assumed",
        PinInList { pin: String } "counted from 0 in the pin list: {pin}, assumed",
        NoCommand { command: u8 } "This firmware has no command {command}.",
        NoAddress { address: UnitAddress } "{address} is no address of packet serial",
        AddressWithMixing { address: String } "Mixing is written together with the address, which this firmware does not report: {address} is written, the address this link speaks to. Over USB a unit answers to every address, so check it first.",
        ConfigurationWord "The configuration word takes effect at once and can move the controller to another address, baud rate or control mode: the link may be lost.",
        OwnPortChanges { stream: Stream, to: String } "This program is connected through {stream}, which becomes \"{to}\": the link is lost then.",
        OwnPortRate { stream: Stream, to: String } "This program is connected through {stream}, which changes to {to}: connect again at that rate.",
        OwnPortTimeout { stream: Stream } "{stream} has no time-out then: the motors would go on if this program died, so it cannot be armed.",
        Autorun { delay_ms: i64 } "A stored script starts {delay_ms} ms after each power up and can move the motors.",
        Bridged "Bridged channels drive one motor with both outputs: wire that motor to them only after this is written and saved to EEPROM, and exactly as in MCP manual 1.8.2. Wired before, or wired otherwise, the controller is damaged.",
        Separated "The channels are separate again: take the single motor off both of them before this is written, or the controller is damaged. MCP manual 1.8.",
        SerialNowhere "Serial is at no priority level then, so this program cannot be armed to move motors.",
        TorqueControl { motor: usize } "Motor {motor} has both L and R then: duty commands set its current instead of its voltage, and duty 0 lets it coast.",
        InputCommands { pin: String, target: String, kind: &'static str, level: usize } "{pin} commands {target} as soon as this is written, since {kind} inputs are at priority level {level}: the motor can start.",
        NoSuchInput { pin: &'static str, kind: String, model: &'static str } "{pin} cannot be {kind} on the {model}; it measures nothing instead.",
    }
}

messages! {
    /// What can drive a motor besides this program, and what arming cannot see.
    pub enum McpDriverMessage {
        Coasts { motor: Motor } "{motor} is in torque control: Stop lets it coast instead of braking it.",
        StatusUnseen "This controller does not tell its status: a fault, a limit or an E-stop is not seen here.",
        InputDrives { kind: &'static str, pin: String, motors: String } "The {kind} input {pin} can drive {motors}.",
        InputStartsScript { pin: String } "The input {pin} can start the script.",
        ScriptMayRun "A script may still run: the controller did not confirm its end.",
        ScriptUnknown "A script may still run: which model this is is not known, so no script was ended.",
    }
}

messages! {
    /// What is odd about a unit that was found.
    pub enum McpIdentityMessage {
        OtherGeneration { command: u8 } "Command {command} answers as another generation does.",
        NothingTells "Nothing tells the firmware's generation; it is taken for generation 1.",
        Unanswered { names: String } "It does not answer for: {names}.",
        Heartbeat { state: String } "Its heartbeat says: {state}.",
        CanOpenIdentity { parts: String } "CANopen identity: {parts}.",
    }
}

messages! {
    /// Settings that contradict each other.
    pub enum ConflictMessage {
        NoSuchRate { bus: &'static str, rate: i64, listed: String } "{bus} has no rate of {rate} bit/s. It has {listed}.",
        TwoFunctions { pin: String, mode: String } "{pin} is set as a digital input and as {mode} at once. Choose one mode for it.",
        NoSuchFunction { pin: String, mode: String } "{pin} is set to {mode}, which this pin cannot measure. Choose one of the modes in its name.",
        PortHoldsPin { pin: String, mode: String, port: &'static str } "{pin} is set to {mode}, but {port} is in use and holds the pin. Disable {port}, or set the pin to None.",
        HalfAnEncoder { pin: String, encoder: u8, other: String } "{pin} is one line of encoder {encoder}, but {other} is not set to encoder. Set both or none: the lines of an encoder count in pairs.",
        MinimumNeverActs { pin: String, why: Message } "The minimum action of {pin} never acts: {why}",
        MaximumNeverActs { pin: String, why: Message } "The maximum action of {pin} never acts: {why}",
        MeasuresNothing "the pin measures nothing. Choose its mode.",
        Held { port: &'static str } "{port} is in use and holds the pin. Disable {port}.",
        NeverDown { to: String } "the input never goes down to {to}. Raise the minimum.",
        NeverUp { to: String } "the input never goes up to {to}. Lower the maximum.",
        NoEncoder { motor: usize } "motor {motor} has no encoder whose count it could set.",
        NoSecondMotor "the channels are bridged, so there is no motor 2.",
        NoCommand { pin: String, why: Message } "{pin} gives no usable command: {why}.",
        MinimumNotBelow { min: f64, max: f64 } "its minimum {min} is not below its maximum {max}",
        CenterOutside { center: f64, min: f64, max: f64 } "its center {center} is not between {min} and {max}",
        DeadbandCoversAll { deadband: f64 } "its deadband {deadband} covers the whole range",
        NeverCommands { pin: String, kind: &'static str } "{pin} is set to control a motor, but {kind} inputs are at no priority level, so it never does. Put {kind} at a level, or set the pin to control none.",
        EncoderMeasuresNothing { motor: usize, pin: String } "Motor {motor} takes its encoder from {pin}, which measures nothing. Set that pin's mode, or choose another input.",
        EncoderIsDigital { motor: usize, pin: String } "Motor {motor} takes its encoder from {pin}, which is a digital input. Set that pin's mode, or choose another input.",
        EncoderHeld { motor: usize, pin: String, port: &'static str } "Motor {motor} takes its encoder from {pin}, which {port} holds. Disable {port}, or choose another input.",
        TwoCommanders { first: String, last: String, motor: usize, kind: &'static str } "{first} and {last} both control motor {motor} as {kind} inputs, and only one of them can. Let the other control none.",
    }
}
