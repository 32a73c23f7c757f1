//! Updating a controller's firmware from a file that the user has: the risk, what may be sent to whom, and the transfer.
//!
//! An update is: settings backed up, motors stopped and the loader entered (`Request::EnterLoader` on the device thread, which
//! ends that link), then [`send`] over a fresh line, since the unit comes back as another USB device. What was learned about the
//! loader is in `brushwork_mcp_wire::loader`.

mod check;
mod error;
mod loads;
mod risk;
mod send;

pub use brushwork_mcp_wire::loader::Image;
pub use check::{Unsuitable, suit, suit_model};
pub use error::{Left, SendError};
pub use loads::Firmware;
pub use risk::risks;
pub use send::{Progress, Sent, send};

/// What has to be true before a transfer that broke is begun again.
pub const RESUME_NOTE: &str = "Begin again only after the controller was switched off and on: its STAT1 and STAT2 LEDs then take turns \
                               (MCP manual 1.6.3). A loader that still waits for the rest of a page would take the new transfer for it.";
