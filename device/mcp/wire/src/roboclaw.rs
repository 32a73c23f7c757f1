//! What the numbers of a RoboClaw's own commands mean: pin functions (74, 75), the configuration word (98, 99), CTRL modes
//! (100, 101), idle modes (160, 161).
//!
//! Sources: RoboClaw manual 2018 and its edition of 2015 (functions of pins, CTRL modes, battery), public clients 2015-2025 (the
//! configuration word, the bit that inverts an input). A number that none of them names is kept as it is.

use brushwork_values::{Code, by_raw};

use crate::codes::code;
use crate::packet_serial::Generation;

/// Functions of S3 in generations 1 and 2 (RoboClaw manual, edition of 2015, command 74).
pub static S3_FUNCTIONS_GENERATION_1: &[Code] = &[
    code(0, "default", "Default: E-Stop (latching), in R/C and analog mode the flip switch"),
    code(1, "e_stop_latching", "E-Stop (latching)"),
    code(2, "e_stop", "E-Stop"),
    code(3, "voltage_clamp", "Voltage clamp"),
];

/// Functions of S4, for motor 1, and S5, for motor 2, in generations 1 and 2.
pub static S4_S5_FUNCTIONS_GENERATION_1: &[Code] = &[
    code(0, "disabled", "Disabled"),
    code(1, "e_stop_latching", "E-Stop (latching)"),
    code(2, "e_stop", "E-Stop"),
    code(3, "voltage_clamp", "Voltage clamp"),
    code(4, "home", "Home"),
];

/// Functions of S3 from generation 3 on (RoboClaw manual 2018, command 74).
pub static S3_FUNCTIONS: &[Code] = &[
    code(0x00, "default", "Default: E-Stop (latching), in R/C and analog mode the flip switch"),
    code(0x01, "e_stop", "E-Stop"),
    code(0x81, "e_stop_latching", "E-Stop (latching)"),
    code(0x09, "e_stop_inverted", "E-Stop, inverted"),
    code(0x89, "e_stop_latching_inverted", "E-Stop (latching), inverted"),
    code(0x14, "voltage_clamp", "Voltage clamp"),
    code(0x24, "rs485_direction", "RS-485 direction"),
    code(0x84, "encoder_toggle", "Encoder toggle"),
];

/// Functions of S4, for motor 1, and S5, for motor 2, from generation 3 on.
pub static S4_S5_FUNCTIONS: &[Code] = &[
    code(0x00, "disabled", "Disabled"),
    code(0x01, "e_stop", "E-Stop"),
    code(0x81, "e_stop_latching", "E-Stop (latching)"),
    code(0x14, "voltage_clamp", "Voltage clamp"),
    code(0x04, "brake", "Brake"),
    code(0x62, "home", "Home (user)"),
    code(0xE2, "home_auto", "Home (auto)"),
    code(0x72, "home_limit_forward", "Home (user) and forward limit"),
    code(0xF2, "home_auto_limit_forward", "Home (auto) and forward limit"),
    code(0x12, "limit_forward", "Forward limit"),
    code(0x22, "limit_reverse", "Reverse limit"),
    code(0x32, "limit_both", "Both limits"),
    code(0x09, "e_stop_inverted", "E-Stop, inverted"),
    code(0x89, "e_stop_latching_inverted", "E-Stop (latching), inverted"),
    code(0x6A, "home_inverted", "Home (user), inverted"),
    code(0xEA, "home_auto_inverted", "Home (auto), inverted"),
    code(0x7A, "home_limit_forward_inverted", "Home (user) and forward limit, inverted"),
    code(0xFA, "home_auto_limit_forward_inverted", "Home (auto) and forward limit, inverted"),
    code(0x1A, "limit_forward_inverted", "Forward limit, inverted"),
    code(0x2A, "limit_reverse_inverted", "Reverse limit, inverted"),
    code(0x3A, "limit_both_inverted", "Both limits, inverted"),
];

