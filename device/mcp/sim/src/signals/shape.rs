//! From a raw input reading to position, percent and motor command (MCP manual 1.9.8 to 1.9.12).
//!
//! Assumed, all in this file: the dead band is measured to either side of the center and the slope continues from zero at
//! its edge; the curve is x^(1/(1+e)) for an exponent e > 0 and x^(1+|e|) for e < 0; the power minimum is added after the
//! curve and the result limited to the range.

use crate::settings::SignalSettings;

/// Full scale of percent and command: 100 % (MCP manual 1.9.12).
pub const FULL_SCALE: f64 = 32_767.0;

/// Scale of the power exponent on the wire (MCP manual, command 143).
const POWER_EXP_SCALE: f64 = 65_536.0;
/// Largest power exponent either way.
const POWER_EXP_LIMIT: f64 = 8.0;

/// Signed distance from the center after ranging, dead band, curve and power minimum, in input units.
pub fn position(raw: f64, settings: &SignalSettings) -> f64 {
    let center = f64::from(settings.center);
    let (low, high) = (f64::from(settings.min.min(settings.max)), f64::from(settings.max.max(settings.min)));
    let offset = raw.clamp(low, high) - center;
    let span = span(offset, settings);
    let deadband = f64::from(settings.deadband);
    if offset.abs() <= deadband || span <= deadband {
        return 0.0;
    }
    let share = (offset.abs() - deadband) / (span - deadband);
    let shaped = curve(share.min(1.0), settings.power_exp_raw) * span;
    (shaped + f64::from(settings.power_min)).min(span).copysign(offset)
}

/// The position as a share of its side of the range, +-32767.
pub fn percent(position: f64, settings: &SignalSettings) -> f64 {
    let span = span(position, settings);
    if span > 0.0 { (position / span * FULL_SCALE).clamp(-FULL_SCALE, FULL_SCALE) } else { 0.0 }
}

/// A percent value scaled to the output range: full scale gives `max_output`, minus full scale `min_output`.
pub fn scaled_to_output(percent: f64, settings: &SignalSettings) -> f64 {
    let limit = if percent < 0.0 { -f64::from(settings.min_output) } else { f64::from(settings.max_output) };
    percent / FULL_SCALE * limit
}

/// A speed limited to the output range.
pub fn limited_to_output(speed: f64, settings: &SignalSettings) -> f64 {
    let (low, high) = (f64::from(settings.min_output), f64::from(settings.max_output));
    speed.clamp(low.min(high), high.max(low))
}

/// Distance from the center to the end of the range on the side of `offset`.
fn span(offset: f64, settings: &SignalSettings) -> f64 {
    let end = if offset < 0.0 { settings.min } else { settings.max };
    (f64::from(end) - f64::from(settings.center)).abs()
}

fn curve(share: f64, power_exp_raw: i32) -> f64 {
    let exponent = (f64::from(power_exp_raw) / POWER_EXP_SCALE).clamp(-POWER_EXP_LIMIT, POWER_EXP_LIMIT);
    match exponent {
        0.0 => share,
        e if e > 0.0 => share.powf(1.0 / (1.0 + e)),
        e => share.powf(1.0 - e),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn analog() -> SignalSettings {
        SignalSettings { kind: 1, ..SignalSettings::default() }
    }

    #[test]
    fn the_reading_on_the_manuals_status_screen_comes_out() {
        // MCP manual 1.9.12: min 0, center 2048, max 4095, outputs +-32767; position -2043, percent and command -32687.
        let settings = analog();
        let position = position(5.0, &settings);
        let percent = percent(position, &settings);
        assert_eq!(position, -2043.0);
        assert_eq!(percent.trunc(), -32687.0);
        assert_eq!(scaled_to_output(percent, &settings).trunc(), -32687.0);
    }

    #[test]
    fn each_side_of_the_center_reaches_full_scale_at_its_own_end() {
        let settings = SignalSettings { min: 1000, center: 1200, max: 2000, ..analog() };
        assert_eq!(percent(position(1000.0, &settings), &settings), -32767.0);
        assert_eq!(percent(position(2000.0, &settings), &settings), 32767.0);
        assert_eq!(position(5000.0, &settings), 800.0);
        assert_eq!(position(-5000.0, &settings), -200.0);
    }

    #[test]
    fn inside_the_dead_band_is_zero_and_outside_the_slope_starts_there() {
        let settings = SignalSettings { min: -1000, center: 0, max: 1000, deadband: 100, ..analog() };
        assert_eq!(position(100.0, &settings), 0.0);
        assert_eq!(position(-100.0, &settings), 0.0);
        assert!(position(101.0, &settings) < 2.0);
        assert_eq!(position(1000.0, &settings), 1000.0);
    }

    #[test]
    fn a_positive_exponent_is_steep_near_the_center_a_negative_one_flat() {
        let base = SignalSettings { min: -1000, center: 0, max: 1000, ..analog() };
        let with = |exp: f64| SignalSettings { power_exp_raw: (exp * 65_536.0) as i32, ..base.clone() };
        assert!((position(250.0, &with(1.0)) - 500.0).abs() < 1e-9); // square root
        assert!((position(-500.0, &with(-1.0)) + 250.0).abs() < 1e-9); // square
        assert_eq!(position(500.0, &base), 500.0);
        for exp in [-8.0, -1.0, 0.0, 1.0, 8.0] {
            assert_eq!(position(1000.0, &with(exp)), 1000.0);
        }
    }

    #[test]
    fn the_power_minimum_lifts_every_value_but_zero() {
        let settings = SignalSettings { min: -1000, center: 0, max: 1000, power_min: 50, ..analog() };
        assert_eq!(position(0.0, &settings), 0.0);
        assert_eq!(position(1.0, &settings), 51.0);
        assert_eq!(position(-1.0, &settings), -51.0);
        assert_eq!(position(990.0, &settings), 1000.0);
    }

    #[test]
    fn the_output_range_scales_each_direction_by_itself() {
        let settings = SignalSettings { min_output: -10_000, max_output: 20_000, ..analog() };
        assert_eq!(scaled_to_output(-32_767.0, &settings), -10_000.0);
        assert_eq!(scaled_to_output(32_767.0, &settings), 20_000.0);
        assert_eq!(limited_to_output(90_000.0, &settings), 20_000.0);
    }

    #[test]
    fn a_range_without_extent_gives_zero() {
        let settings = SignalSettings { min: 7, center: 7, max: 7, ..analog() };
        assert_eq!(position(9.0, &settings), 0.0);
        assert_eq!(percent(0.0, &settings), 0.0);
    }
}
