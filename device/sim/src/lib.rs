//! Simulated motor controllers and the machines they drive: deterministic, in a time that the caller moves, free of IO at the core.
//!
#![doc = include_str!("../README.md")]

pub mod bridge;
pub mod controller;
pub mod faults;
pub mod machine;
pub mod motion;
pub mod motion_mind;
pub mod pacing;
pub mod plant;
pub mod presets;
pub mod priority;
pub mod server;
pub mod settings;
pub mod signals;
pub mod supervision;
pub mod world;
