//! Encoder counts and speeds, and which input is whose encoder.

use super::super::command::{Command, Effect, Form};
use super::super::field::{byte, field, position, speed};
use super::super::name::{self, Name};
use super::{
    CLIENTS, G1, G3, G4, MANUAL_ADVANCED, MANUAL_ENCODERS, fields, forms, read, reads, rows, sets, write,
};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    MANUAL_ENCODERS READ_ENCODER_M1 "read M1 encoder" COUNT_AND_STATUS;
    MANUAL_ENCODERS READ_ENCODER_M2 "read M2 encoder" COUNT_AND_STATUS;
    MANUAL_ENCODERS READ_SPEED_M1 "read M1 speed" SPEED_AND_STATUS, note SIGN_IN_STATUS;
    MANUAL_ENCODERS READ_SPEED_M2 "read M2 speed" SPEED_AND_STATUS, note SIGN_IN_STATUS;
    MANUAL_ENCODERS RESET_ENCODERS "zero both encoders" forms![write(G1, G4, Effect::Encoder, &[])];
    MANUAL_ENCODERS SET_ENCODER_M1 "set M1 encoder" SET_COUNT;
    MANUAL_ENCODERS SET_ENCODER_M2 "set M2 encoder" SET_COUNT;
    MANUAL_ENCODERS READ_RAW_SPEED_M1 "read M1 raw speed" SPEED_AND_STATUS, note SIGN_IN_STATUS;
    MANUAL_ENCODERS READ_RAW_SPEED_M2 "read M2 raw speed" SPEED_AND_STATUS, note SIGN_IN_STATUS;
    MANUAL_ENCODERS READ_ENCODERS "read encoders"
        reads![position(name::ENCODER_M1), position(name::ENCODER_M2)],
        note "The manual gives absolute encoders 0 to 2047 here and 0 to 4095 for 16; 4095 is followed.";
    MANUAL_ENCODERS READ_RAW_SPEEDS "read raw speeds"
        reads![speed(name::RAW_SPEED_M1), speed(name::RAW_SPEED_M2)],
        note "Counts of the last 1/300 s expressed per second; signed, unlike 30 and 31.";
    MANUAL_ADVANCED READ_ENCODER_MODES "read encoder pins" reads![pin(name::MODE_M1), pin(name::MODE_M2)];
    MANUAL_ADVANCED SET_ENCODER_MODE_M1 "M1 encoder pin" SET_MODE;
    MANUAL_ADVANCED SET_ENCODER_MODE_M2 "M2 encoder pin" SET_MODE;
    CLIENTS READ_ENCODER_STATUS "read encoder status"
        forms![
            write(super::G2, G3, Effect::Setting, fields![super::config::ctrl_duty(name::DUTY_2)])
                .titled("CTRL2 duty"),
            read(G4, G4, fields![byte(name::STATUS_M1, STATUS), byte(name::STATUS_M2, STATUS)]),
        ],
        note "Generations 2 and 3 set the duty of the second CTRL pin with this number; the simulated controller only stores it.";
    CLIENTS READ_SPEEDS "read speeds"
        forms![read(G3, G4, fields![speed(name::SPEED_M1), speed(name::SPEED_M2)])],
        note "Averaged as 18 and 19; signed, unlike them.";
};

const SIGN_IN_STATUS: &str =
    "The value is the magnitude, the status byte the direction; some old clients read the value signed.";

const STATUS: &str = "bit 0 underflow, bit 1 backwards, bit 2 overflow; reading clears bits 0 and 2";

const COUNT_AND_STATUS: &[Form] = reads![position(name::ENCODER), byte(name::STATUS, STATUS)];

const SPEED_AND_STATUS: &[Form] = reads![
    field(name::SPEED, Kind::U32, "magnitude of the speed").unit(Unit::CountsPerSecond),
    byte(name::STATUS, "0 forward, 1 backward"),
];

const SET_COUNT: &[Form] = forms![write(G1, G4, Effect::Encoder, fields![position(name::ENCODER)])];

const SET_MODE: &[Form] = sets![pin(name::MODE)];

const fn pin(name: impl Name) -> Field {
    byte(name, "input that is the motor's encoder; its numbers are not public")
}
