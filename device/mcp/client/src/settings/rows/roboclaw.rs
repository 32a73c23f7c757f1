//! What only RoboClaw boards have: functions of S3 to S5, the inputs S1 and S2, CTRL outputs, the
//! configuration word (public clients, 2015-2025). What the numbers of a function mean differs by firmware
//! and is not repeated here.

use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{number, scale};
use brushwork_values::Code;
use brushwork_values::Unit;

use crate::settings::rows::scales::{GEN1, GEN2, GEN3, GEN4, U8_STEPS};
use crate::settings::template::{DefaultValue, Form, Limits, Repeat, Template, at, settings};
use brushwork_link::settings::Coding;
use brushwork_link::settings::Group;

const PRODUCT_LINE: Group = Group::new(160, "robo_claw", "RoboClaw");

pub(crate) static ROWS: &[Template] = settings! {
    roboclaw("roboclaw.pin.{n}", "Function").per(Repeat::RoboClawPins).int(Unit::None, U8_STEPS)
        .assumed_default(DefaultValue::Int(0));
        [Form::field(&[number::READ_PIN_FUNCTIONS], &[number::SET_PIN_FUNCTIONS], &["s3", "s4", "s5", "d1", "d2"])]
        "The number of the pin's function: E-Stop, voltage clamp, home switch and others. Command 74.";
    roboclaw("roboclaw.deadband.reverse", "Reverse deadband").int(Unit::None, U8_STEPS)
        .assumed_default(DefaultValue::Int(0));
        [control(&["deadband_min"]).only(GEN1, GEN2)]
        "How far below center the RC and analog inputs still count as 0. Command 76.";
    roboclaw("roboclaw.deadband.forward", "Forward deadband").int(Unit::None, U8_STEPS)
        .assumed_default(DefaultValue::Int(0));
        [control(&["deadband_max"]).only(GEN1, GEN2)]
        "How far above center the RC and analog inputs still count as 0. Command 76.";
    input("roboclaw.{n}.reverse_deadband", "Reverse deadband").int(Unit::None, U8_STEPS);
        [control(&["s1_min", "s2_min"]).only(GEN3, GEN3),
         control(&["s1_reverse_deadband", "s2_reverse_deadband"]).only(GEN4, GEN4)]
        "How far below center the input still counts as 0. Command 76.";
    input("roboclaw.{n}.forward_deadband", "Forward deadband").int(Unit::None, U8_STEPS);
        [control(&["s1_max", "s2_max"]).only(GEN3, GEN3),
         control(&["s1_forward_deadband", "s2_forward_deadband"]).only(GEN4, GEN4)]
        "How far above center the input still counts as 0. Command 76.";
    input("roboclaw.{n}.reverse_limit", "Reverse limit").int(Unit::None, U16_STEPS);
        [control(&["s1_reverse_limit", "s2_reverse_limit"]).only(GEN4, GEN4)]
        "The most that the input commands backward. Command 76.";
    input("roboclaw.{n}.forward_limit", "Forward limit").int(Unit::None, U16_STEPS);
        [control(&["s1_forward_limit", "s2_forward_limit"]).only(GEN4, GEN4)]
        "The most that the input commands forward. Command 76.";
    input("roboclaw.{n}.center", "Center").int(Unit::None, U16_STEPS);
        [control(&["s1_center", "s2_center"]).only(GEN4, GEN4)]
        "The value of the input at rest. Command 76.";
    input("roboclaw.{n}.min", "Minimum").int(Unit::None, U16_STEPS);
        [control(&["s1_min", "s2_min"]).only(GEN4, GEN4)]
        "The lowest value of the input. Command 76.";
    input("roboclaw.{n}.max", "Maximum").int(Unit::None, U16_STEPS);
        [control(&["s1_max", "s2_max"]).only(GEN4, GEN4)]
        "The highest value of the input. Command 76.";
    input("roboclaw.{n}.output_min", "Output minimum").fixed(Unit::Percent, OUTPUT, 1, U16_STEPS)
        .assumed_default(DefaultValue::Number(0.0));
        [output(&["s1_min", "s2_min"])]
        "The share of full output that the low end of the input commands. Command 117.";
    input("roboclaw.{n}.output_max", "Output maximum").fixed(Unit::Percent, OUTPUT, 1, U16_STEPS)
        .assumed_default(DefaultValue::Number(0.0));
        [output(&["s1_max", "s2_max"])]
        "The share of full output that the high end of the input commands. Command 117.";
    // Commands 100 and 101 carry the CTRL modes in these generations; their names are those of generation
    // 4.
    roboclaw("roboclaw.ctrl{n}.mode", "Mode").per(Repeat::Ctrls).int(Unit::None, Limits::Between(0.0, 3.0))
        .assumed_default(DefaultValue::Int(0));
        [Form::field(&[number::READ_TEMPERATURES], &[number::READ_VOLTS], &["mode_1", "mode_2"])
            .only(GEN2, GEN3)]
        "The number of what the CTRL output does. Command 100.";
    roboclaw("roboclaw.config.word", "Configuration word").int(Unit::Bits, U16_STEPS)
        .assumed_default(DefaultValue::Int(0));
        [Form::read_only(at(&[number::READ_CONFIG], &["config"]), "The word as a whole is shown for \
         comparison; change its parts below.")]
        "All of the configuration in one number. Command 99.";
    roboclaw("roboclaw.config.mode", "Control mode").choice(CONTROL_MODES)
        .assumed_default(DefaultValue::Key("rc"));
        [config(0, 2)]
        "What commands the motors. Anything but packet serial ends this connection. Command 98, bits 0 \
         and 1.";
    roboclaw("roboclaw.config.battery", "Battery mode").int(Unit::None, Limits::Between(0.0, 7.0))
        .assumed_default(DefaultValue::Int(0));
        [config(2, 3)]
        "Off, detected at power up, or a number of lithium cells. Command 98, bits 2 to 4.";
    roboclaw("roboclaw.config.baud", "Baud rate number").int(Unit::None, Limits::Between(0.0, 7.0))
        .assumed_default(DefaultValue::Int(0));
        [config(5, 3)]
        "From 0 for 2400 baud: 2400, 9600, 19200, 38400, 57600, 115200, 230400, 460800. In RC mode bit 0 \
         is mixing and bit 1 exponential. Command 98, bits 5 to 7.";
    roboclaw("roboclaw.config.address", "Address number").int(Unit::None, Limits::Between(0.0, 7.0))
        .assumed_default(DefaultValue::Int(0));
        [config(8, 3)]
        "From 0 for address 0x80 to 7 for 0x87; it counts at once. In RC mode bit 0 is the flip switch \
         and bit 1 the time-out. Command 98, bits 8 to 10.";
    roboclaw("roboclaw.config.bit_11", "Configuration bit 11").assumed_default(DefaultValue::Bool(false));
        [config(11, 1)]
        UNNAMED_BIT;
    roboclaw("roboclaw.config.slave_select", "Slave select").assumed_default(DefaultValue::Bool(false));
        [config(12, 1)]
        "Lets a pin choose which of several boards listens. Command 98, bit 12.";
    roboclaw("roboclaw.config.swap_encoders", "Relay or swapped encoders")
        .assumed_default(DefaultValue::Bool(false));
        [config(13, 1)]
        "Relay mode on old boards, exchanged encoder inputs on later ones. Command 98, bit 13.";
    roboclaw("roboclaw.config.bit_14", "Configuration bit 14").assumed_default(DefaultValue::Bool(false));
        [config(14, 1)]
        UNNAMED_BIT;
    roboclaw("roboclaw.config.open_drain", "Multi-unit mode").assumed_default(DefaultValue::Bool(false));
        [config(15, 1)]
        "Open-drain output, so that several boards share one receive line. Command 98, bit 15.";
};

/// A row of its own all the same, so that a backup brings back the whole word.
const UNNAMED_BIT: &str = "What this bit does is not published. Leave it as it is. Command 98.";

static CONTROL_MODES: &[Code] = &[
    Code { raw: 0, key: "rc", label: "RC" },
    Code { raw: 1, key: "analog", label: "Analog" },
    Code { raw: 2, key: "simple_serial", label: "Simple serial" },
    Code { raw: 3, key: "packet_serial", label: "Packet serial" },
];

const OUTPUT: Coding = Coding::PerUnit(scale::DEFAULT_SPEED_RAW / 100.0);
const U16_STEPS: Limits = Limits::Steps(0, 0xFFFF);

const fn roboclaw(key: &'static str, label: &'static str) -> Template {
    Template::new(key, label, PRODUCT_LINE).only_on(Family::RoboClaw)
}

const fn input(key: &'static str, label: &'static str) -> Template {
    roboclaw(key, label).per(Repeat::RoboClawInputs).assumed_default(DefaultValue::Int(0))
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
