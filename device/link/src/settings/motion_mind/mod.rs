//! The settings of Motion Minds: the rows, and what is particular in writing and keeping them.

mod memory;
mod rows;
mod steps;

pub use memory::{reset, restore, save};
pub use rows::rows;
pub use steps::{arguments, stage, step_bytes, step_title, step_words, warnings, weaken_first};
