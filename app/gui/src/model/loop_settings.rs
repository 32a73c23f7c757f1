//! The settings of the control loops of both motors, as the screens that drive show and edit them.
//!
//! They are read when such a screen opens and written to RAM only, by a button or at once. Both are jobs on the device
//! thread. Every write has a backup and a journal; of a series only the first reads everything for that.

use std::time::Duration;

use brushwork_link::Failure;
use brushwork_link::device::{Event, Identity, Job, JobEnding, QueuedJob};
use brushwork_link::settings::{
    Keeper, Kind, Known, ReadReport, Row, RowState, SettingValue, SettingsImage, SettingsTable, WriteError,
    WriteOptions, WriteReport, read_some, write_kept_knowing,
};
use brushwork_link::transport::Stream;
use brushwork_tuning::axis::EncoderClass;
use brushwork_values::Motor;

use super::link::Effect;
use super::message::Gravity;
use super::watched::Watched;
use brushwork_core::tune::encoder;

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
const QPPS: &str = "velocity.qpps";
const INDUCTANCE: &str = "inductance_henries";
const RESISTANCE: &str = "resistance_ohms";

/// Reading a dozen commands at the slowest baud rate, with retries.
const READ_LIMIT: Duration = Duration::from_secs(20);
/// Reading everything for the backup, writing and reading back.
const WRITE_LIMIT: Duration = Duration::from_secs(130);

const READ_JOB: &str = "read the settings of the control loops";
const WRITE_JOB: &str = "write the settings of the control loops";

/// What is known of the settings, what was edited, and what runs.
#[derive(Debug, Default)]
pub struct LoopSettings {
    table: Option<SettingsTable>,
    ram: SettingsImage,
    edits: SettingsImage,
    job: Watched<Outcome>,
    wants_reading: bool,
    /// Every edit is applied as soon as it is made.
    pub at_once: bool,
    /// Something was edited since the edits were last applied.
    is_fresh: bool,
    /// All settings, as known from the last write.
    known: Known,
    /// What the last write came to, for others that show the same settings.
    written: Option<Box<WriteReport>>,
}

#[derive(Debug)]
enum Outcome {
    Read(Result<ReadReport, Failure>),
    Written(Result<Box<WriteReport>, WriteError>, Known),
}

/// The key of a motor's setting.
pub fn key(motor: Motor, column: &str) -> String {
    format!("motor{}.{column}", motor.index() + 1)
}

fn keys(columns: &[Column]) -> Vec<String> {
    Motor::BOTH.iter().flat_map(|motor| columns.iter().map(|column| key(*motor, column.key))).collect()
}

impl LoopSettings {
    /// Another unit, or none: nothing is known.
    pub fn forget(&mut self) {
        *self = Self { at_once: self.at_once, ..Self::default() };
    }

    /// The controller is to be asked (again) as soon as one is there.
    pub fn want_reading(&mut self) {
        self.wants_reading = true;
    }

    pub fn wants_reading(&self) -> bool {
        self.wants_reading && !self.job.is_running()
    }

    pub fn is_busy(&self) -> bool {
        self.job.is_running()
    }

    /// Whether anything was read from the controller.
    pub fn is_known(&self) -> bool {
        !self.ram.is_empty()
    }

    /// The setting's row, where this controller has it.
    pub fn row(&self, motor: Motor, column: &Column) -> Option<&Row> {
        self.table.as_ref()?.row(&key(motor, column.key))
    }

    /// What the controller holds, as last read.
    pub fn held(&self, motor: Motor, column: &str) -> Option<f64> {
        number(self.ram.get(&key(motor, column))?)
    }

    /// The same of any setting of the loops, by its whole key.
    pub fn held_value(&self, key: &str) -> Option<SettingValue> {
        self.ram.get(key)
    }

    /// What is to be shown: the edit, or else what the controller holds.
    pub fn shown(&self, motor: Motor, column: &Column) -> Option<SettingValue> {
        let key = key(motor, column.key);
        self.edits.get(&key).or_else(|| self.ram.get(&key))
    }

    pub fn is_edited(&self, motor: Motor, column: &Column) -> bool {
        self.edits.get(&key(motor, column.key)).is_some()
    }

