//! Limits and the emergency stop: commands 57 to 60, 109 to 116, 133 to 136, 200 to 202.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::SET_MAIN_VOLTAGES, |unit, args| {
        let battery = &mut unit.settings.battery;
        battery.main_min_tenths = args.u16("min");
        battery.main_max_tenths = args.u16("max");
        let auto_offset = battery.main_auto_offset_tenths;
        battery.main_auto_offset_tenths = args.int_or("auto_offset", auto_offset.into()) as u8;
        Answer::Ack
    }),
    (number::READ_MAIN_VOLTAGES, |unit, _| {
        let battery = &unit.settings.battery;
        Answer::ints([
            ("min", battery.main_min_tenths.into()),
            ("max", battery.main_max_tenths.into()),
            ("auto_offset", battery.main_auto_offset_tenths.into()),
        ])
    }),
    (number::SET_LOGIC_VOLTAGES, |unit, args| {
        unit.settings.battery.logic_min_tenths = args.u16("min");
        unit.settings.battery.logic_max_tenths = args.u16("max");
        Answer::Ack
    }),
    (number::READ_LOGIC_VOLTAGES, |unit, _| {
        let battery = &unit.settings.battery;
        Answer::ints([("min", battery.logic_min_tenths.into()), ("max", battery.logic_max_tenths.into())])
    }),
    (number::SET_SPEED_ERROR_LIMITS, |unit, args| {
        unit.motion(M1).speed_error_limit = args.u32("limit_m1");
        unit.motion(M2).speed_error_limit = args.u32("limit_m2");
        Answer::Ack
    }),
    (number::READ_SPEED_ERROR_LIMITS, |unit, _| {
        let limits = [M1, M2].map(|motor| unit.motion(motor).speed_error_limit);
        error_limits(unit, limits)
    }),
    (number::READ_SPEED_ERRORS, |unit, _| {
        let errors = [M1, M2].map(|motor| unit.channels[motor.index()].errors().speed_counts_per_s);
        loop_errors(unit, errors)
    }),
    (number::SET_POSITION_ERROR_LIMITS, |unit, args| {
        unit.motion(M1).position_error_limit = args.u32("limit_m1");
        unit.motion(M2).position_error_limit = args.u32("limit_m2");
        Answer::Ack
    }),
    (number::READ_POSITION_ERROR_LIMITS, |unit, _| {
        let limits = [M1, M2].map(|motor| unit.motion(motor).position_error_limit);
        error_limits(unit, limits)
    }),
    (number::READ_POSITION_ERRORS, |unit, _| {
        let errors = [M1, M2].map(|motor| unit.channels[motor.index()].errors().position_counts);
        loop_errors(unit, errors)
    }),
    (number::SET_VOLTAGE_OFFSETS, |unit, args| {
        unit.settings.battery.main_offset_tenths = args.int_or("main", 0) as i8;
        unit.settings.battery.logic_offset_tenths = args.int_or("logic", 0) as i8;
        Answer::Ack
    }),
    (number::READ_VOLTAGE_OFFSETS, |unit, _| {
        let battery = &unit.settings.battery;
        Answer::ints([
            ("main", battery.main_offset_tenths.into()),
            ("logic", battery.logic_offset_tenths.into()),
        ])
    }),
    (number::SET_CURRENT_LIMITS_M1, |unit, args| set_current(unit, M1, args)),
    (number::SET_CURRENT_LIMITS_M2, |unit, args| set_current(unit, M2, args)),
    (number::READ_CURRENT_LIMITS_M1, |unit, _| current(unit, M1)),
    (number::READ_CURRENT_LIMITS_M2, |unit, _| current(unit, M2)),
    (number::RESET_ESTOP, |unit, _| {
        let reset = unit.estop_reset();
        unit.estop.reset(reset);
        unit.update_estop();
        Answer::Ack
    }),
    (number::SET_ESTOP_LOCK, |unit, args| {
        unit.settings.unit.estop_lock = args.u8("lock");
        Answer::Ack
    }),
    (number::READ_ESTOP_LOCK, |unit, _| Answer::ints([("lock", unit.settings.unit.estop_lock.into())])),
];

/// Generation 4 has two bytes for what generation 3 has four.
fn error_limits(unit: &Firmware, limits: [u32; 2]) -> Answer {
    let narrow = unit.generation == Generation::Gen4;
    let [m1, m2] = limits.map(|limit| if narrow { limit.min(u16::MAX.into()) } else { limit });
    Answer::ints([("limit_m1", m1.into()), ("limit_m2", m2.into())])
}

/// Signed in generation 3, a magnitude of two bytes in generation 4.
fn loop_errors(unit: &Firmware, errors: [i32; 2]) -> Answer {
    let narrow = unit.generation == Generation::Gen4;
    let magnitude = |error: i32| i64::from(error.unsigned_abs().min(u16::MAX.into()));
    let [m1, m2] = errors.map(|error| if narrow { magnitude(error) } else { error.into() });
    Answer::ints([("error_m1", m1), ("error_m2", m2)])
}

fn set_current(unit: &mut Firmware, motor: Motor, args: &Arguments<'_>) -> Answer {
    let motion = unit.motion(motor);
    motion.max_current_raw = args.u32("max");
    motion.min_current_raw = args.i32("min");
    Answer::Ack
}

fn current(unit: &mut Firmware, motor: Motor) -> Answer {
    let motion = unit.motion(motor);
    Answer::ints([("max", i64::from(motion.max_current_raw as i32)), ("min", motion.min_current_raw.into())])
}
