//! Experiments on a guarded axis: what they drive and what they read off at once. Fits over their records stand in [`crate::fit`].

pub(crate) mod backlash;
pub(crate) mod free;
pub(crate) mod limit_cycle;
pub(crate) mod own_test;
pub(crate) mod position_relay;
pub(crate) mod probe;
pub(crate) mod relay;
mod rest;
pub(crate) mod step;
pub(crate) mod window;

pub use backlash::{Backlash, measure_backlash};
pub use free::{FreeRun, run_free};
pub use limit_cycle::Figure;
pub use own_test::{OwnPositionTestRun, OwnTestRun, run_own_position_test, run_own_test};
pub use position_relay::{PositionRelayRun, run_position_relay};
pub use probe::{Probe, run_probe};
pub use relay::{RelayRun, run_relay};
pub(crate) use rest::rest;
pub use step::{StepRun, run_step};
pub(crate) use window::WINDOW;
pub use window::{WindowRun, go_to, run_window};
