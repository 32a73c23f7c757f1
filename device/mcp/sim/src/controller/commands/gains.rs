//! Control settings of a motor: commands 28, 29, 55, 56, 61 to 64, 68 to 72, 81, 128 to 132.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::motion::MotionSettings;
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::SET_VELOCITY_PID_M1, |unit, args| set_velocity(unit, M1, args)),
    (number::SET_VELOCITY_PID_M2, |unit, args| set_velocity(unit, M2, args)),
    (number::READ_VELOCITY_PID_M1, |unit, _| velocity(unit.motion(M1))),
    (number::READ_VELOCITY_PID_M2, |unit, _| velocity(unit.motion(M2))),
    (number::SET_POSITION_PID_M1, |unit, args| set_position(unit, M1, args)),
    (number::SET_POSITION_PID_M2, |unit, args| set_position(unit, M2, args)),
    (number::READ_POSITION_PID_M1, |unit, _| position(unit.motion(M1))),
    (number::READ_POSITION_PID_M2, |unit, _| position(unit.motion(M2))),
    (number::SET_DEFAULT_ACCEL_M1, |unit, args| set_accel(unit, M1, args)),
    (number::SET_DEFAULT_ACCEL_M2, |unit, args| set_accel(unit, M2, args)),
    (number::READ_DEFAULT_ACCELS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| *unit.motion(motor));
        Answer::ints([
            ("accel_m1", m1.default_accel_raw.into()),
            ("decel_m1", m1.default_decel_raw.into()),
            ("accel_m2", m2.default_accel_raw.into()),
            ("decel_m2", m2.default_decel_raw.into()),
        ])
    }),
    (number::SET_DEFAULT_SPEED_M1, |unit, args| set_speed(unit, M1, args)),
    (number::SET_DEFAULT_SPEED_M2, |unit, args| set_speed(unit, M2, args)),
    (number::READ_DEFAULT_SPEEDS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.motion(motor).default_speed_raw);
        Answer::ints([("speed_m1", m1.into()), ("speed_m2", m2.into())])
    }),
    (number::SET_INDUCTANCE_RESISTANCE_M1, |unit, args| set_winding(unit, M1, args)),
    (number::SET_INDUCTANCE_RESISTANCE_M2, |unit, args| set_winding(unit, M2, args)),
    (number::READ_INDUCTANCE_RESISTANCE_M1, |unit, _| winding(unit.motion(M1))),
    (number::READ_INDUCTANCE_RESISTANCE_M2, |unit, _| winding(unit.motion(M2))),
    (number::CALIBRATE_INDUCTANCE_RESISTANCE, |_, _| Answer::Ack),
];

impl Firmware {
    /// The raw control settings of a motor.
    pub(super) fn motion(&mut self, motor: Motor) -> &mut MotionSettings {
        &mut self.settings.motors[motor.index()].motion
    }
}

fn set_velocity(unit: &mut Firmware, motor: Motor, args: &Arguments<'_>) -> Answer {
    let motion = unit.motion(motor);
    motion.velocity_p_raw = args.u32("p");
    motion.velocity_i_raw = args.u32("i");
    motion.velocity_d_raw = args.u32("d");
    motion.qpps = args.u32("qpps");
    Answer::Ack
}

fn velocity(motion: &MotionSettings) -> Answer {
    Answer::ints([
        ("p", motion.velocity_p_raw.into()),
        ("i", motion.velocity_i_raw.into()),
        ("d", motion.velocity_d_raw.into()),
        ("qpps", motion.qpps.into()),
    ])
}

fn set_position(unit: &mut Firmware, motor: Motor, args: &Arguments<'_>) -> Answer {
    let motion = unit.motion(motor);
    motion.position_p_raw = args.u32("p");
    motion.position_i_raw = args.u32("i");
    motion.position_d_raw = args.u32("d");
    motion.position_max_i = args.u32("max_i");
    motion.position_deadzone_counts = args.u32("deadzone");
    motion.position_min_counts = args.i32("min");
    motion.position_max_counts = args.i32("max");
    Answer::Ack
}

fn position(motion: &MotionSettings) -> Answer {
    Answer::ints([
        ("p", motion.position_p_raw.into()),
        ("i", motion.position_i_raw.into()),
        ("d", motion.position_d_raw.into()),
        ("max_i", motion.position_max_i.into()),
        ("deadzone", motion.position_deadzone_counts.into()),
        ("min", motion.position_min_counts.into()),
        ("max", motion.position_max_counts.into()),
    ])
}

/// Generation 1 has one rate for both directions of a ramp.
fn set_accel(unit: &mut Firmware, motor: Motor, args: &Arguments<'_>) -> Answer {
    let one_rate = unit.generation == Generation::Gen1;
    let motion = unit.motion(motor);
    motion.default_accel_raw = args.u32("accel");
    let current = if one_rate { motion.default_accel_raw } else { motion.default_decel_raw };
    motion.default_decel_raw = args.int_or("decel", current.into()) as u32;
    Answer::Ack
}

fn set_speed(unit: &mut Firmware, motor: Motor, args: &Arguments<'_>) -> Answer {
    unit.motion(motor).default_speed_raw = args.u16("speed");
    Answer::Ack
}

fn set_winding(unit: &mut Firmware, motor: Motor, args: &Arguments<'_>) -> Answer {
    let motion = unit.motion(motor);
    motion.inductance_raw = args.u32("inductance");
    motion.resistance_raw = args.u32("resistance");
    Answer::Ack
}

fn winding(motion: &MotionSettings) -> Answer {
    Answer::ints([("inductance", motion.inductance_raw.into()), ("resistance", motion.resistance_raw.into())])
}
