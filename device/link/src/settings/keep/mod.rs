//! Acts on a controller's settings that leave a trace on the computer before they begin: a backup of what was
//! there, and a journal of what is about to change. Should power, cable or program fail midway, the next
//! connection compares the journal with what the controller holds and tells which settings are old and which new.
//!
//! Files are the caller's: a [`Keeper`] takes what is to be kept. Nothing here waits for a disk for longer than a
//! moment, so that Stop overtakes it.

mod acts;
mod aftermath;
mod journal;
mod keeper;

pub use acts::{
    Known, begin_command, begin_trial, defaults_kept, end_act, reload_kept, save_kept, write_kept,
    write_kept_knowing, write_watched,
};
pub use aftermath::{Aftermath, Held};
pub use journal::{Act, Journal, JournalError};
pub use keeper::{Ending, Entry, Keeper};
