//! The copies that exist of a controller's settings: RAM, EEPROM, profile and defaults.

use serde::Serialize;

use super::difference::{Difference, diff};
use super::image::SettingsImage;
use super::table::SettingsTable;

brushwork_values::listed! {
    /// One of the copies of a controller's settings.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Copy {
        /// What the controller works with now, as last read.
        Ram "controller (RAM)",
        /// What the controller will work with after a power cycle, as last known.
        Eeprom "controller (EEPROM as last known)",
        /// What the open profile holds.
        Profile "profile",
        /// What "restore defaults" would give.
        Default "defaults",
    }
    /// The copy's name.
    fn label;
}

/// The copies of one controller's settings, told apart. What is not known stays `None`; nothing is guessed:
/// EEPROM is known only after a reload or a save that were confirmed.
#[derive(Clone, Debug, Default)]
pub struct Copies {
    ram: Option<SettingsImage>,
    eeprom: Option<SettingsImage>,
    profile: Option<SettingsImage>,
}

impl Copies {
    /// A copy, if known. The defaults come from the table.
    pub fn get(&self, copy: Copy, table: &SettingsTable) -> Option<SettingsImage> {
        match copy {
            Copy::Ram => self.ram.clone(),
            Copy::Eeprom => self.eeprom.clone(),
            Copy::Profile => self.profile.clone(),
            Copy::Default => Some(table.default_image()),
        }
    }

    /// The controller's RAM as last read, if it was.
    pub fn ram(&self) -> Option<&SettingsImage> {
        self.ram.as_ref()
    }

    /// The controller's EEPROM as last known, if it is.
    pub fn eeprom(&self) -> Option<&SettingsImage> {
        self.eeprom.as_ref()
    }

    /// The controller's EEPROM was read in a way that leaves open what RAM holds.
    pub fn note_eeprom(&mut self, image: SettingsImage) {
        self.eeprom = Some(image);
    }

    /// The controller may work with anything: it was out of reach.
    pub fn forget_ram(&mut self) {
        self.ram = None;
    }

    /// The controller's RAM was read.
    pub fn note_ram(&mut self, image: SettingsImage) {
        self.ram = Some(image);
    }

    /// The controller's RAM was loaded from its EEPROM and then read: both are known.
    pub fn note_reloaded(&mut self, image: SettingsImage) {
        self.eeprom = Some(image.clone());
        self.ram = Some(image);
    }

    /// The controller's EEPROM may hold anything: a save was not confirmed, or another unit is connected.
    pub fn forget_eeprom(&mut self) {
        self.eeprom = None;
    }

    /// A profile was opened (`None`: closed).
    pub fn note_profile(&mut self, image: Option<SettingsImage>) {
        self.profile = image;
    }

    /// What differs between two copies; `None` when one of them is not known.
    pub fn diff(&self, table: &SettingsTable, left: Copy, right: Copy) -> Option<Vec<Difference>> {
        Some(diff(table, &self.get(left, table)?, &self.get(right, table)?))
    }
}
