//! What a motor axis does, in figures, and the gains that make it do better. Knows no serial port, no window, no clock and no
//! simulator.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]
//!
#![doc = include_str!("../MEASURED.md")]

pub mod alternatives;
pub mod axis;
mod backlash;
pub mod cascade;
pub mod cause;
mod closed_loop_monitor;
pub mod closed_loop_record;
mod current_silence;
pub mod design;
mod diagnosis;
pub mod duty_limiter;
pub mod experiment;
pub mod experiment_guard;
pub mod fit;
pub mod forecast;
mod gains;
pub mod joined;
pub mod lag;
pub mod law;
pub mod law_probe;
pub mod linear;
pub mod load_change;
mod margin;
pub mod model;
pub mod motor_monitor;
mod moves;
pub mod open_loop_record;
pub mod oscillation;
mod pace;
pub mod plain_law;
mod poll;
pub mod promise;
mod proposal;
pub mod record;
pub mod registers;
mod replay;
pub mod report;
mod request;
pub mod response;
pub mod rules;
pub mod score;
pub mod sensitivity;
pub mod setpoint;
pub mod settle;
pub mod setup;
pub mod stability;
mod step;
pub mod thresholds;
pub mod ticks;
pub mod trace;
pub mod trajectory;
pub mod trial;
pub mod tune;
mod verify;
pub mod whatif;
pub mod winding;
mod windup;

pub use step::{Point, StepFigures};
