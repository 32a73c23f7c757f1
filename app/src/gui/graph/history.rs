//! What was sampled since the link was opened: one row per sample, one [`Series`] per channel.
//!
//! Rows carry one time for all channels. A sample may leave channels out ([`super::series::NOT_READ`]); lost data is a row of
//! [`GAP`]. The history keeps the newest rows, up to its capacity, and knows nothing of pixels.

use std::ops::Range;

use super::series::{GAP, LONGEST_BLOCK, Ring, Series};

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

    /// Adds one sample. Times never run back: an earlier one is taken as the newest so far.
    pub fn push(&mut self, time_s: f64, values: &[f64]) {
        debug_assert_eq!(values.len(), self.channels.len());
        let time_s = self.last_time_s().map_or(time_s, |last| time_s.max(last));
        self.times_s.set(self.next_row, time_s);
        for (series, value) in self.channels.iter_mut().zip(values) {
            series.push(self.next_row, *value);
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

    pub fn last_time_s(&self) -> Option<f64> {
        self.next_row.checked_sub(1).map(|row| self.time_s(row))
    }

    /// The first row kept at or after `time_s`; the end of [`History::rows`] if there is none.
    pub fn row_at(&self, time_s: f64) -> u64 {
        let mut rows = self.rows();
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
    fn time_never_runs_back() {
        let mut history = History::new(1, 1);
        history.push(5.0, &[1.0]);
        history.push(4.0, &[2.0]);
        assert_eq!(history.last_time_s(), Some(5.0));
    }
}
