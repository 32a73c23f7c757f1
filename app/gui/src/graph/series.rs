//! One channel's values: a ring with a pyramid of minima and maxima above it.
//!
//! The ring keeps every value that was read, and how long before the time of its row that was: the signals of one sweep
//! are read one after the other. Level `n` of the pyramid holds one [`Extrema`] for each block of
//! 16ⁿ rows, so the extrema of any stretch of rows cost a few dozen steps, however long the stretch is.
//! One level also holds [`Moments`], for statistics of long stretches.
//! The times of rows are kept once for all channels, in [`super::history`]. What is drawn of this is decided in
//! [`super::trace`].

use std::ops::Range;

use super::moments::Moments;

/// A value that was not read in its row. The line passes over it.
pub const NOT_READ: f64 = f64::NAN;

/// A row where data was lost. The line breaks here.
pub const GAP: f64 = f64::from_bits(0x7ff8_0000_0067_6170);

/// Rows per block of the first level; each level has blocks this many times as long as the one below.
pub const FACTOR: u64 = 16;
const LEVELS: u32 = 3;

/// Rows in a block of [`Moments`].
const MOMENTS_BLOCK: u64 = FACTOR * FACTOR;

/// What one step of [`Series::behind_s`] stands for: far below what a serial link can tell apart.
const BEHIND_STEP_S: f64 = 20e-6;

/// No value is further behind its row than this.
pub const MOST_BEHIND_S: f64 = u16::MAX as f64 * BEHIND_STEP_S;

/// Rows in a block of the highest level. The capacity of a [`Series`] is a multiple of this.
pub const LONGEST_BLOCK: u64 = FACTOR.pow(LEVELS);

/// Whether `value` marks lost data rather than a value that was simply not read.
pub fn is_gap(value: f64) -> bool {
    value.to_bits() == GAP.to_bits()
}

/// The least and greatest value of a stretch of rows, and whether data was lost inside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrema {
    pub min: f64,
    pub max: f64,
    pub gap: bool,
}

impl Extrema {
    pub const NONE: Self = Self { min: f64::INFINITY, max: f64::NEG_INFINITY, gap: false };

    /// No value was read in the stretch.
    pub fn is_empty(&self) -> bool {
        self.min > self.max
    }

    /// Counts one value more.
    pub fn add(&mut self, value: f64) {
        self.merge(&Self { min: value, max: value, gap: is_gap(value) });
    }

    /// Comparing passes over NaN, which covers both marks, and is one instruction each.
    fn merge(&mut self, other: &Self) {
        self.min = if other.min < self.min { other.min } else { self.min };
        self.max = if other.max > self.max { other.max } else { self.max };
        self.gap |= other.gap;
    }
}

/// A ring of `f64` that grows to its capacity and then overwrites its oldest rows.
///
/// Rows are numbered from the first one ever pushed; the caller keeps the count.
#[derive(Clone, Debug)]
pub struct Ring<T> {
    items: Vec<T>,
    capacity: u64,
    /// The row in the first slot: the last multiple of the capacity that was written. It saves a division at each look.
    lap: u64,
}

impl<T: Copy> Ring<T> {
    /// A ring grows in this many steps: a short history stays small, and a long one is never doubled.
    const GROWTH_STEPS: u64 = 64;

    pub fn new(capacity: u64) -> Self {
        Self { items: Vec::new(), capacity, lap: 0 }
    }

    pub fn get(&self, row: u64) -> T {
        self.items[self.slot(row)]
    }

    /// Where a row still kept is.
    fn slot(&self, row: u64) -> usize {
        let in_this_lap = row >= self.lap;
        (if in_this_lap { row - self.lap } else { row + self.capacity - self.lap }) as usize
    }

    /// The items of `rows`, all of them still kept, in one piece or, across the end of the ring, in two.
    fn stretch(&self, rows: Range<u64>) -> (&[T], &[T]) {
        if rows.is_empty() {
            return (&[], &[]);
        }
        let length = (rows.end - rows.start) as usize;
        let start = self.slot(rows.start);
        let first = length.min(self.capacity as usize - start);
        (&self.items[start..start + first], &self.items[..length - first])
    }

