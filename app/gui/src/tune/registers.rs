//! The gains of a motor as settings: written from registers, and read into them.

use brushwork_core::tune::law::AnyRegisters;
use brushwork_link::settings::{SettingValue, SettingsImage, Signed};
use brushwork_tuning::registers::{Form, RegisterField, RegisterTable as _};
use brushwork_values::Motor;

use crate::model::loop_settings::key;

/// The key of a field's setting.
pub fn key_of(field: &RegisterField, motor: Motor) -> String {
    if field.of_motor { key(motor, field.key) } else { field.key.to_owned() }
}

/// A register's value as its setting.
fn setting(field: &RegisterField, raw: i64) -> SettingValue {
    match (field.form, field.scale) {
        (Form::Switch, _) => SettingValue::Bool(raw != 0),
        (Form::Number, 1.0) => SettingValue::Int(raw),
        (Form::Number, scale) => SettingValue::Number(raw as f64 / scale),
    }
}

/// A setting as the register's value; none where it is no number.
fn raw(field: &RegisterField, value: SettingValue) -> Option<i64> {
    match value {
        SettingValue::Bool(set) => Some(i64::from(set)),
        SettingValue::Int(number) => Some((number as f64 * field.scale).round() as i64),
        SettingValue::Number(number) | SettingValue::Signed(Signed { number, .. }) => {
            Some((number * field.scale).round() as i64)
        }
        SettingValue::Choice(_) | SettingValue::UnknownCode(_) => None,
    }
}

/// The settings that registers stand for, to be written.
pub fn image(registers: &AnyRegisters, motor: Motor) -> SettingsImage {
    let mut image = SettingsImage::default();
    for field in AnyRegisters::fields() {
        if let Some(raw) = registers.raw(field.key) {
            image.set(&key_of(field, motor), setting(field, raw));
        }
    }
    image
}

/// What settings say of the registers; those of a position loop of its own where they are asked for. None while one is not known.
pub fn of_settings(
    value: impl Fn(&RegisterField, &str) -> Option<SettingValue>,
    motor: Motor,
    with_position: bool,
) -> Option<AnyRegisters> {
    AnyRegisters::of_values(&|field| raw(field, value(field, &key_of(field, motor))?), with_position)
}

/// One register as a person reads it; none where the controller has no such one.
pub fn value_of(registers: &AnyRegisters, key: &str) -> Option<f64> {
    let field = AnyRegisters::fields().into_iter().find(|field| field.key == key)?;
    registers.value(field)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_go_into_settings_and_come_back() {
        for with_position in [false, true] {
            let mut registers = AnyRegisters::blank(with_position);
            for (number, field) in (3..).zip(AnyRegisters::fields()) {
                registers.set_raw(field.key, number);
            }
            let image = image(&registers, Motor::M2);
            assert_eq!(image.iter().count(), if with_position { 11 } else { 4 });
            let read = |motor| of_settings(|_, key| image.get(key), motor, with_position);
            assert_eq!((read(Motor::M2), read(Motor::M1)), (Some(registers), None));
        }
    }
}
