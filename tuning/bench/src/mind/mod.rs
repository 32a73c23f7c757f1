//! The same bench for the Motion Mind 3: its axis over the wire, motors that suit it, their optima, the table and the faults.

pub mod axis;
mod clock;
pub mod faults;
mod fence;
pub mod line;
pub mod plant_under_test;
pub mod population;
pub mod table;
