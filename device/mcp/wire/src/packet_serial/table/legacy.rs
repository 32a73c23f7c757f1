//! Commands 0 to 13, 26 and 27: the compatibility commands with one byte of argument.

use super::super::command::{ClientUse, Command, Effect, Form};
use super::super::field::byte;
use super::super::name;
use super::super::number;
use super::{G1, G3, G4, MANUAL_ADVANCED, MANUAL_LEGACY, fields, forms, write};
use brushwork_values::Field;

const NOT_SENT: &str =
    "Libraries of 2025 no longer send it. Firmware 4.3.6 and later drives and does not acknowledge.";
const ASSUMED: &str = "libraries of generation 4 do not send it; taken as in generation 3";
const DUTY: ClientUse = ClientUse::Superseded("the signed duty commands 32 to 34 say the same with 16 bits");
const VOLTAGES: ClientUse = ClientUse::Superseded("57 and 58 set both limits in tenths of a volt");

pub(super) const ROWS: &[Command] = &[
    drive(number::FORWARD_M1, "drive M1 forward", ONE_WAY),
    drive(number::BACKWARD_M1, "drive M1 backward", ONE_WAY),
    limit(number::SET_MAIN_VOLTAGE_MIN, "minimum main voltage (old form)", MANUAL_LEGACY, MIN),
    limit(number::SET_MAIN_VOLTAGE_MAX, "maximum main voltage (old form)", MANUAL_LEGACY, MAX),
    drive(number::FORWARD_M2, "drive M2 forward", ONE_WAY),
    drive(number::BACKWARD_M2, "drive M2 backward", ONE_WAY),
    drive(number::DRIVE_7BIT_M1, "drive M1 (7 bit)", TWO_WAY),
    drive(number::DRIVE_7BIT_M2, "drive M2 (7 bit)", TWO_WAY),
    drive(number::MIXED_FORWARD, "drive forward (mixed)", ONE_WAY),
    drive(number::MIXED_BACKWARD, "drive backward (mixed)", ONE_WAY),
    drive(number::MIXED_RIGHT, "turn right (mixed)", ONE_WAY),
    drive(number::MIXED_LEFT, "turn left (mixed)", ONE_WAY),
    drive(number::MIXED_DRIVE_7BIT, "drive (mixed, 7 bit)", TWO_WAY),
    drive(number::MIXED_TURN_7BIT, "turn (mixed, 7 bit)", TWO_WAY),
    limit(number::SET_LOGIC_VOLTAGE_MIN, "minimum logic voltage (old form)", MANUAL_ADVANCED, MIN),
    limit(number::SET_LOGIC_VOLTAGE_MAX, "maximum logic voltage (old form)", MANUAL_ADVANCED, MAX),
];

const POWER: &[Field] = fields![byte(name::POWER, "0 stops, 127 is full power").range(0, 127)];

/// The manual's text for 13 says "0 = stop"; all clients and command 12 have 64.
const SIGNED_POWER: &[Field] =
    fields![byte(name::POWER, "1 is full power backward or left, 64 stops, 127 is full power").range(0, 127)];

const MIN_STEP: &[Field] = fields![byte(name::VALUE, "6 V plus 0.2 V for each count").range(0, 140)];
const MAX_STEP: &[Field] = fields![byte(name::VALUE, "5.12 counts for each volt").range(30, 175)];

const ONE_WAY: &[Form] =
    forms![write(G1, G3, Effect::Motion, POWER), write(G4, G4, Effect::Motion, POWER).assumed(ASSUMED)];
const TWO_WAY: &[Form] = forms![
    write(G1, G3, Effect::Motion, SIGNED_POWER),
    write(G4, G4, Effect::Motion, SIGNED_POWER).assumed(ASSUMED)
];
const MIN: &[Form] = forms![
    write(G1, G3, Effect::Setting, MIN_STEP),
    write(G4, G4, Effect::Setting, MIN_STEP).assumed(ASSUMED)
];
const MAX: &[Form] = forms![
    write(G1, G3, Effect::Setting, MAX_STEP),
    write(G4, G4, Effect::Setting, MAX_STEP).assumed(ASSUMED)
];

const fn drive(number: u8, title: &'static str, forms: &'static [Form]) -> Command {
    Command::new(number, title, MANUAL_LEGACY, forms).client(DUTY).note(NOT_SENT)
}

const fn limit(number: u8, title: &'static str, source: &'static str, forms: &'static [Form]) -> Command {
    Command::new(number, title, source, forms).client(VOLTAGES).note("Sets one limit of commands 57 and 58.")
}