    /// Writes `row`, which is either the next one ever or one still kept.
    pub fn set(&mut self, row: u64, item: T) {
        if row >= self.lap + self.capacity {
            self.lap = row - row % self.capacity;
        }
        let slot = self.slot(row);
        if slot < self.items.len() {
            self.items[slot] = item;
        } else {
            if self.items.len() == self.items.capacity() {
                let step = self.capacity.div_ceil(Self::GROWTH_STEPS);
                self.items.reserve_exact((self.capacity - slot as u64).min(step) as usize);
            }
            self.items.push(item);
        }
    }

    /// Items of all rows before `row` that are still kept, in an empty ring.
    fn fill(&mut self, row: u64, item: T) {
        debug_assert!(self.items.is_empty());
        let count = row.min(self.capacity) as usize;
        self.lap = row.saturating_sub(1) / self.capacity * self.capacity;
        self.items.reserve_exact(count);
        self.items.resize(count, item);
    }

    pub fn bytes(&self) -> usize {
        self.items.capacity() * size_of::<T>()
    }
}

/// The values of one channel.
#[derive(Clone, Debug)]
pub struct Series {
    values: Ring<f64>,
    behind: Ring<u16>,
    levels: Vec<Ring<Extrema>>,
    moments: Ring<Moments>,
}

impl Series {
    /// `capacity` is a multiple of [`LONGEST_BLOCK`].
    pub fn new(capacity: u64) -> Self {
        debug_assert_eq!(capacity % LONGEST_BLOCK, 0);
        let levels = (1..=LEVELS).map(|level| Ring::new(capacity / FACTOR.pow(level))).collect();
        let moments = Ring::new(capacity / MOMENTS_BLOCK);
        Self { values: Ring::new(capacity), behind: Ring::new(capacity), levels, moments }
    }

    /// No number was ever read: nothing is held.
    fn is_blank(&self) -> bool {
        self.values.items.is_empty()
    }

    /// Takes the rows before `row` as not read. A channel that is never read costs no memory until then.
    fn begin_at(&mut self, row: u64) {
        self.values.fill(row, NOT_READ);
        self.behind.fill(row, 0);
        let mut block_rows = 1;
        for level in &mut self.levels {
            block_rows *= FACTOR;
            level.fill(row.div_ceil(block_rows), Extrema::NONE);
        }
        self.moments.fill(row.div_ceil(MOMENTS_BLOCK), Moments::default());
    }

    /// Writes the next row, whose time is `row_s`; the value was read `behind_s` before that. An infinite value counts
    /// as not read.
    pub fn push(&mut self, row: u64, value: f64, row_s: f64, behind_s: f64) {
        let value = if value.is_infinite() { NOT_READ } else { value };
        if self.is_blank() {
            if value.is_nan() {
                return;
            }
            self.begin_at(row);
        }
        self.values.set(row, value);
        self.behind.set(row, (behind_s / BEHIND_STEP_S).round().clamp(0.0, f64::from(u16::MAX)) as u16);
        let starts_here = row.is_multiple_of(MOMENTS_BLOCK);
        let block = row / MOMENTS_BLOCK;
        let mut moments = if starts_here { Moments::default() } else { self.moments.get(block) };
        if !value.is_nan() {
            moments.add(row_s - self.behind_s(row), value);
        }
        self.moments.set(block, moments);
        let mut block_rows = 1;
        for level in &mut self.levels {
            block_rows *= FACTOR;
            let block = row / block_rows;
            let starts_here = row.is_multiple_of(block_rows);
            let mut extrema = if starts_here { Extrema::NONE } else { level.get(block) };
            extrema.add(value);
            level.set(block, extrema);
        }
    }

    /// The value of a row still kept: a number, [`NOT_READ`] or [`GAP`].
    pub fn value(&self, row: u64) -> f64 {
        if self.is_blank() { NOT_READ } else { self.values.get(row) }
    }

    /// How long before its row's time a value was read.
    pub fn behind_s(&self, row: u64) -> f64 {
        if self.is_blank() { 0.0 } else { f64::from(self.behind.get(row)) * BEHIND_STEP_S }
    }

