//! What the screens of the Motion Mind show, in words.

use brushwork_values::messages;

messages! {
    /// What the screens of a Motion Mind say.
    pub enum MindMessage {
        Switches { mode: String, protocol: String } "{mode}; {protocol} protocol",
        ForOther { address: String, selected: u8 } "this is for {address}, and the link speaks to unit {selected}. Select the unit at the left",
        AsTyped { meaning: String } "as typed: {meaning}",
        Asked { per_loop: f64, per_s: f64 } "Asked: {per_loop:.0} counts/loop = {per_s:.0} counts/s",
        PulseNow { milliseconds: f64, count: i64 } "Pulse now {milliseconds:.3} ms ({count})",
        Farthest { milliseconds: f64, count: i64 } "Farthest so far {milliseconds:.3} ms ({count})",
        Held { name: &'static str, value: String } "{name} held: {value}",
        LastStep { text: String } "Last step: {text}",
        Advice { advice: String } "Advice: {advice}",
        Step { counts: f64, rise: String, overshoot_percent: f64, settled: String, off: f64 } "Step of {counts:.0} counts: rise {rise}, overshoot {overshoot_percent:.0} %, settled {settled}, off by {off:.0} counts at the end",
    }
}

messages! {
    /// What is said of a register.
    pub enum RegisterMessage {
        BitSet { means: &'static str } "Set: {means}.",
        Binary { frame: String } "Binary: {frame}",
        Text { line: String } "Text: {line}",
        Range { min: i64, max: i64 } "Range {min} to {max}.",
        Step { scale: f64, unit: &'static str } "One step is {scale} {unit}.",
        Factory { value: i64 } "Factory value {value}.",
        Bit { bit: u8, name: &'static str, means: &'static str } "Bit {bit} {name}: {means}.",
        Named { name: &'static str } "Register {name}",
        Bits { word: u16 } "0x{word:04X} bits",
        BitsOf { name: &'static str } "Bits of {name}",
        IsChanged { name: &'static str } "{name} is changed and not written",
        Differs { name: &'static str } "{name} in RAM differs from EEPROM",
        Head { name: &'static str, number: u8 } "{name} (register {number})",
        Now { text: String } "Now {text}.",
        OneByte "1 byte on the wire.",
        Bytes { bytes: usize } "{bytes} bytes on the wire.",
        From { min: i64, max: i64 } "Range {min} to {max}",
        OneIs { step: String } ", one is {step}. ",
        Unsaved { difference: String } "EEPROM -> RAM: {difference}",
        In { name: &'static str, copy: &'static str, value: String } "{name} in {copy}: {value}",
    }
}
