//! Every system register with its type, its length and what it is.

use crate::mcl::types::VarType;
use serde::Serialize;

/// One system register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Register {
    /// Its name.
    pub name: &'static str,
    /// Type of each element.
    pub kind: VarType,
    /// How many elements it has; 1 is no array.
    pub length: u8,
    /// Whether a program may set it.
    pub writable: bool,
    /// What one step of its value is; empty for plain numbers.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

/// Which register, as an index into [`REGISTERS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct RegisterId(pub u8);

impl RegisterId {
    /// Its row. Ids are made by [`register`](crate::mcl::words::register) alone or checked when an image is read.
    #[must_use]
    pub fn row(self) -> &'static Register {
        &REGISTERS[usize::from(self.0) % REGISTERS.len()]
    }
}

const fn row(
    name: &'static str,
    kind: VarType,
    length: u8,
    writable: bool,
    unit: &'static str,
    meaning: &'static str,
) -> Register {
    Register { name, kind, length, writable, unit, meaning }
}

/// Every register, in the manual's order.
pub const REGISTERS: [Register; 80] = [
    row(
        "VERSION",
        VarType::Word,
        1,
        false,
        "",
        "firmware version: major in the high byte, minor in the low byte",
    ),
    row(
        "SYSSTATUS",
        VarType::Word,
        1,
        false,
        "",
        "warning and error states (bits of this register, not of command 90)",
    ),
    row("SYSCLK", VarType::Long, 1, false, "1/160 MHz", "clock counter since power-up"),
    row("SYSUSTICK", VarType::Long, 1, false, "µs", "time since power-up"),
    row("SYSTICK", VarType::Long, 1, false, "ms", "time since power-up"),
    row("SYSTEMP", VarType::Word, 1, false, "0.1 °C", "board temperature"),
    row("SYSTEMP2", VarType::Word, 1, false, "0.1 °C", "second board temperature (MCP21xx alone)"),
    row("SYSMBAT", VarType::Word, 1, false, "0.1 V", "main battery voltage"),
    row("SYSLBAT", VarType::Word, 1, false, "0.1 V", "logic battery voltage"),
    row("SYSMINMBAT", VarType::Word, 1, true, "0.1 V", "minimum main battery voltage"),
    row("SYSMAXMBAT", VarType::Word, 1, true, "0.1 V", "maximum main battery voltage"),
    row("SYSMINLBAT", VarType::Word, 1, true, "0.1 V", "minimum logic battery voltage"),
    row("SYSMAXLBAT", VarType::Word, 1, true, "0.1 V", "maximum logic battery voltage"),
    row("DOUTACTION", VarType::Byte, 8, true, "", "what switches an output pin"),
    row("DOUT", VarType::Bit, 8, true, "", "state of an output pin; writing it overrides its action"),
    row("PRIORITYLEVEL", VarType::Byte, 1, false, "", "active priority level: 0, 1 or 2"),
    row(
        "PRIORITYACTIVE",
        VarType::Byte,
        1,
        false,
        "",
        "mask of the inputs that can raise the priority level: serial 1, pulse 2, analog 4",
    ),
    row("MOTORFLAGS", VarType::Word, 2, false, "", "control state flags of a motor"),
    row("MOTORPWM", VarType::SWord, 2, false, "1/32767", "duty of a motor"),
    row("MOTORCURRENT", VarType::SWord, 2, false, "10 mA", "motor current"),
    row("MOTORTARGETPWM", VarType::SWord, 2, false, "1/32767", "duty that a motor is going to"),
    row("MOTORVELKP", VarType::Long, 2, true, "1/65536", "velocity P"),
    row("MOTORVELKI", VarType::Long, 2, true, "1/65536", "velocity I"),
    row("MOTORVELKD", VarType::Long, 2, true, "1/65536", "velocity D"),
    row("MOTORVELQPPS", VarType::Long, 2, true, "counts/s", "speed at full duty"),
    row("MOTORTARGETSPEED", VarType::SLong, 2, false, "counts/s", "speed that a motor is going to"),
    row("MOTORDISTANCE", VarType::Long, 2, false, "counts", "distance left"),
    row("MOTORPOSKP", VarType::Long, 2, true, "1/2048", "position P"),
    row("MOTORPOSKI", VarType::Long, 2, true, "", "position I"),
    row("MOTORPOSKIMAX", VarType::Long, 2, true, "", "limit of the position integral"),
    row("MOTORPOSKD", VarType::Long, 2, true, "", "position D"),
    row("MOTORPOSMAX", VarType::SLong, 2, true, "counts", "largest position"),
    row("MOTORPOSMIN", VarType::SLong, 2, true, "counts", "smallest position"),
    row("MOTORPOSDEADZONE", VarType::Long, 2, true, "counts", "position dead zone"),
    row("MOTORTARGETPOS", VarType::SLong, 2, false, "counts", "position that a motor is going to"),
    row("MOTORACCEL", VarType::Long, 2, false, "counts/s²", "acceleration in force"),
    row("MOTORDECCEL", VarType::Long, 2, false, "counts/s²", "deceleration in force, of position commands"),
    row("MOTORSPEED", VarType::SLong, 2, false, "counts/s", "speed setpoint now"),
    row("MOTORDEFAULTACCEL", VarType::Long, 2, true, "", "acceleration of duty commands that carry none"),
    row("MOTORMAXCURRENT", VarType::SWord, 2, true, "10 mA", "current limit"),
    row("MOTORMINCURRENT", VarType::SWord, 2, true, "10 mA", "negative current limit"),
    row(
        "MOTORL",
        VarType::Long,
        2,
        true,
        "1/16777216 H",
        "motor inductance; with MOTORR duty becomes a current",
    ),
    row(
        "MOTORR",
        VarType::Long,
        2,
        true,
        "1/16777216 ohm",
        "motor resistance; with MOTORL duty becomes a current",
    ),
    row("MOTORENCPOS", VarType::SLong, 2, true, "counts", "encoder position"),
    row("MOTORENCSPEED", VarType::SLong, 2, false, "counts/s", "encoder speed"),
    row("MOTORENCSPEEDS", VarType::SLong, 2, false, "counts/s", "encoder speed, mean of a second"),
    row("MOTORENCSTATUS", VarType::Byte, 2, false, "", "encoder status bits"),
    row("MOTORENCPIN", VarType::Byte, 2, true, "", "which signal is the encoder"),
    row(
        "MOTORBUFFER",
        VarType::Byte,
        2,
        false,
        "",
        "buffered commands; 0x80 when the buffer is empty and nothing runs",
    ),
    row("STREAMTYPE", VarType::Byte, 4, true, "", "0 script, 1 packet serial"),
    row("STREAMRATE", VarType::Long, 4, true, "bit/s", "speed of a stream"),
    row("STREAMTIMEOUT", VarType::Long, 4, true, "ms", "silence after which a stream is inactive"),
    row("STREAMTICK", VarType::Long, 4, false, "ms", "SYSTICK of the last byte received"),
    row("STREAMISBUSY", VarType::Bit, 4, false, "", "whether a stream is active"),
    row("STREAMCOUNT", VarType::Byte, 4, false, "bytes", "bytes waiting to be read"),
    row("SIGNALACTIVE", VarType::Byte, 32, false, "", "whether a signal is active"),
    row("SIGNALTYPE", VarType::Byte, 32, true, "", "0 none, 1 analog, 2 pulse, 3 quadrature encoder"),
    row("SIGNALTARGET", VarType::Byte, 32, true, "", "motor that a signal commands: 0 or 1"),
    row("SIGNALMINACTION", VarType::Word, 32, true, "", "action at the signal's minimum"),
    row("SIGNALMAXACTION", VarType::Word, 32, true, "", "action at the signal's maximum"),
    row("SIGNALLOWPASS", VarType::Byte, 32, true, "", "low pass over 2^n samples, 0 is none"),
    row("SIGNALTIMEOUT", VarType::Long, 32, true, "ms", "silence after which a signal is inactive"),
    row("SIGNALTICK", VarType::Long, 32, false, "ms", "SYSTICK of the last change"),
    row("SIGNALITER", VarType::Long, 32, false, "", "updates of the signal"),
    row("SIGNALLOADHOME", VarType::SLong, 32, true, "counts", "encoder value that a load-home action sets"),
    row("SIGNALMIN", VarType::SLong, 32, true, "", "smallest raw value"),
    row("SIGNALMAX", VarType::SLong, 32, true, "", "largest raw value"),
    row("SIGNALCENTER", VarType::SLong, 32, true, "", "raw value of the centre"),
    row("SIGNALDEADBAND", VarType::Long, 32, true, "", "width around the centre that counts as the centre"),
    row("SIGNALPOWEREXP", VarType::SLong, 32, true, "1/65536", "power exponent"),
    row("SIGNALPOWERMIN", VarType::Long, 32, true, "", "smallest output that is not zero"),
    row("SIGNALMODE", VarType::Byte, 32, false, "", "0 position, 1 percent, 2 mean speed, 3 speed"),
    row("SIGNALMINOUT", VarType::SLong, 32, true, "", "output at the minimum"),
    row("SIGNALMAXOUT", VarType::SLong, 32, true, "", "output at the maximum"),
    row("SIGNALPOSITION", VarType::SLong, 32, false, "", "position of a signal"),
    row("SIGNALPERCENT", VarType::SWord, 32, false, "1/32767", "position within the range"),
    row("SIGNALSPEED", VarType::SLong, 32, false, "", "speed of a signal"),
    row("SIGNALSPEEDS", VarType::SLong, 32, false, "", "mean speed of a signal"),
    row("SIGNALCOMMAND", VarType::SLong, 32, false, "", "what a signal commands, by its mode"),
    row("I2CERROR", VarType::Byte, 1, false, "", "last error of the I2C bus, 0 is none"),
];

/// Spellings of the manual's table that its pages do not confirm, and what they stand for.
pub const MISSPELT: [(&str, &str); 3] =
    [("SYSMINMBAY", "SYSMINMBAT"), ("SINGALTIMEOUT", "SIGNALTIMEOUT"), ("SIGNALLOWPAS", "SIGNALLOWPASS")];
