//! What was worked out of a column before: a scrolling graph asks for nearly the same columns in each frame.
//!
//! A slot is known by its very rows, and a row never changes once it is written, so what is found here always holds.

use std::ops::Range;

use super::series::{Extrema, Series};

/// What there is in a stretch of rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    pub extrema: Extrema,
    /// The newest value; none if there is none, or if data was lost after it.
    pub last: Option<f64>,
}

/// What was found for the columns of one channel.
#[derive(Clone, Debug, Default)]
pub struct Memo {
    /// A power of two of them, or none.
    slots: Vec<Slot>,
}

#[derive(Clone, Debug)]
struct Slot {
    rows: Range<u64>,
    seen: Seen,
}

impl Seen {
    fn in_rows(series: &Series, rows: Range<u64>) -> Self {
        let last = series.last_number(rows.clone()).map(|(_, value)| value);
        Self { extrema: series.extrema(rows), last }
    }
}

impl Memo {
    /// Makes room for `columns` columns side by side.
    pub fn make_room(&mut self, columns: usize) {
        if self.slots.len() < columns {
            let nothing = Slot { rows: 0..0, seen: Seen { extrema: Extrema::NONE, last: None } };
            self.slots = vec![nothing; columns.next_power_of_two()];
        }
    }

    /// What there is in `rows` of `series`, which is the same at each call. Columns that lie side by side do not
    /// displace each other.
    pub fn look(&mut self, series: &Series, column: i64, rows: Range<u64>) -> Seen {
        // Their number is a power of two: the lowest bits are the rest of a division by it, below zero too.
        let slot = column as usize & self.slots.len().wrapping_sub(1);
        let Some(slot) = self.slots.get_mut(slot) else {
            return Seen::in_rows(series, rows);
        };
        if slot.rows != rows {
            *slot = Slot { seen: Seen::in_rows(series, rows.clone()), rows };
        }
        slot.seen
    }

    /// Memory held, in bytes.
    pub fn bytes(&self) -> usize {
        self.slots.capacity() * size_of::<Slot>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::series::LONGEST_BLOCK;
    use super::*;

    #[test]
    fn a_column_that_gained_a_row_or_lost_its_oldest_is_worked_out_anew() {
        let mut series = Series::new(LONGEST_BLOCK);
        (0..100).for_each(|row| series.push(row, row as f64, row as f64, 0.0));
        let mut memo = Memo::default();
        memo.make_room(8);
        let mut look = |rows: Range<u64>| {
            let seen = memo.look(&series, -3, rows.clone());
            assert_eq!(seen, Seen::in_rows(&series, rows));
            (seen.extrema.min, seen.extrema.max, seen.last)
        };
        assert_eq!(look(10..20), (10.0, 19.0, Some(19.0)));
        assert_eq!(look(10..20), (10.0, 19.0, Some(19.0)));
        assert_eq!(look(10..21), (10.0, 20.0, Some(20.0)));
        assert_eq!(look(12..21), (12.0, 20.0, Some(20.0)));
    }

    #[test]
    fn without_room_it_remembers_nothing_and_is_right_all_the_same() {
        let mut series = Series::new(LONGEST_BLOCK);
        (0..40).for_each(|row| series.push(row, -(row as f64), row as f64, 0.0));
        let found = Memo::default().look(&series, 5, 0..40).extrema;
        assert_eq!((found.min, found.max), (-39.0, 0.0));
    }
}
