//! What a motor axis does, in figures, and the gains that make it do better. Knows no serial port, no window, no clock and no
//! simulator.
//!
#![doc = include_str!("../README.md")]
//!
#![doc = include_str!("../MEASURED.md")]

pub mod axis;
mod backlash;
pub mod cause;
mod closed_loop_monitor;
pub mod design;
mod diagnosis;
pub mod experiment;
pub mod experiment_guard;
pub mod fit;
mod gains;
pub mod lag;
pub mod law_probe;
pub mod linear;
mod margin;
pub mod model;
pub mod motion_mind;
pub mod motor_monitor;
pub mod open_loop_record;
mod oscillation;
mod pace;
mod poll;
mod proposal;
pub mod record;
pub mod registers;
mod replay;
pub mod report;
mod request;
pub mod rules;
pub mod score;
mod setpoint;
pub mod settle;
mod step;
pub mod ticks;
pub mod trace;
pub mod trial;
pub mod tune;
mod verify;
pub mod whatif;
pub mod winding;

pub use step::{Point, StepFigures};
