//! What was sampled since the link was opened: one row per sample, one [`Series`] per channel.
//!
//! Rows carry one time, and each value its own where it was read earlier than that. A sample may leave channels out ([`super::series::NOT_READ`]); lost data is a row of
//! [`GAP`]. The history keeps the newest rows, up to its capacity, and knows nothing of pixels.

use std::ops::Range;

use super::moments::Moments;
use super::series::{Extrema, GAP, LONGEST_BLOCK, MOST_BEHIND_S, Ring, Series, is_gap};

/// Rows kept by default: more than one hour at 100 Hz.
pub const DEFAULT_ROWS: u64 = 360_000_u64.next_multiple_of(LONGEST_BLOCK);

/// The samples of one link, oldest first.
#[derive(Clone, Debug)]
pub struct History {
    times_s: Ring<f64>,
    channels: Vec<Series>,
    capacity: u64,
    next_row: u64,
}

impl History {
    /// An empty history of `channels` channels that keeps at least `rows` rows.
    pub fn new(channels: usize, rows: u64) -> Self {
        let capacity = rows.max(1).next_multiple_of(LONGEST_BLOCK);
        let channels = (0..channels).map(|_| Series::new(capacity)).collect();
        Self { times_s: Ring::new(capacity), channels, capacity, next_row: 0 }
    }

    /// Keeps the channels of these places in this order; in a place of `None` there is a channel that was never read.
    pub fn take_channels(&mut self, places: &[Option<usize>]) {
        let series = |place: &Option<usize>| {
            place.map_or_else(|| Series::new(self.capacity), |place| self.channels[place].clone())
        };
        self.channels = places.iter().map(series).collect();
    }

    /// Adds one sample, all of it read at once.
    pub fn push(&mut self, time_s: f64, values: &[f64]) {
        self.push_read(time_s, values, |_| time_s);
    }

    /// Adds one sample, complete at `time_s`; `read_s` tells when each channel was read. Times never run back: an
    /// earlier one is taken as the newest so far.
    pub fn push_read(&mut self, time_s: f64, values: &[f64], read_s: impl Fn(usize) -> f64) {
        debug_assert_eq!(values.len(), self.channels.len());
        let time_s = self.last_time_s().map_or(time_s, |last| time_s.max(last));
        self.times_s.set(self.next_row, time_s);
        for (index, (series, value)) in self.channels.iter_mut().zip(values).enumerate() {
            series.push(self.next_row, *value, time_s, time_s - read_s(index));
        }
        self.next_row += 1;
    }

    /// Adds a row that says data was lost here.
    pub fn push_gap(&mut self, time_s: f64) {
        let lost = vec![GAP; self.channels.len()];
        self.push(time_s, &lost);
    }

    /// The rows still kept.
    pub fn rows(&self) -> Range<u64> {
        self.next_row.saturating_sub(self.capacity)..self.next_row
    }

    pub fn is_empty(&self) -> bool {
        self.next_row == 0
    }

    pub fn channel(&self, index: usize) -> &Series {
        &self.channels[index]
    }

    /// The time of a row still kept.
    pub fn time_s(&self, row: u64) -> f64 {
        self.times_s.get(row)
    }

    /// When the value of a row still kept was read.
    pub fn read_s(&self, channel: usize, row: u64) -> f64 {
        self.time_s(row) - self.channels[channel].behind_s(row)
    }

    /// A channel's reading of a row still kept, with its own time; none where there is no number.
    pub fn reading(&self, channel: usize, row: u64) -> Option<(f64, f64)> {
        let value = self.channels[channel].value(row);
        (!value.is_nan()).then(|| (self.read_s(channel, row), value))
    }

    pub fn first_time_s(&self) -> Option<f64> {
        (!self.is_empty()).then(|| self.time_s(self.rows().start))
    }

