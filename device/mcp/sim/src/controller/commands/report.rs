//! What the unit says about itself: commands 21, 24, 25, 47 to 49, 73, 82, 83, 90, 100 and 101.

use super::super::answer::{Answer, Handlers, On, tell, tell_value};
use super::super::firmware::Firmware;
use super::super::readings::{amps_raw, celsius_raw, volts_raw};
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};
use brushwork_values::Value;

pub(super) const HANDLERS: Handlers = &[
    &On(commands::READ_VERSION, |unit, _| {
        Answer::of([tell_value(VERSION, Value::Text(unit.options.version_text(unit.model)))])
    }),
    &On(commands::READ_MAIN_BATTERY, |unit, _| Answer::of([tell(MAIN_BATTERY, unit.main_battery_raw())])),
    &On(commands::READ_LOGIC_BATTERY, |unit, _| Answer::of([tell(LOGIC_BATTERY, unit.logic_battery_raw())])),
    &On(commands::READ_BUFFERS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.channels[motor.index()].buffer_length());
        Answer::of([tell(BUFFER_M1, m1.into()), tell(BUFFER_M2, m2.into())])
    }),
    &On(commands::READ_PWMS, |unit, _| {
        Answer::of([tell(DUTY_M1, unit.duty_raw(M1)), tell(DUTY_M2, unit.duty_raw(M2))])
    }),
    &On(commands::READ_CURRENTS, |unit, _| {
        Answer::of([tell(CURRENT_M1, unit.current_raw(M1)), tell(CURRENT_M2, unit.current_raw(M2))])
    }),
    &On(commands::READ_ALL_STATUS, |unit, _| all_status(unit)),
    &On(commands::READ_TEMPERATURE_1, |unit, _| Answer::of([tell(TEMPERATURE_1, unit.temperature_raw(0))])),
    &On(commands::READ_TEMPERATURE_2, |unit, _| Answer::of([tell(TEMPERATURE_2, unit.temperature_raw(1))])),
    &On(commands::READ_STATUS, |unit, _| Answer::of([tell(STATUS, unit.status_word().into())])),
    &On(commands::READ_VOLTS, |unit, args| match unit.generation {
        Generation::Gen1 => factory_test(unit, M1),
        Generation::Gen2 | Generation::Gen3 => {
            unit.settings.roboclaw.control_modes =
                [args.int_or(MODE_1, 0) as u8, args.int_or(MODE_2, 0) as u8];
            Answer::Ack
        }
        Generation::Gen4 => Answer::of([
            tell(MAIN_BATTERY, unit.main_battery_raw()),
            tell(LOGIC_BATTERY, unit.logic_battery_raw()),
        ]),
    }),
    &On(commands::READ_TEMPERATURES, |unit, _| match unit.generation {
        Generation::Gen1 => factory_test(unit, M2),
        Generation::Gen2 | Generation::Gen3 => {
            let [first, second] = unit.settings.roboclaw.control_modes;
            Answer::of([tell(MODE_1, first.into()), tell(MODE_2, second.into())])
        }
        Generation::Gen4 => Answer::of([
            tell(TEMPERATURE_1, unit.temperature_raw(0)),
            tell(TEMPERATURE_2, unit.temperature_raw(1)),
        ]),
    }),
];

impl Firmware {
    /// Main battery in 0.1 V, offset included.
    pub(in super::super) fn main_battery_raw(&self) -> i64 {
        volts_raw(self.readings.main_volts, self.settings.battery.main_offset_tenths)
    }

    /// Logic battery in 0.1 V, offset included.
    pub(in super::super) fn logic_battery_raw(&self) -> i64 {
        volts_raw(self.readings.logic_volts, self.settings.battery.logic_offset_tenths)
    }

    /// Duty as command 48 reads it.
    pub(in super::super) fn duty_raw(&self, motor: Motor) -> i64 {
        self.channels[motor.index()].duty_raw().into()
    }

    /// Current in 10 mA; bridged, motor 1 has all of it.
    pub(in super::super) fn current_raw(&self, motor: Motor) -> i64 {
        if self.is_bridged() && motor == M2 { 0 } else { amps_raw(self.readings.amps[motor.index()]) }
    }

    /// Temperature in 0.1 degrees; a sensor that the model lacks reads 0 (MCP manual 1.2.10).
    pub(in super::super) fn temperature_raw(&self, sensor: usize) -> i64 {
        let exists = sensor == 0 || self.model.second_temperature;
        if exists { celsius_raw(self.readings.celsius[sensor]) } else { 0 }
    }
}

/// Command 73. Assumed: the tick counts milliseconds since power up.
fn all_status<const L: u8>(unit: &Firmware) -> Answer<L> {
    let narrow = |value: i32| i64::from(value.clamp(i32::from(i16::MIN), i32::from(i16::MAX)));
    let errors = [M1, M2].map(|motor| unit.channels[motor.index()].errors());
    let speeds = [M1, M2].map(|motor| unit.speeds(motor));
    Answer::of([
        tell(TICK, unit.up_for().as_millis() as i64 & i64::from(u32::MAX)),
        tell(STATUS, unit.status_word().into()),
        tell(TEMPERATURE_1, unit.temperature_raw(0)),
        tell(TEMPERATURE_2, unit.temperature_raw(1)),
        tell(MAIN_BATTERY, unit.main_battery_raw()),
        tell(LOGIC_BATTERY, unit.logic_battery_raw()),
        tell(DUTY_M1, unit.duty_raw(M1)),
        tell(DUTY_M2, unit.duty_raw(M2)),
        tell(CURRENT_M1, unit.current_raw(M1)),
        tell(CURRENT_M2, unit.current_raw(M2)),
        tell(ENCODER_M1, unit.position(M1)),
        tell(ENCODER_M2, unit.position(M2)),
        tell(SPEED_M1, speeds[0].filtered.into()),
        tell(SPEED_M2, speeds[1].filtered.into()),
        tell(RAW_SPEED_M1, speeds[0].raw.into()),
        tell(RAW_SPEED_M2, speeds[1].raw.into()),
        tell(SPEED_ERROR_M1, narrow(errors[0].speed_counts_per_s)),
        tell(SPEED_ERROR_M2, narrow(errors[1].speed_counts_per_s)),
        tell(POSITION_ERROR_M1, narrow(errors[0].position_counts)),
        tell(POSITION_ERROR_M2, narrow(errors[1].position_counts)),
    ])
}

/// Commands 100 and 101 of generation 1. Assumed: without running the motor they read its present speed.
fn factory_test<const L: u8>(unit: &Firmware, motor: Motor) -> Answer<L> {
    let speed = unit.speeds(motor).filtered.clamp(i16::MIN.into(), i16::MAX.into());
    Answer::of([tell(SPEED, speed.into())])
}
