//! The window as a page in a browser: simulated controllers alone, no thread, no disk, and time that the page hands out.
//!
//! What turns the links is plain and tested on any system; what speaks to the browser is only in the page.

mod links;
mod world;

#[cfg(target_family = "wasm")]
pub mod browser;
#[cfg(target_family = "wasm")]
mod labels;
#[cfg(target_family = "wasm")]
mod runner;

pub use links::{Links, NoPorts, PageOpener};
#[cfg(target_family = "wasm")]
pub use runner::run;
