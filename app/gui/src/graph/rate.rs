//! The rate of samples that was really reached, and what was late or lost.

use std::collections::VecDeque;

/// The rate is taken over the newest samples within this time.
const WINDOW_S: f64 = 2.0;
/// At most this many.
const MOST: usize = 4096;

/// A sample that comes later than this many usual intervals is late: there is a gap before it.
const LATE_INTERVALS: f64 = 3.0;

/// Intervals that tell what is usual.
const USUAL_OF: usize = 15;

/// Watches samples come in.
#[derive(Clone, Debug)]
pub struct Rate {
    asked_s: f64,
    times_s: VecDeque<f64>,
    pub late: u64,
    pub lost: u64,
    after_loss: bool,
}

impl Rate {
    /// Samples are asked for every `asked_s`.
    pub fn new(asked_s: f64) -> Self {
        Self { asked_s, times_s: VecDeque::new(), late: 0, lost: 0, after_loss: false }
    }

    pub fn ask(&mut self, asked_s: f64) {
        self.asked_s = asked_s;
        self.restart();
    }

    /// What comes next is not measured against what was.
    pub fn restart(&mut self) {
        self.times_s.clear();
    }

    /// Samples were thrown away: the next one is no later than it has to be.
    pub fn lose(&mut self, samples: u64) {
        self.lost += samples;
        self.after_loss = true;
    }

    /// A sample came. Whether it was late.
    pub fn take(&mut self, time_s: f64) -> bool {
        let pause_s = self.times_s.back().map_or(0.0, |last| time_s - last);
        let late = !std::mem::take(&mut self.after_loss) && pause_s > LATE_INTERVALS * self.usual_s();
        self.late += u64::from(late);
        self.times_s.push_back(time_s);
        while self.times_s.len() > MOST || self.times_s.front().is_some_and(|first| first + WINDOW_S < time_s)
        {
            if self.times_s.len() <= 2 {
                break;
            }
            self.times_s.pop_front();
        }
        late
    }

    /// Samples a second; none before two came.
    pub fn reached_hz(&self) -> Option<f64> {
        let (first, last) = (self.times_s.front()?, self.times_s.back()?);
        (last > first).then(|| (self.times_s.len() - 1) as f64 / (last - first))
    }

    /// Time between two samples as it usually is: as asked for, or longer where the link cannot do that.
    pub fn usual_s(&self) -> f64 {
        let newest = self.times_s.iter().rev();
        let mut pauses: Vec<f64> = newest
            .clone()
            .zip(newest.skip(1))
            .take(USUAL_OF)
            .map(|(later, earlier)| later - earlier)
            .collect();
        pauses.sort_by(f64::total_cmp);
        pauses.get(pauses.len() / 2).map_or(self.asked_s, |median| median.max(self.asked_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_reached_is_told_and_a_pause_is_late() {
        let mut rate = Rate::new(0.1);
        assert_eq!(rate.reached_hz(), None);
        let late: Vec<bool> = (0..20).map(|tick| rate.take(f64::from(tick) * 0.1)).collect();
        assert!(!late.contains(&true));
        assert!((rate.reached_hz().unwrap() - 10.0).abs() < 1e-6);
        assert!(rate.take(2.4));
        assert_eq!(rate.late, 1);
    }

    #[test]
    fn a_link_that_cannot_hold_what_is_asked_is_measured_by_what_it_holds() {
        let mut rate = Rate::new(0.001);
        let late = (0..300).filter(|tick| rate.take(f64::from(*tick) * 0.01)).count();
        assert!(late <= 1, "{late}");
        assert!((rate.reached_hz().unwrap() - 100.0).abs() < 1e-6);
        assert!((rate.usual_s() - 0.01).abs() < 1e-9);
    }
}
