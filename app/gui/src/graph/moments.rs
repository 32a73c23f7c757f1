//! Count, means and second moments of a stretch of readings, mergeable: mean, standard deviation and slope of any
//! stretch follow from a few blocks of these.
//!
//! Means and centred sums are kept rather than plain sums, so that times far from zero and nearly constant values
//! lose no digits (the parallel form of Welford's method).

/// What is known of a set of readings, each a time and a value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: f64,
    mean_time_s: f64,
    mean: f64,
    /// Sums of squared and mixed deviations from the means.
    times: f64,
    values: f64,
    mixed: f64,
}

impl Moments {
    /// Counts one reading more.
    pub fn add(&mut self, time_s: f64, value: f64) {
        self.count += 1.0;
        let (ahead_s, above) = (time_s - self.mean_time_s, value - self.mean);
        self.mean_time_s += ahead_s / self.count;
        self.mean += above / self.count;
        self.times += ahead_s * (time_s - self.mean_time_s);
        self.values += above * (value - self.mean);
        self.mixed += ahead_s * (value - self.mean);
    }

    /// Counts the readings of `other` too.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0.0 {
            return;
        }
        let count = self.count + other.count;
        let (ahead_s, above) = (other.mean_time_s - self.mean_time_s, other.mean - self.mean);
        let weight = self.count * other.count / count;
        self.times += other.times + ahead_s * ahead_s * weight;
        self.values += other.values + above * above * weight;
        self.mixed += other.mixed + ahead_s * above * weight;
        self.mean_time_s += ahead_s * other.count / count;
        self.mean += above * other.count / count;
        self.count = count;
    }

    pub fn count(&self) -> u64 {
        self.count as u64
    }

    pub fn mean(&self) -> Option<f64> {
        (self.count > 0.0).then_some(self.mean)
    }

    /// Standard deviation of these very readings (divided by their count).
    pub fn deviation(&self) -> Option<f64> {
        (self.count > 0.0).then(|| (self.values / self.count).max(0.0).sqrt())
    }

    /// Slope of the straight line that fits best, per second. There is none through fewer than two moments.
    pub fn slope_per_s(&self) -> Option<f64> {
        (self.count > 1.0 && self.times > 0.0).then(|| self.mixed / self.times)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn of(readings: &[(f64, f64)]) -> Moments {
        let mut moments = Moments::default();
        readings.iter().for_each(|(time_s, value)| moments.add(*time_s, *value));
        moments
    }

    /// From the definitions, in two passes.
    fn naive(readings: &[(f64, f64)]) -> (f64, f64, f64) {
        let count = readings.len() as f64;
        let mean = readings.iter().map(|(_, value)| value).sum::<f64>() / count;
        let mean_time_s = readings.iter().map(|(time_s, _)| time_s).sum::<f64>() / count;
        let squares = readings.iter().map(|(_, value)| (value - mean).powi(2)).sum::<f64>();
        let times = readings.iter().map(|(time_s, _)| (time_s - mean_time_s).powi(2)).sum::<f64>();
        let mixed =
            readings.iter().map(|(time_s, value)| (time_s - mean_time_s) * (value - mean)).sum::<f64>();
        (mean, (squares / count).sqrt(), mixed / times)
    }

    fn near(a: f64, b: f64, size: f64) -> bool {
        (a - b).abs() <= 1e-7 * size.max(1.0)
    }

    proptest! {
        #![proptest_config(proptest::test_runner::Config {
            rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED),
            failure_persistence: None,
            ..proptest::test_runner::Config::default()
        })]

        #[test]
        fn merged_parts_tell_what_a_plain_walk_tells(
            steps in prop::collection::vec((0.001..0.5f64, -1e6..1e6f64), 2..300),
            cut in 0.0..1.0f64,
            start_s in 0.0..1e5f64,
        ) {
            let mut time_s = start_s;
            let readings: Vec<_> = steps.iter().map(|(step, value)| { time_s += step; (time_s, *value) }).collect();
            let (left, right) = readings.split_at((cut * readings.len() as f64) as usize);
            let mut moments = of(left);
            moments.merge(&of(right));
            let (mean, deviation, slope) = naive(&readings);
            prop_assert_eq!(moments.count(), readings.len() as u64);
            prop_assert!(near(moments.mean().unwrap(), mean, 1e6));
            prop_assert!(near(moments.deviation().unwrap(), deviation, 1e6));
            prop_assert!(near(moments.slope_per_s().unwrap(), slope, 1e9), "{:?} {slope}", moments.slope_per_s());
        }
    }

    #[test]
    fn nothing_has_no_mean_and_one_reading_no_slope() {
        assert_eq!(Moments::default().mean(), None);
        let one = of(&[(3.0, 5.0)]);
        assert_eq!((one.mean(), one.deviation(), one.slope_per_s()), (Some(5.0), Some(0.0), None));
    }
}
