//! Experiments on a guarded axis: what they drive and what they read off at once. Fits over their records stand in [`crate::fit`].

mod backlash;
mod free;
mod limit_cycle;
mod own_test;
mod position_relay;
mod probe;
mod relay;
mod rest;
mod step;
mod window;

pub use backlash::{Backlash, measure_backlash};
pub use free::{FreeRun, run_free};
pub use limit_cycle::Figure;
pub use own_test::{OwnTestRun, run_own_test};
pub use position_relay::{PositionRelayRun, run_position_relay};
pub use probe::{Probe, run_probe};
pub use relay::{RelayRun, run_relay};
pub(crate) use rest::rest;
pub use step::{StepRun, run_step};
pub use window::{WindowRun, go_to, run_window};
