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

messages! {
    /// What edits of registers do once they are written.
    pub enum EditMessage {
        Above { counts: f64, limit: f64 } "The motor stands at {counts:.0} counts, above the virtual limit of {limit:.0}: as soon as this is written, nothing drives it further up.",
        Below { counts: f64, limit: f64 } "The motor stands at {counts:.0} counts, below the virtual limit of {limit:.0}: as soon as this is written, nothing drives it further down.",
        Within { counts: f64, low: f64, high: f64 } "The motor stands at {counts:.0} counts, between the virtual limits of {low:.0} and {high:.0}.",
        Nowhere { low: f64, high: f64 } "Where the motor stands is not read yet: see that it is between {low:.0} and {high:.0} counts.",
        Reduced { amps: f64, limit: f64 } "The motor draws {amps:.2} A now: as soon as this is written, its drive is reduced to {limit:.2} A.",
        NoCurrentLimit "With 0 A nothing but the fuse limits the current as soon as this is written.",
        OtherFeedback "Another feedback is another position: as soon as this is written, the motor may move at once.",
        AskedBy { volts: f64 } "ANA_CON is at {volts:.2} V now: as soon as this is written, the motor goes where that asks for.",
        AskedByUnread "As soon as this is written, the motor goes where the voltage at ANA_CON asks for, which is not read yet.",
        Gains "A loop holds the motor: as soon as this is written, it goes by the new gains, and the motor may move.",
        AtReset "ADSTEP counts after a reset of the unit.",
        Rate "The other baud rate counts once it is stored and the power was off and on. Connect with it then.",
    }
}
