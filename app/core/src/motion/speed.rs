//! Speed from encoder counts: the slope of a straight line through timed readings.
//!
//! A line through many readings resolves far better than the controller's own speed figures, which count whole counts in
//! a short window. Times are in seconds on any clock.

/// One reading of an encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    pub at_s: f64,
    pub counts: f64,
    /// Half the time between its request and its reply.
    pub half_s: f64,
}

/// A line through readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    pub counts_per_s: f64,
    /// Standard error of the slope by the noise of single readings.
    pub error_counts_per_s: f64,
}

/// A speed that was held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldSpeed {
    pub counts_per_s: f64,
    /// Greatest difference between parts of the record, as a share of the speed.
    pub spread: f64,
}

/// Time over which one speed is taken.
pub const PART_S: f64 = 0.2;
/// The same when settling is judged: longer for noisy encoders.
const PARTS_S: [f64; 3] = [PART_S, 0.4, 0.8];
/// Parts that have to agree.
const PARTS: usize = 3;
/// How well they have to agree where noise allows it, as a share of the speed.
const AGREEMENT: f64 = 0.002;
/// Standard errors within which two speeds are the same.
const SAME_ERRORS: f64 = 3.0;

/// The line of least squares; none through fewer than three readings or at one moment.
pub fn slope(readings: &[Reading]) -> Option<Slope> {
    let count = readings.len() as f64;
    if readings.len() < 3 {
        return None;
    }
    let mean = |value: fn(&Reading) -> f64| readings.iter().map(value).sum::<f64>() / count;
    let (mean_s, mean_counts) = (mean(|reading| reading.at_s), mean(|reading| reading.counts));
    let about = |reading: &Reading| (reading.at_s - mean_s, reading.counts - mean_counts);
    let spread: f64 = readings.iter().map(|reading| about(reading).0.powi(2)).sum();
    let common: f64 = readings.iter().map(about).map(|(time, counts)| time * counts).sum();
    if spread <= 0.0 {
        return None;
    }
    let counts_per_s = common / spread;
    // From one reading to the next, so that a speed that changes slowly does not count as noise.
    let off_line = |reading: &Reading| about(reading).1 - counts_per_s * about(reading).0;
    let jumps = readings.windows(2).map(|pair| (off_line(&pair[1]) - off_line(&pair[0])).powi(2));
    let variance = jumps.sum::<f64>() / (2.0 * (count - 1.0));
    let error_counts_per_s = (variance / spread).sqrt();
    Some(Slope { counts_per_s, error_counts_per_s })
}

/// Whether the last three parts of the record show the same speed, and not a stand. The parts are as long as their noise
/// asks for, so a record can be too short to tell.
pub fn has_settled(readings: &[Reading]) -> bool {
    let Some((_, slopes)) = telling_parts(readings) else { return false };
    let (mean, noise) = (mean_of(&slopes), noise_of(&slopes));
    range(&slopes) <= (AGREEMENT * mean.abs()).max(noise) && mean.abs() > noise
}

/// The speed of the last three parts of the record together.
pub fn held_speed(readings: &[Reading]) -> Option<HeldSpeed> {
    let (part_s, slopes) = telling_parts(readings)?;
    let counts_per_s = slope(since(readings, PARTS as f64 * part_s))?.counts_per_s;
    let spread = range(&slopes) / counts_per_s.abs();
    spread.is_finite().then_some(HeldSpeed { counts_per_s, spread })
}

/// The speed of the last part of the record.
pub fn present_speed(readings: &[Reading]) -> Option<Slope> {
    slope(since(readings, PART_S))
}

/// The lines through the last parts of a record, and how long the parts are: the shortest whose noise does not hide the
/// agreement that is asked for, or else the longest.
fn telling_parts(readings: &[Reading]) -> Option<(f64, [Slope; PARTS])> {
    for part_s in PARTS_S {
        let slopes = last_parts(readings, part_s)?;
        let hides_nothing = noise_of(&slopes) <= AGREEMENT * mean_of(&slopes).abs();
        if hides_nothing || part_s == PARTS_S[PARTS_S.len() - 1] {
            return Some((part_s, slopes));
        }
    }
    None
}

