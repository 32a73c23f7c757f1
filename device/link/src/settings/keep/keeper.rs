//! Who keeps what there was before an act, and what it is told of the act.

use super::super::image::SettingsImage;
use super::super::table::SettingsTable;
use super::journal::Act;
use crate::failure::Failure;
use crate::unit::UnitAddress;

/// What is about to be done, and to what.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What is about to be done.
    pub act: Act,
    /// The table of the controller.
    pub table: SettingsTable,
    /// Where it answers.
    pub address: UnitAddress,
    /// Every setting that could be read, as the controller works with it now.
    pub ram: SettingsImage,
    /// The values that it is to hold afterwards: the changes of a write, everything of a save or of the defaults.
    pub wanted: SettingsImage,
}

/// How an act ended, as far as what was kept of it goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// Nothing was sent: it is as if the act had never begun.
    NotDone,
    /// What became of every setting is known and was reported: the journal is closed.
    Known,
    /// As [`Ending::Known`]; and this is what the EEPROM was found to hold.
    EepromKnown(SettingsImage),
    /// Something is left open: the journal stays, to be compared at the next connection.
    Open,
}

/// Takes what is to be kept, on a thread of its own.
pub trait Keeper: Send {
    /// Takes a backup and a journal. Returns at once.
    fn begin(&mut self, entry: Entry);

    /// Whether both are safely kept; waits for a few milliseconds at most. `None` while it is under way.
    fn begun(&mut self) -> Option<Result<(), Failure>>;

    /// Closes the journal, or leaves it. Returns at once.
    fn end(&mut self, ending: Ending);

    /// Whether what [`Keeper::end`] has to write is written; waits for a few milliseconds at most.
    fn ended(&mut self) -> bool {
        true
    }
}
