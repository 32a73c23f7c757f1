//! When a position was taken, by the unit's own clock.
//!
//! POSITION is that of the last loop, so that a reading is up to 5 ms old and nobody can tell how much from outside. TIME counts the
//! loops (Motion Mind manual 6.0) and comes in the same frame: with it each reading has its loop.

use brushwork_tuning::axis::Exchange;
use std::collections::VecDeque;
use std::time::Duration;

/// One step of TIME, s.
const LOOP_S: f64 = 0.005;
/// A jump of TIME by more than this against the clock here is a restart, s.
const RESTART_S: f64 = 1.0;

/// Readings that the clock is kept by: among so many at least one was read without delay.
const KEPT: usize = 32;

/// The unit's clock as seen from here.
#[derive(Clone, Debug, Default)]
pub(super) struct UnitClock {
    /// The latest time here at which TIME can have been 0, by each of the last readings, s.
    latest_s: VecDeque<f64>,
}

impl UnitClock {
    /// The stamp of a reading that was taken at about `read_at` and came with `time`: half a loop after its loop, which is how old
    /// a reading without TIME is on average.
    ///
    /// No reading is taken before its loop, so each bounds where the loops are, and the one that was read soonest after its loop
    /// bounds best. A busy computer only makes readings later; clocks that drift against each other are followed.
    pub(super) fn stamp(&mut self, read_at: Exchange, time: u32) -> Exchange {
        let loop_s = f64::from(time) * LOOP_S;
        let latest = read_at.middle_s() - loop_s;
        if self.latest_s.back().is_some_and(|before| (before - latest).abs() > RESTART_S) {
            self.latest_s.clear();
        }
        self.latest_s.push_back(latest);
        if self.latest_s.len() > KEPT {
            self.latest_s.pop_front();
        }
        let zero_s = self.latest_s.iter().copied().fold(f64::INFINITY, f64::min);
        let at = Duration::from_secs_f64((zero_s + loop_s + 0.5 * LOOP_S).max(0.0));
        Exchange { sent: at, received: at }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_come_on_the_loops_of_the_unit_whatever_the_jitter_and_a_slow_drift() {
        // The unit's loops come at 1.2 ms past each 5 ms of its clock, which runs 100 ppm fast.
        let mut clock = UnitClock::default();
        let mut worst: f64 = 0.0;
        for n in 0..2_000 {
            let t = 0.0137 * f64::from(n) + 0.0009 * f64::from(n % 7);
            let own = t * 1.0001;
            let time = ((own - 0.0012) / LOOP_S).floor().max(0.0);
            let taken = (time * LOOP_S + 0.0012) / 1.0001;
            let at = Duration::from_secs_f64(t);
            let got = clock.stamp(Exchange { sent: at, received: at }, time as u32).middle_s();
            if n > 100 {
                worst = worst.max((got - 0.5 * LOOP_S - taken).abs());
            }
        }
        assert!(worst < 0.0006, "{worst} s");
    }

    #[test]
    fn what_a_busy_computer_reads_late_keeps_its_time() {
        let mut clock = UnitClock::default();
        let mut worst: f64 = 0.0;
        for n in 0..500 {
            let taken = 0.0137 * f64::from(n) + 0.0009 * f64::from(n % 7);
            let time = (taken / LOOP_S).floor();
            let late_s = if n % 3 == 1 { 0.004 * f64::from(n % 11) } else { 0.0 };
            let at = Duration::from_secs_f64(taken + late_s);
            let got = clock.stamp(Exchange { sent: at, received: at }, time as u32).middle_s();
            if n > 40 {
                worst = worst.max((got - 0.5 * LOOP_S - time * LOOP_S).abs());
            }
        }
        assert!(worst < 0.001, "{worst} s");
    }

    #[test]
    fn a_unit_that_started_anew_has_a_new_clock() {
        let mut clock = UnitClock::default();
        let at = |seconds: f64| {
            let at = Duration::from_secs_f64(seconds);
            Exchange { sent: at, received: at }
        };
        clock.stamp(at(10.0), 2_000);
        let stamp = clock.stamp(at(11.0), 3).middle_s();
        assert!((stamp - 11.0).abs() < 0.005, "{stamp}");
    }
}
