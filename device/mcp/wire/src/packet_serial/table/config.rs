//! The unit as a whole: serial time-out, memory of settings, serial number, configuration word, CTRL outputs, homing,
//! PWM, user memory.

use super::super::command::{ClientUse, Command, Effect, Form, Simulated};
use super::super::field::{byte, celsius, field, volts};
use super::super::name::{self, Name};
use super::super::scale;
use super::{
    CLIENTS, G1, G2, G3, G4, MANUAL_ADVANCED, fields, forms, read, read_at, reads, rows, sets, write,
};
use crate::codes;
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    CLIENTS SET_SERIAL_TIMEOUT "serial time-out"
        forms![write(G2, G4, Effect::Setting, fields![SERIAL_TIMEOUT])],
        note "No source says which generation brought it; the library of 2015 does not have it.";
    CLIENTS READ_SERIAL_TIMEOUT "read serial time-out" forms![read(G2, G4, fields![SERIAL_TIMEOUT])];
    MANUAL_ADVANCED RESTORE_DEFAULTS "restore defaults"
        forms![write(G1, G2, Effect::Memory, &[]), write(G3, G4, Effect::Memory, KEY)], accepts &[&[], KEY],
        note "Without the key later firmware does nothing.";
    MANUAL_ADVANCED SAVE_SETTINGS "save settings" forms![write(G1, G4, Effect::Memory, KEY)], accepts &[&[]],
        note "The manual prints neither key nor CRC. Some units restart after it and take seconds.";
    MANUAL_ADVANCED RELOAD_SETTINGS "reload settings" forms![write(G1, G4, Effect::Memory, &[])],
        note "The manual prints a read with the reply of 91; all clients write. Sent right after 94 it can time out.";
    CLIENTS SET_SERIAL_NUMBER "serial number" SET_SERIAL, simulated LABEL;
    CLIENTS READ_SERIAL_NUMBER "read serial number" READ_SERIAL, simulated LABEL;
    CLIENTS SET_CONFIG "configuration word" sets![CONFIG],
        client ClientUse::Superseded("the MCP has 139 to 147 for what it says"),
        note "Writing it can move the unit to another address at once. The simulated MCP takes the address alone and tells its ports.";
    CLIENTS READ_CONFIG "read configuration word" reads![CONFIG];
    CLIENTS READ_VOLTS "read voltages" VOLTS,
        note "A factory test in generation 1, the CTRL modes in 2 and 3.";
    CLIENTS READ_TEMPERATURES "read temperatures" TEMPERATURES,
        note "A factory test in generation 1, the CTRL modes in 2 and 3.";
    CLIENTS SET_AUX_DUTIES "auxiliary duties" SET_AUX,
        note "Sets the duty of the first CTRL pin in generations 2 and 3.";
    CLIENTS READ_AUX_DUTIES "read auxiliary duties" READ_AUX;
    CLIENTS SET_HOMING_M1 "M1 homing" SET_HOMING;
    CLIENTS SET_HOMING_M2 "M2 homing" SET_HOMING;
    CLIENTS READ_HOMING "read homing" READ_HOMING;
    MANUAL_ADVANCED SET_PWM_MODE "PWM mode" SET_PWM, simulated NO_RIPPLE;
    MANUAL_ADVANCED READ_PWM_MODE "read PWM mode" READ_PWM, simulated NO_RIPPLE;
    CLIENTS SET_PWM_IDLE "PWM idle"
        forms![write(G3, G4, Effect::Setting, fields![idle(name::IDLE_M1), idle(name::IDLE_M2)])];
    CLIENTS READ_PWM_IDLE "read PWM idle"
        forms![read(G3, G4, fields![idle(name::IDLE_M1), idle(name::IDLE_M2)])];
    MANUAL_ADVANCED READ_USER_MEMORY "read user memory"
        forms![read_at(G1, G4, fields![USER_ADDRESS], fields![USER_VALUE])],
        note "The reply's CRC covers the address byte.";
    MANUAL_ADVANCED WRITE_USER_MEMORY "write user memory" sets![USER_ADDRESS, USER_VALUE],
        note "The manual's text calls it \"Get Priority Levels\"; the RoboClaw manual of 2018 swaps it with 252.";
};

const LABEL: Simulated = Simulated::StoredOnly("a label that nothing else depends on");
const NO_RIPPLE: Simulated =
    Simulated::StoredOnly("the simulated bridge has no ripple: both modes give the same mean voltage");

const SERIAL_TIMEOUT: Field = byte(
    name::TIMEOUT,
    "time without a packet after which the motors stop; 0 for never",
)
.scaled(Unit::Seconds, scale::DECISECOND_S, 1);

const KEY: &[Field] = fields![
    field(name::KEY, Kind::U32, "the key E22EAB7A").unit(Unit::Bits).fixed(scale::SETTINGS_KEY as i64),
];

const SET_SERIAL: &[Form] =
    forms![write(G3, G3, Effect::Setting, UTF16_SERIAL), write(G4, G4, Effect::Setting, ASCII_SERIAL)];
