//! Numbers as characters, by the output modifiers (MCP manual 3.3).

use crate::mcl::ast::Format;

/// Nobody wants more leading zeros than this.
const MOST_ZEROS: u32 = 64;

/// A whole number as DEC, SDEC, HEX or IHEX write it: the lowest `max` digits (0: all), with zeros to `min`.
///
/// The manual shows HEX as "12ab" and as "0x12ab"; its text and IHEX agree with the former.
#[must_use]
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn whole(format: Format, value: u32, max: u32, min: u32) -> String {
    let negative = format == Format::SDec && (value as i32) < 0;
    let mut digits = match format {
        Format::Hex | Format::IHex => format!("{value:x}"),
        Format::SDec => (value as i32).unsigned_abs().to_string(),
        Format::Dec | Format::Rep | Format::Real | Format::Str => value.to_string(),
    };
    let max = max as usize;
    if max > 0 && digits.len() > max {
        digits = digits.split_off(digits.len() - max);
    }
    let width = min.min(MOST_ZEROS) as usize;
    let sign = match format {
        Format::IHex => "$",
        _ if negative => "-",
        _ => "",
    };
    format!("{sign}{digits:0>width$}")
}

/// A number with a decimal point, as REAL writes it: at most `max` digits before the point (0: all) and at most `decimals` after it.
#[must_use]
pub fn real(value: f32, max: u32, decimals: u32) -> String {
    if !value.is_finite() {
        return if value.is_nan() {
            "nan"
        } else if value > 0.0 {
            "inf"
        } else {
            "-inf"
        }
        .to_owned();
    }
    let places = decimals.min(MOST_ZEROS) as usize;
    let shortest = value.abs().to_string();
    let own = shortest.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let rounded = if own > places { format!("{:.places$}", value.abs()) } else { shortest };
    let (mut before, after) = rounded.split_once('.').unwrap_or((&rounded, ""));
    let max = max as usize;
    if max > 0 && before.len() > max {
        before = &before[before.len() - max..];
    }
    let after = after.trim_end_matches('0');
    let sign = if value < 0.0 { "-" } else { "" };
    match (after, places) {
        (_, 0) => format!("{sign}{before}"),
        ("", _) => format!("{sign}{before}.0"),
        _ => format!("{sign}{before}.{after}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manuals_examples_of_modifiers() {
        assert_eq!(whole(Format::Dec, 1234, 0, 0), "1234");
        assert_eq!(whole(Format::SDec, (-1234i32) as u32, 0, 0), "-1234");
        assert_eq!(whole(Format::Hex, 0x12AB, 0, 0), "12ab");
        assert_eq!(whole(Format::IHex, 0x3456, 0, 0), "$3456");
        assert_eq!(real(2.345, 0, u32::MAX), "2.345");
    }

    #[test]
    fn limits_cut_from_the_left_and_fill_with_zeros() {
        assert_eq!(whole(Format::Dec, 12_345, 2, 0), "45");
        assert_eq!(whole(Format::Hex, 1, 2, 2), "01");
        assert_eq!(whole(Format::SDec, (-7i32) as u32, 0, 3), "-007");
        assert_eq!(whole(Format::Dec, 7, 0, u32::MAX).len(), 64);
    }

    #[test]
    fn decimals_are_rounded_and_there_is_always_one() {
        assert_eq!(real(12.345, 0, 2), "12.35");
        assert_eq!(real(10.0, 0, 2), "10.0");
        assert_eq!(real(-0.5, 0, u32::MAX), "-0.5");
        assert_eq!(real(2.6, 0, 0), "3");
        assert_eq!(real(1234.5, 2, 1), "34.5");
        assert_eq!(real(f32::INFINITY, 0, 2), "inf");
    }
}
