//! What drives motors: duty, speed, distance and position.

use super::super::command::{Command, Effect, Form};
use super::super::field::{accel, byte, distance, duty, duty_accel, field, position, speed};
use super::super::name::{self, Name};
use super::super::scale;
use super::{CLIENTS, G1, G3, G4, MANUAL_MOTION, fields, forms, rows, write};
use brushwork_values::{Field, Kind, Unit};

pub(super) const ROWS: &[Command] = rows! {
    MANUAL_MOTION DUTY_M1 "M1 duty" DUTY;
    MANUAL_MOTION DUTY_M2 "M2 duty" DUTY;
    MANUAL_MOTION DUTY_BOTH "duty" forms![drive(fields![duty(name::DUTY_M1), duty(name::DUTY_M2)])];
    MANUAL_MOTION SPEED_M1 "M1 speed" SPEED;
    MANUAL_MOTION SPEED_M2 "M2 speed" SPEED;
    MANUAL_MOTION SPEED_BOTH "speed" forms![drive(fields![speed(name::SPEED_M1), speed(name::SPEED_M2)])];
    MANUAL_MOTION SPEED_ACCEL_M1 "M1 speed with acceleration" SPEED_ACCEL;
    MANUAL_MOTION SPEED_ACCEL_M2 "M2 speed with acceleration" SPEED_ACCEL;
    MANUAL_MOTION SPEED_ACCEL_BOTH "speed with acceleration"
        forms![drive(fields![accel(name::ACCEL), speed(name::SPEED_M1), speed(name::SPEED_M2)])];
    MANUAL_MOTION SPEED_DISTANCE_M1 "M1 distance" SPEED_DISTANCE;
    MANUAL_MOTION SPEED_DISTANCE_M2 "M2 distance" SPEED_DISTANCE;
    MANUAL_MOTION SPEED_DISTANCE_BOTH "distance"
        forms![travel(fields![
            speed(name::SPEED_M1),
            distance(name::DISTANCE_M1),
            speed(name::SPEED_M2),
            distance(name::DISTANCE_M2),
            BUFFER,
        ])];
    MANUAL_MOTION SPEED_ACCEL_DISTANCE_M1 "M1 distance with acceleration" SPEED_ACCEL_DISTANCE,
        note "The manual's copy at hand lacks the send line; as 45.";
    MANUAL_MOTION SPEED_ACCEL_DISTANCE_M2 "M2 distance with acceleration" SPEED_ACCEL_DISTANCE;
    MANUAL_MOTION SPEED_ACCEL_DISTANCE_BOTH "distance with acceleration"
        forms![travel(fields![
            accel(name::ACCEL),
            speed(name::SPEED_M1),
            distance(name::DISTANCE_M1),
            speed(name::SPEED_M2),
            distance(name::DISTANCE_M2),
            BUFFER,
        ])];
    MANUAL_MOTION SPEED_ACCEL_EACH "speed with acceleration each"
        forms![drive(fields![
            accel(name::ACCEL_M1),
            speed(name::SPEED_M1),
            accel(name::ACCEL_M2),
            speed(name::SPEED_M2)
        ])];
    MANUAL_MOTION SPEED_ACCEL_DISTANCE_EACH "distance with acceleration each"
        forms![travel(fields![
            accel(name::ACCEL_M1),
            speed(name::SPEED_M1),
            distance(name::DISTANCE_M1),
            accel(name::ACCEL_M2),
            speed(name::SPEED_M2),
            distance(name::DISTANCE_M2),
            BUFFER,
        ])];
    MANUAL_MOTION DUTY_ACCEL_M1 "M1 duty with acceleration" DUTY_ACCEL, note FOUR_BYTES;
    MANUAL_MOTION DUTY_ACCEL_M2 "M2 duty with acceleration" DUTY_ACCEL, note FOUR_BYTES;
    MANUAL_MOTION DUTY_ACCEL_BOTH "duty with acceleration"
        forms![drive(fields![
            duty(name::DUTY_M1),
            duty_accel(name::ACCEL_M1),
            duty(name::DUTY_M2),
            duty_accel(name::ACCEL_M2)
        ])], note "The manual's copy at hand lacks the layout; all clients send this one.";
    MANUAL_MOTION POSITION_PROFILE_M1 "M1 position with profile" PROFILE, note UNSIGNED_SPEED;
    MANUAL_MOTION POSITION_PROFILE_M2 "M2 position with profile" PROFILE, note UNSIGNED_SPEED;
    MANUAL_MOTION POSITION_PROFILE_BOTH "position with profile" PROFILE_BOTH, note UNSIGNED_SPEED;
    CLIENTS POSITION_M1 "M1 position" forms![queue(fields![position(name::POSITION), BUFFER])];
    CLIENTS POSITION_M2 "M2 position" forms![queue(fields![position(name::POSITION), BUFFER])];
    CLIENTS POSITION_BOTH "position"
        forms![queue(fields![position(name::POSITION_M1), position(name::POSITION_M2), BUFFER])];
    CLIENTS SPEED_POSITION_M1 "M1 position with speed" SPEED_POSITION;
    CLIENTS SPEED_POSITION_M2 "M2 position with speed" SPEED_POSITION;
    CLIENTS SPEED_POSITION_BOTH "position with speed"
        forms![queue(fields![
            travel_speed(name::SPEED_M1),
            position(name::POSITION_M1),
            travel_speed(name::SPEED_M2),
            position(name::POSITION_M2),
            BUFFER,
        ])];
    CLIENTS PERCENT_POSITION_M1 "M1 position in percent" PERCENT;
    CLIENTS PERCENT_POSITION_M2 "M2 position in percent" PERCENT;
    CLIENTS PERCENT_POSITION_BOTH "position in percent"
        forms![queue(fields![percent(name::POSITION_M1), percent(name::POSITION_M2), BUFFER])];
};

