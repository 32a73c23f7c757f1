//! What a program asks the bench about one family.

use crate::faults::{FaultRow, fault_rows};
use crate::table::{Table, cases, optima_of, table};
use crate::unit::{Unit, population};
use crate::ways::{WayRow, way_rows};

/// A family's bench: of the plants of a seed, as many as wanted.
#[derive(Clone, Copy, Debug)]
pub struct Judge {
    /// Its controllers, for a list.
    pub title: &'static str,
    /// The rows of faults.
    pub faults: fn(u64, usize) -> Vec<FaultRow>,
    /// The rows of every way to tune.
    pub ways: fn(u64, usize) -> Vec<WayRow>,
    /// The optima, worked out anew, as a file has them.
    pub optima: fn(u64, usize) -> serde_json::Result<String>,
    /// The table, with the faults where they are wanted.
    pub table: fn(u64, usize, bool) -> Table,
}

impl Judge {
    /// That of a family's units.
    #[must_use]
    pub const fn of<U: Unit>(title: &'static str) -> Self {
        Self {
            title,
            faults: |seed, plants| fault_rows(&population::<U>(seed, plants)),
            ways: way_rows::<U>,
            optima: |seed, plants| serde_json::to_string(&optima_of(&cases::<U>(seed, plants, true))),
            table: |seed, plants, faults| table(seed, &cases::<U>(seed, plants, false), faults),
        }
    }
}
