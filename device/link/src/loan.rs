//! What a stop may change of a unit for a while, noted where it outlives this program before anything may move, so that it is given back by
//! whoever connects next where the program or the link dies in between.

use std::fmt;

use crate::device::Identity;
use crate::failure::Failure;
use crate::settings::SettingsImage;

/// Keeps loans from one session to the next.
pub trait KeepsLoans: Send + Sync + fmt::Debug {
    /// Notes what these settings of a unit hold, before any of them is changed for a while. A note that is there already stays: what it says is older,
    /// and so what is to be given back.
    ///
    /// # Errors
    /// It cannot be kept.
    fn lend(&self, identity: &Identity, held: &SettingsImage) -> Result<(), Failure>;

    /// These settings of the unit hold this now: notes that say the same are done with.
    fn given_back(&self, identity: &Identity, held: &SettingsImage);
}
