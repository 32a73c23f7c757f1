//! The simulated MCP and RoboClaw controllers: deterministic, with their own clock, free of IO.
//!
#![doc = include_str!("../README.md")]

pub mod controller;
pub mod motion;
pub mod priority;
pub mod settings;
pub mod signals;
pub mod supervision;
