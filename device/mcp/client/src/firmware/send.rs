//! Sending an image to a unit that is in its loader.

use crate::firmware::error::{Left, SendError};
use brushwork_link::clock::Clock;
use brushwork_link::transport::Transport;
use brushwork_mcp_wire::loader::{Advance, ERASE_LIMIT, Image, Stage, Transfer};
use serde::Serialize;
use std::time::Duration;

/// How long a page may take to be confirmed beyond its time on the wire. Assumed: the libraries' own limit is not told apart
/// from their read time-out of 100 ms.
const PAGE_LIMIT: Duration = Duration::from_secs(2);
/// How long the line is quiet before the greeting (public clients, 2015-2020: 250 ms after opening).
const SETTLE: Duration = Duration::from_millis(250);
/// Waiting is cut into slices of this, so that cancelling is seen in time.
const SLICE: Duration = Duration::from_millis(20);

/// How far a transfer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Progress {
    /// About to greet the loader. The last moment at which it can be cancelled.
    Greeting,
    /// The controller erases its memory. Power must not fail now.
    Erasing,
    /// Pages go over.
    Writing {
        /// Pages confirmed.
        pages: usize,
        /// All pages.
        of: usize,
    },
}

/// A transfer that was completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    /// How many pages it was.
    pub pages: usize,
    /// How long it took, the erase included.
    pub took: Duration,
}

impl Progress {
    /// Whether it can still be cancelled without leaving the controller without firmware.
    #[must_use]
    pub fn is_harmless(self) -> bool {
        self == Self::Greeting
    }
}

impl Sent {
    /// What was sent, in a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        format!("{} pages were sent and confirmed in {:.1} s.", self.pages, self.took.as_secs_f64())
    }
}

/// Sends `image` to a unit in its loader and restarts it. `goes_on` hears of each step; by returning `false` at
/// [`Progress::Greeting`] it cancels. Afterwards there is no safe moment to stop, and what it returns does not count.
///
/// # Errors
/// Why it broke and in which state the controller is left. Nothing is ever sent twice: after a byte was lost the two ends are out of
/// step.
pub fn send(
    transport: &mut dyn Transport,
    clock: &dyn Clock,
    image: &Image,
    goes_on: &mut dyn FnMut(Progress) -> bool,
) -> Result<Sent, SendError> {
    let begun_at = clock.now();
    settle(transport, clock, goes_on)?;
    let mut transfer = Transfer::new(image);
    let of = image.page_count();
    loop {
        let stage = transfer.stage();
        if let Err(source) = transport.write(transfer.bytes()) {
            return Err(SendError::Line { left: left_at(stage), source });
        }
        match stage {
            Stage::Greeting => goes_on(Progress::Erasing),
            Stage::Page(pages) => goes_on(Progress::Writing { pages, of }),
            Stage::Reset => return Ok(Sent { pages: of, took: clock.now().saturating_sub(begun_at) }),
        };
        wait_for_answer(transport, clock, &mut transfer, of)?;
        if transfer.stage() == Stage::Reset {
            goes_on(Progress::Writing { pages: of, of });
        }
    }
}

/// Lets the line come to rest, throws away what comes, and asks once more.
fn settle(
    transport: &mut dyn Transport,
    clock: &dyn Clock,
    goes_on: &mut dyn FnMut(Progress) -> bool,
) -> Result<(), SendError> {
    let lost = |source| SendError::Line { left: Left::Untouched, source };
    let until = clock.now() + SETTLE;
    let mut buffer = [0; 256];
    while clock.now() < until {
        if !goes_on(Progress::Greeting) {
            return Err(SendError::Cancelled);
        }
        transport.read(&mut buffer, SLICE).map_err(lost)?;
    }
    transport.discard_input().map_err(lost)?;
    if goes_on(Progress::Greeting) { Ok(()) } else { Err(SendError::Cancelled) }
}

/// Waits until what was sent is confirmed.
fn wait_for_answer(
    transport: &mut dyn Transport,
    clock: &dyn Clock,
    transfer: &mut Transfer<'_>,
    of: usize,
) -> Result<(), SendError> {
    let stage = transfer.stage();
    let asked_at = clock.now();
    let length = u32::try_from(transfer.bytes().len() + 1).unwrap_or(u32::MAX);
    let on_the_wire = transport.byte_time().unwrap_or_default().saturating_mul(length);
    let limit = if stage == Stage::Greeting { ERASE_LIMIT } else { PAGE_LIMIT } + on_the_wire;
    let mut buffer = [0; 64];
    while clock.now().saturating_sub(asked_at) < limit {
        let count = match transport.read(&mut buffer, SLICE) {
            Ok(count) => count,
            Err(source) => return Err(SendError::Line { left: left_at(stage), source }),
        };
        for byte in &buffer[..count] {
            match (transfer.take(*byte), stage) {
                (Advance::Done, _) => return Ok(()),
                (Advance::Unexpected(got), Stage::Page(page)) => {
                    return Err(SendError::PageRefused { page, of, got });
                }
                _ => {}
            }
        }
    }
    let waited = clock.now().saturating_sub(asked_at);
    Err(match stage {
        Stage::Page(page) => SendError::PageLost { page, of, waited },
        Stage::Greeting | Stage::Reset => SendError::NoGreeting { waited },
    })
}

/// What a controller is left with when a write fails.
fn left_at(stage: Stage) -> Left {
    match stage {
        // A write that failed may have gone out all the same.
        Stage::Greeting => Left::PerhapsErasing,
        Stage::Page(_) => Left::WithoutFirmware,
        Stage::Reset => Left::Complete,
    }
}