/// Functions of the outputs D1, for motor 1, and D2, for motor 2, in generation 4: those of the manual that are outputs, and the
/// one that a public client names.
pub static D1_D2_FUNCTIONS: &[Code] = &[
    code(0x00, "disabled", "Disabled"),
    code(0x04, "brake", "Brake"),
    code(0x14, "voltage_clamp", "Voltage clamp"),
    code(0x84, "user", "User output"),
];

/// CTRL modes of command 100 (RoboClaw manual 2018).
pub static CTRL_MODES: &[Code] = &[
    code(0, "disabled", "Disabled"),
    code(1, "user", "User output"),
    code(2, "voltage_clamp", "Voltage clamp"),
    code(3, "brake", "Brake"),
];

/// Bit 7 of command 160. Sources disagree: two public libraries (2018-2025) call it "enable", one example brake or coast.
pub static IDLE_MODES: &[Code] =
    &[code(0, "off", "0: idle mode off, or brake"), code(1, "on", "1: idle mode on, or coast")];

/// What commands the motors: bits 0 and 1 of the configuration word.
pub static CONTROL_MODES: &[Code] = &[
    code(0, "rc", "R/C"),
    code(1, "analog", "Analog"),
    code(2, "simple_serial", "Simple serial"),
    code(3, "packet_serial", "Packet serial"),
];

/// Main battery cut-off: bits 2 to 4 of the configuration word.
pub static BATTERY_MODES: &[Code] = &[
    code(0, "user", "User limits"),
    code(1, "auto", "Detected at power-up"),
    code(2, "2_cells", "2 LiPo cells"),
    code(3, "3_cells", "3 LiPo cells"),
    code(4, "4_cells", "4 LiPo cells"),
    code(5, "5_cells", "5 LiPo cells"),
    code(6, "6_cells", "6 LiPo cells"),
    code(7, "7_cells", "7 LiPo cells"),
];

/// Bits 5 to 7 of the configuration word: the baud rate in the serial modes, three options in R/C and analog mode.
pub static BAUD_OR_OPTIONS: &[Code] = &[
    code(0, "2400", "2400 baud; R/C: no option"),
    code(1, "9600", "9600 baud; R/C: mixing"),
    code(2, "19200", "19200 baud; R/C: exponential"),
    code(3, "38400", "38400 baud; R/C: mixing, exponential"),
    code(4, "57600", "57600 baud; R/C: MCU"),
    code(5, "115200", "115200 baud; R/C: mixing, MCU"),
    code(6, "230400", "230400 baud; R/C: exponential, MCU"),
    code(7, "460800", "460800 baud; R/C: mixing, exponential, MCU"),
];

/// Bits 8 to 10 of the configuration word: the address in the serial modes, two switches in R/C and analog mode.
pub static ADDRESS_OR_SWITCHES: &[Code] = &[
    code(0, "0x80", "0x80; R/C: no switch"),
    code(1, "0x81", "0x81; R/C: flip switch"),
    code(2, "0x82", "0x82; R/C: time-out"),
    code(3, "0x83", "0x83; R/C: flip switch, time-out"),
    code(4, "0x84", "0x84"),
    code(5, "0x85", "0x85; R/C: flip switch"),
    code(6, "0x86", "0x86; R/C: time-out"),
    code(7, "0x87", "0x87; R/C: flip switch, time-out"),
];

/// The baud rates of the configuration word, by number.
pub const BAUD_RATES: [u32; 8] = [2_400, 9_600, 19_200, 38_400, 57_600, 115_200, 230_400, 460_800];

/// Bit 0 of an encoder mode (commands 91 to 93): an absolute encoder instead of a quadrature encoder.
pub const ENCODER_ABSOLUTE: u8 = 0x01;
/// Bit 5 of an encoder mode: the motor turns the other way round (RoboClaw manual 2018).
pub const ENCODER_MOTOR_REVERSED: u8 = 0x20;
/// Bit 6 of an encoder mode: the encoder counts the other way round (RoboClaw manual 2018).
pub const ENCODER_REVERSED: u8 = 0x40;
/// Bit 7 of an encoder mode: R/C and analog inputs command speed or position instead of duty.
pub const ENCODER_IN_RC: u8 = 0x80;