    /// Merges the moments of whole blocks inside `rows`, and gives back what `rows` hold before and after those.
    pub fn merge_moments(&self, rows: Range<u64>, found: &mut Moments) -> (Range<u64>, Range<u64>) {
        if self.is_blank() {
            return (rows.end..rows.end, rows.end..rows.end);
        }
        let start = rows.start.div_ceil(MOMENTS_BLOCK);
        let end = rows.end / MOMENTS_BLOCK;
        if start >= end {
            return (rows.clone(), rows.end..rows.end);
        }
        (start..end).for_each(|block| found.merge(&self.moments.get(block)));
        (rows.start..start * MOMENTS_BLOCK, end * MOMENTS_BLOCK..rows.end)
    }

    /// Extrema of `rows`, all of them still kept.
    ///
    /// A block is used only when `rows` covers it whole, so neither the newest block (still filling) nor the
    /// oldest (partly overwritten) can leak rows that are outside.
    pub fn extrema(&self, rows: Range<u64>) -> Extrema {
        let mut found = Extrema::NONE;
        if self.is_blank() {
            return found;
        }
        let whole = whole_blocks(&rows);
        let (head, tail) = around(&rows, &whole);
        for part in [head, tail] {
            let (first, second) = self.values.stretch(part);
            first.iter().chain(second).for_each(|value| found.add(*value));
        }
        self.merge_blocks(0, whole, &mut found);
        found
    }

    /// Merges blocks of a level, by blocks of the levels above where those are covered whole.
    fn merge_blocks(&self, level: usize, blocks: Range<u64>, found: &mut Extrema) {
        let Some(ring) = self.levels.get(level) else { return };
        let is_highest = level + 1 == self.levels.len();
        let whole = if is_highest { 0..0 } else { whole_blocks(&blocks) };
        let (head, tail) = around(&blocks, &whole);
        for part in [head, tail] {
            let (first, second) = ring.stretch(part);
            first.iter().chain(second).for_each(|extrema| found.merge(extrema));
        }
        if !whole.is_empty() {
            self.merge_blocks(level + 1, whole, found);
        }
    }

    /// The newest number at or before `row`, at most `reach` rows back; none if data was lost in between.
    pub fn last_number(&self, rows: Range<u64>) -> Option<(u64, f64)> {
        if self.is_blank() {
            return None;
        }
        // Most often the last row has one.
        let last = rows.end.checked_sub(1).filter(|row| *row >= rows.start)?;
        let value = self.value(last);
        if !value.is_nan() {
            return Some((last, value));
        }
        let mut back = rows.rev().map(|row| (row, self.value(row)));
        back.find(|(_, value)| !value.is_nan() || is_gap(*value)).filter(|(_, value)| !value.is_nan())
    }

    /// The oldest number in `rows`; none if data was lost before it.
    pub fn first_number(&self, rows: Range<u64>) -> Option<(u64, f64)> {
        if self.is_blank() {
            return None;
        }
        let mut ahead = rows.map(|row| (row, self.value(row)));
        ahead.find(|(_, value)| !value.is_nan() || is_gap(*value)).filter(|(_, value)| !value.is_nan())
    }

    pub fn bytes(&self) -> usize {
        let levels = self.levels.iter().map(Ring::bytes).sum::<usize>();
        self.values.bytes() + self.behind.bytes() + levels + self.moments.bytes()
    }
}

/// The blocks of the next level that `items` cover whole; empty if there is none.
fn whole_blocks(items: &Range<u64>) -> Range<u64> {
    let start = items.start.div_ceil(FACTOR);
    start..(items.end / FACTOR).max(start)
}

