//! Link statistics: rates over the last seconds, round trips in a histogram of fixed size, counts since the link was opened.

use serde::Serialize;
use std::time::Duration;

/// Bits that one byte takes on a serial wire: start, eight data, stop.
pub const BITS_PER_BYTE: u64 = 10;

/// Rates and round trips look back between one and two of these.
const WINDOW: Duration = Duration::from_secs(2);

/// A link's figures at one moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LinkStatistics {
    /// Traffic of both directions, kbit/s at ten bits per byte.
    pub kbit_per_s: f64,
    /// Requests that got their reply, per second.
    pub transactions_per_s: f64,
    /// Median time from request to complete reply, s.
    pub round_trip_median_s: f64,
    /// 99th percentile of the same, s.
    pub round_trip_p99_s: f64,
    /// Bytes written since the link was opened.
    pub bytes_out: u64,
    /// Bytes read since the link was opened.
    pub bytes_in: u64,
    /// Requests that got their reply, since the link was opened.
    pub transactions: u64,
    /// Requests sent again.
    pub retries: u64,
    /// Requests to which no complete reply came in time.
    pub timeouts: u64,
    /// Replies whose CRC or acknowledgement was wrong.
    pub crc_errors: u64,
    /// Bytes that answered nothing: late replies and noise.
    pub stray_bytes: u64,
    /// Those of them that came while the reply to a request that was given up could still come.
    #[serde(skip)]
    pub late_bytes: u64,
    /// Samples thrown away because nobody took them.
    pub dropped_samples: u64,
}

/// Counts what an exchange does and turns it into [`LinkStatistics`].
#[derive(Debug, Default)]
pub struct Counters {
    /// Totals; the rates in it are filled in by [`Counters::at`].
    pub totals: LinkStatistics,
    current: Window,
    last: Window,
}

#[derive(Debug, Default)]
struct Window {
    started_at: Duration,
    lasted: Duration,
    bytes: u64,
    transactions: u64,
    round_trips: Histogram,
}

impl Counters {
    /// Counters of a link opened at `now`.
    #[must_use]
    pub fn new(now: Duration) -> Self {
        Self { current: Window { started_at: now, ..Window::default() }, ..Self::default() }
    }

    /// Bytes were written.
    pub fn wrote(&mut self, bytes: usize) {
        self.totals.bytes_out += bytes as u64;
        self.current.bytes += bytes as u64;
    }

    /// Bytes were read.
    pub fn read(&mut self, bytes: usize) {
        self.totals.bytes_in += bytes as u64;
        self.current.bytes += bytes as u64;
    }

    /// A request got its reply.
    pub fn replied(&mut self, requested_at: Duration, now: Duration) {
        self.turn(now);
        self.totals.transactions += 1;
        self.current.transactions += 1;
        self.current.round_trips.add(now.saturating_sub(requested_at));
    }

    /// The figures as they stand at `now`.
    #[must_use]
    pub fn at(&mut self, now: Duration) -> LinkStatistics {
        self.turn(now);
        let running = now.saturating_sub(self.current.started_at);
        let span_s = (self.last.lasted + running).as_secs_f64();
        let per_s = |count: u64| if span_s > 0.0 { count as f64 / span_s } else { 0.0 };
        let mut round_trips = self.last.round_trips.clone();
        round_trips.merge(&self.current.round_trips);
        LinkStatistics {
            kbit_per_s: per_s((self.last.bytes + self.current.bytes) * BITS_PER_BYTE) / 1000.0,
            transactions_per_s: per_s(self.last.transactions + self.current.transactions),
            round_trip_median_s: round_trips.quantile_s(0.5),
            round_trip_p99_s: round_trips.quantile_s(0.99),
            ..self.totals.clone()
        }
    }

    /// Begins a new window when the present one is full; a long silence empties both.
    fn turn(&mut self, now: Duration) {
        let running = now.saturating_sub(self.current.started_at);
        if running < WINDOW {
            return;
        }
        let mut ended = std::mem::take(&mut self.current);
        ended.lasted = running;
        self.last = ended;
        self.current.started_at = now;
    }
}

