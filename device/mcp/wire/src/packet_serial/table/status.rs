//! What a unit reports about itself: version, voltages, temperatures, currents, status.

use super::super::command::{Command, Form};
use super::super::field::{amps, byte, celsius, duty, position, speed, volts};
use super::super::number;
use super::{CLIENTS, G1, G2, G3, G4, MANUAL_ADVANCED, MANUAL_MOTION, fields, forms, read};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = &[
    Command::new(
        number::READ_VERSION,
        "read_version",
        "read version",
        MANUAL_ADVANCED,
        forms![read(
            G1,
            G4,
            fields![Field::new("version", Kind::Text { max: 48 }, "model and firmware version")]
        )],
    ),
    Command::new(
        number::READ_MAIN_BATTERY,
        "read_main_battery",
        "read main battery",
        MANUAL_ADVANCED,
        forms![read(G1, G4, fields![volts("main_battery")])],
    ),
    Command::new(
        number::READ_LOGIC_BATTERY,
        "read_logic_battery",
        "read logic battery",
        MANUAL_ADVANCED,
        forms![read(G1, G4, fields![volts("logic_battery")])],
    ),
    Command::new(
        number::READ_BUFFERS,
        "read_buffers",
        "read buffer lengths",
        MANUAL_MOTION,
        forms![read(G1, G4, fields![buffer("buffer_m1"), buffer("buffer_m2")])],
    )
    .note("Clients of 2025 say that 0 means empty; the manual's 0x80 is followed."),
    Command::new(
        number::READ_PWMS,
        "read_pwms",
        "read motor PWM",
        MANUAL_ADVANCED,
        forms![read(G1, G4, fields![duty("duty_m1"), duty("duty_m2")])],
    ),
    Command::new(
        number::READ_CURRENTS,
        "read_currents",
        "read motor currents",
        MANUAL_ADVANCED,
        forms![read(G1, G4, fields![amps("current_m1"), amps("current_m2")])],
    )
    .note("The manual gives no sign; most clients read it with one."),
    Command::new(
        number::READ_ALL_STATUS,
        "read_all_status",
        "read all status",
        CLIENTS,
        forms![read(G4, G4, ALL_STATUS)],
    )
    .note("Firmware 4.2.8 does not answer it."),
    Command::new(
        number::READ_TEMPERATURE_1,
        "read_temperature_1",
        "read temperature 1",
        MANUAL_ADVANCED,
        forms![read(G1, G4, fields![celsius("temperature_1")])],
    ),
    Command::new(
        number::READ_TEMPERATURE_2,
        "read_temperature_2",
        "read temperature 2",
        MANUAL_ADVANCED,
        forms![read(G1, G4, fields![celsius("temperature_2")])],
    )
    .note("Only on units with a second sensor."),
    Command::new(number::READ_STATUS, "read_status", "read status", MANUAL_ADVANCED, STATUS)
        .note("The bits mean different things in two bytes and in four; see the table of status bits."),
];

const STATUS: &[Form] = forms![
    read(G1, G2, fields![Field::new("status", Kind::U16, "state of the unit").unit(Unit::Status)]),
    read(G3, G4, fields![Field::new("status", Kind::U32, "state of the unit").unit(Unit::Status)]),
];

const ALL_STATUS: &[Field] = fields![
    Field::new("tick", Kind::U32, "running time of the unit"),
    Field::new("status", Kind::U32, "as command 90").unit(Unit::Status),
    celsius("temperature_1"),
    celsius("temperature_2"),
    volts("main_battery"),
    volts("logic_battery"),
    duty("duty_m1"),
    duty("duty_m2"),
    amps("current_m1"),
    amps("current_m2"),
    position("encoder_m1"),
    position("encoder_m2"),
    speed("speed_m1"),
    speed("speed_m2"),
    speed("raw_speed_m1"),
    speed("raw_speed_m2"),
    error("speed_error_m1", Unit::CountsPerSecond),
    error("speed_error_m2", Unit::CountsPerSecond),
    error("position_error_m1", Unit::Counts),
    error("position_error_m2", Unit::Counts),
];

const fn buffer(name: &'static str) -> Field {
    byte(name, "commands waiting, at most 63; 0 means the last one runs, 0x80 that all are done")
}

/// Clients differ in the sign; read as signed.
const fn error(name: &'static str, unit: Unit) -> Field {
    Field::new(name, Kind::I16, "how far the motor is from its setpoint").unit(unit)
}
