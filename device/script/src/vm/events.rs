//! What a machine knows of events, what its subroutines keep, and when a clock ticks.

use std::collections::BTreeMap;
use std::time::Duration;

/// Which events there are, as a machine knows them.
#[derive(Clone, Debug, Default)]
pub struct Events {
    /// First instruction of the handler of each event that has one.
    pub handlers: BTreeMap<u32, u32>,
    /// Events that were raised and whose handler has not run yet, a bit each.
    pub raised: u32,
    pub are_let_in: bool,
    pub in_handler: bool,
}

/// Bytes that a subroutine found in memory and puts back.
#[derive(Clone, Debug)]
pub struct Kept {
    /// How deep the calls were.
    pub depth: usize,
    pub first: u32,
    pub bytes: Vec<u8>,
}

const NANOSECONDS: u128 = 1_000_000_000;

/// How often a clock of so many ticks a second has ticked, which is at 0 when the power comes.
#[must_use]
pub fn ticks(now: Duration, per_second: u32) -> u64 {
    u64::try_from(now.as_nanos() * u128::from(per_second) / NANOSECONDS).unwrap_or(u64::MAX)
}

/// When a clock of so many ticks a second will have ticked so often again: what counts ticks ends with one.
#[must_use]
pub fn after_ticks(now: Duration, count: u32, per_second: u32) -> Duration {
    let per_second = per_second.max(1);
    let tick = u128::from(ticks(now, per_second)) + u128::from(count);
    let nanoseconds = (tick * NANOSECONDS).div_ceil(u128::from(per_second));
    now.max(Duration::from_nanos(u64::try_from(nanoseconds).unwrap_or(u64::MAX)))
}
