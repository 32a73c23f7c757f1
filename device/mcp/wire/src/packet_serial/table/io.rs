//! Pins and streams: signals, digital outputs, priorities, serial ports (MCP manual 1.9).

use super::super::command::{ClientUse, Command, Effect, Form};
use super::super::field::{byte, field};
use super::super::name::{self, Name};
use super::super::scale;
use super::{CLIENTS, G1, G2, G3, G4, MANUAL_ADVANCED, fields, forms, read, reads, rows, sets, write};
use crate::codes;
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    CLIENTS SET_PIN_FUNCTIONS "pin functions" SET_PINS, client MCP_PINS;
    CLIENTS READ_PIN_FUNCTIONS "read pin functions" READ_PINS, client MCP_PINS;
    CLIENTS SET_CONTROL_SETTINGS "control input settings" SET_CONTROL,
        client MCP_PINS;
    CLIENTS READ_CONTROL_SETTINGS "read control input settings" READ_CONTROL,
        client MCP_PINS;
    MANUAL_ADVANCED SET_DOUT_ACTION "digital output action"
        sets![byte(name::INDEX, "output, counted from 0"), ACTION], note "The manual prints no reply.";
    MANUAL_ADVANCED READ_DOUT_ACTIONS "read digital output actions"
        reads![counted(name::DOUTS, fields![ACTION], "one record for each output of the model")];
    MANUAL_ADVANCED SET_PRIORITIES "priority levels" forms![write(G1, G4, Effect::Setting, PRIORITIES)];
    MANUAL_ADVANCED READ_PRIORITIES "read priority levels" forms![read(G1, G4, PRIORITIES)];
    MANUAL_ADVANCED SET_ADDRESS_MIXED "address and mixed mode" sets![ADDRESS, MIXED],
        note "Takes effect with the next packet.";
    MANUAL_ADVANCED READ_ADDRESS_MIXED "read address and mixed mode"
        forms![read(G1, G1, fields![MIXED]), read(G2, G4, fields![ADDRESS, MIXED])];
    MANUAL_ADVANCED SET_SIGNAL "signal properties" SET_SIGNAL, note OUTPUT_RANGE;
    MANUAL_ADVANCED READ_SIGNALS "read signal properties" READ_SIGNALS,
        note "The manual prints a further 0xFF after the reply; no client reads one.";
    MANUAL_ADVANCED SET_STREAM "stream properties" forms![write(G1, G4, Effect::Setting, SET_STREAM)];
    MANUAL_ADVANCED READ_STREAMS "read stream properties"
        reads![counted(name::STREAMS, STREAM, "one record for each stream, USB first")];
    MANUAL_ADVANCED READ_SIGNAL_VALUES "read signal values"
        reads![counted(name::SIGNALS, VALUES, "one record for each signal")];
};

const MCP_PINS: ClientUse = ClientUse::Superseded("the MCP has 137 to 147 for its pins");
const OUTPUT_RANGE: &str =
    "The manual's text gives outputs up to 2068, its screens up to 32767; 32767 is followed.";

const ACTION: Field = byte(name::ACTION, "what switches the output").codes(codes::DOUT_ACTIONS);
const ADDRESS: Field = byte(name::ADDRESS, "address of the unit").range(0x80, 0x87);
const MIXED: Field = byte(name::MIXED, "1 drives both motors as one differential drive").range(0, 1);
const PRIORITIES: &[Field] =
    fields![priority(name::LEVEL_1), priority(name::LEVEL_2), priority(name::LEVEL_3)];

const S3_TO_S5: &[Field] = fields![pin(name::S3), pin(name::S4), pin(name::S5)];
const S3_TO_D2: &[Field] = fields![pin(name::S3), pin(name::S4), pin(name::S5), pin(name::D1), pin(name::D2)];
const SET_PINS: &[Form] =
    forms![write(G1, G3, Effect::Setting, S3_TO_S5), write(G4, G4, Effect::Setting, S3_TO_D2)];
const READ_PINS: &[Form] = forms![read(G1, G3, S3_TO_S5), read(G4, G4, S3_TO_D2)];

const DEADBAND: &[Field] = fields![deadband(name::DEADBAND_MIN), deadband(name::DEADBAND_MAX)];
const DEADBANDS: &[Field] =
    fields![deadband(name::S1_MIN), deadband(name::S1_MAX), deadband(name::S2_MIN), deadband(name::S2_MAX)];
const CONTROL: &[Field] = fields![
    deadband(name::S1_REVERSE_DEADBAND),
    deadband(name::S1_FORWARD_DEADBAND),
    control(name::S1_REVERSE_LIMIT),
    control(name::S1_FORWARD_LIMIT),
    control(name::S1_CENTER),
    control(name::S1_MIN),
    control(name::S1_MAX),
    deadband(name::S2_REVERSE_DEADBAND),
    deadband(name::S2_FORWARD_DEADBAND),
    control(name::S2_REVERSE_LIMIT),
    control(name::S2_FORWARD_LIMIT),
    control(name::S2_CENTER),
    control(name::S2_MIN),
    control(name::S2_MAX),
];
const SET_CONTROL: &[Form] = forms![
    write(G1, G2, Effect::Setting, DEADBAND),
    write(G3, G3, Effect::Setting, DEADBANDS),
    write(G4, G4, Effect::Setting, CONTROL),
];
const READ_CONTROL: &[Form] = forms![read(G1, G2, DEADBAND), read(G3, G3, DEADBANDS), read(G4, G4, CONTROL)];

