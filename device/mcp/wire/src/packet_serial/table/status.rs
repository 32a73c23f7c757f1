//! What a unit reports about itself: version, voltages, temperatures, currents, status.

use super::super::command::{Command, Form};
use super::super::field::{amps, byte, celsius, duty, field, position, speed, volts};
use super::super::name::{self, Name};
use super::{CLIENTS, G1, G2, G3, G4, MANUAL_ADVANCED, MANUAL_MOTION, fields, forms, read, reads, rows};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    MANUAL_ADVANCED READ_VERSION "read version"
        reads![field(name::VERSION, Kind::Text { max: 48 }, "model and firmware version")];
    MANUAL_ADVANCED READ_MAIN_BATTERY "read main battery" reads![volts(name::MAIN_BATTERY)];
    MANUAL_ADVANCED READ_LOGIC_BATTERY "read logic battery" reads![volts(name::LOGIC_BATTERY)];
    MANUAL_MOTION READ_BUFFERS "read buffer lengths" reads![buffer(name::BUFFER_M1), buffer(name::BUFFER_M2)],
        note "Clients of 2025 say that 0 means empty; the manual's 0x80 is followed.";
    MANUAL_ADVANCED READ_PWMS "read motor PWM" reads![duty(name::DUTY_M1), duty(name::DUTY_M2)];
    MANUAL_ADVANCED READ_CURRENTS "read motor currents"
        reads![amps(name::CURRENT_M1), amps(name::CURRENT_M2)],
        note "The manual gives no sign; most clients read it with one.";
    CLIENTS READ_ALL_STATUS "read all status" forms![read(G4, G4, ALL_STATUS)],
        note "Firmware 4.2.8 does not answer it.";
    MANUAL_ADVANCED READ_TEMPERATURE_1 "read temperature 1" reads![celsius(name::TEMPERATURE_1)];
    MANUAL_ADVANCED READ_TEMPERATURE_2 "read temperature 2" reads![celsius(name::TEMPERATURE_2)],
        note "Only on units with a second sensor.";
    MANUAL_ADVANCED READ_STATUS "read status" STATUS,
        note "The bits mean different things in two bytes and in four; see the table of status bits.";
};

const STATUS: &[Form] = forms![
    read(G1, G2, fields![field(name::STATUS, Kind::U16, "state of the unit").unit(Unit::Status)]),
    read(G3, G4, fields![field(name::STATUS, Kind::U32, "state of the unit").unit(Unit::Status)]),
];

const ALL_STATUS: &[Field] = fields![
    field(name::TICK, Kind::U32, "running time of the unit"),
    field(name::STATUS, Kind::U32, "as command 90").unit(Unit::Status),
    celsius(name::TEMPERATURE_1),
    celsius(name::TEMPERATURE_2),
    volts(name::MAIN_BATTERY),
    volts(name::LOGIC_BATTERY),
    duty(name::DUTY_M1),
    duty(name::DUTY_M2),
    amps(name::CURRENT_M1),
    amps(name::CURRENT_M2),
    position(name::ENCODER_M1),
    position(name::ENCODER_M2),
    speed(name::SPEED_M1),
    speed(name::SPEED_M2),
    speed(name::RAW_SPEED_M1),
    speed(name::RAW_SPEED_M2),
    error(name::SPEED_ERROR_M1, Unit::CountsPerSecond),
    error(name::SPEED_ERROR_M2, Unit::CountsPerSecond),
    error(name::POSITION_ERROR_M1, Unit::Counts),
    error(name::POSITION_ERROR_M2, Unit::Counts),
];

const fn buffer(name: impl Name) -> Field {
    byte(name, "commands waiting, at most 63; 0 means the last one runs, 0x80 that all are done")
}

/// Clients differ in the sign; read as signed.
const fn error(name: impl Name, unit: Unit) -> Field {
    field(name, Kind::I16, "how far the motor is from its setpoint").unit(unit)
}
