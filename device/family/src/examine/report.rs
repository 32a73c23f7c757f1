//! What an examination found, as it is kept and sent. It holds nothing of the computer: no path, no name, no number.

use super::question::{Need, Question, Step};
use brushwork_link::Identity;
use brushwork_link::capability::Presence;
use brushwork_link::exchange::Lateness;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What a file of an examination calls itself.
pub const SCHEMA: &str = "brushwork-examination";
/// The version of its form. Members may be added within one; whoever reads one skips what he does not know.
pub const VERSION: u32 = 1;

/// What was found out of one unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Examination {
    /// [`SCHEMA`].
    pub schema: String,
    /// [`VERSION`].
    pub version: u32,
    /// The program that asked, with its version.
    pub program: String,
    /// The unit's family, by its key.
    pub family: String,
    /// Who it is.
    pub unit: Unit,
    /// The line to it.
    #[serde(default)]
    pub line: Line,
    /// Each command that was asked, by number.
    #[serde(default)]
    pub commands: Vec<CommandFound>,
    /// Each question, whether it was asked or not.
    #[serde(default)]
    pub answers: Vec<Answer>,
    /// What cannot be asked over the wire.
    #[serde(default)]
    pub not_askable: Vec<Unasked>,
    /// What its owner had written raw, oldest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub raw_writes: Vec<RawWrite>,
}

/// A number that was written to a register at its owner's word, since what it means is not public.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RawWrite {
    /// When.
    pub date: String,
    /// The setting's key.
    pub key: String,
    /// The command that carries it.
    pub command: u8,
    /// The pin, stream or output that the command names.
    pub index: Option<u8>,
    /// The field of the command.
    pub field: String,
    /// What the register held before.
    pub before: Option<i64>,
    /// What was written.
    pub wanted: i64,
    /// What was read back.
    pub found: Option<i64>,
    /// It was begun, and is not known to have come to its end.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_open: bool,
}

/// Who a unit is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unit {
    /// Its version text as it came.
    pub version_text: String,
    /// Its model, where the text names one that is known.
    pub model: Option<String>,
    /// Its firmware version; empty if the text has none.
    pub firmware: String,
    /// The number of its firmware generation.
    pub generation: u8,
    /// How it is spoken to.
    pub protocol: String,
    /// What was odd when it was found, in the words in which it was written down.
    #[serde(default, rename = "notes")]
    pub oddities: Vec<String>,
}

/// The line to it, as far as it has shown itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// How late replies are beyond the time of their bytes.
    pub lateness: Option<Lateness>,
    /// Requests and replies that it carries in a second, one after the other.
    pub requests_per_s: Option<f64>,
    /// How often in a second everything that changes quickly can be read.
    pub sweeps_per_s: Option<f64>,
}

/// How one command is taken.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommandFound {
    /// Its number.
    pub command: u8,
    /// What it does.
    pub title: String,
    /// How the firmware takes it.
    pub presence: Presence,
    /// Bytes of its reply, CRC included.
    pub reply_bytes: Option<usize>,
    /// The generations whose reply it is.
    #[serde(default)]
    pub generations: Vec<u8>,
    /// The quickest reply, ms.
    pub quickest_ms: Option<f64>,
}

/// What became of a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It was asked, and the answer is clear.
    Answered,
    /// It was asked, and the answer is not.
    Unclear,
    /// It was not asked.
    NotAsked,
}

/// One question with what became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// The question's name.
    pub key: String,
    /// The question.
    pub question: String,
    /// How it is asked.
    pub how: String,
    /// The step in which it is asked.
    pub step: String,
    /// What has to be agreed to for that.
    pub need: Need,
    /// What became of it.
    pub state: State,
    /// The answer, as data; null without one.
    #[serde(default)]
    pub value: Value,
    /// What it was told from, where that is not the same each time; null where nothing is to be told.
    #[serde(default)]
    pub measured: Value,
    /// The answer, or why there is none, in the words in which it was written down: a file keeps them.
    #[serde(rename = "sentence")]
    pub worded: String,
}

/// What cannot be asked, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unasked {
    /// What.
    pub what: String,
    /// Why.
    pub why: String,
}

