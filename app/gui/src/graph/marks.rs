//! Marks on the time axis: commands that were sent, stops, arming, notes of the user.

use std::collections::VecDeque;

/// Marks that are kept; older ones go.
const MOST: usize = 4096;

/// What a mark stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// A motor was told to move.
    Drive,
    /// Motors were stopped.
    Stop,
    /// A screen was armed or disarmed.
    Arm,
    /// A setting was changed.
    Setting,
    /// Written by the user, or something else worth knowing.
    Note,
}

impl MarkKind {
    pub const ALL: [Self; 5] = [Self::Drive, Self::Stop, Self::Arm, Self::Setting, Self::Note];

    /// Name in files, and at the flag.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Stop => "stop",
            Self::Arm => "arm",
            Self::Setting => "setting",
            Self::Note => "note",
        }
    }

    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
    }
}

/// Something that happened at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub at_s: f64,
    pub kind: MarkKind,
    /// A few words.
    pub text: String,
}

/// The marks of a track, oldest first.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    kept: VecDeque<Mark>,
}

impl Marks {
    /// Adds a mark where its time belongs.
    pub fn push(&mut self, mark: Mark) {
        let after = self.kept.iter().rev().take_while(|kept| kept.at_s > mark.at_s).count();
        self.kept.insert(self.kept.len() - after, mark);
        if self.kept.len() > MOST {
            self.kept.pop_front();
        }
    }

    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &Mark> {
        self.kept.iter()
    }

    /// Those from `from_s` to `to_s`.
    pub fn between(&self, from_s: f64, to_s: f64) -> impl DoubleEndedIterator<Item = &Mark> {
        let start = self.kept.partition_point(|mark| mark.at_s < from_s);
        let end = self.kept.partition_point(|mark| mark.at_s <= to_s);
        self.kept.range(start..end.max(start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(at_s: f64) -> Mark {
        Mark { at_s, kind: MarkKind::Drive, text: String::new() }
    }

    #[test]
    fn a_mark_that_comes_late_stands_where_its_time_belongs() {
        let mut marks = Marks::default();
        [1.0, 3.0, 2.0, 2.0].into_iter().for_each(|at_s| marks.push(mark(at_s)));
        let times: Vec<f64> = marks.iter().map(|mark| mark.at_s).collect();
        assert_eq!(times, [1.0, 2.0, 2.0, 3.0]);
        assert_eq!(marks.between(1.5, 2.0).count(), 2);
        assert_eq!(marks.between(5.0, 4.0).count(), 0);
    }

    #[test]
    fn the_oldest_marks_go_and_words_lead_back_to_kinds() {
        let mut marks = Marks::default();
        (0..5000).for_each(|at| marks.push(mark(f64::from(at))));
        assert_eq!(marks.iter().next().unwrap().at_s, 5000.0 - MOST as f64);
        for kind in MarkKind::ALL {
            assert_eq!(MarkKind::of_word(kind.word()), Some(kind));
        }
    }
}
