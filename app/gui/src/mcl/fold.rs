//! Which lines are folded away, and which row of the screen a line stands in.

use super::buffer::Edit;

/// A closed fold: its first line stays in view, the others up to `last` do not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fold {
    pub head: usize,
    pub last: usize,
}

/// The closed folds of a program: in order, none within or across another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folds {
    closed: Vec<Fold>,
}

impl Folds {
    pub fn is_closed(&self, head: usize) -> bool {
        self.closed.iter().any(|fold| fold.head == head)
    }

    pub fn is_empty(&self) -> bool {
        self.closed.is_empty()
    }

    /// Closes a fold; those within it are forgotten.
    pub fn close(&mut self, head: usize, last: usize) {
        if last <= head || self.closed.iter().any(|fold| fold.head < head && head <= fold.last) {
            return;
        }
        self.closed.retain(|fold| fold.head < head || fold.head > last);
        self.closed.push(Fold { head, last });
        self.closed.sort_unstable_by_key(|fold| fold.head);
    }

    /// Opens the fold that begins at a line.
    pub fn open(&mut self, head: usize) {
        self.closed.retain(|fold| fold.head != head);
    }

    pub fn open_all(&mut self) {
        self.closed.clear();
    }

    /// Opens whatever hides a line.
    pub fn show(&mut self, line: usize) {
        self.closed.retain(|fold| line <= fold.head || line > fold.last);
    }

    /// How many rows so many lines take.
    pub fn rows(&self, lines: usize) -> usize {
        lines - self.closed.iter().map(|fold| fold.last - fold.head).sum::<usize>().min(lines)
    }

    /// The row, from 0, in which a line stands; one that is hidden stands in that of its fold.
    pub fn row_of(&self, line: usize) -> usize {
        let hidden = self.closed.iter().filter(|fold| fold.head < line);
        line - hidden.map(|fold| fold.last.min(line) - fold.head).sum::<usize>()
    }

    /// The line that stands in a row.
    pub fn line_at(&self, row: usize) -> usize {
        let mut line = row;
        for fold in &self.closed {
            if fold.head >= line {
                break;
            }
            line += fold.last - fold.head;
        }
        line
    }

    /// The line so many rows further on, within `lines` lines.
    pub fn step(&self, line: usize, rows: isize, lines: usize) -> usize {
        let row = self.row_of(line).saturating_add_signed(rows);
        self.line_at(row.min(self.rows(lines).saturating_sub(1)))
    }

    /// Follows an edit; a fold that is touched below its first line opens.
    pub fn follow(&mut self, edit: &Edit) {
        let (removed, inserted) = edit.line_change();
        let touched = edit.line..=edit.line + removed;
        self.closed.retain(|fold| {
            let inside = *touched.end() > fold.head && *touched.start() <= fold.last;
            let breaks_head = fold.head == edit.line && inserted > 0 && !edit.at_line_start;
            !inside && !breaks_head
        });
        for fold in &mut self.closed {
            if fold.head > edit.line || fold.head == edit.line && inserted > 0 {
                fold.head = fold.head - removed + inserted;
                fold.last = fold.last - removed + inserted;
            }
        }
    }

    /// Keeps only folds that there still are: `last_of` tells where the block that begins at a line ends.
    pub fn keep(&mut self, last_of: impl Fn(usize) -> Option<usize>) {
        self.closed.retain_mut(|fold| match last_of(fold.head) {
            Some(last) if last > fold.head => {
                fold.last = last;
                true
            }
            _ => false,
        });
        let mut end = 0;
        self.closed.retain(|fold| {
            let apart = end == 0 || fold.head > end;
            end = end.max(fold.last);
            apart
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folds() -> Folds {
        let mut folds = Folds::default();
        folds.close(2, 4);
        folds.close(7, 8);
        folds
    }

    #[test]
    fn rows_and_lines_agree_both_ways() {
        let folds = folds();
        assert_eq!(folds.rows(10), 7);
        let lines: Vec<usize> = (0..7).map(|row| folds.line_at(row)).collect();
        assert_eq!(lines, [0, 1, 2, 5, 6, 7, 9]);
        for (row, line) in lines.iter().enumerate() {
            assert_eq!(folds.row_of(*line), row, "line {line}");
        }
        assert_eq!((folds.row_of(3), folds.row_of(4), folds.row_of(8)), (2, 2, 5));
        assert_eq!((folds.step(2, 1, 10), folds.step(5, -1, 10), folds.step(9, 5, 10)), (5, 2, 9));
    }

    #[test]
    fn a_fold_around_others_takes_them_in_and_one_inside_is_not_made() {
        let mut folds = folds();
        folds.close(1, 9);
        assert_eq!(folds.closed, [Fold { head: 1, last: 9 }]);
        folds.close(3, 5);
        assert_eq!(folds.closed.len(), 1);
        folds.show(4);
        assert!(folds.is_empty());
    }

    #[test]
    fn folds_move_with_lines_before_them_and_open_when_their_inside_changes() {
        let edit = |at_line: usize, removed: &str, inserted: &str| Edit {
            at: 0,
            removed: removed.into(),
            inserted: inserted.into(),
            line: at_line,
            at_line_start: true,
        };
        let mut moved = folds();
        moved.follow(&edit(0, "", "x\n"));
        assert_eq!(moved.closed, [Fold { head: 3, last: 5 }, Fold { head: 8, last: 9 }]);
        let mut opened = folds();
        opened.follow(&edit(3, "a", "b"));
        assert_eq!(opened.closed, [Fold { head: 7, last: 8 }]);
        let mut same = folds();
        same.follow(&edit(2, "a", "b"));
        assert_eq!(same, folds());
    }
}
