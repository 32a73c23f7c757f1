//! What is drawn of a channel: at most about two points per pixel column, and never a spike lost.
//!
//! A column that holds more than two samples is drawn as its minimum and maximum. Columns lie on whole multiples
//! of their width since the start of time, not on the edge of the view, so a scrolling line does not shimmer.

use std::ops::Range;

use super::history::History;
use super::memo::{Memo, Seen};
use super::series::{FACTOR, is_gap};

/// How far a line looks past the edge of the view for the sample that carries it out of the picture.
const REACH_ROWS: u64 = 4096;

/// Columns of more blocks than this begin at whole blocks, so that none has to look at single rows: a zoom costs less,
/// in which every column is new.
const ROUNDED_FROM_BLOCKS: u64 = 4;

/// A row may stand this part of a column beside its place for it.
const MOST_ASIDE: f64 = 0.3;

/// The beginning of the block that `row` is in, unless that is no longer kept or `row` is the end of all.
fn rounded(row: u64, kept: &Range<u64>) -> u64 {
    if row >= kept.end { row } else { (row - row % FACTOR).max(kept.start) }
}

/// The first row at or after each of some rising times. Rows come at a steady pace most of the time, so each is looked
/// for as far behind the one before as that was behind its own.
fn rows_at(history: &History, times_s: impl Iterator<Item = f64>) -> Vec<u64> {
    let mut found: Vec<u64> = Vec::with_capacity(times_s.size_hint().0);
    for time_s in times_s {
        found.push(match found.as_slice() {
            [] => history.row_at(time_s),
            [only] => history.row_from(time_s, *only, 0),
            [.., before, last] => history.row_from(time_s, *last, last - before),
        });
    }
    found
}

/// A stretch of time and the pixel columns it is drawn in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The left edge.
    pub start_s: f64,
    /// The right edge.
    pub end_s: f64,
    /// Pixels across.
    pub columns: usize,
}

/// The rows of each pixel column. Made once per frame and shared by all channels.
#[derive(Clone, Debug)]
pub struct Columns {
    /// Row bounds: column `i` holds the rows `bounds[i]..bounds[i + 1]`.
    bounds: Vec<u64>,
    first_column: f64,
    column_s: f64,
    kept: Range<u64>,
}

impl Columns {
    pub fn new(history: &History, view: &View) -> Self {
        let column_s = (view.end_s - view.start_s) / view.columns.max(1) as f64;
        let kept = history.rows();
        if !column_s.is_finite() || column_s <= 0.0 {
            return Self { bounds: vec![kept.end], first_column: 0.0, column_s: 1.0, kept };
        }
        let first_column = (view.start_s / column_s).floor();
        let starts_s = (0..=view.columns + 1).map(|i| (first_column + i as f64) * column_s);
        let mut bounds = rows_at(history, starts_s.clone());
        let rows = bounds[bounds.len() - 1] - bounds[0];
        if rows > bounds.len() as u64 * ROUNDED_FROM_BLOCKS * FACTOR {
            let mut before = 0;
            for (bound, start_s) in bounds.iter_mut().zip(starts_s) {
                let block = rounded(*bound, &kept);
                // Rows are not evenly spread in time: a pause may lie between the block's beginning and the column's.
                let is_near = block < kept.end && start_s - history.time_s(block) <= column_s * MOST_ASIDE;
                if block >= before && is_near {
                    *bound = block;
                }
                before = *bound;
            }
        }
        Self { bounds, first_column, column_s, kept }
    }

    fn middle_s(&self, column: usize) -> f64 {
        (self.first_column + column as f64 + 0.5) * self.column_s
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.bounds.len() - 1
    }

    /// A column's number since the start of time, which scrolling does not change.
    fn number(&self, column: usize) -> i64 {
        (self.first_column + column as f64) as i64
    }

    fn before(&self) -> Range<u64> {
        let first = self.bounds[0];
        first.saturating_sub(REACH_ROWS).max(self.kept.start)..first
    }

    fn after(&self) -> Range<u64> {
        let end = self.bounds[self.bounds.len() - 1];
        end..(end + REACH_ROWS).min(self.kept.end)
    }
}

/// Unbroken lines, each point a time in seconds and a value; between two of them data was lost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    pub lines: Vec<Vec<[f64; 2]>>,
    /// The value that the line has come to, while it is not broken.
    carried: Option<f64>,
}

