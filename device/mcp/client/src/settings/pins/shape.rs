//! What an input's settings make of its reading: the signal graph (MCP manual 1.9.8, 1.9.10 to 1.9.12), there and back.
//!
//! Assumed, since the manual gives words and pictures: the deadband is measured to either side of the center and the slope
//! begins at its edge with zero; the curve is x^(1/(1+e)) for an exponent e above 0, which is steep near the center, and
//! x^(1+|e|) below; the power minimum is added after the curve, in the units of the input, and the ends of the range
//! limit the sum.

use brushwork_mcp_wire::packet_serial::scale;

use crate::settings::pins::values::{Lookup, PinValues};

/// How a reading becomes a position and a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalShape {
    /// Lowest reading.
    pub min: f64,
    /// Reading at rest.
    pub center: f64,
    /// Highest reading.
    pub max: f64,
    /// Distance from the center that counts as zero.
    pub deadband: f64,
    /// Bend of the curve, -8 to 8; 0 is straight.
    pub power_exponent: f64,
    /// Added to every position other than zero, in units of the reading.
    pub power_min: f64,
    /// Command at the low end, -32767 for all.
    pub min_output: f64,
    /// Command at the high end, 32767 for all.
    pub max_output: f64,
}

/// Which reading stands behind a position, as far as the position tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behind {
    /// This one.
    Reading(f64),
    /// One within the deadband.
    Deadband,
    /// One at the low end or beyond.
    LowEnd,
    /// One at the high end or beyond.
    HighEnd,
}

/// Largest exponent either way (MCP manual 2.3.1, command 143).
const EXPONENT_LIMIT: f64 = 8.0;

impl SignalShape {
    /// The shape that a pin (from 1) is set to; `None` while one of its values is not known.
    pub fn of(get: Lookup<'_>, pin: usize) -> Option<Self> {
        let pin = PinValues::new(get, pin);
        Some(Self {
            min: pin.number("min")?,
            center: pin.number("center")?,
            max: pin.number("max")?,
            deadband: pin.number("deadband")?,
            power_exponent: pin.number("power_exp")?,
            power_min: pin.number("power_min")?,
            min_output: pin.number("min_output")?,
            max_output: pin.number("max_output")?,
        })
    }

    /// Signed distance from the center as it counts, in units of the reading.
    pub fn position(&self, reading: f64) -> f64 {
        let (low, high) = (self.min.min(self.max), self.min.max(self.max));
        let offset = reading.clamp(low, high) - self.center;
        let span = self.span(offset);
        if offset.abs() <= self.deadband || span <= self.deadband {
            return 0.0;
        }
        let share = ((offset.abs() - self.deadband) / (span - self.deadband)).min(1.0);
        let position = share.powf(self.exponent()) * span + self.power_min;
        position.min(span).copysign(offset)
    }

    /// A position as a share of its side of the range: -1 to 1.
    pub fn share(&self, position: f64) -> f64 {
        let span = self.span(position);
        if span > 0.0 { (position / span).clamp(-1.0, 1.0) } else { 0.0 }
    }

    /// The motor command of a reading, in position and percent mode: `min_output` to `max_output`.
    pub fn command(&self, reading: f64) -> f64 {
        let share = self.share(self.position(reading));
        share * if share < 0.0 { -self.min_output } else { self.max_output }
    }

    /// The command as a share of full output: -1 to 1.
    pub fn output(&self, reading: f64) -> f64 {
        self.command(reading) / scale::FULL_DUTY_RAW as f64
    }

    /// Which reading gives this position. Positions come from the controller as whole numbers cut toward zero, so a steep
    /// curve leaves the reading as uncertain as it is flat the other way.
    pub fn behind(&self, position: f64) -> Behind {
        if position == 0.0 {
            return if self.deadband > 0.0 { Behind::Deadband } else { Behind::Reading(self.center) };
        }
        let span = self.span(position);
        if position.abs() >= span {
            return if position < 0.0 { Behind::LowEnd } else { Behind::HighEnd };
        }
        let bent = ((position.abs() - self.power_min) / span).max(0.0);
        let share = bent.powf(1.0 / self.exponent());
        // Whatever has a position stands beyond the deadband.
        let offset = (self.deadband + share * (span - self.deadband)).max(self.deadband + 1.0);
        Behind::Reading((self.center + offset.copysign(position)).round())
    }

    /// Distance from the center to the end on the side of `offset`.
    pub fn span(&self, offset: f64) -> f64 {
        let end = if offset < 0.0 { self.min } else { self.max };
        (end - self.center).abs()
    }

