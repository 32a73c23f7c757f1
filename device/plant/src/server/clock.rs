//! The wall clock, as far as it is shared with a client, as the time of a machine: less the time that was skipped, and at the pace that was
//! chosen.

use super::pace::Pace;
use super::shared_time::SharedTime;
use std::time::Duration;

/// After a longer gap (the computer slept, the program was stopped) the machine's time does not catch up but goes on from where
/// it was. Where it has a client in this program the two have stood still together.
const LONGEST_CATCH_UP: Duration = Duration::from_millis(250);

/// What time it is for the machine.
#[derive(Debug)]
pub struct Clock {
    shared: SharedTime,
    /// From here on the machine's time is counted.
    since: Duration,
    machine_since: Duration,
    pace: Pace,
}

impl Clock {
    /// A clock at real time, for a machine that stands at this time now.
    pub fn starting_at(machine_now: Duration) -> Self {
        let shared = SharedTime::new();
        let since = shared.machine_looks();
        Self { shared, since, machine_since: machine_now, pace: Pace::default() }
    }

    /// The time that it shares with a client inside the program.
    pub fn shared(&self) -> &SharedTime {
        &self.shared
    }

    /// Counts on from here.
    fn count_from(&mut self, machine_now: Duration) {
        (self.since, self.machine_since) = (self.shared.machine_looks(), machine_now);
    }

    /// The machine's thread has nothing to do for so long of the wall clock, unless bytes come; `None` for ever. At full speed nobody waits
    /// for it.
    pub fn rest(&self, time: Option<Duration>) {
        self.shared.machine_rests(time.filter(|_| self.pace != Pace::Max));
    }

    /// How fast it goes.
    pub fn pace(&self) -> Pace {
        self.pace
    }

    /// Goes at another pace from here on.
    pub fn set_pace(&mut self, pace: Pace, machine_now: Duration) {
        if pace != self.pace {
            self.pace = pace;
            self.count_from(machine_now);
        }
    }

    /// The machine's time by the wall clock; the machine itself stands at `machine_now`. At full speed it has no time but its own.
    pub fn now(&mut self, machine_now: Duration) -> Duration {
        if self.pace == Pace::Max {
            return machine_now;
        }
        let now = self.machine_since + self.to_machine(self.shared.machine_looks() - self.since);
        if self.shared.is_shared() || now.saturating_sub(machine_now) <= self.to_machine(LONGEST_CATCH_UP) {
            return now;
        }
        self.count_from(machine_now);
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

impl Drop for Clock {
    fn drop(&mut self) {
        self.shared.machine_rests(None);
    }
}
