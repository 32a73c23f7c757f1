//! The steps in which a unit's edits were made, to go back and forth in.

use std::collections::BTreeSet;

use brushwork_link::settings::SettingsImage;

/// Steps that can be gone back.
const MOST: usize = 200;

/// What is wanted of a unit: its edits, and which of them were read from a unit once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wishes {
    pub edits: SettingsImage,
    pub taken: BTreeSet<String>,
}

/// The steps, newest last.
#[derive(Debug, Default)]
pub struct Steps {
    /// The revision of the last look.
    pub looked_at: u64,
    now: Wishes,
    before: Vec<Wishes>,
    after: Vec<Wishes>,
}

impl Steps {
    /// None yet.
    pub fn new(revision: u64, now: Wishes) -> Self {
        Self { looked_at: revision, now, before: Vec::new(), after: Vec::new() }
    }

    /// Whether these are others than at the last look.
    pub fn differs(&self, wishes: &Wishes) -> bool {
        self.now != *wishes
    }

    /// Takes note of a step, if it is one.
    pub fn note(&mut self, revision: u64, wishes: Wishes) {
        self.looked_at = revision;
        if self.differs(&wishes) {
            self.before.push(std::mem::replace(&mut self.now, wishes));
            self.after.clear();
            if self.before.len() > MOST {
                self.before.remove(0);
            }
        }
    }

    pub fn can_undo(&self) -> bool {
        !self.before.is_empty()
    }

    pub fn can_redo(&self) -> bool {
        !self.after.is_empty()
    }

    /// What is wanted one step earlier, or later again.
    pub fn go(&mut self, again: bool) -> Option<Wishes> {
        let (from, to) =
            if again { (&mut self.after, &mut self.before) } else { (&mut self.before, &mut self.after) };
        let wanted = from.pop()?;
        to.push(std::mem::replace(&mut self.now, wanted.clone()));
        Some(wanted)
    }
}