    /// How many edits wait to be applied.
    pub fn edits(&self, columns: &[Column]) -> usize {
        keys(columns).iter().filter(|key| self.edits.get(key).is_some()).count()
    }

    /// Changes a setting here; the controller is told by [`LoopSettings::apply`].
    pub fn edit(&mut self, motor: Motor, column: &Column, value: f64) {
        let Some(row) = self.row(motor, column) else { return };
        let value = match row.kind {
            Kind::Int => SettingValue::Int(value.round() as i64),
            _ => row.settle(SettingValue::Number(value)),
        };
        let key = row.key.clone();
        let is_held = self.ram.get(&key).is_some_and(|held| row.encode(held) == row.encode(value));
        self.is_fresh |= !is_held;
        if is_held { self.edits.remove(&key) } else { self.edits.set(&key, value) }
    }

    /// Whether edits are to be applied now. Told once for each edit, so that what was refused is not sent again and again.
    pub fn wants_applying(&mut self) -> bool {
        self.at_once && self.is_known() && !self.is_busy() && std::mem::take(&mut self.is_fresh)
    }

    /// Edits QPPS of a motor, as it was measured.
    pub fn edit_qpps(&mut self, motor: Motor, counts_per_s: f64) {
        if let Some(column) = PWM.iter().find(|column| column.key == QPPS) {
            self.edit(motor, column, counts_per_s);
        }
    }

    /// Edits the resistance of a motor, as it was measured, ohm.
    pub fn edit_resistance(&mut self, motor: Motor, ohms: f64) {
        if let Some(column) = PWM.iter().find(|column| column.key == RESISTANCE) {
            self.edit(motor, column, ohms);
        }
    }

    /// Edits the other motor to be like `from`.
    pub fn copy_from(&mut self, from: Motor, columns: &[Column]) {
        let to = if from == Motor::M1 { Motor::M2 } else { Motor::M1 };
        for column in columns {
            if let Some(value) = self.shown(from, column).and_then(number) {
                self.edit(to, column, value);
            }
        }
    }

    /// Drops the edits.
    pub fn revert(&mut self, columns: &[Column]) {
        keys(columns).iter().for_each(|key| self.edits.remove(key));
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
        encoder::class(&|key| self.ram.get(key), motor)
    }

    /// Motors whose L and R, as shown, are both other than 0.
    pub fn torque_controlled(&self) -> Vec<Motor> {
        let is_set = |motor, name: &str| {
            let key = key(motor, name);
            self.edits.get(&key).or_else(|| self.ram.get(&key)).and_then(number).is_some_and(|v| v != 0.0)
        };
        let both = |motor: &Motor| is_set(*motor, INDUCTANCE) && is_set(*motor, RESISTANCE);
        Motor::BOTH.into_iter().filter(both).collect()
    }

    /// What to ask of the device thread to read the settings.
    pub fn read(&mut self, identity: &Identity) -> Option<QueuedJob> {
        self.wants_reading = false;
        self.known.forget();
        let table = SettingsTable::new(identity.subject()?);
        self.table = Some(table.clone());
        let of_encoders = table.rows().iter().map(|row| row.key.clone()).filter(|key| encoder::is_asked(key));
        let keys = [keys(VELOCITY), keys(POSITION), of_encoders.collect()].concat();
        self.job.begin(Job::new(READ_JOB, READ_LIMIT, move |wire| {
            Ok(Outcome::Read(read_some(wire, &table, &keys)))
        }))
    }

    /// What to ask of the device thread to write the edits to RAM.
    pub fn apply(
        &mut self,
        columns: &[Column],
        identity: &Identity,
        own_stream: Option<Stream>,
        keeper: Box<dyn Keeper>,
    ) -> Option<QueuedJob> {
        let wanted: SettingsImage = keys(columns)
            .into_iter()
            .filter_map(|key| self.edits.get(&key).map(|value| (key, value)))
            .collect();
        self.apply_image(wanted, identity, own_stream, keeper)
    }

    /// Works with a table that was not read for the loops: what a family has of them is in its other settings.
    pub fn adopt(&mut self, table: SettingsTable) {
        self.table.get_or_insert(table);
    }