    /// Extrema and moments of the readings of a channel from `from_s` to `to_s`, both included, by their own times.
    pub fn summary(&self, channel: usize, from_s: f64, to_s: f64) -> (Extrema, Moments) {
        let (mut extrema, mut moments) = (Extrema::NONE, Moments::default());
        let series = &self.channels[channel];
        // Rows outside cannot belong to the stretch, rows inside cannot fall out of it; the rest is looked at.
        let outer = self.row_at(from_s)..self.row_at((to_s + MOST_BEHIND_S).next_up());
        let inner = self.row_at(from_s + MOST_BEHIND_S)..self.row_at(to_s.next_up());
        let inner = if inner.start < inner.end { inner } else { outer.start..outer.start };
        let (head, tail) = series.merge_moments(inner.clone(), &mut moments);
        for row in head.chain(tail) {
            if let Some((time_s, value)) = self.reading(channel, row) {
                moments.add(time_s, value);
            }
        }
        if !inner.is_empty() {
            extrema = series.extrema(inner.clone());
        }
        for row in (outer.start..inner.start).chain(inner.end..outer.end) {
            if let Some((time_s, value)) = self.reading(channel, row)
                && (from_s..=to_s).contains(&time_s)
            {
                extrema.add(value);
                moments.add(time_s, value);
            }
        }
        (extrema, moments)
    }

    /// The newest reading of a channel at or before `time_s`; none if data was lost since, or if it is older than
    /// [`LONGEST_BLOCK`] rows.
    pub fn value_at(&self, channel: usize, time_s: f64) -> Option<f64> {
        let end = self.row_at((time_s + MOST_BEHIND_S).next_up());
        let start = self.row_at(time_s.next_up()).saturating_sub(LONGEST_BLOCK).max(self.rows().start);
        let series = &self.channels[channel];
        for row in (start..end).rev() {
            if self.read_s(channel, row) > time_s {
                continue;
            }
            let value = series.value(row);
            if !value.is_nan() {
                return Some(value);
            }
            if is_gap(value) {
                return None;
            }
        }
        None
    }

    pub fn last_time_s(&self) -> Option<f64> {
        self.next_row.checked_sub(1).map(|row| self.time_s(row))
    }

    /// The first row kept at or after `time_s`; the end of [`History::rows`] if there is none.
    pub fn row_at(&self, time_s: f64) -> u64 {
        self.row_within(time_s, self.rows())
    }

    /// As [`History::row_at`], for a time that is not before the row `from`; quick when the row is near `from + ahead`.
    pub fn row_from(&self, time_s: f64, from: u64, ahead: u64) -> u64 {
        let end = self.rows().end;
        let is_before = |row: u64| row < end && self.time_s(row) < time_s;
        let guess = (from + ahead).min(end);
        let mut step = 1;
        if is_before(guess) {
            let mut low = guess;
            while is_before(low + step) {
                low += step;
                step *= 2;
            }
            return self.row_within(time_s, low + 1..(low + step).min(end));
        }
        let mut high = guess;
        while high > from && !is_before(high.saturating_sub(step).max(from)) {
            high = high.saturating_sub(step).max(from);
            step *= 2;
        }
        self.row_within(time_s, high.saturating_sub(step).max(from)..high)
    }

    /// The first of `rows` at or after `time_s`; their end if there is none.
    fn row_within(&self, time_s: f64, mut rows: Range<u64>) -> u64 {
        while rows.start < rows.end {
            let middle = rows.start + (rows.end - rows.start) / 2;
            if self.time_s(middle) < time_s { rows.start = middle + 1 } else { rows.end = middle }
        }
        rows.start
    }