/// None while the record is too short.
fn last_parts(readings: &[Reading], part_s: f64) -> Option<[Slope; PARTS]> {
    let end_s = readings.last()?.at_s;
    if end_s - readings.first()?.at_s < PARTS as f64 * part_s {
        return None;
    }
    let part = |index: usize| {
        let from_s = end_s - part_s * (PARTS - index) as f64;
        let start = readings.partition_point(|reading| reading.at_s < from_s);
        let end = readings.partition_point(|reading| reading.at_s <= from_s + part_s);
        slope(&readings[start..end])
    };
    (0..PARTS).map_while(part).collect::<Vec<_>>().try_into().ok()
}

/// The readings of the last `seconds`.
fn since(readings: &[Reading], seconds: f64) -> &[Reading] {
    let from_s = readings.last().map_or(0.0, |last| last.at_s - seconds);
    let start = readings.iter().position(|reading| reading.at_s >= from_s).unwrap_or(0);
    &readings[start..]
}

fn mean_of(slopes: &[Slope; PARTS]) -> f64 {
    slopes.iter().map(|slope| slope.counts_per_s).sum::<f64>() / PARTS as f64
}

/// Below this two speeds are the same.
fn noise_of(slopes: &[Slope; PARTS]) -> f64 {
    slopes.iter().map(|slope| slope.error_counts_per_s).fold(0.0, f64::max) * SAME_ERRORS
}

fn range(slopes: &[Slope; PARTS]) -> f64 {
    let speeds = slopes.map(|slope| slope.counts_per_s);
    let greatest = speeds.into_iter().fold(f64::NEG_INFINITY, f64::max);
    greatest - speeds.into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole counts, read each 5 ms.
    fn record(seconds: f64, counts: impl Fn(f64) -> f64) -> Vec<Reading> {
        let times = (0..=(seconds * 200.0) as usize).map(|index| index as f64 / 200.0);
        times.map(|at_s| Reading { at_s, counts: counts(at_s).floor(), half_s: 0.0 }).collect()
    }

    /// Counts of a motor that goes up to `speed` with a time constant.
    fn lag(speed: f64, tau_s: f64) -> impl Fn(f64) -> f64 {
        move |at_s| speed * (at_s - tau_s * (1.0 - (-at_s / tau_s).exp()))
    }

    #[test]
    fn whole_counts_of_a_slow_encoder_give_a_tenth_of_a_percent() {
        for speed in [170.0, -4321.0, 250_000.0] {
            let held = held_speed(&record(2.5, |at_s| speed * at_s)).unwrap();
            assert!((held.counts_per_s / speed - 1.0).abs() < 0.003, "{speed}: {held:?}");
            assert!(held.spread < 0.02, "{held:?}");
        }
    }

    #[test]
    fn a_heavy_motor_has_settled_only_within_two_percent_of_its_top_speed() {
        for (tau_s, speed) in [(0.03, 50_000.0), (0.3, 50_000.0), (1.5, 51_165.0), (3.0, 90_000.0)] {
            let of = lag(speed, tau_s);
            let seconds = (1..400).map(|step| f64::from(step) * 0.05);
            let settled_s = seconds.into_iter().find(|end| has_settled(&record(*end, &of))).unwrap();
            let held = held_speed(&record(settled_s, &of)).unwrap();
            assert!((held.counts_per_s / speed - 1.0).abs() < 0.016, "{tau_s} s: {held:?} at {settled_s} s");
        }
    }

    #[test]
    fn a_motor_that_stands_has_not_settled() {
        assert!(!has_settled(&record(2.0, |_| 17.0)));
        assert!(!has_settled(&record(0.3, |at_s| 9000.0 * at_s)), "too short to tell");
    }

    #[test]
    fn noise_of_a_potentiometer_does_not_keep_a_speed_from_settling() {
        // A fixed pattern of half a count to two counts.
        let noise = |at_s: f64| ((at_s * 977.0).sin() + (at_s * 3331.0).cos()) * 0.8;
        let readings = record(2.5, |at_s| 290.0 * at_s + noise(at_s));
        assert!(has_settled(&readings));
        let held = held_speed(&readings).unwrap();
        assert!((held.counts_per_s / 290.0 - 1.0).abs() < 0.01, "{held:?}");
    }

    #[test]
    fn one_moment_has_no_speed() {
        let here = Reading { at_s: 1.0, counts: 5.0, half_s: 0.0 };
        assert_eq!(slope(&[here; 9]), None);
        assert_eq!(slope(&[]), None);
    }
}
