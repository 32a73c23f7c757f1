//! The same bench for the Motion Mind 3: motors that suit it, their optima, the table and the faults.

mod axis;
pub mod faults;
pub mod line;
pub mod plant_under_test;
pub mod population;
pub mod table;
