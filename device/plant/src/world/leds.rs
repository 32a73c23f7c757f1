//! The LEDs of a unit, where it has them.

use serde::Serialize;

/// Which LEDs are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Leds {
    /// Green STAT1.
    pub stat1: bool,
    /// Green STAT2.
    pub stat2: bool,
    /// Red ERR.
    pub err: bool,
}
