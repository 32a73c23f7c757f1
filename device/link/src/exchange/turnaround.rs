//! How long a line takes to answer beyond the time of the bytes on the wire, learned from its replies.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Longer than this nothing is waited for unless somebody says so: radio links and serial servers are 50 to 400 ms late.
pub const LONGEST: Duration = Duration::from_millis(500);
/// Room beyond what was learned: the 16 ms timer of common USB serial adapters, at both ends of a radio link.
const ROOM: Duration = Duration::from_millis(32);

/// How late replies are beyond the time of the bytes on the wire, ms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lateness {
    /// Their mean, of which the newer ones are a larger part.
    pub mean_ms: f64,
    /// Their mean deviation from it.
    pub deviation_ms: f64,
    /// The quickest one.
    pub shortest_ms: f64,
    /// The latest one.
    pub longest_ms: f64,
}

/// Mean and mean deviation as TCP keeps them (RFC 6298, section 2), with its doubling after each time-out (section 5.5).
#[derive(Clone, Copy, Debug, Default)]
pub struct Turnaround {
    learned: Option<Learned>,
    /// Without a reply since.
    timed_out: u32,
}

#[derive(Clone, Copy, Debug)]
struct Learned {
    mean: Duration,
    deviation: Duration,
    shortest: Duration,
    longest: Duration,
}

impl Turnaround {
    /// A reply came so long after its request, the time of both on the wire taken off.
    pub fn learn(&mut self, took: Duration) {
        self.timed_out = 0;
        self.learned = Some(match self.learned {
            None => Learned { mean: took, deviation: took / 2, shortest: took, longest: took },
            Some(Learned { mean, deviation, shortest, longest }) => Learned {
                mean: mean * 7 / 8 + took / 8,
                deviation: deviation * 3 / 4 + mean.abs_diff(took) / 4,
                shortest: shortest.min(took),
                longest: longest.max(took),
            },
        });
    }

    /// Whether other replies came about as late as this.
    pub fn is_usual(&self, took: Duration) -> bool {
        self.learned.is_some_and(|Learned { mean, deviation, .. }| took <= mean + deviation * 4 + ROOM / 2)
    }

    /// What was learned.
    pub fn lateness(&self) -> Option<Lateness> {
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        self.learned.map(|Learned { mean, deviation, shortest, longest }| Lateness {
            mean_ms: ms(mean),
            deviation_ms: ms(deviation),
            shortest_ms: ms(shortest),
            longest_ms: ms(longest),
        })
    }

    /// No reply came in time.
    pub fn timed_out(&mut self) {
        self.timed_out = (self.timed_out + 1).min(10);
    }

    /// How long the next reply may take on a port where `usual` is enough as a rule. Time-outs count on a line that has shown itself late alone:
    /// elsewhere they tell of an address where nobody is, or of a command that a unit lacks.
    pub fn allowance(&self, usual: Duration) -> Duration {
        let seen =
            self.learned.map_or(Duration::ZERO, |Learned { mean, deviation, .. }| mean + deviation * 4);
        if seen <= usual {
            return usual;
        }
        ((seen + ROOM) * 2_u32.pow(self.timed_out)).min(LONGEST.max(usual))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    const USUAL: Duration = ms(60);

    #[test]
    fn a_steady_line_is_given_its_own_time_and_little_more() {
        let mut turnaround = Turnaround::default();
        assert_eq!(turnaround.allowance(USUAL), USUAL);
        turnaround.learn(ms(150));
        assert_eq!(turnaround.allowance(USUAL), ms(482), "the first reply leaves everything open");
        (0..40).for_each(|_| turnaround.learn(ms(150)));
        let steady = turnaround.allowance(USUAL);
        assert!(steady >= ms(180) && steady <= ms(190), "{steady:?}");
        (0..80).for_each(|_| turnaround.learn(ms(1)));
        assert_eq!(turnaround.allowance(USUAL), USUAL, "never less than the port is known to need");
    }

    #[test]
    fn a_line_that_varies_is_given_more_and_each_time_out_doubles_it_up_to_the_longest() {
        let mut turnaround = Turnaround::default();
        (0..40).for_each(|index| turnaround.learn(ms(if index % 2 == 0 { 60 } else { 120 })));
        let varying = turnaround.allowance(USUAL);
        assert!(varying > ms(200) && varying < ms(280), "{varying:?}");
        turnaround.timed_out();
        assert_eq!(turnaround.allowance(USUAL), (varying * 2).min(LONGEST));
        (0..100).for_each(|_| turnaround.timed_out());
        assert_eq!(turnaround.allowance(USUAL), LONGEST);
        assert_eq!(turnaround.allowance(2 * LONGEST), 2 * LONGEST, "the owner may ask for more");
        turnaround.learn(ms(90));
        assert!(turnaround.allowance(USUAL) < varying + ms(40));
    }

    #[test]
    fn a_fast_line_is_given_no_more_for_what_stays_silent() {
        let mut turnaround = Turnaround::default();
        turnaround.learn(ms(2));
        (0..100).for_each(|_| turnaround.timed_out());
        assert_eq!(turnaround.allowance(USUAL), USUAL);
    }
}
