//! A stepper as the board drives it: waits between steps that get shorter and longer again.

use super::assumed::{STEP_TICKS_PER_SECOND, WAIT_CHANGE, WAITS};
use std::time::Duration;

/// One of the two.
#[derive(Clone, Debug, PartialEq)]
pub struct Stepper {
    /// Waits at the highest and at the lowest speed, in 1/1024 s.
    waits: (u32, u32),
    /// Percentage of full power while it stands.
    pub hold_percent: u32,
    /// +1 forward, -1 backward.
    pub sense: i64,
    /// Steps of this move, and those made.
    pub steps: u32,
    pub made: u32,
    /// When the next step is due; none while it stands.
    pub next_step: Option<Duration>,
    /// Steps since power-up.
    pub position: i64,
}

impl Default for Stepper {
    fn default() -> Self {
        Self { waits: WAITS, hold_percent: 0, sense: 1, steps: 0, made: 0, next_step: None, position: 0 }
    }
}

impl Stepper {
    /// ConfigStepper; a wait of 0 is taken for 1, and the lowest speed is never the higher one.
    pub fn configure(&mut self, least: u32, most: u32, hold_percent: u32) {
        let least = least.max(1);
        self.waits = (least, most.max(least));
        self.hold_percent = hold_percent.min(100);
    }

    /// SetStepper: a move that was under way is given up.
    pub fn start(&mut self, now: Duration, sense: i64, steps: u32) {
        (self.sense, self.steps, self.made) = (sense, steps, 0);
        self.next_step = Some(if steps == 0 { now } else { now + self.wait() });
    }

    /// The wait before the next step: the steps made, or those left, shorten it.
    fn wait(&self) -> Duration {
        let (least, most) = self.waits;
        let along = self.made.min(self.steps.saturating_sub(1).saturating_sub(self.made));
        let ticks = most.saturating_sub(along.saturating_mul(WAIT_CHANGE)).max(least);
        Duration::from_nanos(u64::from(ticks) * 1_000_000_000 / u64::from(STEP_TICKS_PER_SECOND))
    }

    /// Makes the step that is due; true with the last one.
    pub fn step(&mut self) -> bool {
        let Some(due) = self.next_step.take() else { return false };
        if self.made < self.steps {
            self.made += 1;
            self.position += self.sense;
        }
        if self.made >= self.steps {
            return true;
        }
        self.next_step = Some(due + self.wait());
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waits_get_shorter_to_the_middle_and_longer_again() {
        let mut stepper = Stepper::default();
        stepper.configure(8, 10, 50);
        stepper.start(Duration::ZERO, -1, 6);
        let mut times = Vec::new();
        while let Some(due) = stepper.next_step {
            times.push((due.as_secs_f64() * 1024.0).round() as u32);
            stepper.step();
        }
        // Waits of 10, 9, 8, 8, 9, 10.
        assert_eq!(times, [10, 19, 27, 35, 44, 54]);
        assert_eq!(stepper.position, -6);
    }

    #[test]
    fn no_steps_are_made_at_once() {
        let mut stepper = Stepper::default();
        stepper.start(Duration::from_secs(1), 1, 0);
        assert_eq!(stepper.next_step, Some(Duration::from_secs(1)));
        assert!(stepper.step());
        assert_eq!((stepper.position, stepper.next_step), (0, None));
    }
}
