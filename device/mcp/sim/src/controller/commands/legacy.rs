//! The compatibility commands 0 to 13, 26 and 27.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::motion::{MotionCommand, seven_bit_backward, seven_bit_centered, seven_bit_forward};
use brushwork_mcp_wire::packet_serial::{number, scale};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::FORWARD_M1, |unit, args| drive(unit, M1, seven_bit_forward(power(args)))),
    (number::BACKWARD_M1, |unit, args| drive(unit, M1, seven_bit_backward(power(args)))),
    (number::SET_MAIN_VOLTAGE_MIN, |unit, args| {
        unit.settings.battery.main_min_tenths = min_tenths(args);
        unit.legacy_ack()
    }),
    (number::SET_MAIN_VOLTAGE_MAX, |unit, args| {
        unit.settings.battery.main_max_tenths = max_tenths(args);
        unit.legacy_ack()
    }),
    (number::FORWARD_M2, |unit, args| drive(unit, M2, seven_bit_forward(power(args)))),
    (number::BACKWARD_M2, |unit, args| drive(unit, M2, seven_bit_backward(power(args)))),
    (number::DRIVE_7BIT_M1, |unit, args| drive(unit, M1, seven_bit_centered(power(args)))),
    (number::DRIVE_7BIT_M2, |unit, args| drive(unit, M2, seven_bit_centered(power(args)))),
    (number::MIXED_FORWARD, |unit, args| mix_drive(unit, seven_bit_forward(power(args)))),
    (number::MIXED_BACKWARD, |unit, args| mix_drive(unit, seven_bit_backward(power(args)))),
    (number::MIXED_RIGHT, |unit, args| mix_turn(unit, seven_bit_forward(power(args)))),
    (number::MIXED_LEFT, |unit, args| mix_turn(unit, seven_bit_backward(power(args)))),
    (number::MIXED_DRIVE_7BIT, |unit, args| mix_drive(unit, seven_bit_centered(power(args)))),
    (number::MIXED_TURN_7BIT, |unit, args| mix_turn(unit, seven_bit_centered(power(args)))),
    (number::SET_LOGIC_VOLTAGE_MIN, |unit, args| {
        unit.settings.battery.logic_min_tenths = min_tenths(args);
        Answer::Ack
    }),
    (number::SET_LOGIC_VOLTAGE_MAX, |unit, args| {
        unit.settings.battery.logic_max_tenths = max_tenths(args);
        Answer::Ack
    }),
];

impl Firmware {
    fn legacy_ack(&self) -> Answer {
        if self.options.acknowledges_legacy { Answer::Ack } else { Answer::Silence }
    }
}

fn power(args: &Arguments<'_>) -> u8 {
    args.u8("power")
}

fn drive(unit: &mut Firmware, motor: Motor, duty_raw: i16) -> Answer {
    match unit.drive(motor, MotionCommand::Duty { duty_raw, acceleration_raw: None }) {
        Answer::Ack => unit.legacy_ack(),
        refused => refused,
    }
}

fn mix_drive(unit: &mut Firmware, duty_raw: i16) -> Answer {
    let duties = unit.mixer.drive(duty_raw);
    drive_mixed(unit, duties)
}

fn mix_turn(unit: &mut Firmware, duty_raw: i16) -> Answer {
    let duties = unit.mixer.turn(duty_raw);
    drive_mixed(unit, duties)
}

fn drive_mixed(unit: &mut Firmware, duties: Option<[i16; 2]>) -> Answer {
    if let Some(duties) = duties {
        unit.drive_both(duties.map(|duty_raw| MotionCommand::Duty { duty_raw, acceleration_raw: None }));
    }
    unit.legacy_ack()
}

/// Command value 0 is 6 V, each count 0.2 V more.
fn min_tenths(args: &Arguments<'_>) -> u16 {
    let volts =
        scale::LEGACY_MIN_VOLTS_OFFSET + f64::from(args.u8("value")) * scale::LEGACY_MIN_VOLTS_PER_COUNT;
    (volts / scale::VOLTAGE_VOLTS).round() as u16
}

/// 5.12 counts for each volt.
fn max_tenths(args: &Arguments<'_>) -> u16 {
    let volts = f64::from(args.u8("value")) / scale::LEGACY_MAX_COUNTS_PER_VOLT;
    (volts / scale::VOLTAGE_VOLTS).round() as u16
}
