//! The gains of a motor as a person reads them: which there are, in what unit, and where they stand in the settings.
//!
//! One table for both families. A field that a family does not have gives no value for its registers, so that whoever walks the
//! table asks no family which one it is.

use brushwork_core::tune::law::{
    AnyRegisters, MotionMindRegisters, PositionRegisters, VelocityRegisters, bits,
};
use brushwork_link::settings::{SettingValue, SettingsImage};
use brushwork_values::Motor;

use crate::model::loop_settings::key;
use crate::model::settings::UnitSettings;

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
    /// Of a Motion Mind, which has one set of registers for both kinds of moves and neither of the two above.
    pub motion_mind: Option<MotionMindRegisters>,
}

/// What a field holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Number,
    /// A bit: 0 or 1.
    Switch,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// The key of its setting: behind "motor1." or "motor2." where it is one of a motor.
    pub key: &'static str,
    of_motor: bool,
    pub label: &'static str,
    pub form: Form,
    /// What it does, where the name alone does not say it.
    pub hint: &'static str,
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
            of_motor: true,
            label: $label,
            form: Form::Number,
            hint: "",
            unit: "",
            scale: VELOCITY_SCALE,
            decimals: 4,
            step: 0.01,
            range: (0.0, 65_535.0),
            get: |registers| of_loops(registers).map(|velocity| velocity.$field.into()),
            set: |registers, raw| registers.velocity.$field = whole(raw),
        }
    };
}

