//! Whether a run's answers came on time: what late ones show says nothing about the machine.
//!
//! While nobody asks, nobody knows what the motor does; the controller's own time-out may have stopped it, or its travel have ended.
//! So the gap between two answers is kept, from the times at which they were complete, and a conclusion is held against the longest.

use crate::axis::Exchange;
use crate::cause::Whose;
use crate::thresholds::thresholds;

thresholds! {
    /// When an answer counts as late.
    PACE: Thresholds {
        /// Gap beyond which an answer is late, in seconds: less than the 130 ms after which a driven motor is said not to have started and than the 200 ms after which
        /// the controller stops it; more than four lost replies in a row make of polls every 10 ms (67 ms on the plants of the bench).
        late_s: f64 = 0.085,
        /// The same on a slow line, as a multiple of the usual gap: two lost replies of those plants make up to 2.8.
        late_ratio: f64 = 4.0,
        /// How far exchanges may spread, in seconds, from the one that a tenth were quicker than to the one that a tenth were slower than: half the time between two
        /// polls. Lost replies are none of them; the plants of the bench spread by 2 ms, a simulated controller beside it on a quiet computer by 0.1 ms, and with three
        /// busy programs to each processor by 12 to 16 ms.
        unsteady_s: f64 = 0.005,
        /// Gap that may have stopped the motor, in seconds: the time-out that a run sets where the controller has one.
        stopping_s: f64 = 0.2,
        /// How long a shorter one counts against what the last polls tell, in seconds: longer than the monitor of the motor looks back.
        remembered_s: f64 = 1.0,
    }
}

/// That answers were late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Late {
    /// The longest gap, or the spread of the exchanges where that is longer, s.
    pub(crate) longest_s: f64,
    /// When the longest gap ended, s, on the clock of the exchanges.
    pub(crate) at_s: f64,
    /// How much of it this computer took, s.
    pub(crate) stolen_s: f64,
}

impl Late {
    /// Who was late for most of it: a computer that came in time to ask and to read was not.
    pub(crate) fn whose(&self) -> Whose {
        if 2.0 * self.stolen_s >= self.longest_s { Whose::Computer } else { Whose::Line }
    }
}

/// The answers of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pace {
    /// When the last answer was complete, s; `None` after a pause of the run itself.
    last_s: Option<f64>,
    /// The gaps so far, oldest first.
    gaps: Vec<Gap>,
    /// The longest gap, s, and when it ended.
    longest: Option<Late>,
    /// Time that this computer took since the last answer, and between that and the one before, s: what it took beside an answer may
    /// have been before or after its time.
    stolen_s: f64,
    stolen_before_s: f64,
}

/// The time between two answers.
#[derive(Clone, Copy, Debug)]
struct Gap {
    long_s: f64,
    ended_s: f64,
    /// Time that this computer took after the answer before it.
    stolen_s: f64,
}

impl Pace {
    /// An answer has come.
    pub(crate) fn answered(&mut self, exchange: &Exchange) {
        let now_s = exchange.received.as_secs_f64();
        if let Some(last_s) = self.last_s {
            let gap_s = now_s - last_s;
            self.gaps.push(Gap { long_s: gap_s, ended_s: now_s, stolen_s: self.stolen_s });
            if self.longest.is_none_or(|longest| gap_s > longest.longest_s) {
                self.longest = Some(self.gap(last_s, now_s));
            }
        }
        self.stolen_before_s = std::mem::take(&mut self.stolen_s);
        self.last_s = Some(now_s);
    }

    /// A gap that ends now.
    fn gap(&self, from_s: f64, now_s: f64) -> Late {
        let longest_s = now_s - from_s;
        Late { longest_s, at_s: now_s, stolen_s: (self.stolen_s + self.stolen_before_s).min(longest_s) }
    }

    /// This computer took so long of what goes on, s.
    pub(crate) fn stole(&mut self, seconds: f64) {
        self.stolen_s += seconds;
    }

    /// The silence since the last answer, or since `begun_s` where the run was not asking before; it ends now.
    pub(crate) fn silence(&self, begun_s: f64, now_s: f64) -> Late {
        self.gap(self.last_s.unwrap_or(begun_s), now_s)
    }

    /// The run computes: the gap that comes is its own.
    pub(crate) fn pause(&mut self) {
        (self.last_s, self.stolen_s, self.stolen_before_s) = (None, 0.0, 0.0);
    }

    /// The longest gap.
    pub(crate) fn longest(&self) -> Option<Late> {
        self.longest
    }

    /// The longest gap, where it was a late one.
    pub(crate) fn late_gap(&self) -> Option<Late> {
        self.longest.filter(|longest| longest.longest_s > self.limit_s())
    }

    /// The longest gap, where a late one may have stopped the motor or ended not long before now: what the last polls tell is doubtful then.
    pub(crate) fn late_gap_before(&self, now_s: f64) -> Option<Late> {
        let limit_s = self.limit_s();
        let mut gaps = self.gaps.iter().filter(|gap| gap.long_s > limit_s);
        let may_matter = |gap: &Gap| gap.long_s >= PACE.stopping_s || now_s - gap.ended_s < PACE.remembered_s;
        self.longest.filter(|_| gaps.any(may_matter))
    }

    fn limit_s(&self) -> f64 {
        PACE.late_s.max(PACE.late_ratio * quantile(&self.of_gaps(|gap| gap.long_s), 0.5).unwrap_or_default())
    }

    fn of_gaps(&self, figure: fn(&Gap) -> f64) -> Vec<f64> {
        self.gaps.iter().map(figure).collect()
    }

