//! What a motor axis does, in figures, and the gains that make it do better. Knows no serial port, no window, no clock and no
//! simulator.
//!
#![doc = include_str!("../README.md")]
//!
#![doc = include_str!("../MEASURED.md")]

pub mod axis;
pub mod cause;
pub mod course;
pub mod design;
mod diagnosis;
pub mod experiment;
pub mod fit;
pub mod lag;
pub mod law_probe;
pub mod linear;
mod looped;
mod margin;
pub mod model;
pub mod motion_mind;
mod pace;
pub mod record;
pub mod registers;
pub mod report;
pub mod rig;
pub mod rules;
pub mod score;
pub mod settle;
mod step;
mod swing;
pub mod ticks;
pub mod trace;
pub mod trial;
pub mod tune;
mod verify;
pub mod watch;
pub mod whatif;
pub mod winding;

pub use step::{Point, StepFigures};
