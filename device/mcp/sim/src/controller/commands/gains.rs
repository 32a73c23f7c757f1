//! Control settings of a motor: commands 28, 29, 55, 56, 61 to 64, 68 to 72, 81, 128 to 132.

use super::super::answer::{Answer, Arguments, Handlers, On, tell};
use super::super::firmware::Firmware;
use crate::motion::MotionSettings;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_VELOCITY_PID_M1, |unit, args| set_velocity(unit, M1, args)),
    &On(commands::SET_VELOCITY_PID_M2, |unit, args| set_velocity(unit, M2, args)),
    &On(commands::READ_VELOCITY_PID_M1, |unit, _| velocity(unit.motion(M1))),
    &On(commands::READ_VELOCITY_PID_M2, |unit, _| velocity(unit.motion(M2))),
    &On(commands::SET_POSITION_PID_M1, |unit, args| set_position(unit, M1, args)),
    &On(commands::SET_POSITION_PID_M2, |unit, args| set_position(unit, M2, args)),
    &On(commands::READ_POSITION_PID_M1, |unit, _| position(unit.motion(M1))),
    &On(commands::READ_POSITION_PID_M2, |unit, _| position(unit.motion(M2))),
    &On(commands::SET_DEFAULT_ACCEL_M1, |unit, args| set_accel(unit, M1, args)),
    &On(commands::SET_DEFAULT_ACCEL_M2, |unit, args| set_accel(unit, M2, args)),
    &On(commands::READ_DEFAULT_ACCELS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| *unit.motion(motor));
        Answer::of([
            tell(ACCEL_M1, m1.default_accel_raw.into()),
            tell(DECEL_M1, m1.default_decel_raw.into()),
            tell(ACCEL_M2, m2.default_accel_raw.into()),
            tell(DECEL_M2, m2.default_decel_raw.into()),
        ])
    }),
    &On(commands::SET_DEFAULT_SPEED_M1, |unit, args| set_speed(unit, M1, args)),
    &On(commands::SET_DEFAULT_SPEED_M2, |unit, args| set_speed(unit, M2, args)),
    &On(commands::READ_DEFAULT_SPEEDS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.motion(motor).default_speed_raw);
        Answer::of([tell(SPEED_M1, m1.into()), tell(SPEED_M2, m2.into())])
    }),
    &On(commands::SET_INDUCTANCE_RESISTANCE_M1, |unit, args| set_winding(unit, M1, args)),
    &On(commands::SET_INDUCTANCE_RESISTANCE_M2, |unit, args| set_winding(unit, M2, args)),
    &On(commands::READ_INDUCTANCE_RESISTANCE_M1, |unit, _| winding(unit.motion(M1))),
    &On(commands::READ_INDUCTANCE_RESISTANCE_M2, |unit, _| winding(unit.motion(M2))),
    &On(commands::CALIBRATE_INDUCTANCE_RESISTANCE, |_, _| Answer::Ack),
];

impl Firmware {
    /// The raw control settings of a motor.
    pub(super) fn motion(&mut self, motor: Motor) -> &mut MotionSettings {
        &mut self.settings.motors[motor.index()].motion
    }
}

fn set_velocity<const L: u8>(unit: &mut Firmware, motor: Motor, args: &Arguments<'_, L>) -> Answer<L> {
    let motion = unit.motion(motor);
    motion.velocity_p_raw = args.u32(P);
    motion.velocity_i_raw = args.u32(I);
    motion.velocity_d_raw = args.u32(D);
    motion.qpps = args.u32(QPPS);
    Answer::Ack
}

fn velocity<const L: u8>(motion: &MotionSettings) -> Answer<L> {
    Answer::of([
        tell(P, motion.velocity_p_raw.into()),
        tell(I, motion.velocity_i_raw.into()),
        tell(D, motion.velocity_d_raw.into()),
        tell(QPPS, motion.qpps.into()),
    ])
}

fn set_position<const L: u8>(unit: &mut Firmware, motor: Motor, args: &Arguments<'_, L>) -> Answer<L> {
    let motion = unit.motion(motor);
    motion.position_p_raw = args.u32(P);
    motion.position_i_raw = args.u32(I);
    motion.position_d_raw = args.u32(D);
    motion.position_max_i = args.u32(MAX_I);
    motion.position_deadzone_counts = args.u32(DEADZONE);
    motion.position_min_counts = args.i32(MIN);
    motion.position_max_counts = args.i32(MAX);
    Answer::Ack
}

fn position<const L: u8>(motion: &MotionSettings) -> Answer<L> {
    Answer::of([
        tell(P, motion.position_p_raw.into()),
        tell(I, motion.position_i_raw.into()),
        tell(D, motion.position_d_raw.into()),
        tell(MAX_I, motion.position_max_i.into()),
        tell(DEADZONE, motion.position_deadzone_counts.into()),
        tell(MIN, motion.position_min_counts.into()),
        tell(MAX, motion.position_max_counts.into()),
    ])
}

/// Generation 1 has one rate for both directions of a ramp.
fn set_accel<const L: u8>(unit: &mut Firmware, motor: Motor, args: &Arguments<'_, L>) -> Answer<L> {
    let one_rate = unit.generation == Generation::Gen1;
    let motion = unit.motion(motor);
    motion.default_accel_raw = args.u32(ACCEL);
    let current = if one_rate { motion.default_accel_raw } else { motion.default_decel_raw };
    motion.default_decel_raw = args.int_or(DECEL, current.into()) as u32;
    Answer::Ack
}

fn set_speed<const L: u8>(unit: &mut Firmware, motor: Motor, args: &Arguments<'_, L>) -> Answer<L> {
    unit.motion(motor).default_speed_raw = args.u16(SPEED);
    Answer::Ack
}

fn set_winding<const L: u8>(unit: &mut Firmware, motor: Motor, args: &Arguments<'_, L>) -> Answer<L> {
    let motion = unit.motion(motor);
    motion.inductance_raw = args.u32(INDUCTANCE);
    motion.resistance_raw = args.u32(RESISTANCE);
    Answer::Ack
}

fn winding<const L: u8>(motion: &MotionSettings) -> Answer<L> {
    Answer::of([
        tell(INDUCTANCE, motion.inductance_raw.into()),
        tell(RESISTANCE, motion.resistance_raw.into()),
    ])
}