    /// The longest gap, where this computer took most of the time of all.
    pub(crate) fn computer_late(&self) -> Option<Late> {
        let sum = |figure: fn(&Gap) -> f64| self.gaps.iter().map(figure).sum::<f64>();
        let (stolen_s, all_s) = (sum(|gap| gap.stolen_s), sum(|gap| gap.long_s));
        let longest_s = self.longest?.longest_s;
        (2.0 * stolen_s >= all_s).then_some(Late { stolen_s: longest_s, ..self.longest? })
    }

    /// The longest gap or the spread, where each of the exchanges, which took so long, took another time, so that nobody knows when what was read.
    pub(crate) fn unsteady(&self, took_s: &[f64]) -> Option<Late> {
        let spread = |times_s: &[f64]| {
            quantile(times_s, 0.9).zip(quantile(times_s, 0.1)).map_or(0.0, |(slow, quick)| slow - quick)
        };
        let spread_s = spread(took_s);
        let longest = self.longest.unwrap_or_default();
        let longest_s = longest.longest_s.max(spread_s);
        // Whose the spread is, is whose it is in most of the exchanges, not in the longest gap.
        let stolen_s = spread(&self.of_gaps(|gap| gap.stolen_s)) / spread_s.max(f64::MIN_POSITIVE);
        let stolen_s = longest_s * stolen_s.min(1.0);
        (spread_s > PACE.unsteady_s).then_some(Late { longest_s, stolen_s, ..longest })
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
        assert_eq!(polled(&[10; 30]).late_gap(), None);
        assert_eq!(polled(&[10, 10, 10, 55, 10, 10]).late_gap(), None);
        let late = polled(&[10, 10, 10, 200, 10, 10]).late_gap();
        assert!(
            late.is_some_and(|late| {
                (late.longest_s - 0.2).abs() < 1e-9 && (late.at_s - 0.23).abs() < 1e-9
            })
        );
        assert_eq!(polled(&[100, 90, 110, 300, 100]).late_gap(), None, "a slow line");
        assert!(polled(&[100, 90, 110, 450, 100]).late_gap().is_some());
    }

    #[test]
    fn a_short_gap_says_nothing_against_polls_long_after_it_and_one_that_may_have_stopped_the_motor_does() {
        let short = polled(&[10, 10, 150, 10, 10]);
        assert!(short.late_gap_before(0.2).is_some(), "{short:?}");
        assert!(short.late_gap_before(1.1).is_some(), "{short:?}");
        assert_eq!(short.late_gap_before(1.3), None);
        assert!(polled(&[10, 10, 250, 10, 10]).late_gap_before(5.0).is_some());
        let two = polled(&[&[10, 150][..], &[10; 110], &[90, 10]].concat()).late_gap_before(1.4);
        assert!(
            two.is_some_and(|late| (late.longest_s - 0.15).abs() < 1e-9),
            "a later one, if a shorter: {two:?}"
        );
    }

    #[test]
    fn exchanges_that_spread_by_half_a_poll_are_late_and_slow_ones_are_not() {
        let late = |took_ms: &dyn Fn(u32) -> u32| {
            let took_s: Vec<f64> = (0..40).map(|number| 1e-3 * f64::from(took_ms(number))).collect();
            polled(&[25; 40]).unsteady(&took_s).map(|late| late.longest_s)
        };
        assert_eq!(late(&|number| 15 + number % 5), None, "a slow line");
        assert_eq!(late(&|number| if number % 20 == 3 { 24 } else { 1 }), None, "one in twenty");
        let busy = late(&|number| 4 * (number % 5)).expect("a time slice of 4 ms, and up to four of them");
        assert!((busy - 0.025).abs() < 1e-9, "{busy}");
        assert!(
            Pace::default().unsteady(&[0.0, 0.016]).is_some_and(|late| late.longest_s > 0.015),
            "no gap is reported as 0 ms"
        );
    }

    #[test]
    fn what_the_run_takes_for_itself_is_no_gap() {
        let mut pace = polled(&[10; 30]);
        pace.pause();
        pace.answered(&at(5_000));
        pace.answered(&at(5_010));
        assert_eq!(pace.late_gap(), None);
    }

    #[test]
    fn a_gap_is_whose_most_of_it_was() {
        let late_by = |stolen_s: f64, before: bool| {
            let mut pace = polled(&[10; 3]);
            pace.stole(if before { stolen_s } else { 0.0 });
            pace.answered(&at(40));
            pace.stole(if before { 0.0 } else { stolen_s });
            pace.answered(&at(340));
            pace.late_gap().expect("0.3 s are late").whose()
        };
        assert_eq!(late_by(0.0, false), Whose::Line);
        assert_eq!(late_by(0.01, false), Whose::Line, "a little of it");
        assert_eq!(late_by(0.29, false), Whose::Computer);
        assert_eq!(late_by(0.29, true), Whose::Computer, "behind the time of the counts, with the status");
    }

    #[test]
    fn exchanges_that_spread_are_the_computers_where_it_took_that_time() {
        let whose = |share: f64| {
            let (mut pace, mut took_s) = (Pace::default(), Vec::new());
            for number in 0_u64..40 {
                let late_s = 0.004 * (number % 5) as f64;
                pace.stole(share * late_s);
                pace.answered(&at(25 * number));
                took_s.push(late_s);
            }
            pace.unsteady(&took_s).expect("16 ms are a spread").whose()
        };
        assert_eq!((whose(1.0), whose(0.0)), (Whose::Computer, Whose::Line));
    }
}