macro_rules! position {
    ($key:literal, $label:literal, $unit:literal, $scale:expr, $decimals:literal, $field:ident) => {
        Field {
            key: $key,
            of_motor: true,
            label: $label,
            form: Form::Number,
            hint: "",
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
            of_motor: true,
            label: $label,
            form: Form::Number,
            hint: "",
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

macro_rules! mind {
    ($key:literal, $label:literal, $range:expr, $hint:literal, $field:ident) => {
        Field {
            key: $key,
            of_motor: false,
            label: $label,
            form: Form::Number,
            hint: $hint,
            unit: "",
            scale: 1.0,
            decimals: 0,
            step: 1.0,
            range: (0.0, $range),
            get: |registers| registers.motion_mind.map(|mind| mind.$field.into()),
            set: |registers, raw| {
                if let Some(mind) = &mut registers.motion_mind {
                    // The range keeps it within the register.
                    mind.$field = raw as _;
                }
            },
        }
    };
}

macro_rules! bit {
    ($key:literal, $label:literal, $hint:literal, $word:ident, $mask:expr) => {
        Field {
            key: $key,
            of_motor: false,
            label: $label,
            form: Form::Switch,
            hint: $hint,
            unit: "",
            scale: 1.0,
            decimals: 0,
            step: 1.0,
            range: (0.0, 1.0),
            get: |registers| registers.motion_mind.map(|mind| i64::from(mind.$word & $mask != 0)),
            set: |registers, raw| {
                if let Some(mind) = &mut registers.motion_mind {
                    mind.$word = if raw == 0 { mind.$word & !$mask } else { mind.$word | $mask };
                }
            },
        }
    };
}

/// All of them: those of the position loop first, as its screen has them; then the registers of a Motion Mind and the bits of FUNCTION and
/// FUNCTION2 that make its loop (Motion Mind manual 3.14 and figures 20 and 21).
pub const FIELDS: [Field; 23] = [
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
        of_motor: true,
        label: "QPPS",
        form: Form::Number,
        hint: "",
        unit: "counts/s",
        scale: 1.0,
        decimals: 0,
        step: 100.0,
        range: (0.0, 4_294_967_295.0),
        get: |registers| of_loops(registers).map(|velocity| velocity.qpps.into()),
        set: |registers, raw| registers.velocity.qpps = whole(raw),
    },
    mind!(
        "register.pterm",
        "PTERM",
        65_535.0,
        "On the error of the place; of its sum under a speed command",
        pterm
    ),
    mind!(
        "register.iterm",
        "ITERM",
        65_535.0,
        "On the sum of the errors of the place; none under a speed command",
        iterm
    ),
    mind!(
        "register.dterm",
        "DTERM",
        65_535.0,
        "On the change of the error: the error of the speed under a speed command",
        dterm
    ),
    mind!(
        "register.pidscalar",
        "PIDSCALAR",
        32.0,
        "The sum of the terms is divided by two to this power",
        pidscalar
    ),
    mind!(
        "register.velocityff",
        "VELOCITYFF",
        255.0,
        "Duty for a speed by itself: counts per loop x this / 255",
        velocity_ff
    ),
    mind!(
        "register.deadband",
        "DEADBAND",
        1_023.0,
        "Errors up to this many counts are none, where ENABLEDB is set",
        deadband
    ),
    bit!(
        "function.satprot",
        "SATPROT",
        "Bounds the sum of the errors closely and stops it at full duty",
        function,
        bits::SATPROT
    ),
    bit!("function.enabledb", "ENABLEDB", "No duty inside DEADBAND", function, bits::ENABLEDB),
    bit!(
        "function.activestop",
        "ACTIVESTOP",
        "A duty of 0 shorts the motor instead of letting it coast",
        function,
        bits::ACTIVESTOP
    ),
    bit!("function.disablepid", "DISABLEPID", "The loop gives no duty", function, bits::DISABLEPID),
    bit!(
        "function2.newvelmode",
        "NEWVELMODE",
        "Speed moves work on speeds, and their output is added up",
        function2,
        bits::NEWVELMODE
    ),
    bit!(
        "function2.fastpid",
        "FASTPID",
        "A loop of 0.5 ms, which serial commands do not have",
        function2,
        bits::FASTPID
    ),
];

/// The velocity registers of a controller that has loops of its own kind for speeds.
fn of_loops(registers: &Registers) -> Option<&VelocityRegisters> {
    registers.motion_mind.is_none().then_some(&registers.velocity)
}

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
        match self.form {
            Form::Number => format!("{value:.*}", self.decimals),
            Form::Switch => if value == 0.0 { "clear" } else { "set" }.to_owned(),
        }
    }

    /// Whether it is P, I or D in these registers.
    pub fn is_term(&self, registers: &Registers) -> bool {
        let name = self.key.rsplit('.').next().unwrap_or_default();
        matches!(name, "p" | "i" | "d" | "pterm" | "iterm" | "dterm") && (self.get)(registers).is_some()
    }

    /// Whether the model knows what it does, so that it can be tried there.
    pub fn is_modelled(&self) -> bool {
        self.form == Form::Number || matches!(self.label, "SATPROT" | "ENABLEDB")
    }

    /// The key of its setting.
    fn key_of(&self, motor: Motor) -> String {
        if self.of_motor { key(motor, self.key) } else { self.key.to_owned() }
    }

    /// A register's value as its setting.
    fn setting(&self, raw: i64) -> SettingValue {
        match (self.form, self.scale) {
            (Form::Switch, _) => SettingValue::Bool(raw != 0),
            (Form::Number, 1.0) => SettingValue::Int(raw),
            (Form::Number, scale) => SettingValue::Number(raw as f64 / scale),
        }
    }
}

impl From<AnyRegisters> for Registers {
    fn from(any: AnyRegisters) -> Self {
        let velocity = any.mcp.velocity.unwrap_or_default();
        Self { velocity, position: any.mcp.position, motion_mind: any.mind.motion_mind }
    }
}

impl From<Registers> for AnyRegisters {
    fn from(registers: Registers) -> Self {
        let mut any = Self::default();
        any.mind.motion_mind = registers.motion_mind;
        any.mcp.velocity = of_loops(&registers).copied();
        any.mcp.position = registers.position;
        any
    }
}

impl Registers {
    /// The settings they stand for, to be written.
    pub fn image(&self, motor: Motor) -> SettingsImage {
        let mut image = SettingsImage::default();
        for field in &FIELDS {
            if let Some(raw) = (field.get)(self) {
                image.set(&field.key_of(motor), field.setting(raw));
            }
        }
        image
    }

