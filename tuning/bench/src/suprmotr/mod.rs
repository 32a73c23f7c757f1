//! The SuprMotr V9 on the bench: motors of up to an ampere or so, lines in virtual time, trials of its registers.

pub mod line;
pub mod population;
mod trial;
mod unit;

use crate::judge::Judge;
use crate::table::table;
use population::BoardSetup;

/// Its bench. Faults are struck while a duty drives a motor, and this board takes none.
pub const JUDGE: Judge = Judge {
    faults: |_, _| Vec::new(),
    table: |seed, plants, _| table(seed, &crate::table::cases::<BoardSetup>(seed, plants, false), false),
    ..Judge::of::<BoardSetup>("SuprMotr V9")
};