/// Sub-divisions per doubling; the error of a quantile is below half of one part in this.
const STEPS_PER_OCTAVE: usize = 16;
/// From one microsecond to over a minute.
const OCTAVES: usize = 26;

/// A histogram of durations with a fixed number of buckets that grow with the value, so that its size never changes.
#[derive(Clone, Debug)]
pub struct Histogram {
    counts: Box<[u32; STEPS_PER_OCTAVE * OCTAVES]>,
    total: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: Box::new([0; STEPS_PER_OCTAVE * OCTAVES]), total: 0 }
    }
}

impl Histogram {
    /// Counts one duration. What is longer than the last bucket is counted there.
    pub fn add(&mut self, time: Duration) {
        let bucket = bucket_of(time);
        self.counts[bucket] = self.counts[bucket].saturating_add(1);
        self.total += 1;
    }

    /// Adds another histogram's counts.
    pub fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(other.counts.iter()) {
            *mine = mine.saturating_add(*theirs);
        }
        self.total += other.total;
    }

    /// How many were counted.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.total
    }

    /// Whether none was counted.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }

    /// The time that `fraction` (0 to 1) of all are no longer than, s; zero when nothing was counted.
    #[must_use]
    pub fn quantile_s(&self, fraction: f64) -> f64 {
        let wanted = (self.total as f64 * fraction).ceil().max(1.0) as u64;
        let mut seen = 0;
        for (bucket, count) in self.counts.iter().enumerate() {
            seen += u64::from(*count);
            if seen >= wanted {
                return middle_s(bucket);
            }
        }
        0.0
    }
}

fn bucket_of(time: Duration) -> usize {
    let microseconds = (time.as_secs_f64() * 1e6).max(1.0);
    let bucket = (microseconds.log2() * STEPS_PER_OCTAVE as f64) as usize;
    bucket.min(STEPS_PER_OCTAVE * OCTAVES - 1)
}

fn middle_s(bucket: usize) -> f64 {
    ((bucket as f64 + 0.5) / STEPS_PER_OCTAVE as f64).exp2() * 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_right_within_a_bucket() {
        let mut histogram = Histogram::default();
        for millisecond in 1..=1000 {
            histogram.add(Duration::from_millis(millisecond));
        }
        let relative = |quantile: f64, exact: f64| (histogram.quantile_s(quantile) / exact - 1.0).abs();
        assert!(relative(0.5, 0.5) < 0.05, "{}", histogram.quantile_s(0.5));
        assert!(relative(0.99, 0.99) < 0.05, "{}", histogram.quantile_s(0.99));
        assert_eq!(histogram.len(), 1000);
        assert_eq!(Histogram::default().quantile_s(0.5), 0.0);
    }

    #[test]
    fn extreme_times_fall_into_the_end_buckets() {
        let mut histogram = Histogram::default();
        histogram.add(Duration::ZERO);
        assert!(histogram.quantile_s(1.0) < 2e-6);
        histogram.add(Duration::from_secs(86_400));
        assert!(histogram.quantile_s(1.0) > 60.0);
    }

    #[test]
    fn rates_follow_the_last_seconds_and_totals_stay() {
        let ms = Duration::from_millis;
        let mut counters = Counters::new(Duration::ZERO);
        for step in 0..3000 {
            counters.wrote(2);
            counters.read(8);
            counters.replied(ms(step), ms(step + 1));
        }
        let busy = counters.at(ms(3000));
        assert!((busy.transactions_per_s - 1000.0).abs() < 1.0, "{}", busy.transactions_per_s);
        assert!((busy.kbit_per_s - 100.0).abs() < 0.2, "{}", busy.kbit_per_s);
        assert!((busy.round_trip_median_s / 1e-3 - 1.0).abs() < 0.05);
        let idle = counters.at(ms(20_000));
        let quiet = counters.at(ms(24_000));
        assert!(idle.transactions_per_s < busy.transactions_per_s);
        assert_eq!(quiet.transactions_per_s, 0.0, "nothing happened in the last windows");
        assert_eq!((quiet.transactions, quiet.bytes_in, quiet.bytes_out), (3000, 24_000, 6000));
    }
}
