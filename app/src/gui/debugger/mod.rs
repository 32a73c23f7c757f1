//! The MCL debugger in the window: what the script in a simulated controller does, and what is done to it.
//!
//! It speaks to controllers that are simulated in this program, past the wire: the protocol has no word for any of it.

pub mod names;
mod panel;
mod stack;
pub mod state;
mod stream;
pub mod terminal;
mod toolbar;
mod values;
mod watches;
pub mod wish;

pub use panel::debug_ui;
pub use state::Debugging;
pub use stream::terminal_ui;
pub use wish::DebugWish;

use std::borrow::Cow;

use super::model::Model;

/// Why there is nothing to debug; none where there is.
pub fn why_not(model: &Model) -> Option<Cow<'static, str>> {
    if !model.is_connected() {
        return Some("The debugger needs a simulated controller: connect to sim:mcp266, then download and start the program.".into());
    }
    if model.front.worlds.is_none() {
        return Some(
            "The debugger works with controllers that are simulated in this program. The protocol cannot stop a program \
             in the middle or read its variables, so on this controller use PUTS and the terminal; or connect to \
             sim:mcp266 and download the program there."
                .into(),
        );
    }
    None
}
