//! The simulated MCP and RoboClaw controllers: deterministic, with their own clock, free of IO.
//!
//! A [`controller::Controller`] takes bytes and time and gives bytes; [`brushwork_plant`] is what it drives.

pub mod controller;
pub mod motion;
pub mod priority;
pub mod settings;
pub mod signals;
pub mod supervision;