const FOUR_BYTES: &str =
    "The manual prints two bytes of acceleration with a range that needs four; all clients send four.";
const UNSIGNED_SPEED: &str = "The speed is a magnitude: the position decides the direction. A negative speed is met in \
     the field and taken without its sign.";

const DUTY: &[Form] = forms![drive(fields![duty(name::DUTY)])];
const SPEED: &[Form] = forms![drive(fields![speed(name::SPEED)])];
const SPEED_ACCEL: &[Form] = forms![drive(fields![accel(name::ACCEL), speed(name::SPEED)])];
const SPEED_DISTANCE: &[Form] = forms![travel(fields![speed(name::SPEED), distance(name::DISTANCE), BUFFER])];
const SPEED_ACCEL_DISTANCE: &[Form] =
    forms![travel(fields![accel(name::ACCEL), speed(name::SPEED), distance(name::DISTANCE), BUFFER])];
const DUTY_ACCEL: &[Form] = forms![drive(fields![duty(name::DUTY), duty_accel(name::ACCEL)])];
const PROFILE: &[Form] = forms![write(
    G1,
    G4,
    Effect::Buffered,
    fields![accel(name::ACCEL), speed(name::SPEED), accel(name::DECEL), position(name::POSITION), BUFFER]
)];
const PROFILE_BOTH: &[Form] = forms![write(
    G1,
    G4,
    Effect::Buffered,
    fields![
        accel(name::ACCEL_M1),
        speed(name::SPEED_M1),
        accel(name::DECEL_M1),
        position(name::POSITION_M1),
        accel(name::ACCEL_M2),
        speed(name::SPEED_M2),
        accel(name::DECEL_M2),
        position(name::POSITION_M2),
        BUFFER,
    ]
)];
const SPEED_POSITION: &[Form] =
    forms![queue(fields![travel_speed(name::SPEED), position(name::POSITION), BUFFER])];
const PERCENT: &[Form] = forms![queue(fields![percent(name::POSITION), BUFFER])];

const BUFFER: Field =
    byte(name::BUFFER, "0 queues the command, 1 drops what runs and waits and starts it at once").range(0, 1);

const fn drive(request: &'static [Field]) -> Form {
    write(G1, G4, Effect::Motion, request)
}

const fn travel(request: &'static [Field]) -> Form {
    write(G1, G4, Effect::RelativeMotion, request)
}

const fn queue(request: &'static [Field]) -> Form {
    write(G3, G4, Effect::Buffered, request)
}

const fn travel_speed(name: impl Name) -> Field {
    field(name, Kind::U32, "speed on the way").unit(Unit::CountsPerSecond)
}

const fn percent(name: impl Name) -> Field {
    field(name, Kind::I16, "place between the least and the greatest position of the position PID")
        .scaled(Unit::Percent, scale::DUTY_PERCENT, 2)
        .range(-scale::FULL_DUTY_RAW, scale::FULL_DUTY_RAW)
}