    /// What to ask of the device thread to write these values to RAM, whatever is edited.
    pub fn apply_image(
        &mut self,
        wanted: SettingsImage,
        identity: &Identity,
        own_stream: Option<Stream>,
        mut keeper: Box<dyn Keeper>,
    ) -> Option<QueuedJob> {
        let table = self.table.clone().filter(|_| !self.job.is_running())?;
        if wanted.is_empty() {
            return None;
        }
        let options = WriteOptions { own_stream, simulated: identity.simulated, as_read: false };
        let mut known = std::mem::take(&mut self.known);
        self.job.begin(Job::new(WRITE_JOB, WRITE_LIMIT, move |wire| {
            let result = write_kept_knowing(wire, &table, &wanted, options, &mut *keeper, &mut known);
            Ok(Outcome::Written(result.map(Box::new), std::mem::take(&mut known)))
        }))
    }

    /// The job was not taken.
    pub fn not_begun(&mut self) {
        self.job.forget();
    }

    /// What a write came to, once.
    pub fn take_written(&mut self) -> Option<Box<WriteReport>> {
        self.written.take()
    }

    /// Takes in an event of its job.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let Some((ticket, ending)) = self.job.take(event) else { return Vec::new() };
        match ticket.take() {
            Some(Outcome::Read(Ok(report))) => self.was_read(&report),
            Some(Outcome::Written(Ok(report), known)) => {
                self.known = known;
                let effects = self.was_written(&report);
                self.written = Some(report);
                effects
            }
            Some(Outcome::Read(Err(failure))) => vec![Effect::Say(Gravity::Error, failure.to_string())],
            Some(Outcome::Written(Err(error), _)) => vec![Effect::Say(Gravity::Error, error.to_string())],
            None => vec![Effect::Say(Gravity::Error, nothing_came(ticket.name(), &ending))],
        }
    }

    fn was_read(&mut self, report: &ReadReport) -> Vec<Effect> {
        self.ram = report.image.clone();
        self.drop_edits_that_are_held();
        let failures = report.failures.iter();
        failures.map(|unread| Effect::Say(Gravity::Error, unread.failure.to_string())).collect()
    }

    fn was_written(&mut self, report: &WriteReport) -> Vec<Effect> {
        report.merge_into(&mut self.ram);
        let taken = report.rows.iter().filter(|row| row.state == RowState::Taken);
        let taken: Vec<&str> = taken.map(|row| row.key.as_str()).collect();
        taken.iter().for_each(|key| self.edits.remove(key));
        let mut effects: Vec<Effect> =
            report.warnings.iter().map(|text| Effect::Say(Gravity::Warning, text.clone())).collect();
        let wrong = self.table.as_ref().map(|table| report.sentences(table)).unwrap_or_default();
        effects.push(if wrong.is_empty() {
            Effect::Say(
                Gravity::Note,
                format!(
                    "Applied and read back: {} in the controller's RAM. Until they are saved to EEPROM they last \
                     until it is switched off.",
                    counted(taken.len())
                ),
            )
        } else {
            Effect::Say(Gravity::Error, wrong.join(" "))
        });
        effects
    }

    fn drop_edits_that_are_held(&mut self) {
        let Some(table) = &self.table else { return };
        let is_open = |key: &str, value: SettingValue| {
            let Some((row, held)) = table.row(key).zip(self.ram.get(key)) else { return true };
            row.encode(held) != row.encode(value)
        };
        let open = self.edits.iter().filter(|(key, value)| is_open(key, *value));
        self.edits = open.map(|(key, value)| (key.to_owned(), value)).collect();
    }
}

/// "1 setting", "3 settings".
pub fn counted(settings: usize) -> String {
    if settings == 1 { "1 setting".to_owned() } else { format!("{settings} settings") }
}

pub fn number(value: SettingValue) -> Option<f64> {
    match value {
        SettingValue::Int(whole) => Some(whole as f64),
        SettingValue::Number(number) => Some(number),
        _ => None,
    }
}

fn nothing_came(name: &str, ending: &JobEnding) -> String {
    match ending {
        JobEnding::Failed(failure) => failure.to_string(),
        JobEnding::Panicked(word) => format!("Could not {name}: Brushwork had a bug. Its last word: {word}"),
        JobEnding::Done(()) | JobEnding::Interrupted(_) => {
            format!("Could not {name}: something more urgent came first. Read them again.")
        }
    }
}
