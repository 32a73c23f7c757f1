//! The simulated MCP and RoboClaw controllers: deterministic, with their own clock, free of IO.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

pub mod controller;
pub mod motion;
pub mod priority;
pub mod settings;
pub mod signals;
pub mod supervision;
