//! The Motion Mind 3 on the bench: motors that suit it, frames or lines in virtual time, trials of its registers.

pub mod line;
pub mod population;
mod trial;
mod unit;

use crate::judge::Judge;
use population::MindSetup;

/// Its bench.
pub const JUDGE: Judge = Judge::of::<MindSetup>("Motion Mind 3, frames and lines");
