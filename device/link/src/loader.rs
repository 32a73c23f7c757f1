//! Firmware as a family sends it to a unit that is in its loader.

use crate::clock::Clock;
use crate::failure::Failure;
use crate::transport::Transport;
use brushwork_values::Message;
use std::fmt::Debug;

/// Firmware of a family, and how it is sent.
pub trait Loads: Debug + Send + Sized + 'static {
    /// How far a transfer is.
    type Progress: Copy + Debug + PartialEq + Send;

    /// A transfer that was completed.
    type Sent: Clone + Debug + Send;

    /// Sends it over a fresh line. `goes_on` hears of each step, and may end it while it says so of harmless ones.
    ///
    /// # Errors
    /// Why it broke and in which state the unit is left.
    fn send(
        &self,
        transport: &mut dyn Transport,
        clock: &dyn Clock,
        goes_on: &mut dyn FnMut(Self::Progress) -> bool,
    ) -> Result<Self::Sent, Failure>;

    /// What came back where it was cancelled before anything was sent, as a clause.
    fn cancelled() -> Message;

    /// What to do about a unit to which nothing was sent, as a sentence without its full stop.
    fn nothing_sent() -> Message;
}
