//! How fast a served machine's time goes.
//!
//! Only the machine hurries: its clients, their time-outs and the stamps they give to what they read stay in real time. The controller's
//! own time-outs count its own time, so at ten times the pace a client has a tenth of the time to keep a motor alive.

use std::num::NonZeroU16;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// How fast a machine's time goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// So many times as fast as the wall clock.
    Times(NonZeroU16),
    /// As fast as it goes, until the machine wants real time ([`crate::machine::Machine::wants_real_time`]).
    Max,
}

impl Pace {
    /// Real time.
    pub const REAL: Self = Self::Times(NonZeroU16::MIN);
    /// Ten times as fast.
    pub const TEN: Self = Self::Times(NonZeroU16::new(10).expect("ten is not zero"));

    /// Name on a button: "×1", "×10", "Max".
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Times(times) => format!("×{times}"),
            Self::Max => "Max".to_owned(),
        }
    }
}

impl Default for Pace {
    fn default() -> Self {
        Self::REAL
    }
}

/// The pace, as the server's thread and whoever chooses it share it.
#[derive(Clone, Debug)]
pub struct SharedPace(Arc<AtomicU32>);

/// Stands for [`Pace::Max`], which no number of times reaches.
const MAX: u32 = u32::MAX;

impl SharedPace {
    /// The pace now.
    pub fn get(&self) -> Pace {
        let stored = self.0.load(Ordering::SeqCst);
        let times = u16::try_from(stored).ok().and_then(NonZeroU16::new);
        times.map_or(Pace::Max, Pace::Times)
    }

    /// Another pace from now on.
    pub fn set(&self, pace: Pace) {
        let stored = match pace {
            Pace::Times(times) => times.get().into(),
            Pace::Max => MAX,
        };
        self.0.store(stored, Ordering::SeqCst);
    }
}

impl Default for SharedPace {
    fn default() -> Self {
        let shared = Self(Arc::default());
        shared.set(Pace::default());
        shared
    }
}
