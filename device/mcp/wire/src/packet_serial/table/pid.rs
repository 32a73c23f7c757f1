//! Velocity and position PID, default accelerations and speeds, inductance and resistance.

use super::super::command::{Command, Effect, Form, Simulated};
use super::super::field::{duty_accel, field, position};
use super::super::name::{self, Name};
use super::super::scale;
use super::{
    CLIENTS, G1, G2, G3, G4, MANUAL_ADVANCED, MANUAL_MOTION, fields, forms, read, reads, rows, sets, write,
};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    MANUAL_MOTION SET_VELOCITY_PID_M1 "M1 velocity PID" SET_VELOCITY;
    MANUAL_MOTION SET_VELOCITY_PID_M2 "M2 velocity PID" SET_VELOCITY;
    MANUAL_MOTION READ_VELOCITY_PID_M1 "read M1 velocity PID" READ_VELOCITY, note ORDER;
    MANUAL_MOTION READ_VELOCITY_PID_M2 "read M2 velocity PID" READ_VELOCITY, note ORDER;
    MANUAL_MOTION SET_POSITION_PID_M1 "M1 position PID" SET_POSITION, note FACTOR;
    MANUAL_MOTION SET_POSITION_PID_M2 "M2 position PID" SET_POSITION, note FACTOR;
    MANUAL_MOTION READ_POSITION_PID_M1 "read M1 position PID" READ_POSITION, note NO_LINE;
    MANUAL_MOTION READ_POSITION_PID_M2 "read M2 position PID" READ_POSITION, note NO_LINE;
    MANUAL_MOTION SET_DEFAULT_ACCEL_M1 "M1 default acceleration" SET_ACCEL;
    MANUAL_MOTION SET_DEFAULT_ACCEL_M2 "M2 default acceleration" SET_ACCEL;
    CLIENTS SET_DEFAULT_SPEED_M1 "M1 default speed" SET_SPEED;
    CLIENTS SET_DEFAULT_SPEED_M2 "M2 default speed" SET_SPEED;
    CLIENTS READ_DEFAULT_SPEEDS "read default speeds"
        forms![read(G3, G4, fields![default_speed(name::SPEED_M1), default_speed(name::SPEED_M2)])];
    MANUAL_MOTION READ_DEFAULT_ACCELS "read default accelerations" READ_ACCELS;
    MANUAL_ADVANCED SET_INDUCTANCE_RESISTANCE_M1 "M1 inductance and resistance" SET_LR, note TWO_TO_24;
    MANUAL_ADVANCED SET_INDUCTANCE_RESISTANCE_M2 "M2 inductance and resistance" SET_LR, note TWO_TO_24;
    MANUAL_ADVANCED READ_INDUCTANCE_RESISTANCE_M1 "read M1 inductance and resistance" READ_LR, note TWO_TO_24;
    MANUAL_ADVANCED READ_INDUCTANCE_RESISTANCE_M2 "read M2 inductance and resistance" READ_LR, note TWO_TO_24;
    CLIENTS CALIBRATE_INDUCTANCE_RESISTANCE "calibrate inductance and resistance"
        forms![write(G1, G3, Effect::RelativeMotion, &[])],
        simulated Simulated::Inert("how the unit measures is not public");
};

const ORDER: &str = "Read in the order P, I, D, written in the order D, P, I.";
const FACTOR: &str = "The manual gives no factor for the gains; all vendor libraries use 1024.";
const NO_LINE: &str =
    "The manual's copy at hand lacks the receive line. Read in the order P, I, D, written D, P, I.";

const TWO_TO_24: &str =
    "L and R times 2^24. The vendor's Arduino library of 2025 sends floats and calls that a guess.";

const SET_VELOCITY: &[Form] = sets![
    velocity_gain(name::D, "D", 3),
    velocity_gain(name::P, "P", 1),
    velocity_gain(name::I, "I", 2),
    QPPS
];
const READ_VELOCITY: &[Form] = reads![
    velocity_gain(name::P, "P", 1),
    velocity_gain(name::I, "I", 2),
    velocity_gain(name::D, "D", 3),
    QPPS
];
const SET_POSITION: &[Form] = sets![
    position_gain(name::D, "D", 3),
    position_gain(name::P, "P", 1),
    position_gain(name::I, "I", 2),
    MAX_I,
    DEADZONE,
    MIN,
    MAX,
];
const READ_POSITION: &[Form] = reads![
    position_gain(name::P, "P", 1),
    position_gain(name::I, "I", 2),
    position_gain(name::D, "D", 3),
    MAX_I,
    DEADZONE,
    MIN,
    MAX,
];
const SET_ACCEL: &[Form] = forms![
    write(G1, G1, Effect::Setting, fields![duty_accel(name::ACCEL)]),
    write(G2, G4, Effect::Setting, fields![duty_accel(name::ACCEL), duty_accel(name::DECEL)]),
];
const READ_ACCELS: &[Form] = forms![
    read(G1, G1, fields![duty_accel(name::ACCEL_M1), duty_accel(name::ACCEL_M2)]),
    read(
        G2,
        G4,
        fields![
            duty_accel(name::ACCEL_M1),
            duty_accel(name::DECEL_M1),
            duty_accel(name::ACCEL_M2),
            duty_accel(name::DECEL_M2)
        ]
    ),
];
const SET_SPEED: &[Form] = forms![write(G3, G4, Effect::Setting, fields![default_speed(name::SPEED)])];
const SET_LR: &[Form] = sets![INDUCTANCE, RESISTANCE];
const READ_LR: &[Form] = reads![INDUCTANCE, RESISTANCE];

const QPPS: Field =
    field(name::QPPS, Kind::U32, "speed at full duty in counts per second; the feed-forward term")
        .label("QPPS");
const MAX_I: Field = field(name::MAX_I, Kind::U32, "greatest wind-up of the integral").label("max I");
const DEADZONE: Field =
    field(name::DEADZONE, Kind::U32, "distance from the setpoint that counts as there").unit(Unit::Counts);
const MIN: Field = position(name::MIN);
const MAX: Field = position(name::MAX);
const INDUCTANCE: Field =
    field(name::INDUCTANCE, Kind::U32, "of the armature; with the resistance selects torque control")
        .scaled(Unit::Henries, 1.0 / scale::INDUCTANCE_RESISTANCE, 7)
        .label("L");
const RESISTANCE: Field =
    field(name::RESISTANCE, Kind::U32, "of the armature; with the inductance selects torque control")
        .scaled(Unit::Ohms, 1.0 / scale::INDUCTANCE_RESISTANCE, 6)
        .label("R");

const fn velocity_gain(name: impl Name, label: &'static str, rank: u8) -> Field {
    gain(name, label, rank, scale::VELOCITY_GAIN, "gain times 65536")
}

const fn position_gain(name: impl Name, label: &'static str, rank: u8) -> Field {
    gain(name, label, rank, scale::POSITION_GAIN, "gain times 1024")
}

const fn gain(name: impl Name, label: &'static str, rank: u8, one: f64, doc: &'static str) -> Field {
    field(name, Kind::U32, doc).scaled(Unit::Gain, 1.0 / one, 5).label(label).rank(rank)
}

const fn default_speed(name: impl Name) -> Field {
    field(name, Kind::U16, "speed used where a command gives none").scaled(
        Unit::Percent,
        100.0 / scale::DEFAULT_SPEED_RAW,
        2,
    )
}
