//! Simulated motor controllers and the machines they drive: deterministic, with their own clock, free of IO at the core.
//! See `ARCHITECTURE.md`.

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
