//! What is read from the units in turn: the sweep that is under way, and what of a unit works.

use crate::device::channel::Sample;
use crate::device::controller::{PollItem, PollList};
use crate::device::status::StatusReport;
use std::collections::{HashSet, VecDeque};
use std::time::Duration;

/// A slow signal is read this often at most, so that fast sweeps have room for the fast ones.
const SLOW_INTERVAL: Duration = Duration::from_millis(20);
/// A reading that failed this often in a row while others worked is left out for a while.
const MISSES_TO_SUSPEND: u32 = 2;
/// For how long it is left out.
pub const SUSPENSION: Duration = Duration::from_secs(30);

/// The sweep that is under way, or when the next one is due.
pub struct Sweep {
    pub items: VecDeque<(usize, PollItem)>,
    pub sample: Sample,
    /// What was read of another unit so far.
    pub other: Option<Sample>,
    pub begun_at: Duration,
    pub next_at: Duration,
    pub other_unit: usize,
    pub sequence: u64,
    pub failures_in_a_row: u32,
    /// Silence before this does not count.
    pub restarted_at: Duration,
}

impl Sweep {
    /// Nothing under way; the first is due at `now`.
    pub fn new(now: Duration) -> Self {
        Self {
            items: VecDeque::new(),
            sample: Sample::new(0),
            other: None,
            begun_at: now,
            next_at: now,
            other_unit: 0,
            sequence: 0,
            failures_in_a_row: 0,
            restarted_at: now,
        }
    }

    /// Drops what is under way.
    pub fn abandon(&mut self) {
        self.items.clear();
        self.other = None;
    }
}

/// What is read from one unit, and what of it works.
pub struct Plan {
    pub list: PollList,
    next_slow: usize,
    next_of_all: usize,
    slow_due_at: Duration,
    misses: Vec<(PollItem, u32, Duration)>,
    read: HashSet<PollItem>,
    pub last_status: Option<StatusReport>,
    /// When its status was told last; none tells the next one, changed or not.
    pub status_told_at: Option<Duration>,
}

impl Plan {
    /// A plan for what a unit can be asked.
    pub fn new(list: PollList) -> Self {
        Self {
            list,
            next_slow: 0,
            next_of_all: 0,
            slow_due_at: Duration::ZERO,
            misses: Vec::new(),
            read: HashSet::new(),
            last_status: None,
            status_told_at: None,
        }
    }

    /// The items of a sweep that begins at `now`.
    pub fn sweep(&mut self, now: Duration, with_signals: bool) -> Vec<PollItem> {
        let signals = self.list.signals.filter(|_| with_signals);
        let wanted = self.list.fast.iter().copied().chain(signals);
        let mut items: Vec<_> = wanted.filter(|item| self.works(*item, now)).collect();
        if now >= self.slow_due_at {
            self.slow_due_at = now + SLOW_INTERVAL;
            items.extend(self.next_slow(now));
        }
        items
    }

    fn next_slow(&mut self, now: Duration) -> Option<PollItem> {
        let slow = &self.list.slow;
        let turn = (0..slow.len()).map(|step| (self.next_slow + step) % slow.len());
        let index = turn.into_iter().find(|index| self.works(slow[*index], now))?;
        self.next_slow = index + 1;
        Some(self.list.slow[index])
    }

    /// The next of all that it can be asked but the status, for a unit that is only looked at in passing.
    pub fn next_in_turn(&mut self, now: Duration) -> Option<PollItem> {
        let items: Vec<_> = self.list.fast.iter().chain(&self.list.slow).copied().collect();
        let turn = (0..items.len()).map(|step| (self.next_of_all + step) % items.len());
        let mut wanted =
            turn.filter(|index| Some(items[*index]) != self.list.status && self.works(items[*index], now));
        let index = wanted.next()?;
        self.next_of_all = index + 1;
        Some(items[index])
    }

    pub fn works(&self, item: PollItem, now: Duration) -> bool {
        !self
            .misses
            .iter()
            .any(|(missed, misses, until)| *missed == item && *misses >= MISSES_TO_SUSPEND && now < *until)
    }

    /// Notes a failed reading; whether it is left out from now on.
    pub fn missed(&mut self, item: PollItem, now: Duration) -> bool {
        let known = self.misses.iter().position(|(missed, ..)| *missed == item);
        let index = known.unwrap_or_else(|| {
            self.misses.push((item, 0, now));
            self.misses.len() - 1
        });
        let (_, misses, until) = &mut self.misses[index];
        *misses += 1;
        *until = now + SUSPENSION;
        *misses == MISSES_TO_SUSPEND
    }

    pub fn answered(&mut self, item: PollItem) {
        self.misses.retain(|(missed, ..)| *missed != item);
        self.read.insert(item);
    }

    /// Whether each of its signals has been read once, or is left out since it is not answered.
    pub fn is_all_read(&self, now: Duration) -> bool {
        let mut items = self.list.fast.iter().chain(&self.list.slow);
        items.all(|item| self.read.contains(item) || !self.works(*item, now))
    }
}
