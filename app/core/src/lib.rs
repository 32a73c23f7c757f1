//! What the window and the command line both do: open what the user names, keep backups and journals, record samples, measure and
//! tune. Knows no toolkit and no arguments.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod addresses;
pub mod addressing;
pub mod examine;
pub mod guardian;
pub mod keep;
pub mod known_file;
pub mod messages;
pub mod motion;
pub mod panics;
pub mod recording;
pub mod session;
pub mod settings;
pub mod stop;
pub mod tune;
pub mod update;
pub mod words;

#[cfg(test)]
#[path = "../../gui/tests/gui/support/wait.rs"]
#[allow(dead_code, reason = "shared with the tests of the window")]
mod wait;