/// What `items` hold before and after the `blocks` of the next level; all of it before where there is none.
fn around(items: &Range<u64>, blocks: &Range<u64>) -> (Range<u64>, Range<u64>) {
    if blocks.is_empty() {
        return (items.clone(), items.end..items.end);
    }
    (items.start..blocks.start * FACTOR, blocks.end * FACTOR..items.end)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn brute(values: &[f64], rows: Range<u64>) -> Extrema {
        let mut found = Extrema::NONE;
        values[rows.start as usize..rows.end as usize].iter().for_each(|value| found.add(*value));
        found
    }

    fn any_value() -> impl Strategy<Value = f64> {
        prop_oneof![8 => -1e9..1e9f64, 1 => Just(NOT_READ), 1 => Just(GAP)]
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED), failure_persistence: None, ..ProptestConfig::with_cases(48) })]
        #[test]
        fn extrema_of_any_stretch_equal_a_plain_walk(
            values in prop::collection::vec(any_value(), 1..6000),
            skip in 0u64..5000,
            cuts in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 20),
        ) {
            // Rows before `skip` were overwritten long ago: the ring has gone round at least once.
            let capacity = 2 * LONGEST_BLOCK;
            let mut series = Series::new(capacity);
            let all: Vec<f64> = (0..skip).map(|row| -(row as f64)).chain(values).collect();
            for (row, value) in all.iter().enumerate() {
                series.push(row as u64, *value, row as f64, 0.0);
            }
            let end = all.len() as u64;
            let kept = end.saturating_sub(capacity)..end;
            for (a, b) in cuts {
                let span = (kept.end - kept.start) as f64;
                let (a, b) = ((a * span) as u64 + kept.start, (b * span) as u64 + kept.start);
                let rows = a.min(b)..a.max(b) + 1;
                prop_assert_eq!(series.extrema(rows.clone()), brute(&all, rows));
            }
        }
    }

    #[test]
    fn a_single_spike_in_a_long_stretch_is_found() {
        let mut series = Series::new(16 * LONGEST_BLOCK);
        for row in 0..50_000 {
            series.push(row, if row == 31_234 { 9.0 } else { 0.5 }, row as f64, 0.0);
        }
        assert_eq!(series.extrema(0..50_000), Extrema { min: 0.5, max: 9.0, gap: false });
        assert_eq!(series.extrema(31_235..50_000).max, 0.5);
    }

    #[test]
    fn a_channel_that_is_read_late_holds_nothing_before() {
        for first in [0, 1, 255, 4096, 5000, 70_000] {
            let mut series = Series::new(2 * LONGEST_BLOCK);
            (0..first)
                .for_each(|row| series.push(row, if row % 7 == 0 { GAP } else { NOT_READ }, row as f64, 0.0));
            assert_eq!((series.bytes(), series.extrema(0..first)), (0, Extrema::NONE));
            (first..first + 500).for_each(|row| series.push(row, row as f64, row as f64, 0.001));
            let kept = (first + 500u64).saturating_sub(2 * LONGEST_BLOCK);
            assert_eq!(series.extrema(kept..first + 500).min, first as f64);
            assert_eq!(series.last_number(kept..first + 500), Some((first + 499, (first + 499) as f64)));
            assert!((series.behind_s(first + 3) - 0.001).abs() < 2e-5);
            let mut moments = Moments::default();
            let (head, tail) = series.merge_moments(kept..first + 500, &mut moments);
            let rest = head.chain(tail).filter(|row| !series.value(*row).is_nan()).count() as u64;
            assert_eq!(moments.count() + rest, 500);
        }
    }

    #[test]
    fn a_gap_is_told_apart_from_a_value_that_was_not_read() {
        let mut series = Series::new(LONGEST_BLOCK);
        for (row, value) in [1.0, NOT_READ, 3.0, GAP, NOT_READ].into_iter().enumerate() {
            series.push(row as u64, value, row as f64, 0.0);
        }
        assert_eq!(series.extrema(0..3), Extrema { min: 1.0, max: 3.0, gap: false });
        assert!(series.extrema(2..4).gap);
        assert!(series.extrema(4..5).is_empty());
        assert_eq!(series.last_number(0..3), Some((2, 3.0)));
        assert_eq!(series.last_number(0..5), None);
        assert_eq!(series.first_number(1..3), Some((2, 3.0)));
    }

    #[test]
    fn an_infinite_value_counts_as_not_read() {
        let mut series = Series::new(LONGEST_BLOCK);
        series.push(0, f64::INFINITY, 0.0, 0.0);
        assert_eq!(series.extrema(0..1), Extrema::NONE);
    }
}