/// Kinds of encoders: bit 0 of an encoder mode.
pub static ENCODER_KINDS: &[Code] = &[code(0, "quadrature", "Quadrature"), code(1, "absolute", "Absolute")];

/// Who commands the motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlMode {
    /// Pulses of a radio receiver on S1 and S2.
    Rc,
    /// Voltages on S1 and S2.
    Analog,
    /// Single bytes on S1.
    SimpleSerial,
    /// Packet serial on S1 and S2.
    PacketSerial,
}

/// The words of those that are chosen.
fn listed(words: &[(bool, &'static str)], none: &str) -> String {
    let chosen: Vec<&str> = words.iter().filter(|(is_chosen, _)| *is_chosen).map(|(_, word)| *word).collect();
    if chosen.is_empty() { none.to_owned() } else { chosen.join(", ") }
}

/// The configuration word of commands 98 and 99.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConfigWord(pub u16);

impl ConfigWord {
    /// A unit that speaks packet serial at the default rate, at address number 0 to 7 (0x80 to 0x87), with its own battery limits.
    pub fn packet_serial(address_number: u8) -> Self {
        const DEFAULT_BAUD: u16 = 3;
        Self(0b11 | DEFAULT_BAUD << 5).with_address_number(address_number)
    }

    /// Bits 0 and 1.
    pub fn mode(self) -> ControlMode {
        match self.0 & 0b11 {
            0 => ControlMode::Rc,
            1 => ControlMode::Analog,
            2 => ControlMode::SimpleSerial,
            _ => ControlMode::PacketSerial,
        }
    }

    /// Whether bits 5 to 10 are baud rate and address rather than options of the inputs.
    pub fn is_serial(self) -> bool {
        matches!(self.mode(), ControlMode::SimpleSerial | ControlMode::PacketSerial)
    }

    /// Bits 2 to 4: 0 for the unit's own limits, 1 for detection at power-up, else a number of cells.
    pub fn battery(self) -> u16 {
        self.0 >> 2 & 0b111
    }

    /// The baud rate, in a serial mode.
    pub fn baud_bps(self) -> Option<u32> {
        self.is_serial().then(|| BAUD_RATES[usize::from(self.0 >> 5 & 0b111)])
    }

    /// The same word with the number of that rate, where it has one and the mode is a serial one.
    #[must_use]
    pub fn with_baud_bps(self, baud_bps: u32) -> Self {
        match BAUD_RATES.iter().zip(0..).find(|(rate, _)| **rate == baud_bps) {
            Some((_, number)) if self.is_serial() => self.with_bits(5, 3, number),
            Some(_) | None => self,
        }
    }

    /// The address from 0 for 0x80, in a serial mode.
    pub fn address_number(self) -> Option<u8> {
        self.is_serial().then_some((self.0 >> 8 & 0b111) as u8)
    }

    /// The same word with that address, in a serial mode.
    #[must_use]
    pub fn with_address_number(self, number: u8) -> Self {
        if self.is_serial() { self.with_bits(8, 3, number.into()) } else { self }
    }

    /// The same word with another control mode.
    #[must_use]
    pub fn with_mode(self, mode: ControlMode) -> Self {
        self.with_bits(0, 2, mode as u16)
    }

    /// The same word with bit 15, open-drain output, as given.
    #[must_use]
    pub fn with_multi_unit(self, is_on: bool) -> Self {
        self.with_bits(15, 1, u16::from(is_on))
    }

    /// In R/C and analog mode S1 drives and S2 turns.
    pub fn has_mixing(self) -> bool {
        self.has_option(5)
    }

    /// In R/C and analog mode the middle of the stick is less sensitive.
    pub fn has_exponential(self) -> bool {
        self.has_option(6)
    }

    /// In R/C mode the last pulse counts until another comes, and nothing is calibrated.
    pub fn is_for_mcu(self) -> bool {
        self.has_option(7)
    }

    /// In R/C and analog mode the flip switch on S3 is a pulse instead of a level.
    pub fn has_rc_flip(self) -> bool {
        self.has_option(8)
    }

    /// In R/C mode the motors stop when the pulses do, also with [`ConfigWord::is_for_mcu`].
    pub fn has_rc_timeout(self) -> bool {
        self.has_option(9)
    }

    /// What bits 5 to 7 choose in R/C and analog mode, in words.
    pub fn options_text(self) -> String {
        let options = [
            (self.has_mixing(), "mixing"),
            (self.has_exponential(), "exponential"),
            (self.is_for_mcu(), "MCU"),
        ];
        listed(&options, "no option")
    }

    /// What bits 8 and 9 choose in R/C and analog mode, in words.
    pub fn switches_text(self) -> String {
        listed(&[(self.has_rc_flip(), "flip switch"), (self.has_rc_timeout(), "time-out")], "no switch")
    }

    /// Encoder 1 serves motor 2 and the other way round.
    pub fn swaps_encoders(self) -> bool {
        self.0 >> 13 & 1 != 0
    }

    fn has_option(self, bit: u16) -> bool {
        !self.is_serial() && self.0 >> bit & 1 != 0
    }

    fn with_bits(self, shift: u16, width: u16, value: u16) -> Self {
        let mask = ((1 << width) - 1) << shift;
        Self(self.0 & !mask | value << shift & mask)
    }
}

/// What a control pin does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PinFunction {
    /// Nothing.
    #[default]
    Disabled,
    /// S3 alone: the flip switch in R/C and analog mode, a latching emergency stop in the serial modes.
    Default,
    /// An emergency stop that ends with the signal, or with a power cycle.
    EStop {
        /// Whether it takes a power cycle.
        is_latching: bool,
    },
    /// A limit or home switch of the pin's motor.
    Switch(SwitchFunction),
    /// An output that is on while the main battery is too high.
    VoltageClamp,
    /// An output that is on while the pin's motor stands.
    Brake,
    /// An output whose level is set by a command.
    User,
    /// Named in public, with no effect on the motors that is.
    NoEffect,
}

/// What a limit or home switch stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SwitchFunction {
    /// It is the end of forward travel.
    pub forward: bool,
    /// It is the end of reverse travel.
    pub reverse: bool,
    /// It sets the encoder to 0.
    pub home: bool,
    /// The motor looks for it at power-up.
    pub auto: bool,
}

