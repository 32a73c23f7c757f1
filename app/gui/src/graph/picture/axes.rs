//! The time axis: how long a division is, and what is written at it.

/// Lengths a division can have.
const DIVISIONS_S: [f64; 27] = [
    0.0001, 0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0,
    60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 7200.0, 18_000.0, 36_000.0, 86_400.0,
];

/// Room for a figure of the axis.
const LABEL_WIDTH: f32 = 62.0;

/// Divisions narrower than this are not drawn.
const LEAST_DIVISION: f32 = 9.0;

/// What times are counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zero {
    /// The newest sample, at the right edge.
    Now,
    Trigger,
    /// The first sample.
    Began,
}

/// Seconds per division: one where that can be drawn, as in Ion Studio; else about ten divisions.
pub fn division_s(span_s: f64, width: f32) -> f64 {
    let fits = |division: f64| f64::from(width) * division / span_s;
    if (4.0..=60.0).contains(&span_s) && fits(1.0) >= f64::from(LEAST_DIVISION) {
        return 1.0;
    }
    let about = span_s / 12.0;
    DIVISIONS_S.into_iter().find(|division| *division >= about).unwrap_or(172_800.0)
}

/// How many divisions lie between two figures.
pub fn label_every(division_s: f64, span_s: f64, width: f32) -> i64 {
    let room = (f64::from(width) * division_s / span_s).max(1e-6);
    let every = (f64::from(LABEL_WIDTH) / room).ceil() as i64;
    [1, 2, 5, 10, 20, 30, 60].into_iter().find(|step| *step >= every).unwrap_or(every.max(1))
}

/// A time of the axis, counted from its zero.
pub fn label(time_s: f64, division_s: f64, zero: Zero) -> String {
    if time_s.abs() < division_s * 1e-6 {
        return match zero {
            Zero::Now => "now".to_owned(),
            Zero::Trigger => "T".to_owned(),
            Zero::Began => "0 s".to_owned(),
        };
    }
    let sign = match (time_s < 0.0, zero) {
        (true, _) => "−",
        (false, Zero::Trigger) => "+",
        (false, _) => "",
    };
    format!("{sign}{}", duration_text(time_s.abs(), division_s))
}

/// A length of time with the digits that steps of `step_s` need.
pub fn duration_text(seconds: f64, step_s: f64) -> String {
    let decimals = (-step_s.log10()).ceil().clamp(0.0, 6.0) as usize;
    if seconds < 120.0 - step_s * 0.5 && step_s < 30.0 {
        return format!("{seconds:.decimals$} s");
    }
    let scale = 10f64.powi(decimals as i32);
    let rounded = (seconds * scale).round() / scale;
    let (hours, minutes) = ((rounded / 3600.0).floor(), (rounded / 60.0).floor());
    let rest = rounded - minutes * 60.0;
    let width = if decimals == 0 { 2 } else { decimals + 3 };
    if hours >= 1.0 {
        return format!("{hours:.0}:{:02.0}:{rest:0width$.decimals$}", minutes - hours * 60.0);
    }
    format!("{minutes:.0}:{rest:0width$.decimals$}")
}

/// A span in the words of a person: 20 ms, 10 s, 5 min.
pub fn span_text(span_s: f64) -> String {
    let round = |value: f64| {
        let text = format!("{value:.2}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    match span_s {
        s if s < 1.0 => format!("{} ms", round(s * 1000.0)),
        s if s < 60.0 => format!("{} s", round(s)),
        s if s < 3600.0 => format!("{} min", round(s / 60.0)),
        s => format!("{} h", round(s / 3600.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::sheet::SPANS_S;
    use super::*;

    #[test]
    fn divisions_are_one_second_where_that_can_be_seen() {
        assert_eq!(division_s(10.0, 600.0), 1.0);
        assert_eq!(division_s(30.0, 600.0), 1.0);
        assert_eq!(division_s(3600.0, 600.0), 300.0);
        assert_eq!(division_s(0.05, 600.0), 0.005);
    }

    #[test]
    fn there_are_never_more_labels_than_can_be_read_and_never_none() {
        for width in [300.0, 600.0, 1500.0f32] {
            for span_s in SPANS_S {
                let division = division_s(span_s, width);
                let every = label_every(division, span_s, width);
                let labels = span_s / division / every as f64;
                assert!(labels <= f64::from(width / LABEL_WIDTH) + 1.0, "{labels} labels for {span_s} s");
                assert!(labels >= 1.0, "{labels} labels for {span_s} s on {width}");
            }
        }
    }

    #[test]
    fn times_are_written_with_the_digits_they_need() {
        assert_eq!(label(-5.0, 1.0, Zero::Now), "−5 s");
        assert_eq!(label(0.0, 1.0, Zero::Now), "now");
        assert_eq!(label(0.25, 0.05, Zero::Trigger), "+0.25 s");
        assert_eq!(label(3725.0, 60.0, Zero::Began), "1:02:05");
        assert_eq!(label(754.5, 0.5, Zero::Began), "12:34.5");
        assert_eq!(label(59.9996, 0.001, Zero::Began), "60.000 s");
        assert_eq!(duration_text(119.9996, 0.5), "2:00.0");
        assert_eq!([0.02, 10.0, 90.0, 3600.0].map(span_text), ["20 ms", "10 s", "1.5 min", "1 h"]);
    }
}