impl Trace {
    /// The lines of one channel in the columns of a view, with what is remembered of that channel of that history.
    pub fn remembering(history: &History, channel: usize, columns: &Columns, memo: &mut Memo) -> Self {
        let series = history.channel(channel);
        let mut trace = Self::default();
        // A line that breaks needs no more than one that does not.
        trace.lines.push(Vec::with_capacity(2 * columns.count() + 2));
        if let Some((row, value)) = series.last_number(columns.before()) {
            trace.point(history.read_s(channel, row), value);
        }
        for (column, bounds) in columns.bounds.windows(2).enumerate() {
            let rows = bounds[0]..bounds[1];
            if rows.end - rows.start <= 2 {
                rows.for_each(|row| trace.sample(history.read_s(channel, row), series.value(row)));
            } else {
                trace.column(columns.middle_s(column), memo.look(series, columns.number(column), rows));
            }
        }
        if let Some((row, value)) = series.first_number(columns.after()) {
            trace.point(history.read_s(channel, row), value);
        }
        trace.lines.retain(|line| !line.is_empty());
        trace
    }

    /// Minimum and maximum of many samples. The last value before them counts too, so that a column always reaches
    /// the one before it, however steep the line.
    fn column(&mut self, time_s: f64, seen: Seen) {
        let mut extrema = seen.extrema;
        if !extrema.is_empty() {
            if let Some(before) = self.carried {
                extrema.add(before);
            }
            self.point(time_s, extrema.min);
            self.point(time_s, extrema.max);
            self.carried = seen.last;
        }
        if extrema.gap {
            let after_the_gap = self.carried;
            self.break_line();
            self.carried = after_the_gap.filter(|_| !extrema.is_empty());
        }
    }

    fn point(&mut self, time_s: f64, value: f64) {
        self.carried = Some(value);
        match self.lines.last_mut() {
            Some(line) => line.push([time_s, value]),
            None => self.lines.push(vec![[time_s, value]]),
        }
    }

    fn sample(&mut self, time_s: f64, value: f64) {
        if is_gap(value) {
            self.break_line();
        } else if !value.is_nan() {
            self.point(time_s, value);
        }
    }