/// A control pin whose function is set, in the order of command 74.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlPin {
    /// S3.
    S3,
    /// S4, which serves motor 1.
    S4,
    /// S5, which serves motor 2.
    S5,
    /// D1, which serves motor 1: CTRL1 of earlier firmware. Assumed: they are the same output.
    D1,
    /// D2, which serves motor 2: CTRL2 of earlier firmware.
    D2,
}

impl ControlPin {
    /// All five.
    pub const ALL: [Self; 5] = [Self::S3, Self::S4, Self::S5, Self::D1, Self::D2];

    /// The named functions of the pin in a generation.
    pub fn functions(self, generation: Generation) -> &'static [Code] {
        let is_early = generation < Generation::Gen3;
        match self {
            Self::S3 if is_early => S3_FUNCTIONS_GENERATION_1,
            Self::S3 => S3_FUNCTIONS,
            Self::S4 | Self::S5 if is_early => S4_S5_FUNCTIONS_GENERATION_1,
            Self::S4 | Self::S5 => S4_S5_FUNCTIONS,
            Self::D1 | Self::D2 => D1_D2_FUNCTIONS,
        }
    }

    /// What a number stands for, and whether the input is inverted. A number without a name does nothing. Assumed: bit 3 inverts
    /// an input, as one public client uses it.
    pub fn function(self, raw: u8, generation: Generation) -> (PinFunction, bool) {
        const INVERTED: u8 = 0x08;
        let Some(code) = by_raw(self.functions(generation), raw.into()) else {
            return (PinFunction::Disabled, false);
        };
        let is_inverted = generation >= Generation::Gen3 && code.key.ends_with("_inverted");
        debug_assert_eq!(is_inverted, generation >= Generation::Gen3 && raw & INVERTED != 0);
        let switch = |forward, reverse, home, auto| {
            PinFunction::Switch(SwitchFunction { forward, reverse, home, auto })
        };
        let function = match code.key.trim_end_matches("_inverted") {
            "default" => PinFunction::Default,
            "e_stop" => PinFunction::EStop { is_latching: false },
            "e_stop_latching" => PinFunction::EStop { is_latching: true },
            "voltage_clamp" => PinFunction::VoltageClamp,
            "brake" => PinFunction::Brake,
            "user" => PinFunction::User,
            "home" => switch(false, true, true, false),
            "home_auto" => switch(false, true, true, true),
            "home_limit_forward" => switch(true, true, true, false),
            "home_auto_limit_forward" => switch(true, true, true, true),
            "limit_forward" => switch(true, false, false, false),
            "limit_reverse" => switch(false, true, false, false),
            "limit_both" => switch(true, true, false, false),
            "rs485_direction" | "encoder_toggle" => PinFunction::NoEffect,
            _ => PinFunction::Disabled,
        };
        (function, is_inverted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_function_but_none_does_something() {
        for pin in ControlPin::ALL {
            for generation in Generation::ALL {
                for code in pin.functions(generation) {
                    let (function, is_inverted) = pin.function(code.raw as u8, generation);
                    assert_eq!(function == PinFunction::Disabled, code.key == "disabled", "{code:?}");
                    assert_eq!(is_inverted, code.key.ends_with("_inverted"), "{code:?}");
                }
            }
            assert_eq!(pin.function(0x41, Generation::Gen4), (PinFunction::Disabled, false));
        }
    }

    #[test]
    fn the_same_number_is_another_function_in_another_generation() {
        let latching = PinFunction::EStop { is_latching: true };
        let momentary = PinFunction::EStop { is_latching: false };
        assert_eq!(ControlPin::S3.function(1, Generation::Gen1).0, latching);
        assert_eq!(ControlPin::S3.function(1, Generation::Gen3).0, momentary);
        assert_eq!(ControlPin::S3.function(0x81, Generation::Gen3).0, latching);
    }

    #[test]
    fn a_word_says_rate_and_address_in_serial_modes_and_options_in_the_others() {
        let word = ConfigWord::packet_serial(2);
        assert_eq!(word, ConfigWord(0x0263));
        assert_eq!((word.baud_bps(), word.address_number()), (Some(38_400), Some(2)));
        assert!(!word.has_mixing() && !word.has_rc_timeout());
        let rc = word.with_mode(ControlMode::Rc);
        assert_eq!((rc.mode(), rc.baud_bps(), rc.address_number()), (ControlMode::Rc, None, None));
        assert!(rc.has_mixing() && rc.has_exponential() && !rc.is_for_mcu());
        assert!(rc.has_rc_timeout() && !rc.has_rc_flip());
        assert_eq!(rc.with_address_number(7), rc);
        assert_eq!(word.with_baud_bps(115_200).baud_bps(), Some(115_200));
        assert_eq!(word.with_baud_bps(12_345), word, "it has no number");
        assert_eq!(ConfigWord(0x001C).battery(), 7);
        assert!(word.with_multi_unit(true).0 & 0x8000 != 0);
    }

    #[test]
    fn labels_name_the_options_and_switches_that_the_bits_are() {
        for code in BAUD_OR_OPTIONS {
            let options = ConfigWord((code.raw as u16) << 5).options_text();
            assert_eq!(code.label, format!("{} baud; R/C: {options}", code.key));
        }
        for code in ADDRESS_OR_SWITCHES {
            let switches = ConfigWord((code.raw as u16) << 8).switches_text();
            let label = format!("{}; R/C: {switches}", code.key);
            // No two labels are alike but for the address, so one of them leaves out that no switch is on.
            assert!(code.label == label || code.raw == 4 && code.label == code.key, "{label}");
        }
    }
}
