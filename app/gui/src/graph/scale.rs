//! A channel's own vertical scale: eight divisions between round numbers.
//!
//! A scale grows by itself when a value does not fit and shrinks only when asked to fit, so that a live picture
//! does not jump. It grows to the next round number: 1, 2 or 5 times a power of ten.

/// Horizontal lines of the grid, less one.
pub const DIVISIONS: usize = 8;

/// What the bottom and the top of the graph stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    pub low: f64,
    pub high: f64,
}

impl Scale {
    /// From `-reach` to `reach`, for values with a sign.
    pub const fn around_zero(reach: f64) -> Self {
        Self { low: -reach, high: reach }
    }

    /// Grows until `value` fits.
    pub fn include(&mut self, value: f64) {
        if !value.is_finite() || (self.low..=self.high).contains(&value) {
            return;
        }
        let around_zero = self.low == -self.high;
        if around_zero {
            *self = Self::around_zero(round_up(value.abs()));
        } else if self.low == 0.0 && value > 0.0 {
            self.high = round_up(value);
        } else {
            *self = Self::fitting(self.low.min(value), self.high.max(value), 0.0);
        }
    }

    /// The tightest scale that holds `min` and `max` in round divisions, none smaller than `least_division`.
    pub fn fitting(min: f64, max: f64, least_division: f64) -> Self {
        let divisions = DIVISIONS as f64;
        // Far from zero a division also has to be more than the rounding of the figures themselves.
        let least = least_division.max(max.abs().max(min.abs()) * 1e-9);
        let mut division = round_up(((max - min) / divisions).max(least));
        loop {
            let low = (min / division).floor() * division;
            let spare = ((low + division * divisions - max) / division).floor();
            if spare >= 0.0 || !division.is_finite() {
                let low = low - (spare / 2.0).floor() * division;
                return Self { low, high: low + division * divisions };
            }
            division = round_up(division * 1.01);
        }
    }

    /// Moved so that what was at part `from` of the height is at `to`.
    pub fn shifted(&self, from: f64, to: f64) -> Self {
        let by = (to - from) * (self.high - self.low);
        Self { low: self.low - by, high: self.high - by }
    }

    /// `factor` times as much, with what is at part `about` of the height left where it is.
    pub fn zoomed(&self, factor: f64, about: f64) -> Self {
        let fixed = self.value(about);
        Self { low: fixed + (self.low - fixed) * factor, high: fixed + (self.high - fixed) * factor }
    }

    /// The next rounder number of units per division, up or down, about zero if that is in view, else the middle.
    pub fn stepped(&self, closer: bool) -> Self {
        let now = self.division();
        let steps = (-9..=12).flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(power)));
        let next = match closer {
            true => steps.rev().find(|step| *step < now * 0.999),
            false => steps.clone().find(|step| *step > now * 1.001),
        };
        let about = if (self.low..=self.high).contains(&0.0) { self.part(0.0) } else { 0.5 };
        next.map_or(*self, |next| self.zoomed(next / now, about))
    }

    /// Units per division.
    pub fn division(&self) -> f64 {
        (self.high - self.low) / DIVISIONS as f64
    }

    /// Whether values can be drawn with it.
    pub fn is_sound(&self) -> bool {
        let reach = self.high - self.low;
        let size = self.high.abs().max(self.low.abs());
        reach.is_finite() && reach > size * 1e-12 && reach > 1e-12 && size < 1e15
    }

    /// Where `value` lies: 0 at the bottom, 1 at the top.
    pub fn part(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// The value at `part` of the height.
    pub fn value(&self, part: f64) -> f64 {
        self.low + part * (self.high - self.low)
    }

    /// Digits after the point that the labels of the divisions need; of divisions that are not round, two figures.
    pub fn decimals(&self) -> usize {
        let division = self.division().abs();
        let is_whole = |digits: usize| {
            let shifted = division * 10f64.powi(digits as i32);
            (shifted - shifted.round()).abs() < 1e-6 * shifted.max(1.0)
        };
        let enough = (1.0 - division.max(1e-9).log10().floor()).clamp(0.0, 5.0) as usize;
        (0..=(enough + 1).min(5)).find(|digits| is_whole(*digits)).unwrap_or(enough)
    }
}

/// The next 1, 2 or 5 times a power of ten that is at least `value`.
fn round_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power);
    steps.into_iter().find(|step| *step >= value * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A scale from zero to `reach`.
    fn from_zero(reach: f64) -> Scale {
        Scale { low: 0.0, high: reach }
    }

    #[test]
    fn labels_have_the_digits_they_need_and_two_figures_where_divisions_are_not_round() {
        let of = |low, high| Scale { low, high }.decimals();
        assert_eq!([of(-100.0, 100.0), of(0.0, 2.0), of(0.0, 10.0), of(0.0, 0.8)], [0, 2, 2, 1]);
        assert_eq!([of(-21.739_13, 72.173_91), of(0.0, 8.888), of(0.0, 0.012_345)], [0, 1, 4]);
    }

    #[test]
    fn a_scale_grows_to_the_next_round_number_and_does_not_shrink() {
        let mut scale = Scale::around_zero(1000.0);
        scale.include(-1234.0);
        assert_eq!(scale, Scale::around_zero(2000.0));
        scale.include(3.0);
        assert_eq!(scale, Scale::around_zero(2000.0));
        let mut volts = from_zero(20.0);
        volts.include(24.1);
        assert_eq!(volts, from_zero(50.0));
    }

    #[test]
    fn a_value_below_zero_on_a_scale_from_zero_still_fits() {
        let mut amps = from_zero(10.0);
        amps.include(-3.0);
        assert!(amps.low <= -3.0 && amps.high >= 10.0, "{amps:?}");
    }

    #[test]
    fn labels_have_the_digits_they_need_and_no_more() {
        assert_eq!(Scale::around_zero(100.0).decimals(), 0);
        assert_eq!(from_zero(1.0).decimals(), 3);
        assert_eq!(from_zero(20.0).decimals(), 1);
    }

    #[test]
    fn a_scale_is_moved_and_stretched_about_a_point() {
        let scale = Scale::around_zero(100.0);
        assert_eq!(scale.shifted(0.5, 0.75), Scale { low: -150.0, high: 50.0 });
        assert_eq!(scale.zoomed(0.5, 0.5), Scale::around_zero(50.0));
        assert_eq!(from_zero(8.0).stepped(false), from_zero(16.0));
        assert_eq!(from_zero(8.0).stepped(true), from_zero(4.0));
        assert!(!Scale { low: 5.0, high: 5.0 }.is_sound() && !Scale::around_zero(f64::NAN).is_sound());
    }

    proptest! {
        #![proptest_config(proptest::test_runner::Config {
            rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED),
            failure_persistence: None,
            ..proptest::test_runner::Config::default()
        })]

        #[test]
        fn fitting_holds_both_ends_in_eight_round_divisions(a in -1e7..1e7f64, b in -1e7..1e7f64) {
            let (min, max) = (a.min(b), a.max(b));
            let scale = Scale::fitting(min, max, 0.001);
            prop_assert!(scale.low <= min && max <= scale.high, "{scale:?} for {min}..{max}");
            let division = (scale.high - scale.low) / DIVISIONS as f64;
            prop_assert!((round_up(division) / division - 1.0).abs() < 1e-6, "{division}");
        }

        #[test]
        fn a_flat_line_gets_a_scale_too(value in -1e6..1e6f64) {
            let scale = Scale::fitting(value, value, 0.001);
            prop_assert!(scale.low <= value && value <= scale.high && scale.low < scale.high);
        }
    }
}
