//! The page for settings without public meaning: one number for one register at its owner's word, as `brushwork settings raw` does.

use brushwork_core::examine::RawWrite;
use brushwork_core::keep::{KeepError, Store, UnitId};
use brushwork_core::settings::Done;
use brushwork_link::device::JobId;
use brushwork_link::settings::Row;
use brushwork_link::{Identity, Message};
use brushwork_values::Sentences;

use super::errand::Came;
use super::{Gravity, UnitSettings};
use crate::messages::RawPageMessage;

/// What a person asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawAction {
    /// Writes the number that is typed.
    Write,
    /// Writes the number from before the newest one.
    Undo,
}

/// The page.
#[derive(Debug, Default)]
pub struct RawPage {
    pub open: bool,
    /// The setting that is chosen.
    pub key: String,
    /// The number, as typed.
    pub typed: String,
    /// The owner answers for it.
    pub is_agreed: bool,
    /// What was written raw before, oldest first, of the unit at this address.
    writes: Vec<RawWrite>,
    writes_of: Option<Identity>,
    job: Option<JobId>,
    pub ended: Option<(Gravity, Message)>,
}

/// The settings that no usual write sends to a real controller though a command carries them.
pub fn rows(unit: &UnitSettings) -> impl Iterator<Item = &Row> {
    unit.table().rows().iter().filter(|row| row.sink().is_some() && row.locked(false).is_some())
}

/// A whole number, decimal or with 0x.
pub(super) fn number(text: &str) -> Option<i64> {
    let text = text.trim();
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => i64::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

impl RawPage {
    pub fn writes(&self) -> &[RawWrite] {
        &self.writes
    }

    pub fn is_running(&self) -> bool {
        self.job.is_some()
    }

    pub fn job(&self) -> Option<JobId> {
        self.job
    }

    pub fn begun(&mut self, job: Option<JobId>) {
        self.job = job;
        // Each number is agreed to by itself.
        self.is_agreed &= job.is_none();
    }

    /// Whether what is shown was written to another unit.
    pub fn is_of_another(&self, identity: &Identity) -> bool {
        self.writes_of.as_ref() != Some(identity)
    }

    /// Looks up what was written raw to a unit.
    pub fn look_at(&mut self, store: &Store, identity: Identity, unit: &UnitId) {
        if self.is_of_another(&identity) {
            (self.ended, self.is_agreed) = (None, false);
        }
        self.writes_of = Some(identity);
        match store.raw_writes(unit) {
            Ok(writes) => self.writes = writes,
            Err(KeepError::NoFolder) => self.writes.clear(),
            Err(fault) => {
                self.writes.clear();
                self.ended = Some((Gravity::Error, Message::error(fault)));
            }
        }
    }

    /// Takes in what came of a write; the number that was read back, if one was.
    pub fn came(&mut self, came: Came, unit: Option<&UnitSettings>) -> Option<(String, i64)> {
        self.job = None;
        let mut found = None;
        self.ended = Some(match came {
            Err(unfinished) => (unfinished.gravity, unfinished.sentence),
            Ok(Done::NotWritten(error)) => (Gravity::Error, Message::error(error)),
            Ok(Done::Written(report, _)) => {
                let row = report.rows.first().and_then(|row| {
                    let of = unit?.table().row(&row.key)?;
                    Some((row.key.clone(), of.register_of(row.found?)?))
                });
                found.clone_from(&row);
                match (report.is_complete(), row) {
                    (true, Some((key, raw))) => (Gravity::Note, RawPageMessage::Holds { key, raw }.into()),
                    (false, Some((key, raw))) => {
                        (Gravity::Warning, RawPageMessage::HoldsOther { key, raw }.into())
                    }
                    (_, None) => {
                        let table = unit.map(UnitSettings::table);
                        let why = Sentences(table.map(|table| report.sentences(table)).unwrap_or_default());
                        (Gravity::Error, RawPageMessage::NotReadBack { why }.into())
                    }
                }
            }
            Ok(Done::Read(_) | Done::Reloaded(_) | Done::Saved(_) | Done::Restored(_)) => return None,
        });
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_raw_number_is_decimal_or_hexadecimal_and_nothing_else() {
        assert_eq!(number(" 12 "), Some(12));
        assert_eq!(number("0x1F"), Some(31));
        assert_eq!(number("-3"), Some(-3));
        assert_eq!(number("1.5"), None);
        assert_eq!(number(""), None);
    }
}