const READ_SERIAL: &[Form] = forms![read(G3, G3, UTF16_SERIAL), read(G4, G4, ASCII_SERIAL)];
const UTF16_SERIAL: &[Field] = fields![field(name::SERIAL_NUMBER, Kind::Utf16Le36, "at most 18 characters")];
const ASCII_SERIAL: &[Field] = fields![field(name::SERIAL_NUMBER, Kind::Ascii36, "at most 36 characters")];

const CONFIG: Field = field(
    name::CONFIG,
    Kind::U16,
    "bits 0-1 mode, 2-4 battery, 5-7 baud, 8-10 address, 12 slave select, 13 relay or swapped encoders, 15 open drain; in \
     RC mode 5 mixing, 6 exponential, 7 auto calibrate, 8 flip switch, 9 time-out",
)
.unit(Unit::Bits);

const VOLTS: &[Form] = forms![
    qpps_test("read M1 factory speed test"),
    write(G2, G3, Effect::Setting, fields![ctrl_mode(name::MODE_1), ctrl_mode(name::MODE_2)])
        .titled("CTRL modes"),
    read(G4, G4, fields![volts(name::MAIN_BATTERY), volts(name::LOGIC_BATTERY)]),
];
const TEMPERATURES: &[Form] = forms![
    qpps_test("read M2 factory speed test"),
    read(G2, G3, fields![ctrl_mode(name::MODE_1), ctrl_mode(name::MODE_2)]).titled("read CTRL modes"),
    read(G4, G4, fields![celsius(name::TEMPERATURE_1), celsius(name::TEMPERATURE_2)]),
];
const SET_AUX: &[Form] = forms![
    write(G2, G3, Effect::Setting, fields![ctrl_duty(name::DUTY_1)]).titled("CTRL1 duty"),
    write(G4, G4, Effect::Setting, AUX),
];
const READ_AUX: &[Form] = forms![
    read(G2, G3, fields![ctrl_duty(name::DUTY_1), ctrl_duty(name::DUTY_2)]).titled("read CTRL duties"),
    read(G4, G4, AUX),
];
const AUX: &[Field] = fields![
    aux_duty(name::DUTY_1),
    aux_duty(name::DUTY_2),
    aux_duty(name::DUTY_3),
    aux_duty(name::DUTY_4),
    aux_duty(name::DUTY_5)
];

const SET_HOMING: &[Form] = forms![
    write(G2, G3, Effect::Setting, fields![homing_duty(name::DUTY), homing_timeout(name::TIMEOUT)]),
    write(G4, G4, Effect::Setting, fields![homing_timeout(name::TIMEOUT)]),
];
const READ_HOMING: &[Form] = forms![
    read(
        G2,
        G3,
        fields![
            homing_duty(name::DUTY_M1),
            homing_timeout(name::TIMEOUT_M1),
            homing_duty(name::DUTY_M2),
            homing_timeout(name::TIMEOUT_M2),
        ]
    ),
    read(G4, G4, fields![homing_timeout(name::TIMEOUT_M1), homing_timeout(name::TIMEOUT_M2)]),
];

const SET_PWM: &[Form] = forms![
    write(G1, G2, Effect::Setting, fields![pwm_mode(name::MODE)]),
    write(G3, G4, Effect::Setting, fields![pwm_mode(name::MODE_M1), pwm_mode(name::MODE_M2)]),
];
const READ_PWM: &[Form] = forms![
    read(G1, G2, fields![pwm_mode(name::MODE)]),
    read(G3, G4, fields![pwm_mode(name::MODE_M1), pwm_mode(name::MODE_M2)]),
];

const USER_ADDRESS: Field = byte(name::ADDRESS, "byte address in the user memory of 256 bytes");
const USER_VALUE: Field = field(name::VALUE, Kind::U16, "the word there");

/// The library of 2015 waits up to five seconds for it, so the motor may well run.
const fn qpps_test(title: &'static str) -> Form {
    let mut form = read(
        G1,
        G1,
        fields![field(name::SPEED, Kind::I16, "speed found by a factory test; scale not public")],
    )
    .titled(title)
    .assumed("a factory test that may run the motor");
    form.effect = Effect::RelativeMotion;
    form
}

const fn ctrl_mode(name: impl Name) -> Field {
    byte(name, "what the CTRL pin does").range(0, 3)
}

pub(super) const fn ctrl_duty(name: impl Name) -> Field {
    field(name, Kind::U16, "duty of the CTRL pin").scaled(Unit::Percent, 100.0 / scale::CTRL_DUTY_RAW, 1)
}

const fn aux_duty(name: impl Name) -> Field {
    field(name, Kind::U16, "duty of the auxiliary pin; scale not public")
}

const fn homing_duty(name: impl Name) -> Field {
    field(name, Kind::U16, "duty while homing").scaled(Unit::Percent, 100.0 / scale::DEFAULT_SPEED_RAW, 2)
}

const fn homing_timeout(name: impl Name) -> Field {
    field(name, Kind::U32, "time allowed for homing").scaled(Unit::Seconds, scale::HOMING_TIMEOUT_S, 2)
}

const fn pwm_mode(name: impl Name) -> Field {
    byte(name, "how the bridge is driven").codes(codes::PWM_MODES)
}

const fn idle(name: impl Name) -> Field {
    byte(name, "bit 7 the mode, low bits the delay in tenths of a second").unit(Unit::Bits)
}
