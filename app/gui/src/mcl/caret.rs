//! Where the caret stands and what is selected.

use std::ops::Range;

/// A caret and the other end of what is selected; both the same when nothing is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Caret {
    pub anchor: usize,
    pub head: usize,
    /// The column, in cells, to which moves up and down keep.
    pub goal: Option<usize>,
}

impl Caret {
    pub const fn at(place: usize) -> Self {
        Self { anchor: place, head: place, goal: None }
    }

    pub const fn selecting(anchor: usize, head: usize) -> Self {
        Self { anchor, head, goal: None }
    }

    pub fn range(self) -> Range<usize> {
        self.anchor.min(self.head)..self.anchor.max(self.head)
    }

    pub fn is_empty(self) -> bool {
        self.anchor == self.head
    }

    /// Goes to a place; the other end stays when the selection is extended.
    #[must_use]
    pub fn to(self, place: usize, extend: bool) -> Self {
        if extend { Self { head: place, goal: None, ..self } } else { Self::at(place) }
    }
}
