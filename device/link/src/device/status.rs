//! A controller's status at one moment, and the indicators of which its status word consists.

use brushwork_values::Severity;
use std::time::Duration;

/// One bit of a status word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Indicator {
    /// Name in programs: snake_case.
    pub key: &'static str,
    /// A few letters for the status row; empty for what stands nowhere in it. Indicators with the same letters share a place.
    pub short: &'static str,
    /// What it means when it is set, in words.
    pub title: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// The bit, as a mask; 0 where the unit's generation has none.
    pub mask: u32,
}

/// What a status word says at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusReport {
    /// The unit.
    pub address: u8,
    /// Host time of the reply.
    pub at: Duration,
    /// The word as it came.
    pub word: u32,
    /// What its bits mean in the unit's family and generation.
    pub indicators: &'static [Indicator],
    /// The unit's running time in ticks of its own, where it comes with the status (command 73).
    pub running_ticks: Option<u32>,
}

/// How one place of the status row stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceState {
    /// The status was not read yet.
    Unknown,
    /// The unit cannot tell.
    NotReported,
    /// Nothing is active.
    Clear,
    /// Something is, and so grave.
    Active(Severity),
}

/// One place of the status row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusPlace {
    /// A few letters.
    pub short: &'static str,
    /// In full.
    pub title: &'static str,
    /// How it stands.
    pub state: PlaceState,
}

/// The status row of a family whose places are its indicators, in their order.
#[must_use]
pub fn status_row(report: Option<&StatusReport>, indicators: &[Indicator]) -> Vec<StatusPlace> {
    let state = |indicator: &Indicator| match report {
        None => PlaceState::Unknown,
        Some(report) if report.word & indicator.mask == 0 => PlaceState::Clear,
        Some(_) => PlaceState::Active(indicator.severity),
    };
    let place = |indicator: &Indicator| StatusPlace {
        short: indicator.short,
        title: indicator.title,
        state: state(indicator),
    };
    indicators.iter().map(place).collect()
}

/// A running time that is smaller than the one before has begun anew, unless the one before was this close to its end.
const WRAP_MARGIN_TICKS: u32 = 1 << 24;

impl StatusReport {
    /// A report without a running time.
    #[must_use]
    pub fn new(address: u8, at: Duration, word: u32, indicators: &'static [Indicator]) -> Self {
        Self { address, at, word, indicators, running_ticks: None }
    }

    /// Whether the unit has started anew since an earlier report: it has forgotten every setting that was not saved.
    #[must_use]
    pub fn has_restarted_since(&self, earlier: &Self) -> bool {
        let (Some(now), Some(then)) = (self.running_ticks, earlier.running_ticks) else { return false };
        now < then && then < u32::MAX - WRAP_MARGIN_TICKS
    }

    /// The indicators that are set, in the order of their family.
    pub fn active(&self) -> impl Iterator<Item = &'static Indicator> {
        let word = self.word;
        self.indicators.iter().filter(move |indicator| word & indicator.mask != 0)
    }

    /// Whether an indicator is set.
    #[must_use]
    pub fn is_active(&self, key: &str) -> bool {
        self.active().any(|indicator| indicator.key == key)
    }

    /// What the controller stops motors for, in words. Any of it disarms.
    pub fn faults(&self) -> impl Iterator<Item = &'static str> {
        self.active()
            .filter(|indicator| indicator.severity == Severity::Error)
            .map(|indicator| indicator.title)
    }
}
