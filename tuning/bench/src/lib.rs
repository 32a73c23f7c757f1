//! Judges the tuner on a population of simulated motors, in virtual time.
//!
//! The tuner sees packet serial alone; what the plants really are is used here, to judge it.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod bounds;
pub mod cache;
pub mod faults;
pub mod line;
pub mod motion_mind;
pub mod oracle;
pub mod population;
mod quantile;
pub mod reject;
pub mod run;
pub mod table;
pub mod trial;
pub mod truth;
