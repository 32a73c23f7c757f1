//! What is kept on this computer of the unit that is looked at: backups, what was cut short, its EEPROM as last known.

use std::collections::BTreeMap;
use std::sync::Arc;

use brushwork_link::Message;
use brushwork_link::settings::{Keeper, Profile, SaveVerdict, SettingsImage};
use brushwork_link::transport::PortInfo;

use super::unit_key::UnitKey;
use brushwork_core::keep::{Backup, KeepError, Keeping, OpenJournal, UnitId, Wear};
use brushwork_core::settings::Done;

mod acts;

/// What is kept of the unit that is looked at.
#[derive(Debug, Default)]
pub(super) struct Kept {
    keeping: Option<Keeping>,
    ports: Vec<PortInfo>,
    /// Every unit met, as files know it.
    units: BTreeMap<UnitKey, UnitId>,
    /// The one that is looked at.
    unit: Option<UnitId>,
    backups: Vec<Backup>,
    unfinished: Vec<OpenJournal>,
    /// EEPROM as it was proven last, in this session or an earlier one.
    eeprom: Option<Profile>,
    wear: Wear,
    /// What is noted of it, as it stands in the field, and as it is kept.
    noted: String,
    noted_kept: String,
    /// Why it is not known how often the EEPROM was written.
    wear_fault: Option<Message>,
    /// Journals that cannot be read.
    damaged: Vec<Arc<KeepError>>,
    /// Whether it was looked what became of numbers that were written raw and not read back.
    cut_off_is_told: bool,
    /// What could not be kept or read, to be said once.
    untold: Vec<Message>,
}

/// How something that was cut short is settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settle {
    /// The new values become changes here, to be written.
    Finish,
    /// The old values become changes here, to be written.
    Undo,
    /// All stays as it is, and it is not told again.
    Leave,
}

/// What an outcome means for what is kept.
pub(super) enum Came {
    Read,
    Reloaded(SettingsImage),
    Written,
    Saved { verified: bool },
    Other,
}

impl Came {
    pub(super) fn of(done: &Done) -> Self {
        match done {
            Done::Read(_) => Self::Read,
            Done::Reloaded(report) => Self::Reloaded(report.image.clone()),
            Done::Written(report, _) if report.is_complete() => Self::Written,
            Done::Saved(report) => Self::Saved { verified: report.verdict == SaveVerdict::Verified },
            Done::Written(..) | Done::NotWritten(_) | Done::Restored(_) => Self::Other,
        }
    }
}

impl Kept {
    pub(super) fn keeper(&self, unit: &UnitKey, firmware: &str) -> Option<Box<dyn Keeper>> {
        Some(self.keeping.as_ref()?.keeper(self.units.get(unit)?.clone(), firmware))
    }

    /// What stands on the disk by now of the unit that is looked at.
    fn look_at_files(&mut self) {
        let (Some(keeping), Some(unit)) = (self.keeping.clone(), self.unit.clone()) else { return };
        self.backups = self.told(keeping.store().listed_backups(Some(&unit))).unwrap_or_default();
        match keeping.store().wear(&unit) {
            Ok(wear) => (self.wear, self.wear_fault) = (wear, None),
            Err(fault) => self.wear_fault = Some(Message::error(fault)),
        }
    }

    /// Keeps what stands in the field for notes, if it is new.
    fn keep_notes(&mut self) {
        let (Some(keeping), Some(unit)) = (self.keeping.clone(), self.unit.clone()) else { return };
        if self.noted != self.noted_kept
            && self.told(keeping.store().keep_notes(&unit, &self.noted)).is_some()
        {
            self.noted_kept = self.noted.clone();
        }
    }

    /// What was read, or the sentence why not, to be said.
    fn told<T>(&mut self, read: Result<T, KeepError>) -> Option<T> {
        match read {
            Ok(read) => Some(read),
            // A user without a home has kept nothing, which the first act that keeps something tells.
            Err(KeepError::NoFolder) => None,
            Err(fault) => {
                self.untold.push(Message::error(fault));
                None
            }
        }
    }

    /// A unit has another address.
    pub(super) fn follow_address(&mut self, old: &UnitKey, new: UnitKey) {
        let Some(unit) = self.units.remove(old) else { return };
        let moved = UnitId { address: new.address, ..unit.clone() };
        if self.unit.as_ref() == Some(&unit) {
            self.unit = Some(moved.clone());
        }
        self.units.insert(new, moved);
    }

    pub(super) fn forget_unit(&mut self) {
        self.keep_notes();
        self.noted.clear();
        self.noted_kept.clear();
        self.unit = None;
        self.unfinished.clear();
        self.damaged.clear();
        self.cut_off_is_told = false;
        self.backups.clear();
        self.eeprom = None;
    }
}
