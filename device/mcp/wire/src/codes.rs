//! The named values of coded fields: signal types, actions, stream types and the like (MCP manual 2.3.1 and 3.1).
//!
//! A [`Code`] gives the number on the wire, a stable key for files and command lines and a label for people. The client's
//! settings table and the simulated controller both read these lists.

use brushwork_values::Code;

/// Signal types of command 143 (MCP manual 2.3.1).
pub static SIGNAL_TYPES: &[Code] = &[
    code(0, "none", "None"),
    code(1, "analog", "Analog"),
    code(2, "pulse", "Pulse"),
    code(3, "encoder", "Encoder"),
    code(4, "packet_serial", "Packet serial"),
];

/// Signal modes of command 143: which value of the signal becomes the command.
pub static SIGNAL_MODES: &[Code] = &[
    code(0, "position", "Position"),
    code(1, "percent", "Percent"),
    code(2, "average_speed", "Average speed"),
    code(3, "speed", "Speed"),
];

/// Signal targets of command 143: which motors the signal drives.
pub static SIGNAL_TARGETS: &[Code] = &[
    code(0, "none", "None"),
    code(1, "motor1", "Motor 1"),
    code(2, "motor2", "Motor 2"),
    code(3, "both", "Both motors"),
];

/// Minimum and maximum actions from generation 2: motor 1 in the low byte, motor 2 in the high byte
/// (MCP manual 3.1, SIGNALMINACTION; the field is u16 in public clients from then on).
pub static SIGNAL_ACTIONS: &[Code] = &ACTIONS;

/// Minimum and maximum actions in generation 1, where the field is one byte.
///
/// Assumed: the actions are counted in the order the manual lists them, 0 being none; the numbers of that column cannot be
/// read in our copy of the manual, and the codes of [`SIGNAL_ACTIONS`] do not fit a byte.
pub static SIGNAL_ACTIONS_GENERATION_1: &[Code] = &{
    let mut codes = ACTIONS;
    let mut index = 0;
    while index < codes.len() {
        codes[index].raw = index as i64;
        index += 1;
    }
    codes
};

/// Actions that switch a digital output, command 137 (MCP manual 1.9.9, 2.3.1).
pub static DOUT_ACTIONS: &[Code] = &[
    code(0, "none", "None"),
    code(1, "motor1_on", "Motor 1 on"),
    code(2, "motor2_on", "Motor 2 on"),
    code(3, "motors_on", "Motors on"),
    code(4, "motor1_reverse", "Motor 1 reverse"),
    code(5, "motor2_reverse", "Motor 2 reverse"),
    code(6, "motors_reverse", "Motors reverse"),
    code(7, "over_voltage", "Over voltage"),
    code(8, "over_temperature", "Over temperature"),
    code(9, "status1_led", "Status 1 LED"),
    code(10, "status2_led", "Status 2 LED"),
    code(11, "error_led", "Error LED"),
];

/// Priority level signals of command 139.
pub static PRIORITY_SIGNALS: &[Code] = &[
    code(0, "disabled", "Disabled"),
    code(1, "serial", "Serial"),
    code(2, "pulse", "Pulse"),
    code(3, "analog", "Analog"),
];

/// Stream types of command 145.
pub static STREAM_TYPES: &[Code] = &[
    code(0, "mcl", "MCL serial"),
    code(1, "packet_serial", "Packet serial"),
    code(2, "disabled", "Disabled"),
];

/// Streams in the order of command 145's index.
pub static STREAMS: &[Code] = &[
    code(0, "usb", "USB"),
    code(1, "rs232", "RS-232 (UART0)"),
    code(2, "ttl1", "TTL UART1"),
    code(3, "ttl2", "TTL UART2"),
    code(4, "ttl3", "TTL UART3"),
];

/// PWM modes of command 148.
pub static PWM_MODES: &[Code] =
    &[code(0, "locked_antiphase", "Locked antiphase"), code(1, "sign_magnitude", "Sign magnitude")];

/// E-Stop reset methods of command 201 before generation 4: locked, or released by command 200.
pub static ESTOP_RESETS: &[Code] = &[code(0, "hardware", "Hardware"), code(0xAA, "software", "Software")];

