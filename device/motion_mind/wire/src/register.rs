//! The 32 registers (Motion Mind manual 6.0).

use std::ops::RangeInclusive;

/// How a register lies on the wire; more than one byte is sent least significant byte first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// One byte.
    U8,
    /// Two bytes.
    U16,
    /// Two bytes, two's complement.
    I16,
    /// Four bytes.
    U32,
    /// Four bytes, two's complement.
    I32,
}

/// Who may change a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Access {
    /// A write changes it.
    ReadWrite,
    /// The controller alone changes it.
    ReadOnly,
}

/// One register.
#[derive(Debug, Clone, PartialEq)]
pub struct Register {
    /// Its index in commands, and its bit in the mask of READ.
    pub number: u8,
    /// Its name in the manual.
    pub name: &'static str,
    /// The four letters in front of `=` in an answer in text. Assumed, but for APOS, PTRM, VELO and TIME: no client may
    /// depend on it.
    pub code: &'static str,
    /// Who may change it.
    pub access: Access,
    /// Its width and sign.
    pub kind: Kind,
    /// What the manual allows. A controller takes whatever fits the width; a client warns.
    pub range: RangeInclusive<i64>,
    /// The factory's value; `None` for what is measured.
    pub default: Option<i64>,
    /// The unit of [`Register::scale`], or nothing for a plain number.
    pub unit: &'static str,
    /// One step of the raw value in that unit.
    pub scale: f64,
    /// What it is for.
    pub help: &'static str,
}

impl Kind {
    /// Bytes on the wire.
    pub const fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 => 4,
        }
    }

    /// Every value that the width can hold.
    pub fn range(self) -> RangeInclusive<i64> {
        match self {
            Self::U8 => 0..=i64::from(u8::MAX),
            Self::U16 => 0..=i64::from(u16::MAX),
            Self::I16 => i64::from(i16::MIN)..=i64::from(i16::MAX),
            Self::U32 => 0..=i64::from(u32::MAX),
            Self::I32 => i64::from(i32::MIN)..=i64::from(i32::MAX),
        }
    }

    /// Appends a value, least significant byte first. What does not fit loses its high bits.
    pub fn put(self, value: i64, into: &mut Vec<u8>) {
        into.extend(value.to_le_bytes().into_iter().take(self.bytes()));
    }

    /// The value in the first bytes of `from`, if there are enough.
    pub fn get(self, from: &[u8]) -> Option<i64> {
        let bytes = from.get(..self.bytes())?;
        let raw = bytes.iter().rev().fold(0_i64, |value, byte| value << 8 | i64::from(*byte));
        let unused = 64 - 8 * self.bytes();
        let signed = matches!(self, Self::I16 | Self::I32);
        Some(if signed { raw << unused >> unused } else { raw })
    }
}

impl Register {
    /// The mask of READ that asks for this register alone.
    pub fn mask(&self) -> u32 {
        1 << self.number
    }

    /// Whether a write can change it.
    pub fn is_writable(&self) -> bool {
        self.access == Access::ReadWrite
    }
}

/// The register of that number; firmware newer than the manual may have more of them.
pub fn register(number: u8) -> Option<&'static Register> {
    REGISTERS.get(usize::from(number))
}

/// The register of that name, in any case.
pub fn register_named(name: &str) -> Option<&'static Register> {
    REGISTERS.iter().find(|register| register.name.eq_ignore_ascii_case(name))
}

const U16_MAX: i64 = u16::MAX as i64;
const U32_MAX: i64 = u32::MAX as i64;
const I32_MIN: i64 = i32::MIN as i64;
const I32_MAX: i64 = i32::MAX as i64;

/// One tick of the R/C pulse measurement.
const RC_MS: f64 = 0.001_736;
/// One tick of the controller's timers.
const TICK_S: f64 = 0.005;
/// One step of an analog input.
const ANALOG_VOLTS: f64 = 0.004_89;
/// One step of a duty.
const DUTY_PERCENT: f64 = 100.0 / 1023.0;
/// One step of a current.
const AMPS: f64 = 0.02;

