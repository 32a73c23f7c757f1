//! Input pins and digital outputs (MCP manual 1.9.8 to 1.9.11).

use brushwork_mcp_wire::codes::{
    DOUT_ACTIONS, SIGNAL_ACTIONS, SIGNAL_ACTIONS_GENERATION_1, SIGNAL_MODES, SIGNAL_TARGETS, SIGNAL_TYPES,
};
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{number, scale};
use brushwork_values::Unit;

use crate::settings::rows::scales::{GEN1, GEN2, GEN3, GEN4, I32_STEPS, U32_STEPS};
use crate::settings::template::{DefaultValue, Form, Limits, Repeat, Template, mcp, settings};
use brushwork_link::settings::Group;
use brushwork_link::settings::{Coding, Kind};

pub(crate) static ROWS: &[Template] = settings! {
    pin("pin.{n}.type", "Type").choice(SIGNAL_TYPES).assumed_default(DefaultValue::PinType);
        [signal(&["type"])]
        "What the pin measures: nothing, a voltage, pulses or an encoder. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.digital", "Digital input").assumed_default(DefaultValue::Bool(false));
        [Form::hidden("The number of the digital pin mode is not public: command 143 lists none, analog, \
         pulse, encoder and packet serial only.")]
        "Reads the pin as a switch: 0 or 4095. MCP manual 1.9.8.";
    pin("pin.{n}.mode", "Command mode").choice(SIGNAL_MODES).default(DefaultValue::Key("position"));
        [signal(&["mode"])]
        "Which value of the input becomes the command: where it stands, how far in percent, or how fast \
         it changes. MCP manual 1.9.11, command 143.";
    pin("pin.{n}.target", "Controls").choice(SIGNAL_TARGETS).assumed_default(DefaultValue::Key("none"));
        [signal(&["target"])]
        "Which motors this input commands. MCP manual 1.9.11, command 143.";
    pin("pin.{n}.min_action", "Minimum action").choice(SIGNAL_ACTIONS).default(DefaultValue::Key("none"));
        [signal(&["min_action"]).only(GEN1, GEN1).with_kind(Kind::Choice(SIGNAL_ACTIONS_GENERATION_1))
            .simulated_only(ACTION_NUMBERS),
         signal(&["min_action"]).only(GEN2, GEN4)]
        "What happens when the input is at or below its minimum: a limit switch, a home switch, an \
         E-Stop. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.max_action", "Maximum action").choice(SIGNAL_ACTIONS).default(DefaultValue::Key("none"));
        [signal(&["max_action"]).only(GEN1, GEN1).with_kind(Kind::Choice(SIGNAL_ACTIONS_GENERATION_1))
            .simulated_only(ACTION_NUMBERS),
         signal(&["max_action"]).only(GEN2, GEN4)]
        "What happens when the input is above its maximum. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.timeout", "Priority time-out").int(Unit::Milliseconds, U32_STEPS)
        .default(DefaultValue::Int(1000));
        [signal(&["timeout"])]
        "After this long without a new pulse the input counts as lost and the next priority level takes \
         over. Pulse inputs only. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.load_home", "Load home").int(Unit::Counts, I32_STEPS).default(DefaultValue::Int(0));
        [signal(&["load_home"])]
        "The encoder count that a load home action sets. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.min", "Minimum").int(Unit::None, I32_STEPS).default(DefaultValue::Int(0));
        [signal(&["min"])]
        "The lowest value the input reaches; at or below it the minimum action is triggered. MCP manual \
         1.9.8, command 143.";
    pin("pin.{n}.center", "Center").int(Unit::None, I32_STEPS).default(DefaultValue::Int(2048));
        [signal(&["center"])]
        "The value of the input at rest; it becomes command 0. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.max", "Maximum").int(Unit::None, I32_STEPS).default(DefaultValue::Int(4095));
        [signal(&["max"])]
        "The highest value the input reaches; above it the maximum action is triggered. MCP manual 1.9.8, \
         command 143.";
    pin("pin.{n}.low_pass", "Low pass").int(Unit::None, Limits::Between(0.0, 15.0))
        .assumed_default(DefaultValue::Int(0));
        [Form::hidden("Command 143 of this firmware generation has no field for the low pass; from \
         generation 2 on it has.").only(GEN1, GEN1),
         signal(&["low_pass"]).only(GEN2, GEN4)]
        "Smooths the input over 2 to the power of this many samples, taken 10000 times a second; 0 \
         switches it off. MCP manual 1.9.8.";
    pin("pin.{n}.deadband", "Deadband").int(Unit::None, U32_STEPS).default(DefaultValue::Int(0));
        [signal(&["deadband"])]
        "Values within this distance of the center count as 0, for a stick that does not spring back \
         exactly. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.power_exp", "Power exponent")
        .fixed(Unit::Gain, Coding::PerUnit(scale::POWER_EXPONENT), 2, Limits::Between(-8.0, 8.0))
        .default(DefaultValue::Number(0.0));
        [signal(&["power_exponent"])]
        "Bends the response: one sign gives fine control near the center, the other near the ends; 0 is \
         straight. MCP manual 1.9.8, command 143.";
    pin("pin.{n}.power_min", "Power minimum").int(Unit::None, U32_STEPS).default(DefaultValue::Int(0));
        [signal(&["power_min"])]
        "Added to every command other than 0, for a motor that does not start at small power. MCP manual \
         1.9.8, command 143.";
    pin("pin.{n}.min_output", "Command minimum").int(Unit::None, FULL_OUTPUT)
        .default(DefaultValue::Int(-scale::FULL_DUTY_RAW));
        [signal(&["min_output"])]
        "The command at the low end of the input; -32767 is full backward. MCP manual 1.9.11, command \
         143.";
    pin("pin.{n}.max_output", "Command maximum").int(Unit::None, FULL_OUTPUT)
        .default(DefaultValue::Int(scale::FULL_DUTY_RAW));
        [signal(&["max_output"])]
        "The command at the high end of the input; 32767 is full forward. MCP manual 1.9.11, command \
         143.";
    pin("pin.{n}.potentiometer", "Potentiometer").int(Unit::None, U32_STEPS)
        .assumed_default(DefaultValue::Int(0));
        [signal(&["potentiometer"]).only(GEN3, GEN4)]
        "Stored by newer firmware; what it does is not published. Public clients, 2018-2025, command \
         143.";
    mcp("dout.{n}.action", "Action", Group::OUTPUTS).per(Repeat::Douts).choice(DOUT_ACTIONS)
        .default(DefaultValue::Key("none"));
        [Form::record(&[number::READ_DOUT_ACTIONS], &[number::SET_DOUT_ACTION], &["action"])]
        "What switches this output on: a motor running or reversing, over-voltage for a brake resistor, \
         over-temperature, or one of the indicators. MCP manual 1.9.9, command 137.";
    mcp("dout.{n}.inverted", "Inverted", Group::OUTPUTS).per(Repeat::Douts)
        .default(DefaultValue::Bool(false));
        [Form::hidden("No packet serial command for inverting an output is public: command 137 carries the \
         action only.")]
        "Switches the output on at power-up and off while its action is active. MCP manual 1.9.9.";
};

const ACTION_NUMBERS: &str = "The numbers of the actions in generation 1 are a guess: the field is one \
                              byte, and the codes that later firmware uses do not fit it. They are written \
                              to simulated controllers only.";

const FULL_OUTPUT: Limits = Limits::Steps(-scale::FULL_DUTY_RAW, scale::FULL_DUTY_RAW);

const fn pin(key: &'static str, label: &'static str) -> Template {
    Template::new(key, label, Group::PINS).per(Repeat::Pins).only_on(Family::Mcp)
}

const fn signal(fields: &'static [&'static str]) -> Form {
    Form::record(&[number::READ_SIGNALS], &[number::SET_SIGNAL], fields)
}
