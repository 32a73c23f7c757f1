//! Any two copies of the settings side by side, and taking over from one of them.

use std::collections::BTreeMap;

use brushwork_link::Message;
use brushwork_link::settings::{Difference, Group, Profile, SettingsImage};

mod acts;

/// One of the copies of a controller's settings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// What the controller works with.
    #[default]
    Ram,
    /// What its EEPROM held when that was proven last.
    Eeprom,
    /// The open profile.
    Profile,
    /// What restoring the defaults would give, as far as known.
    Default,
    /// The backup of that name.
    Backup(String),
    /// Another unit of the open links, by its name.
    Unit(String),
}

/// Which two copies are set side by side.
#[derive(Debug)]
pub struct Comparing {
    pub left: Side,
    pub right: Side,
    /// Backups that were opened, by name, as they are for this controller.
    opened: BTreeMap<String, Result<Fitted, Message>>,
    /// The other units of the open links whose settings are known, by name, as they were when the sheet was opened.
    pub others: BTreeMap<String, Profile>,
}

#[derive(Clone, Debug)]
struct Fitted {
    image: SettingsImage,
    changes: Vec<Message>,
}

impl Default for Comparing {
    fn default() -> Self {
        Self { left: Side::Ram, right: Side::Default, opened: BTreeMap::new(), others: BTreeMap::new() }
    }
}

/// Two copies side by side.
#[derive(Debug, Default)]
pub struct Comparison {
    /// What differs, in screen order: left, then right.
    pub groups: Vec<(Group, Vec<Difference>)>,
    /// What had to be changed of a side to compare it here.
    pub notes: Vec<Message>,
    /// Why nothing can be compared.
    pub missing: Vec<Message>,
}

/// What is taken over from the right side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Take {
    All,
    Group(Group),
    Key(String),
}

impl Comparison {
    pub fn count(&self) -> usize {
        self.groups.iter().map(|(_, differences)| differences.len()).sum()
    }
}
