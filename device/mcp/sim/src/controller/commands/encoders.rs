//! Encoder counts and speeds: commands 16 to 20, 22, 23, 30, 31, 78, 79, 91 to 93, 103, 108.

use super::super::answer::{Answer, Handlers, On, tell};
use super::super::firmware::Firmware;
use crate::motion::Speeds;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::READ_ENCODER_M1, |unit, _| count_and_status(unit, M1)),
    &On(commands::READ_ENCODER_M2, |unit, _| count_and_status(unit, M2)),
    &On(commands::READ_SPEED_M1, |unit, _| magnitude(unit.speeds(M1).filtered)),
    &On(commands::READ_SPEED_M2, |unit, _| magnitude(unit.speeds(M2).filtered)),
    &On(commands::READ_RAW_SPEED_M1, |unit, _| magnitude(unit.speeds(M1).raw)),
    &On(commands::READ_RAW_SPEED_M2, |unit, _| magnitude(unit.speeds(M2).raw)),
    &On(commands::RESET_ENCODERS, |unit, _| {
        unit.channels[M1.index()].encoder_mut().set(0);
        set_count(unit, M2, 0)
    }),
    &On(commands::SET_ENCODER_M1, |unit, args| set_count(unit, M1, args.u32(ENCODER))),
    &On(commands::SET_ENCODER_M2, |unit, args| set_count(unit, M2, args.u32(ENCODER))),
    &On(commands::READ_ENCODERS, |unit, _| {
        Answer::of([tell(ENCODER_M1, unit.position(M1)), tell(ENCODER_M2, unit.position(M2))])
    }),
    &On(commands::READ_RAW_SPEEDS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.speeds(motor).raw);
        Answer::of([tell(RAW_SPEED_M1, m1.into()), tell(RAW_SPEED_M2, m2.into())])
    }),
    &On(commands::READ_SPEEDS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.speeds(motor).average);
        Answer::of([tell(SPEED_M1, m1.into()), tell(SPEED_M2, m2.into())])
    }),
    &On(commands::READ_ENCODER_MODES, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.settings.motors[motor.index()].encoder_mode);
        Answer::of([tell(MODE_M1, m1.into()), tell(MODE_M2, m2.into())])
    }),
    &On(commands::SET_ENCODER_MODE_M1, |unit, args| set_mode(unit, M1, args.u8(MODE))),
    &On(commands::SET_ENCODER_MODE_M2, |unit, args| set_mode(unit, M2, args.u8(MODE))),
    &On(commands::READ_ENCODER_STATUS, |unit, args| match unit.generation {
        Generation::Gen2 | Generation::Gen3 => {
            unit.settings.roboclaw.control_duties[1] = args.int_or(DUTY_2, 0) as u16;
            Answer::Ack
        }
        Generation::Gen1 | Generation::Gen4 => {
            let [m1, m2] = [M1, M2].map(|motor| take_status(unit, motor));
            Answer::of([tell(STATUS_M1, m1), tell(STATUS_M2, m2)])
        }
    }),
];

impl Firmware {
    /// The encoder register as a signed count.
    pub(super) fn position(&self, motor: Motor) -> i64 {
        self.channels[motor.index()].encoder().position().into()
    }

    /// Speeds as the commands read them.
    pub(super) fn speeds(&self, motor: Motor) -> Speeds {
        self.channels[motor.index()].speeds()
    }
}

fn count_and_status<const L: u8>(unit: &mut Firmware, motor: Motor) -> Answer<L> {
    let encoder = unit.position(motor);
    Answer::of([tell(ENCODER, encoder), tell(STATUS, take_status(unit, motor))])
}

fn take_status(unit: &mut Firmware, motor: Motor) -> i64 {
    unit.channels[motor.index()].encoder_mut().take_status().into()
}

fn magnitude<const L: u8>(speed: i32) -> Answer<L> {
    Answer::of([tell(SPEED, speed.unsigned_abs().into()), tell(STATUS, i64::from(speed < 0))])
}

fn set_count<const L: u8>(unit: &mut Firmware, motor: Motor, count: u32) -> Answer<L> {
    unit.channels[motor.index()].encoder_mut().set(count);
    Answer::Ack
}

fn set_mode<const L: u8>(unit: &mut Firmware, motor: Motor, mode: u8) -> Answer<L> {
    unit.settings.motors[motor.index()].encoder_mode = mode;
    Answer::Ack
}
