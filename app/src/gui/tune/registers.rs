//! The gains of a motor as a person reads them: which there are, in what unit, and where they stand in the settings.

use brushwork_link::settings::{SettingValue, SettingsImage};
use brushwork_protocol::packet_serial::Motor;
use brushwork_tuning::axis::{PositionRegisters, VelocityRegisters};

use crate::gui::model::loop_settings::{LoopSettings, key};

/// Wire value of a velocity gain of 1 (MCP manual, command 28).
const VELOCITY_SCALE: f64 = 65_536.0;
/// Wire value of a position gain of 1 (public clients, 2015-2025).
const POSITION_SCALE: f64 = 1_024.0;

/// The registers of a motor's loops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Registers {
    pub velocity: VelocityRegisters,
    /// Of the methods that have a position loop.
    pub position: Option<PositionRegisters>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// The key of its setting behind "motor1." or "motor2.".
    pub key: &'static str,
    pub label: &'static str,
    pub unit: &'static str,
    /// Wire value of 1.
    scale: f64,
    pub decimals: usize,
    /// Change per arrow key.
    pub step: f64,
    pub range: (f64, f64),
    get: fn(&Registers) -> Option<i64>,
    set: fn(&mut Registers, i64),
}

macro_rules! velocity {
    ($key:literal, $label:literal, $field:ident) => {
        Field {
            key: $key,
            label: $label,
            unit: "",
            scale: VELOCITY_SCALE,
            decimals: 4,
            step: 0.01,
            range: (0.0, 65_535.0),
            get: |registers| Some(registers.velocity.$field.into()),
            set: |registers, raw| registers.velocity.$field = whole(raw),
        }
    };
}

macro_rules! position {
    ($key:literal, $label:literal, $unit:literal, $scale:expr, $decimals:literal, $field:ident) => {
        Field {
            key: $key,
            label: $label,
            unit: $unit,
            scale: $scale,
            decimals: $decimals,
            step: 1.0,
            range: (0.0, 2_000_000_000.0),
            get: |registers| registers.position.map(|position| position.$field.into()),
            set: |registers, raw| {
                if let Some(position) = &mut registers.position {
                    position.$field = whole(raw);
                }
            },
        }
    };
}

macro_rules! end {
    ($key:literal, $label:literal, $field:ident) => {
        Field {
            key: $key,
            label: $label,
            unit: "counts",
            scale: 1.0,
            decimals: 0,
            step: 100.0,
            range: (-2_147_483_648.0, 2_147_483_647.0),
            get: |registers| registers.position.map(|position| position.$field.into()),
            set: |registers, raw| {
                if let Some(position) = &mut registers.position {
                    // The range keeps it within 32 bits.
                    position.$field = raw as i32;
                }
            },
        }
    };
}

/// All of them: those of the position loop first, as its screen has them.
pub const FIELDS: [Field; 11] = [
    position!("position.p", "Position P", "", POSITION_SCALE, 3, p),
    position!("position.i", "Position I", "", POSITION_SCALE, 3, i),
    position!("position.d", "Position D", "", POSITION_SCALE, 3, d),
    position!("position.max_i", "Max I", "", 1.0, 0, max_i),
    position!("position.deadzone", "Deadzone", "counts", 1.0, 0, deadzone),
    end!("position.min", "Min", min),
    end!("position.max", "Max", max),
    velocity!("velocity.p", "Velocity P", p),
    velocity!("velocity.i", "Velocity I", i),
    velocity!("velocity.d", "Velocity D", d),
    Field {
        key: "velocity.qpps",
        label: "QPPS",
        unit: "counts/s",
        scale: 1.0,
        decimals: 0,
        step: 100.0,
        range: (0.0, 4_294_967_295.0),
        get: |registers| Some(registers.velocity.qpps.into()),
        set: |registers, raw| registers.velocity.qpps = whole(raw),
    },
];

fn whole(raw: i64) -> u32 {
    u32::try_from(raw.max(0)).unwrap_or(u32::MAX)
}

impl Field {
    /// As a person reads it; none where the method has no such gain.
    pub fn value(&self, registers: &Registers) -> Option<f64> {
        (self.get)(registers).map(|raw| raw as f64 / self.scale)
    }

    /// Rounded to what the register can hold.
    pub fn set(&self, registers: &mut Registers, value: f64) {
        let value = value.clamp(self.range.0, self.range.1);
        (self.set)(registers, (value * self.scale).round() as i64);
    }

    pub fn text(&self, value: f64) -> String {
        format!("{value:.*}", self.decimals)
    }
}

impl Registers {
    /// The settings they stand for, to be written.
    pub fn image(&self, motor: Motor) -> SettingsImage {
        let mut image = SettingsImage::default();
        for field in &FIELDS {
            if let Some(raw) = (field.get)(self) {
                let value = match field.scale {
                    1.0 => SettingValue::Int(raw),
                    scale => SettingValue::Number(raw as f64 / scale),
                };
                image.set(&key(motor, field.key), value);
            }
        }
        image
    }

    /// What the controller holds, as last read; position where it is asked for and known.
    pub fn held(loops: &LoopSettings, motor: Motor, with_position: bool) -> Option<Self> {
        let mut held = Self { position: with_position.then(PositionRegisters::default), ..Self::default() };
        for field in &FIELDS {
            if (field.get)(&held).is_some() {
                field.set(&mut held, loops.held(motor, field.key)?);
            }
        }
        Some(held)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_shown_and_set_again_is_the_same_register() {
        let position = PositionRegisters {
            p: 12_345,
            i: 7,
            d: 999_999,
            max_i: 50,
            deadzone: 3,
            min: -900,
            max: 1_000_000,
        };
        let velocity = VelocityRegisters { p: 0x1_2345, i: 1, d: 0x4000, qpps: 44_000 };
        let full = Registers { velocity, position: Some(position) };
        let mut again = Registers { position: Some(PositionRegisters::default()), ..Registers::default() };
        for field in &FIELDS {
            field.set(&mut again, field.value(&full).unwrap());
        }
        assert_eq!(again, full);
    }

    #[test]
    fn without_a_position_loop_only_four_settings_are_written() {
        assert_eq!(Registers::default().image(Motor::M2).iter().count(), 4);
        let with = Registers { position: Some(PositionRegisters::default()), ..Registers::default() };
        assert_eq!(with.image(Motor::M1).iter().count(), 11);
    }
}
