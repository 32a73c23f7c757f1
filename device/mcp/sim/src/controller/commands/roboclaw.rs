//! Commands that only RoboClaw units give a meaning to: 74 to 77, 98, 99, 102, 104 to 107, 117, 118. What they set acts in
//! [`control`](super::super::control).

use super::super::answer::{Answer, Arguments, Handlers, On, tell};
use super::super::firmware::Firmware;
use crate::settings::ControlInput;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Generation, commands};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SET_PIN_FUNCTIONS, |unit, args| {
        let functions = &mut unit.settings.roboclaw.pin_functions;
        let given = [args.get(S3), args.get(S4), args.get(S5), args.get(D1), args.get(D2)];
        for (function, given) in functions.iter_mut().zip(given) {
            *function = given.map_or(*function, |raw| raw as u8);
        }
        Answer::Ack
    }),
    &On(commands::READ_PIN_FUNCTIONS, |unit, _| {
        let [s3, s4, s5, d1, d2] = unit.settings.roboclaw.pin_functions.map(i64::from);
        Answer::of([tell(S3, s3), tell(S4, s4), tell(S5, s5), tell(D1, d1), tell(D2, d2)])
    }),
    &On(commands::SET_CONTROL_SETTINGS, set_control_settings),
    &On(commands::READ_CONTROL_SETTINGS, |unit, _| control_settings(unit)),
    &On(commands::SET_CONFIG, |unit, args| {
        unit.set_config_word(args.u16(CONFIG));
        Answer::Ack
    }),
    &On(commands::READ_CONFIG, |unit, _| Answer::of([tell(CONFIG, unit.config_word().into())])),
    &On(commands::SET_AUX_DUTIES, |unit, args| {
        if matches!(unit.generation, Generation::Gen2 | Generation::Gen3) {
            unit.settings.roboclaw.control_duties[0] = args.int_or(DUTY_1, 0) as u16;
        } else {
            unit.auxiliary_duties =
                [args.get(DUTY_1), args.get(DUTY_2), args.get(DUTY_3), args.get(DUTY_4), args.get(DUTY_5)]
                    .map(|raw| raw.unwrap_or(0) as u16);
        }
        Answer::Ack
    }),
    &On(commands::READ_AUX_DUTIES, |unit, _| {
        let mut duties = unit.auxiliary_duties;
        if unit.generation != Generation::Gen4 {
            duties[..2].copy_from_slice(&unit.settings.roboclaw.control_duties);
        }
        let [d1, d2, d3, d4, d5] = duties.map(i64::from);
        Answer::of([tell(DUTY_1, d1), tell(DUTY_2, d2), tell(DUTY_3, d3), tell(DUTY_4, d4), tell(DUTY_5, d5)])
    }),
    &On(commands::SET_HOMING_M1, |unit, args| set_homing(unit, 0, args)),
    &On(commands::SET_HOMING_M2, |unit, args| set_homing(unit, 1, args)),
    &On(commands::READ_HOMING, |unit, _| {
        let [m1, m2] = &unit.settings.motors;
        Answer::of([
            tell(DUTY_M1, m1.homing_duty_raw.into()),
            tell(TIMEOUT_M1, m1.homing_timeout_ticks.into()),
            tell(DUTY_M2, m2.homing_duty_raw.into()),
            tell(TIMEOUT_M2, m2.homing_timeout_ticks.into()),
        ])
    }),
    &On(commands::SET_CONTROL_LIMITS, |unit, args| {
        unit.settings.roboclaw.control_limits =
            [args.u16(S1_MIN), args.u16(S1_MAX), args.u16(S2_MIN), args.u16(S2_MAX)];
        Answer::Ack
    }),
    &On(commands::READ_CONTROL_LIMITS, |unit, _| {
        let [s1_min, s1_max, s2_min, s2_max] = unit.settings.roboclaw.control_limits.map(i64::from);
        Answer::of([tell(S1_MIN, s1_min), tell(S1_MAX, s1_max), tell(S2_MIN, s2_min), tell(S2_MAX, s2_max)])
    }),
];

