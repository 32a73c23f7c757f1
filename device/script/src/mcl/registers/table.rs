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

/// Rows of registers: the name, the type, how many there are, whether it can be set, the unit and the meaning.
macro_rules! rows {
    ($($name:literal $kind:ident $length:literal $writable:literal $unit:literal $meaning:literal;)*) => {
        [$(Register {
            name: $name,
            kind: VarType::$kind,
            length: $length,
            writable: $writable,
            unit: $unit,
            meaning: $meaning,
        }),*]
    };
}

/// Every register, in the manual's order.
pub const REGISTERS: [Register; 80] = rows! {
    "VERSION" Word 1 false "" "firmware version: major in the high byte, minor in the low byte";
    "SYSSTATUS" Word 1 false "" "warning and error states (bits of this register, not of command 90)";
    "SYSCLK" Long 1 false "1/160 MHz" "clock counter since power-up";
    "SYSUSTICK" Long 1 false "µs" "time since power-up";
    "SYSTICK" Long 1 false "ms" "time since power-up";
    "SYSTEMP" Word 1 false "0.1 °C" "board temperature";
    "SYSTEMP2" Word 1 false "0.1 °C" "second board temperature (MCP21xx alone)";
    "SYSMBAT" Word 1 false "0.1 V" "main battery voltage";
    "SYSLBAT" Word 1 false "0.1 V" "logic battery voltage";
    "SYSMINMBAT" Word 1 true "0.1 V" "minimum main battery voltage";
    "SYSMAXMBAT" Word 1 true "0.1 V" "maximum main battery voltage";
    "SYSMINLBAT" Word 1 true "0.1 V" "minimum logic battery voltage";
    "SYSMAXLBAT" Word 1 true "0.1 V" "maximum logic battery voltage";
    "DOUTACTION" Byte 8 true "" "what switches an output pin";
    "DOUT" Bit 8 true "" "state of an output pin; writing it overrides its action";
    "PRIORITYLEVEL" Byte 1 false "" "active priority level: 0, 1 or 2";
    "PRIORITYACTIVE" Byte 1 false ""
        "mask of the inputs that can raise the priority level: serial 1, pulse 2, analog 4";
    "MOTORFLAGS" Word 2 false "" "control state flags of a motor";
    "MOTORPWM" SWord 2 false "1/32767" "duty of a motor";
    "MOTORCURRENT" SWord 2 false "10 mA" "motor current";
    "MOTORTARGETPWM" SWord 2 false "1/32767" "duty that a motor is going to";
    "MOTORVELKP" Long 2 true "1/65536" "velocity P";
    "MOTORVELKI" Long 2 true "1/65536" "velocity I";
    "MOTORVELKD" Long 2 true "1/65536" "velocity D";
    "MOTORVELQPPS" Long 2 true "counts/s" "speed at full duty";
    "MOTORTARGETSPEED" SLong 2 false "counts/s" "speed that a motor is going to";
    "MOTORDISTANCE" Long 2 false "counts" "distance left";
    "MOTORPOSKP" Long 2 true "1/2048" "position P";
    "MOTORPOSKI" Long 2 true "" "position I";
    "MOTORPOSKIMAX" Long 2 true "" "limit of the position integral";
    "MOTORPOSKD" Long 2 true "" "position D";
    "MOTORPOSMAX" SLong 2 true "counts" "largest position";
    "MOTORPOSMIN" SLong 2 true "counts" "smallest position";
    "MOTORPOSDEADZONE" Long 2 true "counts" "position dead zone";
    "MOTORTARGETPOS" SLong 2 false "counts" "position that a motor is going to";
    "MOTORACCEL" Long 2 false "counts/s²" "acceleration in force";
    "MOTORDECCEL" Long 2 false "counts/s²" "deceleration in force, of position commands";
    "MOTORSPEED" SLong 2 false "counts/s" "speed setpoint now";
    "MOTORDEFAULTACCEL" Long 2 true "" "acceleration of duty commands that carry none";
    "MOTORMAXCURRENT" SWord 2 true "10 mA" "current limit";
    "MOTORMINCURRENT" SWord 2 true "10 mA" "negative current limit";
    "MOTORL" Long 2 true "1/16777216 H" "motor inductance; with MOTORR duty becomes a current";
    "MOTORR" Long 2 true "1/16777216 ohm" "motor resistance; with MOTORL duty becomes a current";
    "MOTORENCPOS" SLong 2 true "counts" "encoder position";
    "MOTORENCSPEED" SLong 2 false "counts/s" "encoder speed";
    "MOTORENCSPEEDS" SLong 2 false "counts/s" "encoder speed, mean of a second";
    "MOTORENCSTATUS" Byte 2 false "" "encoder status bits";
    "MOTORENCPIN" Byte 2 true "" "which signal is the encoder";
    "MOTORBUFFER" Byte 2 false "" "buffered commands; 0x80 when the buffer is empty and nothing runs";
    "STREAMTYPE" Byte 4 true "" "0 script, 1 packet serial";
    "STREAMRATE" Long 4 true "bit/s" "speed of a stream";
    "STREAMTIMEOUT" Long 4 true "ms" "silence after which a stream is inactive";
    "STREAMTICK" Long 4 false "ms" "SYSTICK of the last byte received";
    "STREAMISBUSY" Bit 4 false "" "whether a stream is active";
    "STREAMCOUNT" Byte 4 false "bytes" "bytes waiting to be read";
    "SIGNALACTIVE" Byte 32 false "" "whether a signal is active";
    "SIGNALTYPE" Byte 32 true "" "0 none, 1 analog, 2 pulse, 3 quadrature encoder";
    "SIGNALTARGET" Byte 32 true "" "motor that a signal commands: 0 or 1";
    "SIGNALMINACTION" Word 32 true "" "action at the signal's minimum";
    "SIGNALMAXACTION" Word 32 true "" "action at the signal's maximum";
    "SIGNALLOWPASS" Byte 32 true "" "low pass over 2^n samples, 0 is none";
    "SIGNALTIMEOUT" Long 32 true "ms" "silence after which a signal is inactive";
    "SIGNALTICK" Long 32 false "ms" "SYSTICK of the last change";
    "SIGNALITER" Long 32 false "" "updates of the signal";
    "SIGNALLOADHOME" SLong 32 true "counts" "encoder value that a load-home action sets";
    "SIGNALMIN" SLong 32 true "" "smallest raw value";
    "SIGNALMAX" SLong 32 true "" "largest raw value";
    "SIGNALCENTER" SLong 32 true "" "raw value of the centre";
    "SIGNALDEADBAND" Long 32 true "" "width around the centre that counts as the centre";
    "SIGNALPOWEREXP" SLong 32 true "1/65536" "power exponent";
    "SIGNALPOWERMIN" Long 32 true "" "smallest output that is not zero";
    "SIGNALMODE" Byte 32 false "" "0 position, 1 percent, 2 mean speed, 3 speed";
    "SIGNALMINOUT" SLong 32 true "" "output at the minimum";
    "SIGNALMAXOUT" SLong 32 true "" "output at the maximum";
    "SIGNALPOSITION" SLong 32 false "" "position of a signal";
    "SIGNALPERCENT" SWord 32 false "1/32767" "position within the range";
    "SIGNALSPEED" SLong 32 false "" "speed of a signal";
    "SIGNALSPEEDS" SLong 32 false "" "mean speed of a signal";
    "SIGNALCOMMAND" SLong 32 false "" "what a signal commands, by its mode";
    "I2CERROR" Byte 1 false "" "last error of the I2C bus, 0 is none";
};

/// Spellings of the manual's table that its pages do not confirm, and what they stand for.
pub const MISSPELT: [(&str, &str); 3] =
    [("SYSMINMBAY", "SYSMINMBAT"), ("SINGALTIMEOUT", "SIGNALTIMEOUT"), ("SIGNALLOWPAS", "SIGNALLOWPASS")];
