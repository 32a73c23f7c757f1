//! Whether a run's answers came on time: what late ones show says nothing about the machine.
//!
//! While nobody asks, nobody knows what the motor does; the controller's own time-out may have stopped it, or its travel have ended.
//! So the gap between two answers is kept, from the times at which they were complete, and a conclusion is held against the longest.

use crate::axis::Exchange;

/// A gap that long is a late one, s: less than the 130 ms after which a driven motor is said not to have started and than the 150 ms
/// after which the controller stops it; more than four lost replies in a row make of polls every 10 ms (67 ms on the plants of the bench).
const LATE_S: f64 = 0.085;
/// On a slow line it is one that is so many times the usual: two lost replies of those plants make up to 2.8.
const LATE_RATIO: f64 = 4.0;

/// The answers of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pace {
    /// When the last answer was complete, s; `None` after a pause of the run itself.
    last_s: Option<f64>,
    /// How long each gap was, s, oldest first.
    gaps_s: Vec<f64>,
    /// Whether the polls that failed last came, but too late to be of use.
    came_late: bool,
}

impl Pace {
    /// An answer has come.
    pub(crate) fn answered(&mut self, exchange: &Exchange) {
        let now_s = exchange.received.as_secs_f64();
        if let Some(last_s) = self.last_s {
            self.gaps_s.push(now_s - last_s);
        }
        self.last_s = Some(now_s);
        self.came_late = false;
    }

    /// An answer has come so late that it says nothing.
    pub(crate) fn came_late(&mut self) {
        self.came_late = true;
    }

    /// Whether the answers that are missing since the last good one were late rather than lost.
    pub(crate) fn is_coming_late(&self) -> bool {
        self.came_late
    }

    /// The run computes: the gap that comes is its own.
    pub(crate) fn pause(&mut self) {
        self.last_s = None;
    }

    /// The longest gap, s, where it was a late one.
    pub(crate) fn longest_late_s(&self) -> Option<f64> {
        let longest_s = self.gaps_s.iter().copied().fold(0.0, f64::max);
        let limit_s = LATE_S.max(LATE_RATIO * self.usual_s());
        (longest_s > limit_s).then_some(longest_s)
    }

    /// The middle one of all gaps, s; 0 before the first.
    fn usual_s(&self) -> f64 {
        let mut gaps_s = self.gaps_s.clone();
        gaps_s.sort_by(f64::total_cmp);
        gaps_s.get(gaps_s.len() / 2).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn at(milliseconds: u64) -> Exchange {
        let received = Duration::from_millis(milliseconds);
        Exchange { sent: received, received }
    }

    fn polled(gaps_ms: &[u64]) -> Pace {
        let (mut pace, mut now_ms) = (Pace::default(), 0);
        pace.answered(&at(0));
        for gap_ms in gaps_ms {
            now_ms += gap_ms;
            pace.answered(&at(now_ms));
        }
        pace
    }

    #[test]
    fn a_gap_is_late_beyond_what_a_standstill_is_read_from_and_beyond_the_usual() {
        assert_eq!(polled(&[10; 30]).longest_late_s(), None);
        assert_eq!(polled(&[10, 10, 10, 55, 10, 10]).longest_late_s(), None);
        let late = polled(&[10, 10, 10, 200, 10, 10]);
        assert!(late.longest_late_s().is_some_and(|gap_s| (gap_s - 0.2).abs() < 1e-9));
        assert_eq!(polled(&[100, 90, 110, 300, 100]).longest_late_s(), None, "a slow line");
        assert!(polled(&[100, 90, 110, 450, 100]).longest_late_s().is_some());
    }

    #[test]
    fn what_the_run_takes_for_itself_is_no_gap() {
        let mut pace = polled(&[10; 30]);
        pace.pause();
        pace.answered(&at(5_000));
        pace.answered(&at(5_010));
        assert_eq!(pace.longest_late_s(), None);
    }

    #[test]
    fn answers_that_came_late_are_forgotten_at_the_next_good_one() {
        let mut pace = polled(&[10; 3]);
        pace.came_late();
        assert!(pace.is_coming_late());
        pace.answered(&at(300));
        assert!(!pace.is_coming_late());
    }
}
