//! What only RoboClaw boards have: the configuration word, functions of S3 to S5, the inputs S1 and S2, CTRL
//! outputs (RoboClaw manual 2018; public clients, 2015-2025).

use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{number, scale};
use brushwork_mcp_wire::roboclaw::{
    ADDRESS_OR_SWITCHES, BATTERY_MODES, BAUD_OR_OPTIONS, CONTROL_MODES, CTRL_MODES, S3_FUNCTIONS,
};
use brushwork_values::Unit;

use crate::settings::rows::scales::{GEN1, GEN2, GEN3, GEN4, U8_STEPS};
use crate::settings::template::{DefaultValue, Form, Limits, Repeat, Template, at, settings};
use brushwork_link::settings::Coding;
use brushwork_link::settings::Group;

/// Who commands the motors, what cuts the battery off, how the unit is reached.
const CONFIGURATION: Group = Group::new(15, "configuration", "Control mode and address");
const CONTROL_PINS: Group = Group::new(122, "control_pins", "Control pins");
const CONTROL_INPUTS: Group = Group::new(124, "control_inputs", "R/C and analog inputs");
const CONTROL_OUTPUTS: Group = Group::new(152, "control_outputs", "Control outputs");

pub(crate) static ROWS: &[Template] = settings! {
    roboclaw("roboclaw.config.mode", "Control mode", CONFIGURATION).choice(CONTROL_MODES)
        .assumed_default(DefaultValue::Key("packet_serial"));
        [config(0, 2)]
        "What commands the motors: pulses or voltages on S1 and S2, or the serial line on S1 and S2. It counts \
         from the next power-up. Anything but packet serial ends a connection by S1 and S2; USB goes on. Command \
         98, bits 0 and 1.";
    roboclaw("roboclaw.config.battery", "Battery cut-off", CONFIGURATION).choice(BATTERY_MODES)
        .assumed_default(DefaultValue::Key("user"));
        [config(2, 3)]
        "What sets the least and greatest main battery voltage: the limits under voltage limits, or a number \
         of lithium polymer cells, given or detected at power-up. Detection needs a charged battery. Command 98, \
         bits 2 to 4.";
    roboclaw("roboclaw.config.baud", "Baud rate or R/C options", CONFIGURATION).choice(BAUD_OR_OPTIONS)
        .assumed_default(DefaultValue::Key("38400"));
        [config(5, 3)]
        "In the serial modes the rate of S1 and S2, from the next power-up. In R/C and analog mode three \
         options: mixing (S1 drives, S2 turns), exponential (less sensitive in the middle) and MCU (keeps to the \
         last pulse, calibrates nothing). Command 98, bits 5 to 7.";
    roboclaw("roboclaw.config.address", "Address or R/C switches", CONFIGURATION).choice(ADDRESS_OR_SWITCHES)
        .assumed_default(DefaultValue::Key("0x80"));
        [config(8, 3)]
        "In the serial modes the address, which counts at once. In R/C and analog mode two switches: the flip \
         switch on S3 is a pulse instead of a level, and the motors stop when pulses stop. Command 98, bits 8 \
         to 10.";
    // The vendor's library of 2015 has slave select in bit 12 and relay mode in bit 13; keys of profiles keep those names.
    roboclaw("roboclaw.config.bit_11", "Slave mode", CONFIGURATION).assumed_default(DefaultValue::Bool(false));
        [config(11, 1)]
        "In simple serial mode the board listens only while its select pin is on, so that several share a \
         line. Named by later clients; the library of 2015 leaves the bit without a name. Command 98, bit 11.";
    roboclaw("roboclaw.config.slave_select", "Relay mode", CONFIGURATION).assumed_default(DefaultValue::Bool(false));
        [config(12, 1)]
        "Relay mode in packet serial by later clients, slave select by the vendor's library of 2015: try it \
         before you rely on it. Command 98, bit 12.";
    roboclaw("roboclaw.config.swap_encoders", "Swap encoders", CONFIGURATION)
        .assumed_default(DefaultValue::Bool(false));
        [config(13, 1)]
        "Encoder 1 serves motor 2 and the other way round. With both loops closed it makes the motors run \
         away if the wiring does not fit. Old boards have relay mode here. Command 98, bit 13.";
    roboclaw("roboclaw.config.bit_14", "Swap buttons", CONFIGURATION).assumed_default(DefaultValue::Bool(false));
        [config(14, 1)]
        "Changes the order of the buttons on the board. Named by later clients. Command 98, bit 14.";
    roboclaw("roboclaw.config.open_drain", "Multi-unit mode", CONFIGURATION)
        .assumed_default(DefaultValue::Bool(false));
        [config(15, 1)]
        "Open-drain output of S2, so that several boards share one receive line with a pull-up resistor. \
         Command 98, bit 15.";
    roboclaw("roboclaw.config.word", "Configuration word", CONFIGURATION).int(Unit::Bits, U16_STEPS)
        .assumed_default(DefaultValue::Int(0x63));
        [Form::read_only(at(&[number::READ_CONFIG], &["config"]), "The word as a whole is shown for \
         comparison; change its parts above.")]
        "All of the configuration in one number. Command 99.";
    roboclaw("roboclaw.pin.{n}", "Function", CONTROL_PINS).per(Repeat::RoboClawPins).open_choice(S3_FUNCTIONS, U8_STEPS)
        .assumed_default(DefaultValue::Raw(0));
        [Form::field(&[number::READ_PIN_FUNCTIONS], &[number::SET_PIN_FUNCTIONS], &["s3", "s4", "s5", "d1", "d2"])]
        "What the pin does. S4 and D1 belong to motor 1, S5 and D2 to motor 2; inputs act when they are pulled \
         low, inverted ones when they are not. A number without a name is written as it is given. RoboClaw \
         manual 2018, command 74.";
    roboclaw("roboclaw.deadband.reverse", "Reverse deadband", CONTROL_INPUTS).int(Unit::None, DEADBAND)
        .default(DefaultValue::Int(25));
        [control(&["deadband_min"]).only(GEN1, GEN2)]
        "How far below center R/C and analog inputs still count as 0, in tenths of a percent: 25 is 2.5 %. \
         RoboClaw manual 2018, command 76.";
    roboclaw("roboclaw.deadband.forward", "Forward deadband", CONTROL_INPUTS).int(Unit::None, DEADBAND)
        .default(DefaultValue::Int(25));
        [control(&["deadband_max"]).only(GEN1, GEN2)]
        "How far above center R/C and analog inputs still count as 0, in tenths of a percent: 25 is 2.5 %. \
         RoboClaw manual 2018, command 76.";
    input("roboclaw.{n}.reverse_deadband", "Reverse deadband").int(Unit::None, DEADBAND)
        .default(DefaultValue::Int(25));
        [control(&["s1_min", "s2_min"]).only(GEN3, GEN3),
         control(&["s1_reverse_deadband", "s2_reverse_deadband"]).only(GEN4, GEN4)]
        "How far below center the input still counts as 0, in tenths of a percent: 25 is 2.5 %. RoboClaw \
         manual 2018, command 76.";
    input("roboclaw.{n}.forward_deadband", "Forward deadband").int(Unit::None, DEADBAND)
        .default(DefaultValue::Int(25));
        [control(&["s1_max", "s2_max"]).only(GEN3, GEN3),
         control(&["s1_forward_deadband", "s2_forward_deadband"]).only(GEN4, GEN4)]
        "How far above center the input still counts as 0, in tenths of a percent: 25 is 2.5 %. RoboClaw \
         manual 2018, command 76.";
    input("roboclaw.{n}.reverse_limit", "Reverse limit").int(Unit::None, U16_STEPS);
        [control(&["s1_reverse_limit", "s2_reverse_limit"]).only(GEN4, GEN4)]
        "The most that the input commands backward. Its unit is not public. Command 76.";
    input("roboclaw.{n}.forward_limit", "Forward limit").int(Unit::None, U16_STEPS);
        [control(&["s1_forward_limit", "s2_forward_limit"]).only(GEN4, GEN4)]
        "The most that the input commands forward. Its unit is not public. Command 76.";
    input("roboclaw.{n}.center", "Center").int(Unit::None, U16_STEPS);
        [control(&["s1_center", "s2_center"]).only(GEN4, GEN4)]
        "The value of the input at rest. Its unit is not public. Command 76.";
    input("roboclaw.{n}.min", "Minimum").int(Unit::None, U16_STEPS);
        [control(&["s1_min", "s2_min"]).only(GEN4, GEN4)]
        "The lowest value of the input. Its unit is not public. Command 76.";
    input("roboclaw.{n}.max", "Maximum").int(Unit::None, U16_STEPS);
        [control(&["s1_max", "s2_max"]).only(GEN4, GEN4)]
        "The highest value of the input. Its unit is not public. Command 76.";
    input("roboclaw.{n}.output_min", "Output minimum").fixed(Unit::Percent, OUTPUT, 1, U16_STEPS)
        .assumed_default(DefaultValue::Number(0.0));
        [output(&["s1_min", "s2_min"])]
        "The share of full output that the low end of the input commands, by the vendor's library of 2018; the \
         RoboClaw manual 2018 has the duty below which no current of motor 1 is measured there. Command 117.";
    input("roboclaw.{n}.output_max", "Output maximum").fixed(Unit::Percent, OUTPUT, 1, U16_STEPS)
        .assumed_default(DefaultValue::Number(0.0));
        [output(&["s1_max", "s2_max"])]
        "The share of full output that the high end of the input commands, by the vendor's library of 2018; the \
         RoboClaw manual 2018 has the duty below which no current of motor 2 is measured there. Command 117.";
    // Commands 100 and 101 carry the CTRL modes in these generations; their names are those of generation
    // 4.
    roboclaw("roboclaw.ctrl{n}.mode", "Mode", CONTROL_OUTPUTS).per(Repeat::Ctrls).choice(CTRL_MODES)
        .assumed_default(DefaultValue::Key("disabled"));
        [Form::field(&[number::READ_TEMPERATURES], &[number::READ_VOLTS], &["mode_1", "mode_2"])
            .only(GEN2, GEN3)]
        "What the output does, on boards that have it: off, a level set by a command, a voltage clamp, or the \
         brake of the motor with its number. RoboClaw manual 2018, command 100.";
};

const DEADBAND: Limits = Limits::Steps(0, 250);
const OUTPUT: Coding = Coding::PerUnit(scale::DEFAULT_SPEED_RAW / 100.0);
const U16_STEPS: Limits = Limits::Steps(0, 0xFFFF);

const fn roboclaw(key: &'static str, label: &'static str, group: Group) -> Template {
    Template::new(key, label, group).only_on(Family::RoboClaw)
}

const fn input(key: &'static str, label: &'static str) -> Template {
    roboclaw(key, label, CONTROL_INPUTS).per(Repeat::RoboClawInputs).assumed_default(DefaultValue::Int(0))
}

const fn control(fields: &'static [&'static str]) -> Form {
    Form::field(&[number::READ_CONTROL_SETTINGS], &[number::SET_CONTROL_SETTINGS], fields)
}

const fn output(fields: &'static [&'static str]) -> Form {
    Form::field(&[number::READ_CONTROL_LIMITS], &[number::SET_CONTROL_LIMITS], fields).only(GEN3, GEN3)
}

const fn config(shift: u8, width: u8) -> Form {
    Form::bits(&[number::READ_CONFIG], &[number::SET_CONFIG], &["config"], (shift, width))
}
