//! Judges the tuner on a population of simulated motors, in virtual time.
//!
//! The tuner sees its wire alone; what the plants really are is used here, to judge it.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

/// The families that there is a bench for, in their folders.
macro_rules! families {
    ($($family:ident),*) => { $(pub mod $family;)* };
}

families!(mcp, motion_mind, suprmotr);

pub use brushwork_tuning::sensitivity;

mod bounds;
pub mod faults;
pub mod judge;
pub mod line;
pub mod optimum;
pub mod oracle;
pub mod population;
mod quantile;
pub mod reject;
pub mod run;
pub mod table;
pub mod trial;
pub mod truth;
pub mod unit;
pub mod ways;
