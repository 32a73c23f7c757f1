//! What the program keeps on this computer of the controllers it works on: backups of their settings, journals of
//! what was begun, what their EEPROM held last, and how often it was written.
//!
//! Files are replaced in one step. Those that are needed while a controller is worked on are written by a thread of
//! their own ([`Keeping`]), so that neither the window nor the device thread waits for a disk. What firmware answers is a few kB, which the device
//! thread keeps itself while nothing is armed.

mod backups;
mod firmware;
pub mod folder;
mod journals;
mod loans;
mod memory;
mod notes;
mod raw_writes;
mod sequence;
mod store;
mod today;
mod trial;
mod unit;
mod updates;
mod worker;

pub use backups::Backup;
pub use journals::{OpenJournal, aftermaths};
pub use memory::{Wear, WearLevel};
pub use raw_writes::RawKeeper;
pub use store::{KeepError, Record, Store};
pub use today::today;
pub use trial::TrialKeeper;
pub use unit::{UnitId, profile_of};
pub use updates::OpenUpdate;
pub use worker::Keeping;

#[cfg(test)]
mod tests;
