//! The table of one controller: its rows in screen order, found by key.

use std::collections::HashMap;

use super::image::SettingsImage;
use super::row::{Access, Group, Row};
use super::subject::Subject;
use super::value::SettingValue;
use crate::messages::PlanMessage;
use brushwork_values::Message;

/// The settings of one controller.
#[derive(Clone, Debug)]
pub struct SettingsTable {
    subject: Subject,
    rows: Vec<Row>,
    by_key: HashMap<String, usize>,
}

impl SettingsTable {
    /// The table of a controller.
    pub fn new(subject: Subject) -> Self {
        let rows = subject.family().settings().rows(&subject);
        let by_key = rows.iter().enumerate().map(|(index, row)| (row.key.clone(), index)).collect();
        Self { subject, rows, by_key }
    }

    /// The controller the table was made for.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Every row, in screen order.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The row with that key.
    pub fn row(&self, key: &str) -> Option<&Row> {
        self.by_key.get(key).map(|index| &self.rows[*index])
    }

    /// The rows of one group, in screen order.
    pub fn group(&self, group: Group) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.group == group)
    }

    /// What a value means besides its text: the pin behind an encoder input number, as far as we assume it.
    pub fn note(&self, row: &Row, value: SettingValue) -> Option<Message> {
        self.subject.family().settings().note(self, row, value)
    }

    /// The same table with one row that may be written on a real controller too, whatever is guessed of it: its owner has said so.
    ///
    /// # Errors
    /// A sentence: there is no such row, or no command that writes it.
    pub fn at_owners_word(mut self, key: &str) -> Result<Self, Message> {
        let Some(index) = self.by_key.get(key) else {
            let (model, generation) = (self.subject.model.name, self.subject.generation);
            return Err(PlanMessage::NoSuchSetting { model, generation, key: key.to_owned() }.into());
        };
        let row = &mut self.rows[*index];
        if row.sink().is_none() {
            let reason = row.locked(false).unwrap_or_default();
            return Err(PlanMessage::NoCommandFor { title: row.title(), reason }.into());
        }
        row.access = Access::ReadWrite;
        Ok(self)
    }

    /// Every row at its default.
    pub fn default_image(&self) -> SettingsImage {
        self.rows.iter().map(|row| (row.key.clone(), row.default)).collect()
    }
}
