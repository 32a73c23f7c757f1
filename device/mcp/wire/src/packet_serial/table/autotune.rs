//! The relay test behind auto-tuning (public clients, 2015-2020).

use super::super::command::{Command, Effect, Form};
use super::super::field::field;
use super::super::name;
use super::super::number;
use super::{CLIENTS, G1, G2, G3, G4, fields, forms, read, write};
use brushwork_values::{Field, Kind};

pub(super) const ROWS: &[Command] = &[
    start(number::AUTOTUNE_VELOCITY_M1, "M1 velocity relay test"),
    start(number::AUTOTUNE_VELOCITY_M2, "M2 velocity relay test"),
    start(number::AUTOTUNE_POSITION_M1, "M1 position relay test"),
    start(number::AUTOTUNE_POSITION_M2, "M2 position relay test"),
    result(number::READ_AUTOTUNE_M1, "read M1 relay test"),
    result(number::READ_AUTOTUNE_M2, "read M2 relay test"),
];

const NOT_IN_LIBRARY: &str = "libraries of generation 4 do not send it; taken as in generation 3";

const AMPLITUDE: Field = field(name::AMPLITUDE, Kind::U32, "duty of the relay, as raw duty");
const HYSTERESIS: Field = field(name::HYSTERESIS, Kind::U32, "error at which the relay switches");

const START: &[Form] = forms![
    write(G1, G2, Effect::RelativeMotion, fields![AMPLITUDE]),
    write(G3, G3, Effect::RelativeMotion, fields![AMPLITUDE, HYSTERESIS]),
    write(G4, G4, Effect::RelativeMotion, fields![AMPLITUDE, HYSTERESIS]).assumed(NOT_IN_LIBRARY),
];

const RESULT: &[Field] = fields![
    field(name::AMPLITUDE, Kind::U32, "amplitude of the oscillation found"),
    field(name::PERIOD, Kind::U32, "period of the oscillation found; its unit is not public"),
];

const READ: &[Form] = forms![read(G1, G3, RESULT), read(G4, G4, RESULT).assumed(NOT_IN_LIBRARY)];

const fn start(number: u8, title: &'static str) -> Command {
    Command::new(number, title, CLIENTS, START)
        .note("The formula that turns its result into gains runs in the vendor's program and is not public.")
}

const fn result(number: u8, title: &'static str) -> Command {
    Command::new(number, title, CLIENTS, READ)
}