/// E-Stop reset methods of command 201 in generation 4.
pub static ESTOP_RESETS_GENERATION_4: &[Code] = &[
    code(0, "hardware", "Hardware"),
    code(0xAA, "software", "Software"),
    code(0x55, "automatic", "Automatic"),
];

/// "No encoder" in commands 91 to 93.
///
/// Assumed: their number counts the signals in the order of command 144 from 0 (MCP manual 3.1, MOTORENCPIN, calls it the
/// signal number and gives no list), and 255 stands for none.
pub const ENCODER_PIN_NONE: i64 = 0xFF;

const ACTIONS: [Code; 23] = [
    code(0x0000, "none", "None"),
    code(0x0001, "m1_safe_stop", "M1 safe stop"),
    code(0x0100, "m2_safe_stop", "M2 safe stop"),
    code(0x0101, "both_safe_stop", "M1/M2 safe stop"),
    code(0x0002, "m1_off", "M1 off"),
    code(0x0200, "m2_off", "M2 off"),
    code(0x0202, "both_off", "M1/M2 off"),
    code(0x0004, "m1_reverse", "M1 reverse"),
    code(0x0400, "m2_reverse", "M2 reverse"),
    code(0x0404, "both_reverse", "M1/M2 reverse"),
    code(0x0008, "m1_forward_limit", "M1 forward limit"),
    code(0x0800, "m2_forward_limit", "M2 forward limit"),
    code(0x0808, "both_forward_limit", "M1/M2 forward limit"),
    code(0x0010, "m1_backward_limit", "M1 backward limit"),
    code(0x1000, "m2_backward_limit", "M2 backward limit"),
    code(0x1010, "both_backward_limit", "M1/M2 backward limit"),
    code(0x0020, "m1_load_home", "M1 load home"),
    code(0x2000, "m2_load_home", "M2 load home"),
    code(0x2020, "both_load_home", "M1/M2 load home"),
    code(0x0040, "run_script", "Run script"),
    code(0x4000, "stop_script", "Stop script"),
    code(0x0080, "reset_script", "Reset script"),
    code(0x8000, "e_stop", "E-Stop"),
];

/// One named value.
pub(crate) const fn code(raw: i64, key: &'static str, label: &'static str) -> Code {
    Code { raw, key, label }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet_serial::Generation;
    use crate::roboclaw::{
        ADDRESS_OR_SWITCHES, BATTERY_MODES, BAUD_OR_OPTIONS, CONTROL_MODES, CTRL_MODES, ControlPin,
        IDLE_MODES,
    };
    use brushwork_values::{by_key, by_raw};

    #[test]
    fn keys_and_numbers_are_unique_within_each_list() {
        let lists = [
            SIGNAL_TYPES,
            SIGNAL_MODES,
            SIGNAL_TARGETS,
            SIGNAL_ACTIONS,
            SIGNAL_ACTIONS_GENERATION_1,
            DOUT_ACTIONS,
            PRIORITY_SIGNALS,
            STREAM_TYPES,
            STREAMS,
            PWM_MODES,
            ESTOP_RESETS,
            ESTOP_RESETS_GENERATION_4,
            CTRL_MODES,
            IDLE_MODES,
            CONTROL_MODES,
            BATTERY_MODES,
            BAUD_OR_OPTIONS,
            ADDRESS_OR_SWITCHES,
        ];
        let pins = ControlPin::ALL.map(|pin| Generation::ALL.map(|generation| pin.functions(generation)));
        for list in lists.into_iter().chain(pins.into_iter().flatten()) {
            for (index, code) in list.iter().enumerate() {
                assert!(
                    list[..index].iter().all(|other| other.raw != code.raw && other.key != code.key),
                    "{code:?}"
                );
                assert_eq!(by_raw(list, code.raw), Some(code));
                assert_eq!(by_key(list, code.key), Some(code));
            }
        }
    }

    #[test]
    fn a_generation_1_action_fits_a_byte() {
        assert!(SIGNAL_ACTIONS_GENERATION_1.iter().all(|code| u8::try_from(code.raw).is_ok()));
        assert_eq!(by_raw(SIGNAL_ACTIONS_GENERATION_1, 22).map(|code| code.key), Some("e_stop"));
    }
}
