//! What the unit says about itself: commands 21, 24, 25, 47 to 49, 73, 82, 83, 90, 100 and 101.

use super::super::answer::{Answer, Handlers, Named};
use super::super::firmware::Firmware;
use super::super::readings::{amps_raw, celsius_raw, volts_raw};
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};
use brushwork_values::Value;

pub(super) const HANDLERS: Handlers = &[
    (number::READ_VERSION, |unit, _| {
        Answer::Data(vec![("version", Value::Text(unit.options.version_text(unit.model)))])
    }),
    (number::READ_MAIN_BATTERY, |unit, _| Answer::ints([("main_battery", unit.main_battery_raw())])),
    (number::READ_LOGIC_BATTERY, |unit, _| Answer::ints([("logic_battery", unit.logic_battery_raw())])),
    (number::READ_BUFFERS, |unit, _| {
        let [m1, m2] = [M1, M2].map(|motor| unit.channels[motor.index()].buffer_length());
        Answer::ints([("buffer_m1", m1.into()), ("buffer_m2", m2.into())])
    }),
    (number::READ_PWMS, |unit, _| {
        Answer::ints([("duty_m1", unit.duty_raw(M1)), ("duty_m2", unit.duty_raw(M2))])
    }),
    (number::READ_CURRENTS, |unit, _| {
        Answer::ints([("current_m1", unit.current_raw(M1)), ("current_m2", unit.current_raw(M2))])
    }),
    (number::READ_ALL_STATUS, |unit, _| Answer::Data(all_status(unit))),
    (number::READ_TEMPERATURE_1, |unit, _| Answer::ints([("temperature_1", unit.temperature_raw(0))])),
    (number::READ_TEMPERATURE_2, |unit, _| Answer::ints([("temperature_2", unit.temperature_raw(1))])),
    (number::READ_STATUS, |unit, _| Answer::ints([("status", unit.status_word().into())])),
    (number::READ_VOLTS, |unit, args| match unit.generation {
        Generation::Gen1 => factory_test(unit, M1),
        Generation::Gen2 | Generation::Gen3 => {
            unit.settings.roboclaw.control_modes = [args.u8("mode_1"), args.u8("mode_2")];
            Answer::Ack
        }
        Generation::Gen4 => Answer::ints([
            ("main_battery", unit.main_battery_raw()),
            ("logic_battery", unit.logic_battery_raw()),
        ]),
    }),
    (number::READ_TEMPERATURES, |unit, _| match unit.generation {
        Generation::Gen1 => factory_test(unit, M2),
        Generation::Gen2 | Generation::Gen3 => {
            let [first, second] = unit.settings.roboclaw.control_modes;
            Answer::ints([("mode_1", first.into()), ("mode_2", second.into())])
        }
        Generation::Gen4 => Answer::ints([
            ("temperature_1", unit.temperature_raw(0)),
            ("temperature_2", unit.temperature_raw(1)),
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
fn all_status(unit: &Firmware) -> Vec<Named> {
    let narrow = |value: i32| i64::from(value.clamp(i32::from(i16::MIN), i32::from(i16::MAX)));
    let errors = [M1, M2].map(|motor| unit.channels[motor.index()].errors());
    let speeds = [M1, M2].map(|motor| unit.speeds(motor));
    let fields: [(&'static str, i64); 20] = [
        ("tick", unit.up_for().as_millis() as i64 & i64::from(u32::MAX)),
        ("status", unit.status_word().into()),
        ("temperature_1", unit.temperature_raw(0)),
        ("temperature_2", unit.temperature_raw(1)),
        ("main_battery", unit.main_battery_raw()),
        ("logic_battery", unit.logic_battery_raw()),
        ("duty_m1", unit.duty_raw(M1)),
        ("duty_m2", unit.duty_raw(M2)),
        ("current_m1", unit.current_raw(M1)),
        ("current_m2", unit.current_raw(M2)),
        ("encoder_m1", unit.position(M1)),
        ("encoder_m2", unit.position(M2)),
        ("speed_m1", speeds[0].filtered.into()),
        ("speed_m2", speeds[1].filtered.into()),
        ("raw_speed_m1", speeds[0].raw.into()),
        ("raw_speed_m2", speeds[1].raw.into()),
        ("speed_error_m1", narrow(errors[0].speed_counts_per_s)),
        ("speed_error_m2", narrow(errors[1].speed_counts_per_s)),
        ("position_error_m1", narrow(errors[0].position_counts)),
        ("position_error_m2", narrow(errors[1].position_counts)),
    ];
    fields.into_iter().map(|(name, value)| (name, Value::Int(value))).collect()
}

/// Commands 100 and 101 of generation 1. Assumed: without running the motor they read its present speed.
fn factory_test(unit: &Firmware, motor: Motor) -> Answer {
    let speed = unit.speeds(motor).filtered.clamp(i16::MIN.into(), i16::MAX.into());
    Answer::ints([("speed", speed.into())])
}
