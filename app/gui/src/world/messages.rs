//! What the simulated world shows, in words.

use brushwork_values::{Motor, messages};

messages! {
    /// What the simulated world shows.
    pub enum WorldMessage {
        Device { address: u8, name: String, first: u8, registers: String } "{address:02X} {name} from {first:02X}:{registers}",
        Heard { heard: String } "It heard last:{heard}",
        Bridge { volts: f64, amps: f64 } "{volts:6.2} V at the bridge {amps:8.2} A",
        Axis { rpm: f64, turns: f64, amps: f64 } "{rpm:9.1} rpm {turns:9.2} turns {amps:7.2} A",
        LoadTorque { motor: Motor } "{motor} load torque",
        EncoderNoise { motor: Motor } "{motor} encoder noise",
        ConnectedTo { pin: String } "{pin} is connected to",
        ValueOf { pin: String } "{pin} value",
        Shows { text: String } "The display shows \"{text}\"",
        Switch { motor: Motor, kind: &'static str } "{motor} {kind} switch",
    }
}
