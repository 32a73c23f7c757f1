//! The low-pass filter of an input: a running average of 2^n samples at 10 kHz (MCP manual 1.9.8).
//!
//! The input only changes when somebody changes it, so the average of its samples equals the mean of a step function over
//! the last 2^n / 10000 seconds. That mean is computed from the steps, exactly and without running 10 000 samples a second.

use std::collections::VecDeque;
use std::time::Duration;

/// Samples per second of the firmware's filter (MCP manual 1.9.8).
pub const SAMPLES_PER_S: f64 = 10_000.0;

/// Largest useful exponent; beyond it the window no longer grows.
const MAX_EXPONENT: u8 = 15;

/// Mean of a step function over a sliding window.
#[derive(Clone, Debug, Default)]
pub struct RunningAverage {
    /// Start time and value of each step, oldest first. The first may have begun before the window.
    steps: VecDeque<(Duration, f64)>,
}

impl RunningAverage {
    /// Takes the input as it is from `now` on.
    pub fn push(&mut self, now: Duration, value: f64) {
        if self.steps.back().is_none_or(|(_, last)| *last != value) {
            self.steps.push_back((now, value));
        }
    }

    /// The mean over the 2^`exponent` samples before `now`; with exponent 0 the value itself.
    pub fn mean(&mut self, now: Duration, exponent: u8) -> f64 {
        let window = window(exponent);
        let opening = now.saturating_sub(window);
        while self.steps.get(1).is_some_and(|(start, _)| *start <= opening) {
            self.steps.pop_front();
        }
        let Some(&(_, last)) = self.steps.back() else {
            return 0.0;
        };
        if window.is_zero() || self.steps.len() == 1 {
            return last;
        }
        let mut end = now;
        let mut area = 0.0;
        for &(start, value) in self.steps.iter().rev() {
            let start = start.max(opening);
            area += value * end.saturating_sub(start).as_secs_f64();
            end = start;
        }
        // Before the first step the input is taken to have been the same.
        let first = self.steps.front().map_or(last, |(_, value)| *value);
        area += first * end.saturating_sub(opening).as_secs_f64();
        let span = now.saturating_sub(opening).as_secs_f64();
        if span > 0.0 { area / span } else { last }
    }

    /// Forgets the past, as after a power cycle.
    pub fn clear(&mut self) {
        self.steps.clear();
    }
}

fn window(exponent: u8) -> Duration {
    match exponent.min(MAX_EXPONENT) {
        0 => Duration::ZERO,
        n => Duration::from_secs_f64(f64::from(1_u32 << n) / SAMPLES_PER_S),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn without_a_filter_the_value_passes_at_once() {
        let mut average = RunningAverage::default();
        average.push(ms(0), 100.0);
        average.push(ms(5), 900.0);
        assert_eq!(average.mean(ms(5), 0), 900.0);
    }

    #[test]
    fn a_step_climbs_linearly_over_the_window() {
        let mut average = RunningAverage::default();
        average.push(ms(0), 0.0);
        average.push(ms(1000), 1000.0);
        // 2^8 samples at 10 kHz are 25.6 ms.
        assert_eq!(average.mean(ms(1000), 8), 0.0);
        assert!((average.mean(Duration::from_micros(1_012_800), 8) - 500.0).abs() < 1e-9);
        assert!((average.mean(Duration::from_micros(1_025_600), 8) - 1000.0).abs() < 1e-9);
        assert_eq!(average.mean(ms(5000), 8), 1000.0);
    }

    #[test]
    fn it_equals_the_average_of_the_samples_it_stands_for() {
        let mut average = RunningAverage::default();
        let input = |sample: u64| ((sample / 37) * 1103 % 4096) as f64; // a new level every 3.7 ms
        let mut samples = Vec::new();
        for sample in 0..2000_u64 {
            samples.push(input(sample));
            average.push(Duration::from_micros(sample * 100), input(sample));
        }
        let expected: f64 = samples[2000 - 256..].iter().sum::<f64>() / 256.0;
        let got = average.mean(Duration::from_micros(200_000), 8);
        assert!((got - expected).abs() < 1e-6, "{got} against {expected}");
    }

    #[test]
    fn the_memory_does_not_grow_beyond_the_window() {
        let mut average = RunningAverage::default();
        for step in 0..10_000_u64 {
            average.push(ms(step), step as f64);
            average.mean(ms(step), 6);
        }
        assert!(average.steps.len() <= 9, "{}", average.steps.len()); // 6.4 ms hold eight steps
    }
}
