//! The command numbers by name. Each is the upper-case form of its row's key in the command table.

use super::name::small;

/// Gives every name with its number, in order, to a macro.
macro_rules! command_numbers {
    ($then:ident) => {
        $then! {
            FORWARD_M1 = 0;
            BACKWARD_M1 = 1;
            SET_MAIN_VOLTAGE_MIN = 2;
            SET_MAIN_VOLTAGE_MAX = 3;
            FORWARD_M2 = 4;
            BACKWARD_M2 = 5;
            DRIVE_7BIT_M1 = 6;
            DRIVE_7BIT_M2 = 7;
            MIXED_FORWARD = 8;
            MIXED_BACKWARD = 9;
            MIXED_RIGHT = 10;
            MIXED_LEFT = 11;
            MIXED_DRIVE_7BIT = 12;
            MIXED_TURN_7BIT = 13;
            SET_SERIAL_TIMEOUT = 14;
            READ_SERIAL_TIMEOUT = 15;
            READ_ENCODER_M1 = 16;
            READ_ENCODER_M2 = 17;
            READ_SPEED_M1 = 18;
            READ_SPEED_M2 = 19;
            RESET_ENCODERS = 20;
            READ_VERSION = 21;
            SET_ENCODER_M1 = 22;
            SET_ENCODER_M2 = 23;
            READ_MAIN_BATTERY = 24;
            READ_LOGIC_BATTERY = 25;
            SET_LOGIC_VOLTAGE_MIN = 26;
            SET_LOGIC_VOLTAGE_MAX = 27;
            SET_VELOCITY_PID_M1 = 28;
            SET_VELOCITY_PID_M2 = 29;
            READ_RAW_SPEED_M1 = 30;
            READ_RAW_SPEED_M2 = 31;
            DUTY_M1 = 32;
            DUTY_M2 = 33;
            DUTY_BOTH = 34;
            SPEED_M1 = 35;
            SPEED_M2 = 36;
            SPEED_BOTH = 37;
            SPEED_ACCEL_M1 = 38;
            SPEED_ACCEL_M2 = 39;
            SPEED_ACCEL_BOTH = 40;
            SPEED_DISTANCE_M1 = 41;
            SPEED_DISTANCE_M2 = 42;
            SPEED_DISTANCE_BOTH = 43;
            SPEED_ACCEL_DISTANCE_M1 = 44;
            SPEED_ACCEL_DISTANCE_M2 = 45;
            SPEED_ACCEL_DISTANCE_BOTH = 46;
            READ_BUFFERS = 47;
            READ_PWMS = 48;
            READ_CURRENTS = 49;
            SPEED_ACCEL_EACH = 50;
            SPEED_ACCEL_DISTANCE_EACH = 51;
            DUTY_ACCEL_M1 = 52;
            DUTY_ACCEL_M2 = 53;
            DUTY_ACCEL_BOTH = 54;
            READ_VELOCITY_PID_M1 = 55;
            READ_VELOCITY_PID_M2 = 56;
            SET_MAIN_VOLTAGES = 57;
            SET_LOGIC_VOLTAGES = 58;
            READ_MAIN_VOLTAGES = 59;
            READ_LOGIC_VOLTAGES = 60;
            SET_POSITION_PID_M1 = 61;
            SET_POSITION_PID_M2 = 62;
            READ_POSITION_PID_M1 = 63;
            READ_POSITION_PID_M2 = 64;
            POSITION_PROFILE_M1 = 65;
            POSITION_PROFILE_M2 = 66;
            POSITION_PROFILE_BOTH = 67;
            SET_DEFAULT_ACCEL_M1 = 68;
            SET_DEFAULT_ACCEL_M2 = 69;
            SET_DEFAULT_SPEED_M1 = 70;
            SET_DEFAULT_SPEED_M2 = 71;
            READ_DEFAULT_SPEEDS = 72;
            READ_ALL_STATUS = 73;
            SET_PIN_FUNCTIONS = 74;
            READ_PIN_FUNCTIONS = 75;
            SET_CONTROL_SETTINGS = 76;
            READ_CONTROL_SETTINGS = 77;
            READ_ENCODERS = 78;
            READ_RAW_SPEEDS = 79;
            RESTORE_DEFAULTS = 80;
            READ_DEFAULT_ACCELS = 81;
            READ_TEMPERATURE_1 = 82;
            READ_TEMPERATURE_2 = 83;
            AUTOTUNE_VELOCITY_M1 = 84;
            AUTOTUNE_VELOCITY_M2 = 85;
            AUTOTUNE_POSITION_M1 = 86;
            AUTOTUNE_POSITION_M2 = 87;
            READ_AUTOTUNE_M1 = 88;
            READ_AUTOTUNE_M2 = 89;
            READ_STATUS = 90;
            READ_ENCODER_MODES = 91;
            SET_ENCODER_MODE_M1 = 92;
            SET_ENCODER_MODE_M2 = 93;
            SAVE_SETTINGS = 94;
            RELOAD_SETTINGS = 95;
            SET_SERIAL_NUMBER = 96;
            READ_SERIAL_NUMBER = 97;
            SET_CONFIG = 98;
            READ_CONFIG = 99;
            READ_VOLTS = 100;
            READ_TEMPERATURES = 101;
            SET_AUX_DUTIES = 102;
            READ_ENCODER_STATUS = 103;
            READ_AUX_DUTIES = 104;
            SET_HOMING_M1 = 105;
            SET_HOMING_M2 = 106;
            READ_HOMING = 107;
            READ_SPEEDS = 108;
            SET_SPEED_ERROR_LIMITS = 109;
            READ_SPEED_ERROR_LIMITS = 110;
            READ_SPEED_ERRORS = 111;
            SET_POSITION_ERROR_LIMITS = 112;
            READ_POSITION_ERROR_LIMITS = 113;
            READ_POSITION_ERRORS = 114;
            SET_VOLTAGE_OFFSETS = 115;
            READ_VOLTAGE_OFFSETS = 116;
            SET_CONTROL_LIMITS = 117;
            READ_CONTROL_LIMITS = 118;
            POSITION_M1 = 119;
            POSITION_M2 = 120;
            POSITION_BOTH = 121;
            SPEED_POSITION_M1 = 122;
            SPEED_POSITION_M2 = 123;
            SPEED_POSITION_BOTH = 124;
            PERCENT_POSITION_M1 = 125;
            PERCENT_POSITION_M2 = 126;
            PERCENT_POSITION_BOTH = 127;
            SET_INDUCTANCE_RESISTANCE_M1 = 128;
            SET_INDUCTANCE_RESISTANCE_M2 = 129;
            READ_INDUCTANCE_RESISTANCE_M1 = 130;
            READ_INDUCTANCE_RESISTANCE_M2 = 131;
            CALIBRATE_INDUCTANCE_RESISTANCE = 132;
            SET_CURRENT_LIMITS_M1 = 133;
            SET_CURRENT_LIMITS_M2 = 134;
            READ_CURRENT_LIMITS_M1 = 135;
            READ_CURRENT_LIMITS_M2 = 136;
            SET_DOUT_ACTION = 137;
            READ_DOUT_ACTIONS = 138;
            SET_PRIORITIES = 139;
            READ_PRIORITIES = 140;
            SET_ADDRESS_MIXED = 141;
            READ_ADDRESS_MIXED = 142;
            SET_SIGNAL = 143;
            READ_SIGNALS = 144;
            SET_STREAM = 145;
            READ_STREAMS = 146;
            READ_SIGNAL_VALUES = 147;
            SET_PWM_MODE = 148;
            READ_PWM_MODE = 149;
            SET_NODE_ID = 150;
            READ_NODE_ID = 151;
            SET_PWM_IDLE = 160;
            READ_PWM_IDLE = 161;
            READ_CAN_ERRORS = 180;
            PUT_CAN_PACKET = 181;
            GET_CAN_PACKET = 182;
            WRITE_CAN_DICTIONARY = 190;
            READ_CAN_DICTIONARY = 191;
            RESET_ESTOP = 200;
            SET_ESTOP_LOCK = 201;
            READ_ESTOP_LOCK = 202;
            SET_SCRIPT_AUTORUN = 246;
            READ_SCRIPT_AUTORUN = 247;
            START_SCRIPT = 248;
            STOP_SCRIPT = 249;
            ERASE_SCRIPT = 250;
            WRITE_SCRIPT = 251;
            READ_USER_MEMORY = 252;
            WRITE_USER_MEMORY = 253;
            READ_SCRIPT = 254;
            ENTER_LOADER = 255;
        }
    };
}
pub(super) use command_numbers;

macro_rules! numbers {
    ($($name:ident = $number:literal;)*) => {
        $(
            #[doc = concat!("Command ", stringify!($number), "; see its row in [`COMMANDS`](super::COMMANDS).")]
            pub const $name: u8 = $number;
        )*

        /// The key of a command's row: the name of its number in small letters.
        pub(super) const fn key(number: u8) -> &'static str {
            match number {
                $($number => small!($name),)*
                _ => panic!("no command is named so"),
            }
        }

        /// Every name with its number, in order.
        #[cfg(test)]
        pub(super) const NAMED: &[(&str, u8)] = &[$((stringify!($name), $number)),*];
    };
}

command_numbers!(numbers);
