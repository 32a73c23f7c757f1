//! What became of an act that was cut short: each setting old, new, or neither.

use serde::Serialize;

use super::super::image::SettingsImage;
use super::super::row::Row;
use super::super::table::SettingsTable;
use super::super::value::SettingValue;
use super::journal::{Act, Journal};

/// A journal compared with what the controller holds now.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Aftermath {
    /// What was cut short.
    pub act: Act,
    /// When it began.
    pub begun: String,
    /// Settings that were to change and hold the new value.
    pub new: Vec<Held>,
    /// Settings that were to change and hold the old value.
    pub old: Vec<Held>,
    /// Settings that were to change and hold another value.
    pub other: Vec<Held>,
    /// Settings that were to stay as they were and did not.
    pub disturbed: Vec<Held>,
    /// Settings that were to change and could not be read now.
    pub unread: Vec<Held>,
}

/// One setting of an aftermath.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Held {
    /// The row.
    pub key: String,
    /// Its value before, where that is known.
    pub old: Option<SettingValue>,
    /// The value it was to get.
    pub new: Option<SettingValue>,
    /// Its value now.
    pub now: Option<SettingValue>,
}

impl Journal {
    /// What `now`, which was read from the controller, says of the act.
    pub fn aftermath(&self, table: &SettingsTable, now: &SettingsImage) -> Aftermath {
        let mut aftermath = Aftermath {
            act: self.act,
            begun: self.begun(),
            new: Vec::new(),
            old: Vec::new(),
            other: Vec::new(),
            disturbed: Vec::new(),
            unread: Vec::new(),
        };
        for row in table.rows() {
            let held = Held {
                key: row.key.clone(),
                old: self.before.settings.get(&row.key),
                new: self.wanted.settings.get(&row.key),
                now: now.get(&row.key),
            };
            if let Some(list) = aftermath.list_of(&held) {
                list.push(held);
            }
        }
        aftermath
    }

    /// The values that would finish the act, or with `undo` those that would take it back, of the settings that
    /// hold something else now.
    pub fn remedy(&self, now: &SettingsImage, undo: bool) -> SettingsImage {
        let source = if undo { &self.before } else { &self.wanted };
        let differs = |(key, value): &(&str, SettingValue)| now.get(key).is_some_and(|now| now != *value);
        source.settings.iter().filter(differs).map(|(key, value)| (key.to_owned(), value)).collect()
    }
}

impl Aftermath {
    fn list_of(&mut self, held: &Held) -> Option<&mut Vec<Held>> {
        match (held.old, held.new, held.now) {
            (Some(old), None, Some(now)) if now != old => Some(&mut self.disturbed),
            (_, None, _) => None,
            (Some(old), Some(new), _) if old == new && held.now == Some(new) => None,
            (_, Some(_), None) => Some(&mut self.unread),
            (_, Some(new), Some(now)) if now == new => Some(&mut self.new),
            (Some(old), Some(new), Some(_)) if old == new => Some(&mut self.disturbed),
            (Some(old), _, Some(now)) if now != old => Some(&mut self.other),
            _ => Some(&mut self.old),
        }
    }

    /// Whether the controller holds everything as it was to be.
    pub fn is_all_new(&self) -> bool {
        self.old.is_empty() && self.other.is_empty() && self.disturbed.is_empty() && self.unread.is_empty()
    }

    /// Whether the controller holds everything as it was before.
    pub fn is_all_old(&self) -> bool {
        self.new.is_empty() && self.other.is_empty() && self.disturbed.is_empty() && self.unread.is_empty()
    }

    /// What happened, in a sentence or two.
    pub fn headline(&self) -> String {
        let Self { act, begun, .. } = self;
        let cut = match act {
            Act::Write => format!("A write of settings begun {begun} was cut short."),
            Act::Save => format!("A save to EEPROM begun {begun} was cut short."),
            Act::Defaults => format!("Restoring the defaults, begun {begun}, was cut short."),
            Act::Reload => format!("Loading the settings from EEPROM, begun {begun}, was cut short."),
            Act::Firmware => format!("A firmware change begun {begun} was cut short."),
            Act::Trial => format!("A tuning run or a calibration begun {begun} was cut short."),
        };
        let state = match (self.is_all_new(), self.is_all_old(), act) {
            (true, true, Act::Trial) => "Every setting is as it was before.".to_owned(),
            (_, _, Act::Trial) => {
                format!("Not as before: {}.", settings(self.disturbed.len() + self.unread.len()))
            }
            (true, true, _) => "No setting had to change.".to_owned(),
            (true, _, Act::Save) => format!(
                "The controller works with the values that were to be saved ({} new). Whether its EEPROM has \
                 them is not known if it kept its power since: save again to be sure.",
                self.new.len()
            ),
            (true, ..) => format!("All {} hold the new value.", settings(self.new.len())),
            (_, true, _) => format!("All {} hold the old value.", settings(self.old.len())),
            _ => format!("The controller holds a mix: {}.", self.counts()),
        };
        format!("{cut} {state}")
    }

    fn counts(&self) -> String {
        let parts = [
            (self.new.len(), "new"),
            (self.old.len(), "old"),
            (self.other.len(), "neither old nor new"),
            (self.disturbed.len(), "changed though they were to stay"),
            (self.unread.len(), "not read"),
        ];
        let parts: Vec<String> = parts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        parts.join(", ")
    }

    /// Each list with its heading, empty ones left out.
    pub fn lists(&self) -> Vec<(&'static str, &[Held])> {
        let lists: [(&'static str, &[Held]); 5] = [
            ("These hold the old value", &self.old),
            ("These hold the new value", &self.new),
            ("These hold neither the old nor the new value", &self.other),
            ("These were to stay as they were and have changed", &self.disturbed),
            ("These could not be read now", &self.unread),
        ];
        lists.into_iter().filter(|(_, list)| !list.is_empty()).collect()
    }

    /// A sentence for each setting concerned, those with old values first.
    pub fn sentences(&self, table: &SettingsTable) -> Vec<String> {
        let all = [&self.old, &self.other, &self.disturbed, &self.unread, &self.new];
        let held = all.into_iter().flatten();
        held.filter_map(|held| Some(held.sentence(table.row(&held.key)?))).collect()
    }
}

impl Held {
    /// "Motor 1: velocity P holds the old value 1.000; it was to become 2.500."
    pub fn sentence(&self, row: &Row) -> String {
        let text = |value: Option<SettingValue>| {
            value.map_or_else(|| "unknown".to_owned(), |value| row.format(value))
        };
        let (title, old, new, now) = (row.title(), text(self.old), text(self.new), text(self.now));
        match (self.now, self.new) {
            (None, _) => format!("{title} could not be read; it was to become {new}."),
            (Some(_), new_value) if new_value.is_none_or(|new| self.old == Some(new)) => {
                format!("{title} was {old} and is {now}; it was to stay as it was.")
            }
            (Some(value), Some(new)) if value == new => {
                format!("{title} holds the new value {now}; it was {old} before.")
            }
            (Some(value), Some(_)) if self.old.is_none_or(|old| old == value) => {
                format!("{title} holds the old value {now}; it was to become {new}.")
            }
            _ => format!("{title} is {now}: neither the old value {old} nor the new one {new}."),
        }
    }
}

fn settings(count: usize) -> String {
    if count == 1 { "1 setting".to_owned() } else { format!("{count} settings") }
}
