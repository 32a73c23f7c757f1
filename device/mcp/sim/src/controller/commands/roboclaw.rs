//! Commands that only RoboClaw units give a meaning to: 74 to 77, 98, 99, 102, 104 to 107, 117, 118. Kept and returned.

use super::super::answer::{Answer, Arguments, Handlers, Named};
use super::super::firmware::Firmware;
use crate::settings::ControlInput;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};
use brushwork_values::Value;

pub(super) const HANDLERS: Handlers = &[
    (number::SET_PIN_FUNCTIONS, |unit, args| {
        let functions = &mut unit.settings.roboclaw.pin_functions;
        for (name, function) in PINS.into_iter().zip(functions) {
            *function = args.int_or(name, (*function).into()) as u8;
        }
        Answer::Ack
    }),
    (number::READ_PIN_FUNCTIONS, |unit, _| {
        let functions = unit.settings.roboclaw.pin_functions;
        Answer::Data(PINS.into_iter().zip(functions.map(|function| Value::Int(function.into()))).collect())
    }),
    (number::SET_CONTROL_SETTINGS, set_control_settings),
    (number::READ_CONTROL_SETTINGS, |unit, _| Answer::Data(control_settings(unit))),
    (number::SET_CONFIG, |unit, args| {
        let config = args.u16("config");
        unit.settings.unit.config_word = config;
        // Bits 8 to 10 are the address; it moves at once (public clients, 2015-2025).
        let address = Address::FIRST.get() + (config >> CONFIG_ADDRESS_SHIFT & 0x07) as u8;
        unit.settings.unit.address = address;
        Answer::Ack
    }),
    (number::READ_CONFIG, |unit, _| Answer::ints([("config", unit.settings.unit.config_word.into())])),
    (number::SET_AUX_DUTIES, |unit, args| {
        if matches!(unit.generation, Generation::Gen2 | Generation::Gen3) {
            unit.settings.roboclaw.control_duties[0] = args.u16("duty_1");
        } else {
            unit.auxiliary_duties = AUXILIARY.map(|name| args.u16(name));
        }
        Answer::Ack
    }),
    (number::READ_AUX_DUTIES, |unit, _| {
        let mut duties = unit.auxiliary_duties;
        if unit.generation != Generation::Gen4 {
            duties[..2].copy_from_slice(&unit.settings.roboclaw.control_duties);
        }
        Answer::Data(AUXILIARY.into_iter().zip(duties.map(|duty| Value::Int(duty.into()))).collect())
    }),
    (number::SET_HOMING_M1, |unit, args| set_homing(unit, 0, args)),
    (number::SET_HOMING_M2, |unit, args| set_homing(unit, 1, args)),
    (number::READ_HOMING, |unit, _| {
        let [m1, m2] = &unit.settings.motors;
        Answer::ints([
            ("duty_m1", m1.homing_duty_raw.into()),
            ("timeout_m1", m1.homing_timeout_ticks.into()),
            ("duty_m2", m2.homing_duty_raw.into()),
            ("timeout_m2", m2.homing_timeout_ticks.into()),
        ])
    }),
    (number::SET_CONTROL_LIMITS, |unit, args| {
        unit.settings.roboclaw.control_limits = LIMITS.map(|name| args.u16(name));
        Answer::Ack
    }),
    (number::READ_CONTROL_LIMITS, |unit, _| {
        let limits = unit.settings.roboclaw.control_limits;
        Answer::Data(LIMITS.into_iter().zip(limits.map(|limit| Value::Int(limit.into()))).collect())
    }),
];

const PINS: [&str; 5] = ["s3", "s4", "s5", "d1", "d2"];
const AUXILIARY: [&str; 5] = ["duty_1", "duty_2", "duty_3", "duty_4", "duty_5"];
const LIMITS: [&str; 4] = ["s1_min", "s1_max", "s2_min", "s2_max"];
/// Place of the address in the configuration word (public clients, 2015-2025).
const CONFIG_ADDRESS_SHIFT: u16 = 8;

fn set_homing(unit: &mut Firmware, motor: usize, args: &Arguments<'_>) -> Answer {
    let motor = &mut unit.settings.motors[motor];
    motor.homing_duty_raw = args.int_or("duty", motor.homing_duty_raw.into()) as u16;
    motor.homing_timeout_ticks = args.u32("timeout");
    Answer::Ack
}

/// Commands 76 and 77 in three shapes: one dead band, one per input, and all of each input's settings.
fn set_control_settings(unit: &mut Firmware, args: &Arguments<'_>) -> Answer {
    let generation = unit.generation;
    for (input, side) in unit.settings.roboclaw.inputs.iter_mut().zip(["s1", "s2"]) {
        let int = |name: &str, current: u16| args.int_or(&format!("{side}_{name}"), current.into()) as u16;
        let (reverse, forward) = if generation == Generation::Gen4 {
            ("reverse_deadband", "forward_deadband")
        } else {
            ("min", "max")
        };
        let deadband = |name: &str, common: &str, current: u8| {
            args.int_or(&format!("{side}_{name}"), args.int_or(common, current.into())) as u8
        };
        *input = ControlInput {
            reverse_deadband: deadband(reverse, "deadband_min", input.reverse_deadband),
            forward_deadband: deadband(forward, "deadband_max", input.forward_deadband),
            ..*input
        };
        if generation == Generation::Gen4 {
            *input = ControlInput {
                reverse_limit: int("reverse_limit", input.reverse_limit),
                forward_limit: int("forward_limit", input.forward_limit),
                center: int("center", input.center),
                min: int("min", input.min),
                max: int("max", input.max),
                ..*input
            };
        }
    }
    Answer::Ack
}

fn control_settings(unit: &Firmware) -> Vec<Named> {
    let [s1, s2] = &unit.settings.roboclaw.inputs;
    let mut fields: Vec<Named> = Vec::with_capacity(16);
    let mut push = |name, value: u16| fields.push((name, Value::Int(value.into())));
    push("deadband_min", s1.reverse_deadband.into());
    push("deadband_max", s1.forward_deadband.into());
    push("s1_reverse_deadband", s1.reverse_deadband.into());
    push("s1_forward_deadband", s1.forward_deadband.into());
    push("s1_reverse_limit", s1.reverse_limit);
    push("s1_forward_limit", s1.forward_limit);
    push("s1_center", s1.center);
    push("s2_reverse_deadband", s2.reverse_deadband.into());
    push("s2_forward_deadband", s2.forward_deadband.into());
    push("s2_reverse_limit", s2.reverse_limit);
    push("s2_forward_limit", s2.forward_limit);
    push("s2_center", s2.center);
    // Generation 3 calls the dead bands min and max, generation 4 the ends of the range.
    let ranges = if unit.generation == Generation::Gen4 {
        [s1.min, s1.max, s2.min, s2.max]
    } else {
        [s1.reverse_deadband, s1.forward_deadband, s2.reverse_deadband, s2.forward_deadband].map(u16::from)
    };
    for (name, value) in LIMITS.into_iter().zip(ranges) {
        push(name, value);
    }
    fields
}