macro_rules! registers {
    ($($number:literal $name:ident $code:literal $access:ident $kind:ident $range:expr, $default:expr, $unit:literal $scale:expr, $help:literal;)*) => {
        /// All registers, by number.
        pub static REGISTERS: [Register; 32] = [$(Register {
            number: $number, name: stringify!($name), code: $code, access: Access::$access, kind: Kind::$kind, range: $range,
            default: $default, unit: $unit, scale: $scale, help: $help,
        }),*];

        /// The registers' numbers, by name.
        pub mod register_number {
            $(#[doc = $help] pub const $name: u8 = $number;)*
        }
    };
}

registers! {
    0 POSITION "APOS" ReadWrite I32 I32_MIN..=I32_MAX, Some(0), "counts" 1.0,
        "where the motor is: encoder counts, 0 to 1023 of an analog feedback, or 0.217 us steps of a pulse feedback";
    1 VELOCITYLIMIT "VLIM" ReadWrite U16 1..=1023, Some(1023), "" 1.0,
        "modes 0 to 3: change of the drive per update; mode 4 with VELLIMIT: counts per PID loop";
    2 VELOCITYFF "VLFF" ReadWrite U8 0..=255, Some(128), "" 1.0 / 255.0, "feed-forward of the commanded velocity";
    3 FUNCTION "FUNC" ReadWrite U16 0..=U16_MAX, Some(0), "" 1.0, "switches of the controller's functions";
    4 PTERM "PTRM" ReadWrite U16 0..=U16_MAX, Some(6000), "" 1.0, "proportional gain, before 2^PIDSCALAR divides it";
    5 ITERM "ITRM" ReadWrite U16 0..=U16_MAX, Some(35), "" 1.0, "integral gain, before 2^PIDSCALAR divides it";
    6 DTERM "DTRM" ReadWrite U16 0..=U16_MAX, Some(0), "" 1.0, "derivative gain, before 2^PIDSCALAR divides it";
    7 ADDRESS "ADDR" ReadWrite U8 0..=255, Some(1), "" 1.0, "what the unit answers to: 1 to 98; from 99 on it never answers";
    8 PIDSCALAR "PIDS" ReadWrite U8 0..=32, Some(14), "" 1.0, "the output of the PID is divided by 2 to this power";
    9 TIMER "TIMR" ReadWrite U8 1..=255, Some(10), "s" TICK_S, "time between updates of the speed; debounce of buttons and limits";
    10 RCMAX "RCMX" ReadWrite U16 0..=U16_MAX, Some(1152), "ms" RC_MS, "R/C pulse of full speed forward";
    11 RCMIN "RCMN" ReadWrite U16 0..=U16_MAX, Some(576), "ms" RC_MS, "R/C pulse of full speed reverse";
    12 RCBAND "RCBD" ReadWrite U16 0..=U16_MAX, Some(15), "ms" RC_MS, "R/C pulses this near to 1.5 ms stop the motor";
    13 RCCOUNT "RCCT" ReadOnly U16 0..=U16_MAX, None, "ms" RC_MS, "the R/C pulse as measured";
    14 VELOCITY "VELO" ReadOnly I16 -32_768..=32_767, None, "counts per loop" 1.0, "velocity, the mean of 64 loops";
    15 TIME "TIME" ReadOnly U32 0..=U32_MAX, None, "s" TICK_S, "time since power-up";
    16 STATUS "STAT" ReadOnly U16 0..=U16_MAX, None, "" 1.0, "inputs, limits and faults";
    17 REVISION "REVN" ReadOnly U8 0..=255, None, "" 1.0, "the firmware";
    18 MODE "MODE" ReadOnly U8 0..=7, None, "" 1.0, "what moves the motor, by the switches at power-up";
    19 ANALOGCON "ACON" ReadOnly U16 0..=1023, None, "V" ANALOG_VOLTS, "the analog control input, J4 P4";
    20 ANALOGFBCK "AFBK" ReadOnly U16 0..=1023, None, "V" ANALOG_VOLTS, "the analog feedback input, J4 P3";
    21 PWMOUT "PWMO" ReadOnly I16 -1023..=1023, None, "%" DUTY_PERCENT, "drive of the motor, with its sign";
    22 INDEXPOS "IPOS" ReadOnly I32 I32_MIN..=I32_MAX, None, "counts" 1.0, "POSITION at the last index pulse";
    23 VNLIMIT "VNLM" ReadWrite I32 I32_MIN..=I32_MAX, Some(-100_000), "counts" 1.0, "negative virtual limit, with VIRTLIMIT";
    24 VPLIMIT "VPLM" ReadWrite I32 I32_MIN..=I32_MAX, Some(100_000), "counts" 1.0, "positive virtual limit, with VIRTLIMIT";
    25 PWMLIMIT "PWML" ReadWrite U16 1..=1023, Some(1023), "%" DUTY_PERCENT, "the most drive that the motor gets";
    26 DEADBAND "DBND" ReadWrite U16 0..=1023, Some(15), "" 1.0,
        "mode 1: steps of 4.88 mV around 2.5 V that stop the motor; with ENABLEDB: counts around the setpoint";
    27 DESIREDPOSITION "DPOS" ReadOnly I32 I32_MIN..=I32_MAX, None, "counts" 1.0, "where the motor is sent";
    28 AMPSLIMIT "AMPL" ReadWrite U16 0..=1023, Some(512), "A" AMPS, "current at which the drive is reduced; 0: never";
    29 AMPS "AMPS" ReadOnly U16 0..=1023, None, "A" AMPS, "current of the motor";
    30 FUNCTION2 "FUN2" ReadWrite U16 0..=U16_MAX, Some(0), "" 1.0, "more switches";
    31 THERMISTOR "THRM" ReadOnly U16 0..=1023, None, "" 1.0, "temperature of the bridge: (raw - 1104) x -0.165 degrees Celsius";
}
