//! The MCL debugger in the window: what the script in a simulated controller does, and what is done to it.
//!
//! It speaks to controllers that are simulated in this program, past the wire: the protocol has no word for any of it.

pub mod action;
pub mod messages;
pub mod names;
mod needs;
mod panel;
mod stack;
pub mod state;
mod stream;
pub mod terminal;
mod toolbar;
mod values;
mod watches;

pub use action::DebugAction;
pub use needs::why_not;
pub use panel::debug_ui;
pub use state::Debugging;
pub use stream::terminal_ui;
