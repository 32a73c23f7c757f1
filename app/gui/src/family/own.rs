//! What a family keeps of its own for one link: shared code hands it what happens and asks nothing else of it.

use std::any::Any;
use std::fmt::Debug;
use std::path::Path;
use std::time::Duration;

use brushwork_link::{Event, Failure, Identity, Message, Request, Sample};

use super::known::Known;
use crate::model::screen::Screen;

/// The state of a family's own screens and panels for one link. Each link has that of every family.
pub trait Own: Any + Debug {
    /// Takes in an event of the link. True where it was about a read of its own, which concerns nobody else.
    fn take(&mut self, _event: &Event) -> bool {
        false
    }

    /// Takes in the readings of a sweep.
    fn note_sample(&mut self, _sample: &Sample) {}

    /// Nothing may move any more.
    fn rest(&mut self) {}

    /// Another unit, or none.
    fn forget_unit(&mut self) {}

    /// The link is gone, on request or not.
    fn link_ended(&mut self) {}

    /// Whether it is at work with the unit.
    fn is_busy(&self) -> bool {
        false
    }

    /// Why the window may not be closed now.
    fn holds_window(&self) -> Option<Message> {
        None
    }

    /// What the open screen needs read of that unit besides the signals, when it is time for it. Units of other families concern it not.
    fn read(&mut self, _unit: &Identity, _now: Duration) -> Option<Request> {
        None
    }

    /// Where the unit keeps its motor by itself, in counts: by settings as they were confirmed, and as they are known.
    fn travel(&self, _confirmed: Known<'_>, _known: Known<'_>) -> Option<(f64, f64)> {
        None
    }

    /// Whether its part of that screen shows bytes that come in without being asked for.
    fn shows_unasked(&self, _unit: &Identity, _screen: Screen) -> bool {
        false
    }

    /// Such a read was not taken by the link.
    fn not_read(&mut self) {}

    /// Bytes that were to be sent as they are were not taken by the link.
    fn not_sent(&mut self, _id: u64) {}

    /// A command that was put together by hand was not taken by the link.
    fn not_transacted(&mut self) {}

    /// Such a command was not sent.
    fn refused(&mut self, _id: u64, _why: Failure) {}

    /// Shows the window for firmware updates, with a file if one was named.
    fn open_firmware(&mut self, _file: Option<&Path>) {}
}