    fn exponent(&self) -> f64 {
        let bend = self.power_exponent.clamp(-EXPONENT_LIMIT, EXPONENT_LIMIT);
        if bend > 0.0 { 1.0 / (1.0 + bend) } else { 1.0 - bend }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEFAULT: SignalShape = SignalShape {
        min: 0.0,
        center: 2048.0,
        max: 4095.0,
        deadband: 0.0,
        power_exponent: 0.0,
        power_min: 0.0,
        min_output: -32_767.0,
        max_output: 32_767.0,
    };

    #[test]
    fn with_nothing_changed_the_graph_is_a_straight_slope() {
        // MCP manual 1.9.10: "If no settings are changed ... a straight slope will be shown."
        for (reading, percent) in [(0.0, -100.0), (1024.0, -50.0), (2048.0, 0.0), (4095.0, 100.0)] {
            assert_eq!(DEFAULT.output(reading) * 100.0, percent);
        }
    }

    #[test]
    fn the_reading_on_the_manuals_status_screen_comes_out() {
        // MCP manual 1.9.12: min 0, center 2048, max 4095, outputs +-32767: position -2043 goes with percent -32687.
        assert_eq!(DEFAULT.position(5.0), -2043.0);
        assert_eq!((DEFAULT.share(-2043.0) * 32_767.0).trunc(), -32_687.0);
        assert_eq!(DEFAULT.command(5.0).trunc(), -32_687.0);
        assert_eq!(DEFAULT.behind(-2043.0), Behind::Reading(5.0));
    }

    #[test]
    fn a_deadband_is_level_around_the_center_and_the_slope_begins_at_its_edge() {
        let shape = SignalShape { deadband: 100.0, ..DEFAULT };
        assert_eq!(shape.position(2148.0), 0.0);
        assert_eq!(shape.position(1948.0), 0.0);
        assert!(shape.position(2149.0) > 0.0 && shape.position(2149.0) < 2.0);
        assert_eq!(shape.position(4095.0), 2047.0);
        assert_eq!(shape.behind(0.0), Behind::Deadband);
    }

    #[test]
    fn the_power_minimum_lifts_every_value_but_zero() {
        // MCP manual 1.9.8: "the duty for the motor at stop will be 0 and when movement is initialized will jump".
        let shape = SignalShape { power_min: 100.0, ..DEFAULT };
        assert_eq!(shape.position(2048.0), 0.0);
        assert_eq!(shape.position(2049.0), 101.0);
        assert_eq!(shape.position(2047.0), -101.0);
        assert_eq!(shape.position(4090.0), 2047.0);
    }

    #[test]
    fn a_positive_exponent_is_steep_at_the_center_and_a_negative_one_at_the_ends() {
        // MCP manual 1.9.8: "Positive values increase sensitivity close to the center point".
        let base = SignalShape { min: -1000.0, center: 0.0, max: 1000.0, ..DEFAULT };
        let with = |power_exponent| SignalShape { power_exponent, ..base };
        assert!((with(1.0).position(250.0) - 500.0).abs() < 1e-9);
        assert!((with(-1.0).position(-500.0) + 250.0).abs() < 1e-9);
        for exponent in [-8.0, -1.0, 1.0, 8.0] {
            assert_eq!(with(exponent).position(1000.0), 1000.0);
        }
    }

    #[test]
    fn the_command_range_scales_each_direction_by_itself() {
        let shape = SignalShape { min_output: -10_000.0, max_output: 20_000.0, ..DEFAULT };
        assert_eq!(shape.command(0.0), -10_000.0);
        assert_eq!(shape.command(4095.0), 20_000.0);
    }

    #[test]
    fn the_way_back_finds_every_reading_that_can_be_told() {
        for power_exponent in [-1.0, -0.5, 0.0] {
            let shape = SignalShape { deadband: 30.0, power_min: 20.0, power_exponent, ..DEFAULT };
            for reading in (100..2000).chain(2100..4000).step_by(7) {
                let reading = f64::from(reading);
                let whole = shape.position(reading).trunc();
                match shape.behind(whole) {
                    // The position is cut to a whole number, which a flat part of the curve stretches.
                    Behind::Reading(found) => {
                        let back = shape.position(found);
                        assert!((back - whole).abs() <= 3.0, "{power_exponent}: {reading} gave {found}");
                    }
                    Behind::LowEnd | Behind::HighEnd => assert!(whole.abs() >= shape.span(whole)),
                    Behind::Deadband => assert_eq!(whole, 0.0),
                }
            }
        }
    }

    #[test]
    fn what_lies_beyond_the_ends_is_not_made_up() {
        let shape = SignalShape { min: 1000.0, center: 1500.0, max: 2000.0, ..DEFAULT };
        assert_eq!(shape.behind(shape.position(2300.0)), Behind::HighEnd);
        assert_eq!(shape.behind(shape.position(700.0)), Behind::LowEnd);
        assert_eq!(shape.behind(0.0), Behind::Reading(1500.0));
    }

    #[test]
    fn a_range_without_extent_gives_zero() {
        let shape = SignalShape { min: 7.0, center: 7.0, max: 7.0, ..DEFAULT };
        assert_eq!(shape.position(9.0), 0.0);
        assert_eq!(shape.command(9.0), 0.0);
    }
}
