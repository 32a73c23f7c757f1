//! What became of an act that was cut short: each setting old, new, or neither.

use serde::Serialize;

use super::super::image::SettingsImage;
use super::super::row::Row;
use super::super::table::SettingsTable;
use super::super::value::SettingValue;
use super::journal::{Act, Journal};
use crate::messages::{AftermathMessage, settings};
use brushwork_values::{Listed, Message};

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
    pub fn headline(&self) -> Message {
        let (act, begun) = (self.act, self.begun.clone());
        let cut = match act {
            Act::Write => AftermathMessage::WriteCut { begun },
            Act::Save => AftermathMessage::SaveCut { begun },
            Act::Defaults => AftermathMessage::DefaultsCut { begun },
            Act::Reload => AftermathMessage::ReloadCut { begun },
            Act::Firmware => AftermathMessage::FirmwareCut { begun },
            Act::Trial => AftermathMessage::TrialCut { begun },
        };
        let state = match (self.is_all_new(), self.is_all_old(), act) {
            (true, true, Act::Trial) => AftermathMessage::AllAsBefore,
            (_, _, Act::Trial) => {
                let settings = settings(self.disturbed.len() + self.unread.len());
                AftermathMessage::NotAsBefore { settings }
            }
            (true, true, _) => AftermathMessage::NoneToChange,
            (true, _, Act::Save) => AftermathMessage::WorksWithThem { count: self.new.len() },
            (true, ..) if self.new.len() == 1 => AftermathMessage::TheOneNew,
            (_, true, _) if self.old.len() == 1 => AftermathMessage::TheOneOld,
            (true, ..) => AftermathMessage::AllNew { settings: settings(self.new.len()) },
            (_, true, _) => AftermathMessage::AllOld { settings: settings(self.old.len()) },
            _ => AftermathMessage::Mixed { counts: self.counts() },
        };
        AftermathMessage::Headline { cut: cut.into(), state: state.into() }.into()
    }

    fn counts(&self) -> Listed {
        let all = [&self.new, &self.old, &self.other, &self.disturbed, &self.unread];
        let [new, old, other, disturbed, unread] = all.map(Vec::len);
        let parts = [
            (new, AftermathMessage::New { count: new }),
            (old, AftermathMessage::Old { count: old }),
            (other, AftermathMessage::Neither { count: other }),
            (disturbed, AftermathMessage::Changed { count: disturbed }),
            (unread, AftermathMessage::NotRead { count: unread }),
        ];
        let counted = parts.into_iter().filter(|(count, _)| *count > 0);
        Listed(counted.map(|(_, message)| message.into()).collect())
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
    pub fn sentences(&self, table: &SettingsTable) -> Vec<Message> {
        let all = [&self.old, &self.other, &self.disturbed, &self.unread, &self.new];
        let held = all.into_iter().flatten();
        held.filter_map(|held| Some(held.sentence(table.row(&held.key)?))).collect()
    }
}

impl Held {
    /// "Motor 1: velocity P holds the old value 1.000; it was to become 2.500."
    pub fn sentence(&self, row: &Row) -> Message {
        let text = |value: Option<SettingValue>| {
            value.map_or_else(|| "unknown".to_owned(), |value| row.format(value))
        };
        let (title, old, new, now) = (row.title(), text(self.old), text(self.new), text(self.now));
        match (self.now, self.new) {
            (None, _) => AftermathMessage::Unread { title, new },
            (Some(_), new_value) if new_value.is_none_or(|new| self.old == Some(new)) => {
                AftermathMessage::WasToStay { title, old, now }
            }
            (Some(value), Some(new)) if value == new => AftermathMessage::HoldsNew { title, old, now },
            (Some(value), Some(_)) if self.old.is_none_or(|old| old == value) => {
                AftermathMessage::HoldsOld { title, new, now }
            }
            _ => AftermathMessage::HoldsNeither { title, old, new, now },
        }
        .into()
    }
}