    /// Memory held, in bytes.
    pub fn bytes(&self) -> usize {
        self.times_s.bytes() + self.channels.iter().map(Series::bytes).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::series::NOT_READ;
    use super::*;

    #[test]
    fn an_hour_of_sixteen_channels_at_100_hz_fits_in_100_megabytes() {
        let mut history = History::new(16, DEFAULT_ROWS);
        for row in 0..400_000u32 {
            let time_s = f64::from(row) * 0.01;
            history.push(time_s, &[time_s; 16]);
        }
        let rows = history.rows();
        assert!(history.time_s(rows.end - 1) - history.time_s(rows.start) >= 3599.9);
        assert!(history.bytes() < 100_000_000, "{} bytes", history.bytes());
    }

    #[test]
    fn a_new_history_holds_almost_nothing() {
        let mut history = History::new(24, DEFAULT_ROWS);
        history.push(0.0, &[0.0; 24]);
        assert!(history.bytes() < 3_000_000, "{} bytes", history.bytes());
    }

    #[test]
    fn rows_are_found_by_time_after_the_ring_has_gone_round() {
        let mut history = History::new(1, LONGEST_BLOCK);
        for row in 0..10_000u32 {
            history.push(f64::from(row), &[0.0]);
        }
        assert_eq!(history.rows(), 10_000 - LONGEST_BLOCK..10_000);
        assert_eq!(history.row_at(0.0), 10_000 - LONGEST_BLOCK);
        assert_eq!(history.row_at(9_000.5), 9_001);
        assert_eq!(history.row_at(9_001.0), 9_001);
        assert_eq!(history.row_at(1e9), 10_000);
    }

    #[test]
    fn rows_are_found_from_another_row_wherever_they_are_guessed_to_be() {
        let mut history = History::new(1, LONGEST_BLOCK);
        let mut time_s = 0.0;
        for row in 0..6000u32 {
            time_s += if row % 97 == 0 { 40.0 } else { f64::from(row % 3) };
            history.push(time_s, &[0.0]);
        }
        let rows = history.rows();
        for from in [rows.start, rows.start + 1, rows.start + 1000, rows.end - 1, rows.end] {
            let from_s = if from < rows.end { history.time_s(from) } else { time_s };
            for later_s in [0.0, 0.5, 1.0, 3.0, 41.0, 777.7, 2000.0, 1e6] {
                let wanted = history.row_at(from_s + later_s).max(from);
                for ahead in [0, 1, 7, 300, 100_000] {
                    assert_eq!(
                        history.row_from(from_s + later_s, from, ahead),
                        wanted,
                        "{from} {later_s} {ahead}"
                    );
                }
            }
        }
    }

    #[test]
    fn time_never_runs_back() {
        let mut history = History::new(1, 1);
        history.push(5.0, &[1.0]);
        history.push(4.0, &[2.0]);
        assert_eq!(history.last_time_s(), Some(5.0));
    }

    /// Sweeps of three channels, read one after the other, with readings left out and lost.
    fn sweeps(readings: &[(f64, f64)]) -> (History, Vec<Vec<(f64, f64)>>) {
        let mut history = History::new(3, 2 * LONGEST_BLOCK);
        let mut kept = vec![Vec::new(); 3];
        let mut row_s = 0.0;
        for (step, value) in readings {
            row_s += step;
            let values = [*value, -value, value * 0.5];
            let read = [row_s - 0.0004 * value.abs().fract(), row_s - 0.3, row_s - 0.002];
            history.push_read(row_s, &values, |channel| read[channel]);
            let row = history.rows().end - 1;
            for channel in 0..3 {
                if let Some(reading) = history.reading(channel, row) {
                    assert!((reading.0 - read[channel]).abs() <= 11e-6, "{reading:?} {read:?}");
                    kept[channel].push(reading);
                }
            }
        }
        (history, kept)
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED), failure_persistence: None, ..ProptestConfig::with_cases(24) })]
        #[test]
        fn the_summary_of_any_stretch_equals_a_plain_walk_by_each_readings_own_time(
            readings in prop::collection::vec((0.001..0.05f64, prop_oneof![9 => -1e3..1e3f64, 1 => Just(NOT_READ)]), 1..3000),
            cuts in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 8),
        ) {
            let (history, kept) = sweeps(&readings);
            let end_s = history.last_time_s().unwrap();
            for (a, b) in cuts {
                let (from_s, to_s) = (a.min(b) * end_s, a.max(b) * end_s);
                for (channel, kept) in kept.iter().enumerate() {
                    let within: Vec<_> = kept.iter().filter(|(at, _)| (from_s..=to_s).contains(at)).collect();
                    let (extrema, moments) = history.summary(channel, from_s, to_s);
                    prop_assert_eq!(moments.count(), within.len() as u64);
                    if within.is_empty() {
                        prop_assert!(extrema.is_empty());
                        continue;
                    }
                    let least = within.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
                    let mean = within.iter().map(|(_, value)| value).sum::<f64>() / within.len() as f64;
                    prop_assert_eq!(extrema.min, least);
                    prop_assert!((moments.mean().unwrap() - mean).abs() < 1e-8);
                }
                let before = kept[1].iter().rev().find(|(at, _)| *at <= to_s);
                prop_assert_eq!(history.value_at(1, to_s), before.map(|(_, value)| *value));
            }
        }
    }

    #[test]
    fn no_value_is_told_across_lost_data() {
        let mut history = History::new(1, 100);
        history.push(1.0, &[5.0]);
        history.push_gap(2.0);
        assert_eq!(history.value_at(0, 1.5), Some(5.0));
        assert_eq!(history.value_at(0, 2.5), None);
        assert_eq!(history.value_at(0, 0.5), None);
    }
}