    fn break_line(&mut self) {
        self.carried = None;
        if self.lines.last().is_some_and(|line| !line.is_empty()) {
            self.lines.push(Vec::new());
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    impl Trace {
        /// The lines of one channel, with nothing remembered.
        fn of(history: &History, channel: usize, columns: &Columns) -> Self {
            Self::remembering(history, channel, columns, &mut Memo::default())
        }

        /// Points of all lines together.
        fn points(&self) -> usize {
            self.lines.iter().map(Vec::len).sum()
        }
    }
    use crate::graph::series::{GAP, NOT_READ};

    /// Irregular times: mostly 10 ms apart, at times a long pause.
    fn samples() -> impl Strategy<Value = Vec<(f64, f64)>> {
        let step = prop_oneof![20 => 0.001..0.02f64, 1 => 0.5..5.0f64];
        let value = prop_oneof![20 => -100.0..100.0f64, 2 => Just(NOT_READ), 1 => Just(GAP)];
        prop::collection::vec((step, value), 1..4000)
    }

    fn filled(samples: &[(f64, f64)]) -> (History, Vec<(f64, f64)>) {
        let mut history = History::new(1, 8192);
        let mut time_s = 0.0;
        let mut timed = Vec::new();
        for (step, value) in samples {
            time_s += step;
            history.push(time_s, &[*value]);
            timed.push((time_s, *value));
        }
        (history, timed)
    }

    /// The values drawn within one column's width of `time_s`.
    fn drawn_near(trace: &Trace, time_s: f64, column_s: f64) -> (f64, f64) {
        let near = trace.lines.iter().flatten().filter(|point| (point[0] - time_s).abs() <= column_s);
        near.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
            (low.min(point[1]), high.max(point[1]))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED), failure_persistence: None, ..ProptestConfig::with_cases(64) })]
        #[test]
        fn no_spike_is_lost_and_points_stay_near_two_per_column(
            samples in samples(),
            from in 0.0..1.0f64,
            to in 0.0..1.0f64,
            columns in 1usize..400,
        ) {
            let (history, timed) = filled(&samples);
            let end = timed[timed.len() - 1].0;
            let view = View { start_s: from.min(to) * end, end_s: from.max(to) * end + 0.01, columns };
            let trace = Trace::of(&history, 0, &Columns::new(&history, &view));
            prop_assert!(trace.points() <= 2 * (columns + 1) + 2);
            let column_s = (view.end_s - view.start_s) / columns as f64;
            for (time_s, value) in timed {
                if value.is_nan() || time_s < view.start_s || time_s > view.end_s {
                    continue;
                }
                let (low, high) = drawn_near(&trace, time_s, column_s);
                prop_assert!(low <= value && value <= high, "{value} at {time_s}: drawn {low}..{high}");
            }
        }

        #[test]
        fn every_point_drawn_is_a_value_that_was_read(samples in samples(), columns in 1usize..200) {
            let (history, timed) = filled(&samples);
            let view = View { start_s: 0.0, end_s: timed[timed.len() - 1].0, columns };
            let trace = Trace::of(&history, 0, &Columns::new(&history, &view));
            for point in trace.lines.iter().flatten() {
                prop_assert!(timed.iter().any(|(_, value)| *value == point[1]));
            }
        }
    }

    fn line_of(values: &[f64], columns: usize) -> Trace {
        let mut history = History::new(1, 100);
        for (row, value) in values.iter().enumerate() {
            history.push(row as f64, &[*value]);
        }
        let view = View { start_s: 0.0, end_s: values.len() as f64, columns };
        Trace::of(&history, 0, &Columns::new(&history, &view))
    }

    #[test]
    fn a_gap_breaks_the_line_and_a_value_not_read_does_not() {
        let trace = line_of(&[1.0, NOT_READ, 2.0, GAP, 3.0, 4.0], 100);
        assert_eq!(trace.lines, [vec![[0.0, 1.0], [2.0, 2.0]], vec![[4.0, 3.0], [5.0, 4.0]]]);
    }

    #[test]
    fn a_steep_line_has_no_holes_between_its_columns() {
        let mut history = History::new(1, 8192);
        for row in 0..1000u32 {
            history.push(f64::from(row), &[f64::from(row) * 100.0]);
        }
        let view = View { start_s: 0.0, end_s: 1000.0, columns: 50 };
        let trace = Trace::of(&history, 0, &Columns::new(&history, &view));
        for pair in trace.lines[0].chunks_exact(2).collect::<Vec<_>>().windows(2) {
            let (highest_before, lowest) = (pair[0][1][1], pair[1][0][1]);
            assert!(lowest <= highest_before, "{lowest} above {highest_before}");
        }
    }

    #[test]
    fn the_line_is_carried_past_both_edges_of_the_view() {
        let mut history = History::new(1, 100);
        for row in 0..10 {
            history.push(f64::from(row), &[f64::from(row)]);
        }
        let view = View { start_s: 4.2, end_s: 4.8, columns: 100 };
        let trace = Trace::of(&history, 0, &Columns::new(&history, &view));
        assert_eq!(trace.lines, [vec![[4.0, 4.0], [5.0, 5.0]]]);
    }

    #[test]
    fn scrolling_by_a_fraction_of_a_column_keeps_the_points_where_they_were() {
        let mut history = History::new(1, 8192);
        for row in 0..8000u32 {
            history.push(f64::from(row) * 0.01, &[f64::from(row * 7919 % 101)]);
        }
        let lines = |start_s: f64| {
            let view = View { start_s, end_s: start_s + 60.0, columns: 200 };
            Trace::of(&history, 0, &Columns::new(&history, &view)).lines[0].clone()
        };
        let (before, after) = (lines(10.0), lines(10.1));
        assert_eq!(before[10..300], after[10..300]);
    }

    #[test]
    fn an_empty_history_and_an_empty_view_draw_nothing() {
        let history = History::new(1, 100);
        let view = View { start_s: 0.0, end_s: 0.0, columns: 0 };
        assert_eq!(Trace::of(&history, 0, &Columns::new(&history, &view)), Trace::default());
        let view = View { start_s: -10.0, end_s: 0.0, columns: 10 };
        assert_eq!(Trace::of(&history, 0, &Columns::new(&history, &view)), Trace::default());
    }
}
