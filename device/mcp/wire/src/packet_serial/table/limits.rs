//! Limits of voltage, current and control error, and the emergency stop.

use super::super::command::{Command, Effect, Form, Simulated};
use super::super::field::{byte, field, volts};
use super::super::name::{self, Name};
use super::super::scale;
use super::{CLIENTS, G1, G3, G4, MANUAL_ADVANCED, fields, forms, read, reads, rows, sets, write};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    MANUAL_ADVANCED SET_MAIN_VOLTAGES "main voltage limits" SET_MAIN,
        note "The simulated controller only stores the automatic offset of generation 4.";
    MANUAL_ADVANCED SET_LOGIC_VOLTAGES "logic voltage limits" SET_LOGIC;
    MANUAL_ADVANCED READ_MAIN_VOLTAGES "read main voltage limits" READ_MAIN;
    MANUAL_ADVANCED READ_LOGIC_VOLTAGES "read logic voltage limits" READ_LOGIC;
    CLIENTS SET_SPEED_ERROR_LIMITS "speed error limits"
        forms![
            write(G3, G3, Effect::Setting, fields![wide(name::LIMIT_M1, SPEED), wide(name::LIMIT_M2, SPEED)]),
            write(G4, G4, Effect::Setting, fields![narrow(name::LIMIT_M1, SPEED), narrow(name::LIMIT_M2, SPEED)]),
        ];
    CLIENTS READ_SPEED_ERROR_LIMITS "read speed error limits"
        forms![
            read(G3, G3, fields![wide(name::LIMIT_M1, SPEED), wide(name::LIMIT_M2, SPEED)]),
            read(G4, G4, fields![narrow(name::LIMIT_M1, SPEED), narrow(name::LIMIT_M2, SPEED)]),
        ];
    CLIENTS READ_SPEED_ERRORS "read speed errors"
        forms![
            read(G3, G3, fields![error(name::ERROR_M1, SPEED), error(name::ERROR_M2, SPEED)]),
            read(G4, G4, fields![narrow_error(name::ERROR_M1, SPEED), narrow_error(name::ERROR_M2, SPEED)]),
        ];
    CLIENTS SET_POSITION_ERROR_LIMITS "position error limits"
        forms![
            write(G3, G3, Effect::Setting, fields![wide(name::LIMIT_M1, POSITION), wide(name::LIMIT_M2, POSITION)]),
            write(G4, G4, Effect::Setting, fields![narrow(name::LIMIT_M1, POSITION), narrow(name::LIMIT_M2, POSITION)]),
        ], note "The vendor says that these limits act only where acceleration and deceleration are set.";
    CLIENTS READ_POSITION_ERROR_LIMITS "read position error limits"
        forms![
            read(G3, G3, fields![wide(name::LIMIT_M1, POSITION), wide(name::LIMIT_M2, POSITION)]),
            read(G4, G4, fields![narrow(name::LIMIT_M1, POSITION), narrow(name::LIMIT_M2, POSITION)]),
        ];
    CLIENTS READ_POSITION_ERRORS "read position errors"
        forms![
            read(G3, G3, fields![error(name::ERROR_M1, POSITION), error(name::ERROR_M2, POSITION)]),
            read(G4, G4, fields![narrow_error(name::ERROR_M1, POSITION), narrow_error(name::ERROR_M2, POSITION)]),
        ];
    CLIENTS SET_VOLTAGE_OFFSETS "voltage offsets"
        forms![write(G3, G4, Effect::Setting, fields![offset(name::MAIN), offset(name::LOGIC)])];
    CLIENTS READ_VOLTAGE_OFFSETS "read voltage offsets"
        forms![read(G3, G4, fields![offset(name::MAIN), offset(name::LOGIC)])];
    CLIENTS SET_CONTROL_LIMITS "control input limits" forms![write(G3, G3, Effect::Setting, CONTROL_LIMITS)],
        simulated CONTROL_INPUTS, note BLANKING;
    CLIENTS READ_CONTROL_LIMITS "read control input limits" forms![read(G3, G3, CONTROL_LIMITS)],
        simulated CONTROL_INPUTS, note BLANKING;
    MANUAL_ADVANCED SET_CURRENT_LIMITS_M1 "M1 current limits" SET_CURRENT,
        note "The manual prints command byte 134 and zeros for the minimum. From 2018 the minimum is sent as a positive magnitude.";
    MANUAL_ADVANCED SET_CURRENT_LIMITS_M2 "M2 current limits" SET_CURRENT,
        note "From 2018 the minimum is sent as a positive magnitude.";
    MANUAL_ADVANCED READ_CURRENT_LIMITS_M1 "read M1 current limits" READ_CURRENT;
    MANUAL_ADVANCED READ_CURRENT_LIMITS_M2 "read M2 current limits" READ_CURRENT;
    MANUAL_ADVANCED RESET_ESTOP "reset E-stop" sets![],
        note "Does nothing unless the reset is unlocked (201).";
    MANUAL_ADVANCED SET_ESTOP_LOCK "E-stop reset lock" sets![LOCK],
        note "The manual prints neither argument nor CRC, and the reply of 202.";
    MANUAL_ADVANCED READ_ESTOP_LOCK "read E-stop reset lock" reads![LOCK];
};

