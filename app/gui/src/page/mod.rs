//! The window as a page in a browser: no thread, no disk, simulated controllers in time that the page hands out, and a real one behind a serial
//! port of the browser where it has some.
//!
//! What turns the links is plain and tested on any system; what speaks to the browser is only in the page.

mod links;
mod ports;
mod world;

#[cfg(target_family = "wasm")]
pub mod browser;
#[cfg(target_family = "wasm")]
mod labels;
#[cfg(target_family = "wasm")]
mod runner;
#[cfg(target_family = "wasm")]
mod serial;

pub use links::{Links, PageOpener};
pub use ports::{Browser, Granted, Ports};
#[cfg(target_family = "wasm")]
pub use runner::run;