/// Why a text is no examination. A clause.
#[derive(Debug, thiserror::Error)]
pub enum ExaminationError {
    /// It is no JSON, or lacks something.
    #[error("it is no report of an examination ({0})")]
    Json(#[from] serde_json::Error),
    /// It is something else.
    #[error("it is no report of an examination: its schema is \"{0}\"")]
    Schema(String),
    /// It is of a later program.
    #[error("it is a report of version {0}, and this program knows version {VERSION}; update Brushwork")]
    Version(u32),
}

/// What is said of a question of which nothing is known yet.
const OPEN: &str = "Not asked yet.";

impl Answer {
    pub(super) fn open(step: &Step, question: &Question) -> Self {
        Self {
            key: question.key.to_owned(),
            question: question.question.to_owned(),
            how: question.how.to_owned(),
            step: step.key.to_owned(),
            need: step.need,
            state: State::NotAsked,
            value: Value::Null,
            measured: Value::Null,
            worded: OPEN.to_owned(),
        }
    }
}

impl Examination {
    /// One of a unit of which nothing was asked yet.
    #[must_use]
    pub fn of(identity: &Identity) -> Self {
        // The notes of a node hold the serial number of its unit, and nothing that is odd.
        let oddities = if identity.is_node() {
            Vec::new()
        } else {
            identity.notes.iter().map(ToString::to_string).collect()
        };
        Self {
            schema: SCHEMA.to_owned(),
            version: VERSION,
            program: concat!("Brushwork ", env!("CARGO_PKG_VERSION")).to_owned(),
            family: identity.family.key().to_owned(),
            unit: Unit {
                version_text: identity.version_text.clone(),
                model: identity.model.map(str::to_owned),
                firmware: identity.firmware.clone(),
                generation: identity.generation.number(),
                protocol: identity.protocol.to_owned(),
                oddities,
            },
            line: Line::default(),
            commands: Vec::new(),
            answers: Vec::new(),
            not_askable: Vec::new(),
            raw_writes: Vec::new(),
        }
    }

    /// Reads one.
    ///
    /// # Errors
    /// Why the text is none, as a clause.
    pub fn parse(text: &str) -> Result<Self, ExaminationError> {
        let value: Value = serde_json::from_str(text)?;
        match value["schema"].as_str() {
            Some(SCHEMA) => {}
            other => return Err(ExaminationError::Schema(other.unwrap_or_default().to_owned())),
        }
        let version = value["version"].as_u64().and_then(|version| u32::try_from(version).ok()).unwrap_or(0);
        if version > VERSION {
            return Err(ExaminationError::Version(version));
        }
        Ok(serde_json::from_value(value)?)
    }

    /// The answer to a question; `None` for a question that the family does not have.
    #[must_use]
    pub fn answer(&self, key: &str) -> Option<&Answer> {
        self.answers.iter().find(|answer| answer.key == key)
    }

    /// The value of a clear answer.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<&Value> {
        self.answer(key).filter(|answer| answer.state == State::Answered).map(|answer| &answer.value)
    }

    /// A command as it was found.
    #[must_use]
    pub fn command(&self, number: u8) -> Option<&CommandFound> {
        self.commands.iter().find(|found| found.command == number)
    }

    /// Enters a clear answer.
    pub fn answered(&mut self, key: &str, value: Value, sentence: impl Into<String>) {
        self.enter(key, State::Answered, value, sentence.into());
    }

    /// Enters an answer that is not clear.
    pub fn unclear(&mut self, key: &str, sentence: impl Into<String>) {
        self.enter(key, State::Unclear, Value::Null, sentence.into());
    }

    /// Enters what an answer was told from.
    pub fn measured(&mut self, key: &str, measured: Value) {
        if let Some(answer) = self.answers.iter_mut().find(|answer| answer.key == key) {
            answer.measured = measured;
        }
    }

    /// Says why the questions of a step were not asked of which nothing is said yet.
    pub fn not_asked(&mut self, step: &str, why: &str) {
        let open = |answer: &&mut Answer| answer.step == step && answer.worded == OPEN;
        for answer in self.answers.iter_mut().filter(open) {
            why.clone_into(&mut answer.worded);
        }
    }

    fn enter(&mut self, key: &str, state: State, value: Value, worded: String) {
        if let Some(answer) = self.answers.iter_mut().find(|answer| answer.key == key) {
            *answer = Answer { state, value, worded, ..answer.clone() };
        }
    }

    /// What of it says how the unit behaves, whatever computer asked and however quickly: two examinations of units that behave alike have the
    /// same.
    #[must_use]
    pub fn behaviour(&self) -> Self {
        let quickest_ms = None;
        let commands = self.commands.iter().map(|found| CommandFound { quickest_ms, ..found.clone() });
        let answers = self.answers.iter().map(|answer| Answer {
            measured: Value::Null,
            worded: String::new(),
            ..answer.clone()
        });
        Self {
            line: Line::default(),
            commands: commands.collect(),
            answers: answers.collect(),
            ..self.clone()
        }
    }

    /// As the text of a file.
    ///
    /// # Panics
    /// Never: everything in it has a form in JSON.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("strings, numbers and lists") + "\n"
    }
}
