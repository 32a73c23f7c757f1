//! Experiments on a guarded axis: what they drive and what they read off at once. Fits over their records stand in [`crate::fit`].

mod free;
mod probe;
mod slack;
mod window;

pub use free::{FreeRun, run_free};
pub use probe::{Probe, run_probe};
pub use slack::{Slack, measure_slack};
pub use window::{WindowRun, go_to, run_window};
