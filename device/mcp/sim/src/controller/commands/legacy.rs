//! The compatibility commands 0 to 13, 26 and 27.

use super::super::answer::{Answer, Arguments, Handlers, On};
use super::super::firmware::Firmware;
use crate::motion::{MotionCommand, seven_bit_backward, seven_bit_centered, seven_bit_forward};
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{commands, scale};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::FORWARD_M1, |unit, args| drive(unit, M1, seven_bit_forward(power(args)))),
    &On(commands::BACKWARD_M1, |unit, args| drive(unit, M1, seven_bit_backward(power(args)))),
    &On(commands::SET_MAIN_VOLTAGE_MIN, |unit, args| {
        unit.settings.battery.main_min_tenths = min_tenths(args);
        unit.legacy_ack()
    }),
    &On(commands::SET_MAIN_VOLTAGE_MAX, |unit, args| {
        unit.settings.battery.main_max_tenths = max_tenths(args);
        unit.legacy_ack()
    }),
    &On(commands::FORWARD_M2, |unit, args| drive(unit, M2, seven_bit_forward(power(args)))),
    &On(commands::BACKWARD_M2, |unit, args| drive(unit, M2, seven_bit_backward(power(args)))),
    &On(commands::DRIVE_7BIT_M1, |unit, args| drive(unit, M1, seven_bit_centered(power(args)))),
    &On(commands::DRIVE_7BIT_M2, |unit, args| drive(unit, M2, seven_bit_centered(power(args)))),
    &On(commands::MIXED_FORWARD, |unit, args| mix_drive(unit, seven_bit_forward(power(args)))),
    &On(commands::MIXED_BACKWARD, |unit, args| mix_drive(unit, seven_bit_backward(power(args)))),
    &On(commands::MIXED_RIGHT, |unit, args| mix_turn(unit, seven_bit_forward(power(args)))),
    &On(commands::MIXED_LEFT, |unit, args| mix_turn(unit, seven_bit_backward(power(args)))),
    &On(commands::MIXED_DRIVE_7BIT, |unit, args| mix_drive(unit, seven_bit_centered(power(args)))),
    &On(commands::MIXED_TURN_7BIT, |unit, args| mix_turn(unit, seven_bit_centered(power(args)))),
    &On(commands::SET_LOGIC_VOLTAGE_MIN, |unit, args| {
        unit.settings.battery.logic_min_tenths = min_tenths(args);
        Answer::Ack
    }),
    &On(commands::SET_LOGIC_VOLTAGE_MAX, |unit, args| {
        unit.settings.battery.logic_max_tenths = max_tenths(args);
        Answer::Ack
    }),
];

impl Firmware {
    fn legacy_ack<const L: u8>(&self) -> Answer<L> {
        if self.options.acknowledges_legacy { Answer::Ack } else { Answer::Silence }
    }
}

fn power<const L: u8>(args: &Arguments<'_, L>) -> u8 {
    args.u8(POWER)
}

fn drive<const L: u8>(unit: &mut Firmware, motor: Motor, duty_raw: i16) -> Answer<L> {
    match unit.drive(motor, MotionCommand::Duty { duty_raw, acceleration_raw: None }) {
        Answer::Ack => unit.legacy_ack(),
        refused @ (Answer::Data(_) | Answer::AckThenStatus { .. } | Answer::Refused | Answer::Silence) => {
            refused
        }
    }
}

fn mix_drive<const L: u8>(unit: &mut Firmware, duty_raw: i16) -> Answer<L> {
    let duties = unit.mixer.drive(duty_raw);
    drive_mixed(unit, duties)
}

fn mix_turn<const L: u8>(unit: &mut Firmware, duty_raw: i16) -> Answer<L> {
    let duties = unit.mixer.turn(duty_raw);
    drive_mixed(unit, duties)
}

fn drive_mixed<const L: u8>(unit: &mut Firmware, duties: Option<[i16; 2]>) -> Answer<L> {
    if let Some(duties) = duties {
        let _: Answer<L> =
            unit.drive_both(duties.map(|duty_raw| MotionCommand::Duty { duty_raw, acceleration_raw: None }));
    }
    unit.legacy_ack()
}

/// Command value 0 is 6 V, each count 0.2 V more.
fn min_tenths<const L: u8>(args: &Arguments<'_, L>) -> u16 {
    let volts =
        scale::LEGACY_MIN_VOLTS_OFFSET + f64::from(args.u8(VALUE)) * scale::LEGACY_MIN_VOLTS_PER_COUNT;
    (volts / scale::VOLTAGE_VOLTS).round() as u16
}

/// 5.12 counts for each volt.
fn max_tenths<const L: u8>(args: &Arguments<'_, L>) -> u16 {
    let volts = f64::from(args.u8(VALUE)) / scale::LEGACY_MAX_COUNTS_PER_VOLT;
    (volts / scale::VOLTAGE_VOLTS).round() as u16
}
