//! Pins and streams: signals, digital outputs, priorities, serial ports (MCP manual 1.9).

use super::super::command::{ClientUse, Command, Effect, Form, Simulated};
use super::super::field::byte;
use super::super::{number, scale};
use super::{CLIENTS, G1, G2, G3, G4, MANUAL_ADVANCED, fields, forms, read, write};
use crate::codes;
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = &[
    Command::new(number::SET_PIN_FUNCTIONS, "set_pin_functions", "pin functions", CLIENTS, SET_PINS)
        .simulated(ROBOCLAW_PINS)
        .client(MCP_PINS),
    Command::new(number::READ_PIN_FUNCTIONS, "read_pin_functions", "read pin functions", CLIENTS, READ_PINS)
        .simulated(ROBOCLAW_PINS)
        .client(MCP_PINS),
    Command::new(
        number::SET_CONTROL_SETTINGS,
        "set_control_settings",
        "control input settings",
        CLIENTS,
        SET_CONTROL,
    )
    .simulated(ROBOCLAW_PINS)
    .client(MCP_PINS),
    Command::new(
        number::READ_CONTROL_SETTINGS,
        "read_control_settings",
        "read control input settings",
        CLIENTS,
        READ_CONTROL,
    )
    .simulated(ROBOCLAW_PINS)
    .client(MCP_PINS),
    manual(
        number::SET_DOUT_ACTION,
        "set_dout_action",
        "digital output action",
        forms![write(G1, G4, Effect::Setting, fields![byte("index", "output, counted from 0"), ACTION])],
    )
    .note("The manual prints no reply."),
    manual(
        number::READ_DOUT_ACTIONS,
        "read_dout_actions",
        "read digital output actions",
        forms![read(
            G1,
            G4,
            fields![counted("douts", fields![ACTION], "one record for each output of the model")]
        )],
    ),
    manual(
        number::SET_PRIORITIES,
        "set_priorities",
        "priority levels",
        forms![write(G1, G4, Effect::Setting, PRIORITIES)],
    ),
    manual(
        number::READ_PRIORITIES,
        "read_priorities",
        "read priority levels",
        forms![read(G1, G4, PRIORITIES)],
    ),
    manual(
        number::SET_ADDRESS_MIXED,
        "set_address_mixed",
        "address and mixed mode",
        forms![write(G1, G4, Effect::Setting, fields![ADDRESS, MIXED])],
    )
    .note("Takes effect with the next packet."),
    manual(
        number::READ_ADDRESS_MIXED,
        "read_address_mixed",
        "read address and mixed mode",
        forms![read(G1, G1, fields![MIXED]), read(G2, G4, fields![ADDRESS, MIXED])],
    ),
    manual(number::SET_SIGNAL, "set_signal", "signal properties", SET_SIGNAL).note(OUTPUT_RANGE),
    manual(number::READ_SIGNALS, "read_signals", "read signal properties", READ_SIGNALS)
        .note("The manual prints a further 0xFF after the reply; no client reads one."),
    manual(
        number::SET_STREAM,
        "set_stream",
        "stream properties",
        forms![write(G1, G4, Effect::Setting, SET_STREAM)],
    ),
    manual(
        number::READ_STREAMS,
        "read_streams",
        "read stream properties",
        forms![read(G1, G4, fields![counted("streams", STREAM, "one record for each stream, USB first")])],
    ),
    manual(
        number::READ_SIGNAL_VALUES,
        "read_signal_values",
        "read signal values",
        forms![read(G1, G4, fields![counted("signals", VALUES, "one record for each signal")])],
    ),
];

const ROBOCLAW_PINS: Simulated =
    Simulated::StoredOnly("RoboClaw pins; the simulated inputs are those of the MCP, set by 143");
const MCP_PINS: ClientUse = ClientUse::Superseded("the MCP has 137 to 147 for its pins");
const OUTPUT_RANGE: &str =
    "The manual's text gives outputs up to 2068, its screens up to 32767; 32767 is followed.";

const ACTION: Field = byte("action", "what switches the output").codes(codes::DOUT_ACTIONS);
const ADDRESS: Field = byte("address", "address of the unit").range(0x80, 0x87);
const MIXED: Field = byte("mixed", "1 drives both motors as one differential drive").range(0, 1);
const PRIORITIES: &[Field] = fields![priority("level_1"), priority("level_2"), priority("level_3")];

const S3_TO_S5: &[Field] = fields![pin("s3"), pin("s4"), pin("s5")];
const S3_TO_D2: &[Field] = fields![pin("s3"), pin("s4"), pin("s5"), pin("d1"), pin("d2")];
const SET_PINS: &[Form] =
    forms![write(G1, G3, Effect::Setting, S3_TO_S5), write(G4, G4, Effect::Setting, S3_TO_D2)];
const READ_PINS: &[Form] = forms![read(G1, G3, S3_TO_S5), read(G4, G4, S3_TO_D2)];

