//! Whether a run's answers came on time: what late ones show says nothing about the machine.
//!
//! While nobody asks, nobody knows what the motor does; the controller's own time-out may have stopped it, or its travel have ended.
//! So the gap between two answers is kept, from the times at which they were complete, and a conclusion is held against the longest.

use crate::axis::Exchange;

/// A gap that long is a late one, s: less than the 130 ms after which a driven motor is said not to have started and than the 200 ms
/// after which the controller stops it; more than four lost replies in a row make of polls every 10 ms (67 ms on the plants of the bench).
const LATE_S: f64 = 0.085;
/// On a slow line it is one that is so many times the usual: two lost replies of those plants make up to 2.8.
const LATE_RATIO: f64 = 4.0;
/// How far exchanges may spread, s, from the one that a tenth were quicker than to the one that a tenth were slower than: half the time
/// between two polls. Lost replies are none of them; the plants of the bench spread by 2 ms, a simulated controller beside it on a quiet
/// computer by 0.1 ms, and with three busy programs to each processor by 12 to 16 ms.
const UNSTEADY_S: f64 = 0.005;

/// That answers were late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Late {
    /// The longest gap, or the spread of the exchanges where that is longer, s.
    pub(crate) longest_s: f64,
    /// When the longest gap ended, s, on the clock of the exchanges.
    pub(crate) at_s: f64,
}

/// The answers of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pace {
    /// When the last answer was complete, s; `None` after a pause of the run itself.
    last_s: Option<f64>,
    /// How long each gap was, s, oldest first.
    gaps_s: Vec<f64>,
    /// The longest gap, s, and when it ended.
    longest: Option<Late>,
    /// Whether the polls that failed last came, but too late to be of use.
    came_late: bool,
}

impl Pace {
    /// An answer has come.
    pub(crate) fn answered(&mut self, exchange: &Exchange) {
        let now_s = exchange.received.as_secs_f64();
        if let Some(last_s) = self.last_s {
            let gap_s = now_s - last_s;
            self.gaps_s.push(gap_s);
            if self.longest.is_none_or(|longest| gap_s > longest.longest_s) {
                self.longest = Some(Late { longest_s: gap_s, at_s: now_s });
            }
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

    /// The longest gap.
    pub(crate) fn longest(&self) -> Option<Late> {
        self.longest
    }

    /// The longest gap, where it was a late one.
    pub(crate) fn late_gap(&self) -> Option<Late> {
        let limit_s = LATE_S.max(LATE_RATIO * quantile(&self.gaps_s, 0.5).unwrap_or_default());
        self.longest.filter(|longest| longest.longest_s > limit_s)
    }

    /// The same, or where each of the exchanges, which took so long, took another time, so that nobody knows when what was read.
    pub(crate) fn late(&self, took_s: &[f64]) -> Option<Late> {
        self.late_gap().or_else(|| self.unsteady(took_s))
    }

    /// The longest gap or the spread, where each of the exchanges took another time.
    pub(crate) fn unsteady(&self, took_s: &[f64]) -> Option<Late> {
        let spread_s =
            quantile(took_s, 0.9).zip(quantile(took_s, 0.1)).map_or(0.0, |(slow, quick)| slow - quick);
        let longest = self.longest.unwrap_or_default();
        (spread_s > UNSTEADY_S).then_some(Late { longest_s: longest.longest_s.max(spread_s), ..longest })
    }
}

/// The time that a share of times are shorter than, s; `None` of none.
pub(crate) fn quantile(times_s: &[f64], share: f64) -> Option<f64> {
    let mut sorted_s = times_s.to_vec();
    sorted_s.sort_by(f64::total_cmp);
    sorted_s.get((share * sorted_s.len() as f64) as usize).copied()
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
        assert_eq!(polled(&[10; 30]).late(&[]), None);
        assert_eq!(polled(&[10, 10, 10, 55, 10, 10]).late(&[]), None);
        let late = polled(&[10, 10, 10, 200, 10, 10]);
        assert!(
            late.late(&[])
                .is_some_and(|late| (late.longest_s - 0.2).abs() < 1e-9 && (late.at_s - 0.23).abs() < 1e-9)
        );
        assert_eq!(polled(&[100, 90, 110, 300, 100]).late(&[]), None, "a slow line");
        assert!(polled(&[100, 90, 110, 450, 100]).late(&[]).is_some());
    }

    #[test]
    fn exchanges_that_spread_by_half_a_poll_are_late_and_slow_ones_are_not() {
        let late = |took_ms: &dyn Fn(u32) -> u32| {
            let took_s: Vec<f64> = (0..40).map(|number| 1e-3 * f64::from(took_ms(number))).collect();
            polled(&[25; 40]).late(&took_s).map(|late| late.longest_s)
        };
        assert_eq!(late(&|number| 15 + number % 5), None, "a slow line");
        assert_eq!(late(&|number| if number % 20 == 3 { 24 } else { 1 }), None, "one in twenty");
        let busy = late(&|number| 4 * (number % 5)).expect("a time slice of 4 ms, and up to four of them");
        assert!((busy - 0.025).abs() < 1e-9, "{busy}");
        assert!(
            Pace::default().late(&[0.0, 0.016]).is_some_and(|late| late.longest_s > 0.015),
            "no gap is reported as 0 ms"
        );
    }

    #[test]
    fn what_the_run_takes_for_itself_is_no_gap() {
        let mut pace = polled(&[10; 30]);
        pace.pause();
        pace.answered(&at(5_000));
        pace.answered(&at(5_010));
        assert_eq!(pace.late(&[]), None);
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
