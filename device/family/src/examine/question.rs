//! What a family asks of its units: questions, the steps in which they are asked, and what has to be agreed to for each.

use serde::{Deserialize, Serialize};

brushwork_values::listed! {
    /// What has to be agreed to before a step is taken. Only reading is agreed to beforehand.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Need {
        /// It reads only.
        Read "reads only",
        /// It reads by commands whose layout is a guess.
        Guess "reads by guess",
        /// It writes settings in RAM and puts them back.
        Write "writes in RAM, and puts back",
        /// It moves the motor.
        Move "moves the motor",
        /// It writes the memory that keeps settings.
        Save "saves the settings",
    }
    /// In words.
    fn label;
}

/// Questions that are asked together.
#[derive(Debug)]
pub struct Step {
    /// By which it is named on the command line.
    pub key: &'static str,
    /// What it does, as a bare verb phrase.
    pub title: &'static str,
    /// What has to be agreed to.
    pub need: Need,
    /// What happens to the unit, in sentences for its owner.
    pub does: &'static str,
    /// Settings that it writes and that are put back afterwards: keys, or what they begin with.
    pub touches: &'static [&'static str],
    /// What it finds out.
    pub questions: &'static [Question],
}

/// One thing that nobody knows but the unit.
#[derive(Debug)]
pub struct Question {
    /// By which its answer is found in a report.
    pub key: &'static str,
    /// The question.
    pub question: &'static str,
    /// How it is asked, and how the answer reads.
    pub how: &'static str,
}

/// What is assumed or open and cannot be asked, or is not.
#[derive(Clone, Copy, Debug)]
pub struct NotAskable {
    /// What is assumed, or what nobody knows.
    pub what: &'static str,
    /// Why it is not asked.
    pub why: &'static str,
}

/// What stands in a file as assumed.
#[derive(Clone, Copy, Debug)]
pub struct Assumed {
    /// The file, from the family's folder on.
    pub file: &'static str,
    /// What is assumed there; nothing where questions alone ask it.
    pub what: &'static str,
    /// What becomes of it.
    pub standing: Standing,
}

/// Whether something that is assumed is asked.
#[derive(Clone, Copy, Debug)]
pub enum Standing {
    /// By these questions.
    Asked(&'static [&'static str]),
    /// It is not, for this reason.
    Not(&'static str),
}

impl Assumed {
    /// What these questions ask.
    #[must_use]
    pub const fn asked(file: &'static str, questions: &'static [&'static str]) -> Self {
        Self { file, what: "", standing: Standing::Asked(questions) }
    }

    /// What is not asked, for this reason.
    #[must_use]
    pub const fn not(file: &'static str, what: &'static str, why: &'static str) -> Self {
        Self { file, what, standing: Standing::Not(why) }
    }
}

/// Of what is assumed, that which is not asked.
#[must_use]
pub fn not_asked(assumed: &[Assumed]) -> Vec<NotAskable> {
    let row = |row: &Assumed| match row.standing {
        Standing::Asked(_) => None,
        Standing::Not(why) => Some(NotAskable { what: row.what, why }),
    };
    assumed.iter().filter_map(row).collect()
}
