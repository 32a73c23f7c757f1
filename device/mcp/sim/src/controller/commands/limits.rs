//! Limits and the emergency stop: commands 57 to 60, 109 to 116, 133 to 136, 200 to 202.

use super::super::answer::{Answer, Arguments, Handlers, On, tell};
use super::super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_MAIN_VOLTAGES, |unit, args| {
        let battery = &mut unit.settings.battery;
        battery.main_min_tenths = args.u16(MIN);
        battery.main_max_tenths = args.u16(MAX);
        let auto_offset = battery.main_auto_offset_tenths;
        battery.main_auto_offset_tenths = args.int_or(AUTO_OFFSET, auto_offset.into()) as u8;
        Answer::Ack
    }),
    &On(commands::READ_MAIN_VOLTAGES, |unit, _| {
        let battery = &unit.settings.battery;
        Answer::of([
            tell(MIN, battery.main_min_tenths.into()),
            tell(MAX, battery.main_max_tenths.into()),
            tell(AUTO_OFFSET, battery.main_auto_offset_tenths.into()),
        ])
    }),
    &On(commands::SET_LOGIC_VOLTAGES, |unit, args| {
        unit.settings.battery.logic_min_tenths = args.u16(MIN);
        unit.settings.battery.logic_max_tenths = args.u16(MAX);
        Answer::Ack
    }),
    &On(commands::READ_LOGIC_VOLTAGES, |unit, _| {
        let battery = &unit.settings.battery;
        Answer::of([tell(MIN, battery.logic_min_tenths.into()), tell(MAX, battery.logic_max_tenths.into())])
    }),
    &On(commands::SET_SPEED_ERROR_LIMITS, |unit, args| {
        unit.motion(M1).speed_error_limit = args.u32(LIMIT_M1);
        unit.motion(M2).speed_error_limit = args.u32(LIMIT_M2);
        Answer::Ack
    }),
    &On(commands::READ_SPEED_ERROR_LIMITS, |unit, _| {
        let limits = [M1, M2].map(|motor| unit.motion(motor).speed_error_limit);
        error_limits(unit, limits)
    }),
    &On(commands::READ_SPEED_ERRORS, |unit, _| {
        let errors = [M1, M2].map(|motor| unit.channels[motor.index()].errors().speed_counts_per_s);
        loop_errors(unit, errors)
    }),
    &On(commands::SET_POSITION_ERROR_LIMITS, |unit, args| {
        unit.motion(M1).position_error_limit = args.u32(LIMIT_M1);
        unit.motion(M2).position_error_limit = args.u32(LIMIT_M2);
        Answer::Ack
    }),
    &On(commands::READ_POSITION_ERROR_LIMITS, |unit, _| {
        let limits = [M1, M2].map(|motor| unit.motion(motor).position_error_limit);
        error_limits(unit, limits)
    }),
    &On(commands::READ_POSITION_ERRORS, |unit, _| {
        let errors = [M1, M2].map(|motor| unit.channels[motor.index()].errors().position_counts);
        loop_errors(unit, errors)
    }),
    &On(commands::SET_VOLTAGE_OFFSETS, |unit, args| {
        unit.settings.battery.main_offset_tenths = args.int_or(MAIN, 0) as i8;
        unit.settings.battery.logic_offset_tenths = args.int_or(LOGIC, 0) as i8;
        Answer::Ack
    }),
    &On(commands::READ_VOLTAGE_OFFSETS, |unit, _| {
        let battery = &unit.settings.battery;
        Answer::of([
            tell(MAIN, battery.main_offset_tenths.into()),
            tell(LOGIC, battery.logic_offset_tenths.into()),
        ])
    }),
    &On(commands::SET_CURRENT_LIMITS_M1, |unit, args| set_current(unit, M1, args)),
    &On(commands::SET_CURRENT_LIMITS_M2, |unit, args| set_current(unit, M2, args)),
    &On(commands::READ_CURRENT_LIMITS_M1, |unit, _| current(unit, M1)),
    &On(commands::READ_CURRENT_LIMITS_M2, |unit, _| current(unit, M2)),
    &On(commands::RESET_ESTOP, |unit, _| {
        let reset = unit.estop_reset();
        unit.estop.reset(reset);
        unit.update_estop();
        Answer::Ack
    }),
    &On(commands::SET_ESTOP_LOCK, |unit, args| {
        unit.settings.unit.estop_lock = args.u8(LOCK);
        Answer::Ack
    }),
    &On(commands::READ_ESTOP_LOCK, |unit, _| Answer::of([tell(LOCK, unit.settings.unit.estop_lock.into())])),
];

/// Generation 4 has two bytes for what generation 3 has four.
fn error_limits<const L: u8>(unit: &Firmware, limits: [u32; 2]) -> Answer<L> {
    let narrow = unit.generation == Generation::Gen4;
    let [m1, m2] = limits.map(|limit| if narrow { limit.min(u16::MAX.into()) } else { limit });
    Answer::of([tell(LIMIT_M1, m1.into()), tell(LIMIT_M2, m2.into())])
}

/// Signed in generation 3, a magnitude of two bytes in generation 4.
fn loop_errors<const L: u8>(unit: &Firmware, errors: [i32; 2]) -> Answer<L> {
    let narrow = unit.generation == Generation::Gen4;
    let magnitude = |error: i32| i64::from(error.unsigned_abs().min(u16::MAX.into()));
    let [m1, m2] = errors.map(|error| if narrow { magnitude(error) } else { error.into() });
    Answer::of([tell(ERROR_M1, m1), tell(ERROR_M2, m2)])
}

fn set_current<const L: u8>(unit: &mut Firmware, motor: Motor, args: &Arguments<'_, L>) -> Answer<L> {
    let motion = unit.motion(motor);
    motion.max_current_raw = args.u32(MAX);
    motion.min_current_raw = args.i32(MIN);
    Answer::Ack
}

fn current<const L: u8>(unit: &mut Firmware, motor: Motor) -> Answer<L> {
    let motion = unit.motion(motor);
    Answer::of([
        tell(MAX, i64::from(motion.max_current_raw as i32)),
        tell(MIN, motion.min_current_raw.into()),
    ])
}
