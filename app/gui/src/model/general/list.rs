//! Which settings the list shows.

use brushwork_link::settings::Row;

use super::section::Section;
use crate::model::{General, UnitSettings};

impl General {
    /// Whether rows are picked from all sections.
    pub fn is_filtered(&self) -> bool {
        self.only_changed || !self.search.trim().is_empty()
    }

    /// The keys of a unit's rows to show, in screen order.
    pub fn shown_of(&self, unit: &UnitSettings) -> Vec<String> {
        let words: Vec<String> = self.search.split_whitespace().map(str::to_lowercase).collect();
        let is_shown = |row: &&Row| {
            if self.is_filtered() {
                (!self.only_changed || unit.is_edited(&row.key)) && matches(row, &words)
            } else {
                Section::of(row) == self.section
            }
        };
        unit.table().rows().iter().filter(is_shown).map(|row| row.key.clone()).collect()
    }
}

/// Whether a row has every word in its name, its key or its group.
fn matches(row: &Row, words: &[String]) -> bool {
    if words.is_empty() {
        return true;
    }
    let text = format!("{} {} {}", row.title(), row.key, row.group.label()).to_lowercase();
    words.iter().all(|word| text.contains(word))
}
