//! What the screens of MCP and RoboClaw show, in words.

use brushwork_values::{Motor, messages};

messages! {
    /// What the screens of an MCP say.
    pub enum McpScreenMessage {
        Clamps { outputs: String } "{outputs} clamps over-voltage.",
        ClampTest { motor: Motor } "Clamp test {motor}",
        WithBattery { text: String, volts: f64 } "{text} · battery {volts:.1} V",
        ClampProgress { text: String } "Progress: clamp test, {text}",
        Argument { name: &'static str } "Argument {name}",
        OneIs { scale: f64, symbol: &'static str } ", one is {scale} {symbol}",
        From { source: &'static str } "From: {source}",
        AndMore { count: usize } "and {count} more",
        OnModel { example: String } " ({example}; depends on the model)",
        OnlyFamily { family: &'static str } "{family} controllers",
        Generation { number: u8 } "generation {number}",
        Generations { first: u8, last: u8 } "generations {first} to {last}",
        Leds { err: String, meaning: String, bridge: &'static str, stat2: String, stat1: String } "ERR {err}: {meaning}. STAT2 {stat2}: {bridge}. STAT1 {stat1}",
        Led { name: String, light: String } "LED {name}: {light}",
    }
}

messages! {
    /// What is said of an input pin and its signal.
    pub enum SignalMessage {
        Calibration { what: String } "Calibration {what}",
        Calibrate { pin: String } "Calibrate {pin}",
        Mode { pin: String } "{pin}: mode",
        Signal { what: String } "Signal {what}",
        SetFromLive { title: String } "Set {title} from the live signal",
        At { reading: f64, percent: f64 } "signal at {reading}, {percent:.1} %",
        Graph { name: String, min: f64, max: f64, center: f64, deadband: f64, exponent: f64, least: f64, live: String } "Signal graph of {name}: {min} to {max} around {center}, deadband {deadband}, power exponent {exponent}, power minimum {least}; {live}",
        Handle { name: &'static str, value: f64 } "{name}: {value}. Drag it, or use the arrow keys.",
    }
}

messages! {
    /// What is said of a script or a firmware that is sent.
    pub enum DownloadMessage {
        WritingPage { page: usize, of: usize } "Writing page {page} of {of}.",
        BlocksAnswered { byte: u8 } "each block answered with 0x{byte:02X}, whose meaning is not public",
        Sent { bytes: usize, seconds: f64, verified: String, foreign: &'static str } "{bytes} bytes in {seconds:.1} s, {verified}. Start Script runs it.{foreign}",
        SettingsKept { backup: String } "The previous settings are kept: {backup}.",
    }
}