const CONTROL_INPUTS: Simulated = Simulated::StoredOnly(
    "sources disagree on what it sets: limits of the inputs, or the duty below which no current is measured",
);
const BLANKING: &str =
    "The RoboClaw manual of 2018 calls the number current blanking, with two values of two bytes.";

const SPEED: Unit = Unit::CountsPerSecond;
const POSITION: Unit = Unit::Counts;

const AUTO_OFFSET: Field = byte(name::AUTO_OFFSET, "automatic offset in tenths of a volt").scaled(
    Unit::Volts,
    scale::VOLTAGE_VOLTS,
    1,
);
const SET_MAIN: &[Form] = forms![
    write(G1, G3, Effect::Setting, fields![volts(name::MIN), volts(name::MAX)]),
    write(G4, G4, Effect::Setting, fields![volts(name::MIN), volts(name::MAX), AUTO_OFFSET]),
];
const READ_MAIN: &[Form] = forms![
    read(G1, G3, fields![volts(name::MIN), volts(name::MAX)]),
    read(G4, G4, fields![volts(name::MIN), volts(name::MAX), AUTO_OFFSET]),
];
const SET_LOGIC: &[Form] = sets![volts(name::MIN), volts(name::MAX)];
const READ_LOGIC: &[Form] = reads![volts(name::MIN), volts(name::MAX)];

const SET_CURRENT: &[Form] = sets![limit_amps(name::MAX), limit_amps(name::MIN)];
const READ_CURRENT: &[Form] = reads![limit_amps(name::MAX), limit_amps(name::MIN)];

const CONTROL_LIMITS: &[Field] = fields![
    control_limit(name::S1_MIN),
    control_limit(name::S1_MAX),
    control_limit(name::S2_MIN),
    control_limit(name::S2_MAX)
];

const LOCK: Field =
    byte(name::LOCK, "0xAA lets software reset; 0x55 resets by itself (generation 4); else only hardware");

const fn wide(name: impl Name, unit: Unit) -> Field {
    field(name, Kind::U32, "error at which the motor is stopped; 0 for none").unit(unit)
}

const fn narrow(name: impl Name, unit: Unit) -> Field {
    field(name, Kind::U16, "error at which the motor is stopped; 0 for none").unit(unit)
}

const fn error(name: impl Name, unit: Unit) -> Field {
    field(name, Kind::I32, "how far the motor is from its setpoint").unit(unit)
}

/// Clients read two bytes without a sign.
const fn narrow_error(name: impl Name, unit: Unit) -> Field {
    field(name, Kind::U16, "magnitude of how far the motor is from its setpoint").unit(unit)
}

const fn offset(name: impl Name) -> Field {
    field(name, Kind::I8, "added to the measured voltage, in tenths of a volt")
        .scaled(Unit::Volts, scale::VOLTAGE_VOLTS, 1)
        .range(-10, 10)
}

const fn control_limit(name: impl Name) -> Field {
    field(name, Kind::U16, "share of the output that an input may command").scaled(
        Unit::Percent,
        100.0 / scale::DEFAULT_SPEED_RAW,
        2,
    )
}

const fn limit_amps(name: impl Name) -> Field {
    field(name, Kind::I32, "current in steps of 10 mA").scaled(Unit::Amps, scale::CURRENT_AMPS, 2)
}