/// A list of signal properties, with the index before them in a write.
macro_rules! signal {
    (index: [$($index:expr)?], actions: $actions:ident, low_pass: [$($low_pass:expr)?], potentiometer: [$($potentiometer:expr)?]) => {
        fields![
            $($index,)?
            byte(name::TYPE, "what the pin measures").codes(codes::SIGNAL_TYPES),
            byte(name::MODE, "which of its values becomes the command").codes(codes::SIGNAL_MODES),
            byte(name::TARGET, "which motors it drives").codes(codes::SIGNAL_TARGETS),
            $actions(name::MIN_ACTION, "what happens at the minimum"),
            $actions(name::MAX_ACTION, "what happens at the maximum"),
            $($low_pass,)?
            field(name::TIMEOUT, Kind::U32, "time without a change after which the signal is idle")
                .unit(Unit::Milliseconds),
            field(name::LOAD_HOME, Kind::I32, "position that a load-home action sets"),
            field(name::MIN, Kind::I32, "least position"),
            field(name::MAX, Kind::I32, "greatest position"),
            field(name::CENTER, Kind::I32, "middle of the input"),
            field(name::DEADBAND, Kind::U32, "range around the center that counts as zero"),
            field(name::POWER_EXPONENT, Kind::I32, "curve of the input; 0 is linear")
                .scaled(Unit::Gain, 1.0 / scale::POWER_EXPONENT, 4)
                .range(-524_288, 524_288),
            field(name::MIN_OUTPUT, Kind::I32, "output at the minimum").range(-32_767, 32_767),
            field(name::MAX_OUTPUT, Kind::I32, "output at the maximum").range(-32_767, 32_767),
            field(name::POWER_MIN, Kind::U32, "offset added to an output that is not zero"),
            $($potentiometer,)?
        ]
    };
}

const INDEX: Field = byte(name::INDEX, "signal, counted from 0");
const LOW_PASS: Field = byte(name::LOW_PASS, "averages 2^n samples; 0 for none");
const POTENTIOMETER: Field = field(name::POTENTIOMETER, Kind::U32, "not described in public");

const SET_SIGNAL: &[Form] = forms![
    write(
        G1,
        G1,
        Effect::Setting,
        signal!(index: [INDEX], actions: action_byte, low_pass: [], potentiometer: [])
    ),
    write(
        G2,
        G2,
        Effect::Setting,
        signal!(index: [INDEX], actions: action_word, low_pass: [LOW_PASS], potentiometer: [])
    ),
    write(
        G3,
        G4,
        Effect::Setting,
        signal!(index: [INDEX], actions: action_word, low_pass: [LOW_PASS], potentiometer: [POTENTIOMETER])
    ),
];
const SIGNAL_1: &[Field] = signal!(index: [], actions: action_byte, low_pass: [], potentiometer: []);
const SIGNAL_2: &[Field] = signal!(index: [], actions: action_word, low_pass: [LOW_PASS], potentiometer: []);
const SIGNAL_3: &[Field] =
    signal!(index: [], actions: action_word, low_pass: [LOW_PASS], potentiometer: [POTENTIOMETER]);
const READ_SIGNALS: &[Form] = forms![
    read(G1, G1, fields![counted(name::SIGNALS, SIGNAL_1, "one record for each pin of the model")]),
    read(G2, G2, fields![counted(name::SIGNALS, SIGNAL_2, "one record for each pin of the model")]),
    read(G3, G4, fields![counted(name::SIGNALS, SIGNAL_3, "one record for each pin of the model")]),
];

const TYPE: Field = byte(name::TYPE, "what speaks on the stream").codes(codes::STREAM_TYPES);
const RATE: Field = field(name::RATE, Kind::U32, "speed of the port").unit(Unit::BitsPerSecond);
const TIMEOUT: Field =
    field(name::TIMEOUT, Kind::U32, "time without a byte after which the stream is idle; 0 for never")
        .unit(Unit::Milliseconds);
const STREAM: &[Field] = fields![TYPE, RATE, TIMEOUT];
const SET_STREAM: &[Field] =
    fields![byte(name::INDEX, "the stream").codes(codes::STREAMS), TYPE, RATE, TIMEOUT];

const VALUES: &[Field] = fields![
    field(name::COMMAND, Kind::I32, "the value that the mode selects"),
    field(name::POSITION, Kind::I32, "position of the signal"),
    field(name::PERCENT, Kind::I32, "position as a share of full output"),
    field(name::SPEED, Kind::I32, "speed at this moment"),
    field(name::AVERAGE_SPEED, Kind::I32, "averaged speed"),
];

const fn counted(name: impl Name, fields: &'static [Field], doc: &'static str) -> Field {
    field(name, Kind::Counted(fields), doc)
}

const fn priority(name: impl Name) -> Field {
    byte(name, "what drives the motors at this level").codes(codes::PRIORITY_SIGNALS)
}

const fn pin(name: impl Name) -> Field {
    byte(name, "function of the pin")
}

const fn deadband(name: impl Name) -> Field {
    byte(name, "range around the center that counts as zero")
}

const fn control(name: impl Name) -> Field {
    field(name, Kind::U16, "of the control input")
}

const fn action_byte(name: impl Name, doc: &'static str) -> Field {
    byte(name, doc).codes(codes::SIGNAL_ACTIONS_GENERATION_1)
}

const fn action_word(name: impl Name, doc: &'static str) -> Field {
    field(name, Kind::U16, doc).codes(codes::SIGNAL_ACTIONS)
}