const DEADBAND: &[Field] = fields![deadband("deadband_min"), deadband("deadband_max")];
const DEADBANDS: &[Field] =
    fields![deadband("s1_min"), deadband("s1_max"), deadband("s2_min"), deadband("s2_max")];
const CONTROL: &[Field] = fields![
    deadband("s1_reverse_deadband"),
    deadband("s1_forward_deadband"),
    control("s1_reverse_limit"),
    control("s1_forward_limit"),
    control("s1_center"),
    control("s1_min"),
    control("s1_max"),
    deadband("s2_reverse_deadband"),
    deadband("s2_forward_deadband"),
    control("s2_reverse_limit"),
    control("s2_forward_limit"),
    control("s2_center"),
    control("s2_min"),
    control("s2_max"),
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
            byte("type", "what the pin measures").codes(codes::SIGNAL_TYPES),
            byte("mode", "which of its values becomes the command").codes(codes::SIGNAL_MODES),
            byte("target", "which motors it drives").codes(codes::SIGNAL_TARGETS),
            $actions("min_action", "what happens at the minimum"),
            $actions("max_action", "what happens at the maximum"),
            $($low_pass,)?
            Field::new("timeout", Kind::U32, "time without a change after which the signal is idle")
                .unit(Unit::Milliseconds),
            Field::new("load_home", Kind::I32, "position that a load-home action sets"),
            Field::new("min", Kind::I32, "least position"),
            Field::new("max", Kind::I32, "greatest position"),
            Field::new("center", Kind::I32, "middle of the input"),
            Field::new("deadband", Kind::U32, "range around the center that counts as zero"),
            Field::new("power_exponent", Kind::I32, "curve of the input; 0 is linear")
                .scaled(Unit::Gain, 1.0 / scale::POWER_EXPONENT, 4)
                .range(-524_288, 524_288),
            Field::new("min_output", Kind::I32, "output at the minimum").range(-32_767, 32_767),
            Field::new("max_output", Kind::I32, "output at the maximum").range(-32_767, 32_767),
            Field::new("power_min", Kind::U32, "offset added to an output that is not zero"),
            $($potentiometer,)?
        ]
    };
}

const INDEX: Field = byte("index", "signal, counted from 0");
const LOW_PASS: Field = byte("low_pass", "averages 2^n samples; 0 for none");
const POTENTIOMETER: Field = Field::new("potentiometer", Kind::U32, "not described in public");

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
    read(G1, G1, fields![counted("signals", SIGNAL_1, "one record for each pin of the model")]),
    read(G2, G2, fields![counted("signals", SIGNAL_2, "one record for each pin of the model")]),
    read(G3, G4, fields![counted("signals", SIGNAL_3, "one record for each pin of the model")]),
];

const TYPE: Field = byte("type", "what speaks on the stream").codes(codes::STREAM_TYPES);
const RATE: Field = Field::new("rate", Kind::U32, "speed of the port").unit(Unit::BitsPerSecond);
const TIMEOUT: Field =
    Field::new("timeout", Kind::U32, "time without a byte after which the stream is idle; 0 for never")
        .unit(Unit::Milliseconds);
const STREAM: &[Field] = fields![TYPE, RATE, TIMEOUT];
const SET_STREAM: &[Field] = fields![byte("index", "the stream").codes(codes::STREAMS), TYPE, RATE, TIMEOUT];

const VALUES: &[Field] = fields![
    Field::new("command", Kind::I32, "the value that the mode selects"),
    Field::new("position", Kind::I32, "position of the signal"),
    Field::new("percent", Kind::I32, "position as a share of full output"),
    Field::new("speed", Kind::I32, "speed at this moment"),
    Field::new("average_speed", Kind::I32, "averaged speed"),
];

const fn manual(number: u8, key: &'static str, title: &'static str, forms: &'static [Form]) -> Command {
    Command::new(number, key, title, MANUAL_ADVANCED, forms)
}

const fn counted(name: &'static str, fields: &'static [Field], doc: &'static str) -> Field {
    Field::new(name, Kind::Counted(fields), doc)
}

const fn priority(name: &'static str) -> Field {
    byte(name, "what drives the motors at this level").codes(codes::PRIORITY_SIGNALS)
}

const fn pin(name: &'static str) -> Field {
    byte(name, "function of the pin")
}

const fn deadband(name: &'static str) -> Field {
    byte(name, "range around the center that counts as zero")
}

const fn control(name: &'static str) -> Field {
    Field::new(name, Kind::U16, "of the control input")
}

const fn action_byte(name: &'static str, doc: &'static str) -> Field {
    byte(name, doc).codes(codes::SIGNAL_ACTIONS_GENERATION_1)
}

const fn action_word(name: &'static str, doc: &'static str) -> Field {
    Field::new(name, Kind::U16, doc).codes(codes::SIGNAL_ACTIONS)
}
