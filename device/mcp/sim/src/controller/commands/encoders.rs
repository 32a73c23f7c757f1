//! Encoder counts and speeds: commands 16 to 20, 22, 23, 30, 31, 78, 79, 91 to 93, 103, 108.

use super::super::answer::{Answer, Handlers};
use super::super::firmware::Firmware;
use crate::motion::Speeds;
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::READ_ENCODER_M1, |unit, _| count_and_status(unit, M1)),
    (number::READ_ENCODER_M2, |unit, _| count_and_status(unit, M2)),
    (number::READ_SPEED_M1, |unit, _| magnitude(unit.speeds(M1).filtered)),
    (number::READ_SPEED_M2, |unit, _| magnitude(unit.speeds(M2).filtered)),
    (number::READ_RAW_SPEED_M1, |unit, _| magnitude(unit.speeds(M1).raw)),
    (number::READ_RAW_SPEED_M2, |unit, _| magnitude(unit.speeds(M2).raw)),
    (number::RESET_ENCODERS, |unit, _| {
        set_count(unit, M1, 0);
        set_count(unit, M2, 0)
    }),
    (number::SET_ENCODER_M1, |unit, args| set_count(unit, M1, args.u32("encoder"))),
    (number::SET_ENCODER_M2, |unit, args| set_count(unit, M2, args.u32("encoder"))),
    (number::READ_ENCODERS, |unit, _| {
        Answer::ints([("encoder_m1", unit.position(M1)), ("encoder_m2", unit.position(M2))])
    }),
    (number::READ_RAW_SPEEDS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.speeds(motor).raw);
        Answer::ints([("raw_speed_m1", m1.into()), ("raw_speed_m2", m2.into())])
    }),
    (number::READ_SPEEDS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.speeds(motor).average);
        Answer::ints([("speed_m1", m1.into()), ("speed_m2", m2.into())])
    }),
    (number::READ_ENCODER_MODES, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.settings.motors[motor.index()].encoder_mode);
        Answer::ints([("mode_m1", m1.into()), ("mode_m2", m2.into())])
    }),
    (number::SET_ENCODER_MODE_M1, |unit, args| set_mode(unit, M1, args.u8("mode"))),
    (number::SET_ENCODER_MODE_M2, |unit, args| set_mode(unit, M2, args.u8("mode"))),
    (number::READ_ENCODER_STATUS, |unit, args| match unit.generation {
        Generation::Gen2 | Generation::Gen3 => {
            unit.settings.roboclaw.control_duties[1] = args.u16("duty_2");
            Answer::Ack
        }
        Generation::Gen1 | Generation::Gen4 => {
            let [m1, m2] = [M1, M2].map(|motor| take_status(unit, motor));
            Answer::ints([("status_m1", m1), ("status_m2", m2)])
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

fn count_and_status(unit: &mut Firmware, motor: Motor) -> Answer {
    let encoder = unit.position(motor);
    Answer::ints([("encoder", encoder), ("status", take_status(unit, motor))])
}

fn take_status(unit: &mut Firmware, motor: Motor) -> i64 {
    unit.channels[motor.index()].encoder_mut().take_status().into()
}

fn magnitude(speed: i32) -> Answer {
    Answer::ints([("speed", speed.unsigned_abs().into()), ("status", i64::from(speed < 0))])
}

fn set_count(unit: &mut Firmware, motor: Motor, count: u32) -> Answer {
    unit.channels[motor.index()].encoder_mut().set(count);
    Answer::Ack
}

fn set_mode(unit: &mut Firmware, motor: Motor, mode: u8) -> Answer {
    unit.settings.motors[motor.index()].encoder_mode = mode;
    Answer::Ack
}
