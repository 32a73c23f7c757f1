//! Breakpoints: on a line, perhaps with a condition, perhaps only from the n-th time on.

use super::lines::LineTable;
use super::reason::Reason;
use super::watch::Watch;
use crate::vm::{Host, Machine};

/// A breakpoint as it is wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakpoint {
    /// The line; where that has no code, the next one that has.
    pub line: u32,
    /// Whether it stops anything.
    pub enabled: bool,
    /// It stops only when this is not zero.
    pub condition: Option<Watch>,
    /// It stops from this time on that it is reached (with its condition holding); 0 and 1 are the first.
    pub from_hit: u64,
}

/// A breakpoint and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BreakpointState {
    /// As it is wanted.
    pub wanted: Breakpoint,
    /// The line it lies on; none where no code follows, or no program is known.
    pub line: Option<u32>,
    /// How often it was reached, with its condition holding, since the start.
    pub hits: u64,
}

pub(super) enum Verdict {
    GoOn,
    Stop(Reason),
}

impl Breakpoint {
    /// One that always stops.
    #[must_use]
    pub fn at(line: u32) -> Self {
        Self { line, enabled: true, condition: None, from_hit: 0 }
    }
}

impl BreakpointState {
    pub(super) fn new(wanted: Breakpoint, lines: &LineTable) -> Self {
        let line = lines.next_with_code(wanted.line);
        Self { wanted, line, hits: 0 }
    }

    /// Finds its place in a program that begins.
    pub(super) fn settle(&mut self, lines: &LineTable) {
        self.line = lines.next_with_code(self.wanted.line);
        self.hits = 0;
    }

    pub(super) fn is_on(&self, line: u32) -> bool {
        self.wanted.enabled && self.line == Some(line)
    }

    /// The script is about to run its line.
    pub(super) fn reached(&mut self, machine: &mut Machine, host: &mut dyn Host) -> Verdict {
        let line = self.line.unwrap_or(self.wanted.line);
        let condition = self.wanted.condition.as_ref();
        match condition.map_or(Ok(true), |condition| condition.holds(machine, host)) {
            Ok(false) => return Verdict::GoOn,
            Err(why) => return Verdict::Stop(Reason::BadCondition { line, why }),
            Ok(true) => self.hits += 1,
        }
        if self.hits < self.wanted.from_hit {
            return Verdict::GoOn;
        }
        let condition = condition.map(|condition| condition.text.clone());
        Verdict::Stop(Reason::Breakpoint { line, hits: self.hits, condition })
    }
}