    /// What the controller holds, as last read; position where it is asked for and known.
    pub fn held(unit: &UnitSettings, motor: Motor, with_position: bool) -> Option<Self> {
        let mut held = Self { position: with_position.then(PositionRegisters::default), ..Self::default() };
        for field in &FIELDS {
            if (field.get)(&held).is_some() {
                field.set(&mut held, unit.held(motor, field.key)?);
            }
        }
        Some(held)
    }

    /// The registers of a Motion Mind out of its settings; none while one of them is not known.
    pub fn of_settings(value: impl Fn(&str) -> Option<SettingValue>) -> Option<Self> {
        let mut found = Self { motion_mind: Some(MotionMindRegisters::default()), ..Self::default() };
        for field in FIELDS.iter().filter(|field| !field.of_motor) {
            let raw = match value(field.key)? {
                SettingValue::Bool(set) => i64::from(set),
                SettingValue::Int(raw) => raw,
                _ => return None,
            };
            (field.set)(&mut found, raw);
        }
        Some(found)
    }

    /// Whether there is a gain at all: without any there is no loop to draw.
    pub fn has_a_loop(&self) -> bool {
        match (self.motion_mind, self.position) {
            (Some(mind), _) => [mind.pterm, mind.iterm, mind.dterm].iter().any(|term| *term > 0),
            (None, Some(position)) => position.p > 0 || position.i > 0,
            (None, None) => true,
        }
    }

    /// Whether both stand for the same gains, whatever else of their registers differs.
    pub fn same_gains(&self, other: &Self) -> bool {
        FIELDS.iter().all(|field| (field.get)(self) == (field.get)(other))
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
        let full = Registers { velocity, position: Some(position), motion_mind: None };
        let mut again = Registers { position: Some(PositionRegisters::default()), ..Registers::default() };
        for field in FIELDS.iter().filter(|field| field.of_motor) {
            field.set(&mut again, field.value(&full).unwrap());
        }
        assert_eq!(again, full);
    }

    #[test]
    fn the_registers_of_a_motion_mind_go_into_its_settings_and_come_back() {
        let mind = MotionMindRegisters {
            pterm: 51_234,
            iterm: 7,
            dterm: 65_535,
            pidscalar: 11,
            velocity_ff: 255,
            deadband: 3,
            function: bits::SATPROT | bits::ACTIVESTOP,
            function2: bits::NEWVELMODE,
            virtual_limits: (0, 0),
        };
        let registers = Registers { motion_mind: Some(mind), ..Registers::default() };
        let image = registers.image(Motor::M1);
        assert_eq!(image.iter().count(), 12);
        assert_eq!(image.get("register.pterm"), Some(SettingValue::Int(51_234)));
        assert_eq!(image.get("function.satprot"), Some(SettingValue::Bool(true)));
        assert_eq!(Registers::of_settings(|key| image.get(key)), Some(registers));
        assert_eq!(Registers::of_settings(|key| image.get(key).filter(|_| key != "register.dterm")), None);
        assert_eq!(FIELDS[7].value(&registers), None, "it has no velocity P");
    }

    #[test]
    fn what_is_no_gain_makes_no_other_gains() {
        let with = |mind| Registers { motion_mind: Some(mind), ..Registers::default() };
        let mind =
            MotionMindRegisters { pterm: 5, virtual_limits: (-9, 9), ..MotionMindRegisters::default() };
        assert!(with(mind).same_gains(&with(MotionMindRegisters { virtual_limits: (0, 0), ..mind })));
        assert!(!with(mind).same_gains(&with(MotionMindRegisters { pterm: 6, ..mind })));
    }

    #[test]
    fn without_a_position_loop_only_four_settings_are_written() {
        assert_eq!(Registers::default().image(Motor::M2).iter().count(), 4);
        let with = Registers { position: Some(PositionRegisters::default()), ..Registers::default() };
        assert_eq!(with.image(Motor::M1).iter().count(), 11);
    }
}