fn set_homing<const L: u8>(unit: &mut Firmware, motor: usize, args: &Arguments<'_, L>) -> Answer<L> {
    let motor = &mut unit.settings.motors[motor];
    motor.homing_duty_raw = args.int_or(DUTY, motor.homing_duty_raw.into()) as u16;
    motor.homing_timeout_ticks = args.u32(TIMEOUT);
    Answer::Ack
}

/// Commands 76 and 77 in three shapes: one dead band, one per input, and all of each input's settings. Generation 3 calls the dead
/// bands min and max, generation 4 the ends of the range.
fn set_control_settings<const L: u8>(unit: &mut Firmware, args: &Arguments<'_, L>) -> Answer<L> {
    let (mins, maxes) = ([args.get(S1_MIN), args.get(S2_MIN)], [args.get(S1_MAX), args.get(S2_MAX)]);
    let is_wide = unit.generation == Generation::Gen4;
    let reverses = [args.get(S1_REVERSE_DEADBAND), args.get(S2_REVERSE_DEADBAND)];
    let forwards = [args.get(S1_FORWARD_DEADBAND), args.get(S2_FORWARD_DEADBAND)];
    let (reverses, forwards) = if is_wide { (reverses, forwards) } else { (mins, maxes) };
    let reverse_limits = [args.get(S1_REVERSE_LIMIT), args.get(S2_REVERSE_LIMIT)];
    let forward_limits = [args.get(S1_FORWARD_LIMIT), args.get(S2_FORWARD_LIMIT)];
    let centers = [args.get(S1_CENTER), args.get(S2_CENTER)];
    for (at, input) in unit.settings.roboclaw.inputs.iter_mut().enumerate() {
        let (reverse, forward) =
            (reverses[at].or(args.get(DEADBAND_MIN)), forwards[at].or(args.get(DEADBAND_MAX)));
        input.reverse_deadband = reverse.map_or(input.reverse_deadband, |raw| raw as u8);
        input.forward_deadband = forward.map_or(input.forward_deadband, |raw| raw as u8);
        if is_wide {
            let take = |given: Option<i64>, current: u16| given.map_or(current, |raw| raw as u16);
            input.reverse_limit = take(reverse_limits[at], input.reverse_limit);
            input.forward_limit = take(forward_limits[at], input.forward_limit);
            input.center = take(centers[at], input.center);
            input.min = take(mins[at], input.min);
            input.max = take(maxes[at], input.max);
        }
    }
    Answer::Ack
}

fn control_settings<const L: u8>(unit: &Firmware) -> Answer<L> {
    let [s1, s2] = &unit.settings.roboclaw.inputs;
    let range = |input: &ControlInput| match unit.generation {
        Generation::Gen4 => [input.min.into(), input.max.into()],
        Generation::Gen1 | Generation::Gen2 | Generation::Gen3 => {
            [input.reverse_deadband.into(), input.forward_deadband.into()]
        }
    };
    let ([s1_min, s1_max], [s2_min, s2_max]) = (range(s1), range(s2));
    Answer::of([
        tell(DEADBAND_MIN, s1.reverse_deadband.into()),
        tell(DEADBAND_MAX, s1.forward_deadband.into()),
        tell(S1_REVERSE_DEADBAND, s1.reverse_deadband.into()),
        tell(S1_FORWARD_DEADBAND, s1.forward_deadband.into()),
        tell(S1_REVERSE_LIMIT, s1.reverse_limit.into()),
        tell(S1_FORWARD_LIMIT, s1.forward_limit.into()),
        tell(S1_CENTER, s1.center.into()),
        tell(S1_MIN, s1_min),
        tell(S1_MAX, s1_max),
        tell(S2_REVERSE_DEADBAND, s2.reverse_deadband.into()),
        tell(S2_FORWARD_DEADBAND, s2.forward_deadband.into()),
        tell(S2_REVERSE_LIMIT, s2.reverse_limit.into()),
        tell(S2_FORWARD_LIMIT, s2.forward_limit.into()),
        tell(S2_CENTER, s2.center.into()),
        tell(S2_MIN, s2_min),
        tell(S2_MAX, s2_max),
    ])
}
