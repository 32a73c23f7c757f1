//! The wall clock as the time of a machine: less the time that was skipped, and at the pace that was chosen.

use super::pace::Pace;
use std::time::{Duration, Instant};

/// After a longer gap (the computer slept, the program was stopped) the machine's time does not catch up but goes on from where
/// it was.
const LONGEST_CATCH_UP: Duration = Duration::from_millis(250);

/// What time it is for the machine.
#[derive(Debug)]
pub struct Clock {
    /// From here on the machine's time is counted.
    since: Instant,
    machine_since: Duration,
    pace: Pace,
}

impl Clock {
    /// A clock at real time, for a machine that stands at this time now.
    pub fn starting_at(machine_now: Duration) -> Self {
        Self { since: Instant::now(), machine_since: machine_now, pace: Pace::default() }
    }

    /// How fast it goes.
    pub fn pace(&self) -> Pace {
        self.pace
    }

    /// Goes at another pace from here on.
    pub fn set_pace(&mut self, pace: Pace, machine_now: Duration) {
        if pace != self.pace {
            *self = Self { pace, ..Self::starting_at(machine_now) };
        }
    }

    /// The machine's time by the wall clock; the machine itself stands at `machine_now`. At full speed it has no time but its own.
    pub fn now(&mut self, machine_now: Duration) -> Duration {
        if self.pace == Pace::Max {
            return machine_now;
        }
        let now = self.machine_since + self.to_machine(self.since.elapsed());
        if now.saturating_sub(machine_now) <= self.to_machine(LONGEST_CATCH_UP) {
            return now;
        }
        *self = Self { pace: self.pace, ..Self::starting_at(machine_now) };
        machine_now
    }

    /// How long something of the wall clock takes on the machine.
    pub fn to_machine(&self, wall: Duration) -> Duration {
        wall * self.times()
    }

    /// How long something of the machine takes on the wall clock.
    pub fn to_wall(&self, machine: Duration) -> Duration {
        machine / self.times()
    }

    fn times(&self) -> u32 {
        match self.pace {
            Pace::Times(times) => u32::from(times.get()),
            Pace::Max => 1,
        }
    }
}
