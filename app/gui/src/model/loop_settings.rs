//! The settings of the control loops of both motors, as the screens that drive show and edit them: a view of the unit's settings.

use brushwork_link::settings::{Kind, Row, SettingValue, SettingsImage};
use brushwork_tuning::axis::EncoderClass;
use brushwork_values::Motor;

use super::settings::UnitSettings;
use brushwork_core::tune::{encoder, tells_encoder};

/// One setting that both motors have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// The key behind "motor1." or "motor2.".
    pub key: &'static str,
    /// What stands above it.
    pub label: &'static str,
    /// Change per arrow key.
    pub step: f64,
    /// Room for its greatest value, so that nothing beside it moves, points.
    pub width: f32,
}

const fn column(key: &'static str, label: &'static str, step: f64) -> Column {
    Column { key, label, step, width: 84.0 }
}

const fn wide(key: &'static str, label: &'static str, step: f64) -> Column {
    Column { key, label, step, width: 112.0 }
}

/// What the PWM screen has (MCP manual 1.2.11), and QPPS, which is measured there.
pub const PWM: &[Column] = &[
    column(INDUCTANCE, "L (H)", 0.000_1),
    column(RESISTANCE, "R (Ω)", 0.01),
    column(QPPS, "QPPS (counts/s)", 100.0),
];

/// What the Velocity screen has.
pub const VELOCITY: &[Column] = &[
    column("velocity.p", "P", 0.01),
    column("velocity.i", "I", 0.01),
    column("velocity.d", "D", 0.01),
    column(QPPS, "QPPS (counts/s)", 100.0),
    column(INDUCTANCE, "L (H)", 0.000_1),
    column(RESISTANCE, "R (Ω)", 0.01),
];

/// What the Position screen has of its own (MCP manual 1.2.13); it has those of [`VELOCITY`] too.
pub const POSITION: &[Column] = &[
    column("position.p", "P", 1.0),
    column("position.i", "I", 1.0),
    column("position.d", "D", 1.0),
    column("position.max_i", "Max I", 1.0),
    column("position.deadzone", "Deadzone", 1.0),
    wide(MINIMUM, "Min (counts)", 100.0),
    wide(MAXIMUM, "Max (counts)", 100.0),
];

const MINIMUM: &str = "position.min";
const MAXIMUM: &str = "position.max";
pub const QPPS: &str = "velocity.qpps";
const INDUCTANCE: &str = "inductance_henries";
pub const RESISTANCE: &str = "resistance_ohms";

/// What the screens that drive have of their own.
#[derive(Debug, Default)]
pub struct LoopView {
    /// Every edit is applied as soon as it is made.
    pub at_once: bool,
    /// Something was edited since the edits were last applied.
    is_fresh: bool,
}

/// The key of a motor's setting.
pub fn key(motor: Motor, column: &str) -> String {
    format!("motor{}.{column}", motor.index() + 1)
}

fn keys(columns: &[Column]) -> Vec<String> {
    Motor::BOTH.iter().flat_map(|motor| columns.iter().map(|column| key(*motor, column.key))).collect()
}

impl LoopView {
    /// Something was edited among the settings of the loops; what was edited elsewhere waits for a button.
    pub fn note_edit(&mut self) {
        self.is_fresh = true;
    }

    /// Whether edits are to be applied now. Reported once for each edit, so that what was refused is not sent again and again.
    pub fn wants_applying(&mut self) -> bool {
        self.at_once && std::mem::take(&mut self.is_fresh)
    }
}

/// The settings of the loops among those of a unit.
impl UnitSettings {
    /// What the screens that drive show: the settings of the loops, and those that tell the kind of the encoders.
    pub fn loop_keys(&self) -> Vec<String> {
        let rows = self.table().rows().iter().map(|row| &row.key);
        let of_encoders = rows.filter(|key| tells_encoder(key)).cloned();
        let of_loops = [keys(VELOCITY), keys(POSITION)].concat();
        of_loops.into_iter().filter(|key| self.table().row(key).is_some()).chain(of_encoders).collect()
    }

    /// Whether anything of the loops was read from the controller.
    pub fn is_known(&self) -> bool {
        VELOCITY.iter().chain(POSITION).any(|column| self.held(Motor::M1, column.key).is_some())
    }

    /// The setting's row, where this controller has it.
    pub fn row(&self, motor: Motor, column: &Column) -> Option<&Row> {
        self.table().row(&key(motor, column.key))
    }

    /// What the controller holds, as last read.
    pub fn held(&self, motor: Motor, column: &str) -> Option<f64> {
        number(self.on_controller(&key(motor, column))?)
    }

    /// What is to be shown: the edit, or else what the controller holds.
    pub fn shown(&self, motor: Motor, column: &Column) -> Option<SettingValue> {
        self.wanted(&key(motor, column.key))
    }

    /// The edits among these that wait to be applied.
    pub fn loop_edits(&self, columns: &[Column]) -> SettingsImage {
        let edited = |key: String| self.edits().get(&key).map(|value| (key, value));
        keys(columns).into_iter().filter_map(edited).collect()
    }

    /// Changes a setting here; the controller is told when the edits are applied.
    pub fn edit(&mut self, motor: Motor, column: &str, value: f64) {
        let key = key(motor, column);
        let Some(row) = self.table().row(&key) else { return };
        let value = match row.kind {
            Kind::Int => SettingValue::Int(value.round() as i64),
            Kind::Bool | Kind::Fixed { .. } | Kind::Choice(_) => row.settle(SettingValue::Number(value)),
        };
        self.set(&key, value);
    }

    /// Edits the other motor to be like `from`.
    pub fn copy_from(&mut self, from: Motor, columns: &[Column]) {
        let to = if from == Motor::M1 { Motor::M2 } else { Motor::M1 };
        for column in columns {
            if let Some(value) = self.shown(from, column).and_then(number) {
                self.edit(to, column.key, value);
            }
        }
    }

    /// Drops the edits.
    pub fn revert_loops(&mut self, columns: &[Column]) {
        keys(columns).iter().for_each(|key| self.revert(key));
    }

    /// Speed at full duty, counts/s, as the controller holds it.
    pub fn qpps(&self, motor: Motor) -> Option<f64> {
        self.held(motor, QPPS)
    }

    /// Lowest and highest position, counts, as the controller holds them; none where they leave no travel.
    pub fn travel(&self, motor: Motor) -> Option<(f64, f64)> {
        let (low, high) = self.held(motor, MINIMUM).zip(self.held(motor, MAXIMUM))?;
        (low < high).then_some((low, high))
    }

    /// What kind of encoder a motor has, as the controller's settings say.
    pub fn encoder(&self, motor: Motor) -> Option<EncoderClass> {
        encoder(&|key| self.on_controller(key), motor)
    }

    /// Motors whose L and R, as shown, are both other than 0.
    pub fn torque_controlled(&self) -> Vec<Motor> {
        let is_set =
            |motor, name: &str| self.wanted(&key(motor, name)).and_then(number).is_some_and(|v| v != 0.0);
        let both = |motor: &Motor| is_set(*motor, INDUCTANCE) && is_set(*motor, RESISTANCE);
        Motor::BOTH.into_iter().filter(both).collect()
    }
}

pub fn number(value: SettingValue) -> Option<f64> {
    value.int().map(|whole| whole as f64).or_else(|| value.number())
}
