//! The settings of the units on one link: one state for each unit, one way to read, write and keep them. No screen of its own.

mod applicable;
mod kept;
mod outcome;
mod steps;
mod summary;
mod unit;
mod unit_key;
mod units;
mod work;

pub use kept::Settle;
pub use summary::Summary;
pub use unit::{Before, Saved, UnitSettings};
pub use unit_key::UnitKey;
pub use units::{Ended, Settings};
pub use work::{Calibrating, Running, SettingsAction};
