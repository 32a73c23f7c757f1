//! Automatic battery detection at start-up (MCP manual 1.4.1): lithium polymer cells counted from the voltage of the main battery.
//!
//! Assumed: the two voltages of a cell, that a battery has as few cells as its voltage allows, and that the limits found so take
//! the place of those of command 57, which stay as they are, for as long as the unit runs.

/// Below this a cell is harmed.
const CELL_MIN_VOLTS: f64 = 3.0;
/// A full cell, with a little for a charger's error.
const CELL_MAX_VOLTS: f64 = 4.25;

/// What was found at start-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DetectedBattery {
    /// Lithium polymer cells in series, 1 or more.
    pub cells: u32,
}

impl DetectedBattery {
    /// The battery with that voltage. One that is nearly empty passes for one of fewer cells, as the manual warns.
    pub fn of(main_volts: f64) -> Self {
        Self { cells: ((main_volts / CELL_MAX_VOLTS).ceil() as u32).max(1) }
    }

    /// Minimum and maximum of the main battery, V.
    pub fn limits_volts(self) -> (f64, f64) {
        let cells = f64::from(self.cells);
        (CELL_MIN_VOLTS * cells, CELL_MAX_VOLTS * cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_battery_within_its_range_is_counted_right_and_an_undercharged_one_is_not() {
        for (volts, cells) in [(11.1, 3), (12.6, 3), (14.8, 4), (24.0, 6), (25.2, 6), (12.0, 3)] {
            assert_eq!(DetectedBattery::of(volts).cells, cells, "{volts} V");
        }
        // Four cells at 3.0 V each: "undercharged ... batteries will cause false readings".
        assert_eq!(DetectedBattery::of(4.0 * 3.0).limits_volts(), (9.0, 12.75));
    }
}
