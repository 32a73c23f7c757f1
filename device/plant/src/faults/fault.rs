//! One fault: what goes wrong, which bytes it meets, and when.

use crate::world::WorldAction;
use std::time::Duration;

/// One fault and when it is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What goes wrong.
    pub effect: FaultEffect,
    /// Which bytes it meets; faults of the machine take no notice.
    pub direction: Direction,
    /// Which unit it meets, counted from 0; faults on the wire take no notice.
    pub unit: usize,
    /// When it begins, in the machine's time.
    pub from: Duration,
    /// When it ends; none means never.
    pub until: Option<Duration>,
}

/// What goes wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum FaultEffect {
    /// This share of the bytes is lost.
    Drop {
        /// 0 to 1.
        share: f64,
    },
    /// One bit of this share of the bytes is turned over.
    Corrupt {
        /// 0 to 1.
        share: f64,
    },
    /// This share of the bytes arrives twice.
    Duplicate {
        /// 0 to 1.
        share: f64,
    },
    /// This share of the bytes is late, and with each of them all that follow, since a wire keeps its order.
    Delay {
        /// How late.
        by: Duration,
        /// 0 to 1.
        share: f64,
    },
    /// All bytes are lost.
    Mute,
    /// Things done to the world one after the other, and undone at the end.
    World(Vec<WorldAction>),
}

/// Which bytes a fault meets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Those on their way to the controller.
    ToController,
    /// Those on their way to the host.
    ToHost,
    /// All.
    #[default]
    Both,
}

impl Fault {
    /// Whether the fault is there at a time.
    pub fn acts_at(&self, now: Duration) -> bool {
        now >= self.from && self.until.is_none_or(|until| now < until)
    }
}

impl Direction {
    /// Whether bytes going `to` are met.
    pub(super) fn meets(self, to: Self) -> bool {
        self == Self::Both || self == to
    }
}
