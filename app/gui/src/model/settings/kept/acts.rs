//! What the settings of a unit have to do with what is kept on this computer.

use brushwork_link::settings::{Act, Aftermath, Journal};
use brushwork_link::{Identity, Keeper, PortInfo, Profile};

use super::Came;
use crate::model::settings::unit_key::UnitKey;
use crate::model::settings::units::Settings;
use brushwork_core::keep::{Backup, Keeping, UnitId, Wear, aftermaths};

impl Settings {
    /// Where backups and journals go from now on; the ports tell serial numbers.
    pub fn keep_in(&mut self, keeping: Keeping, ports: Vec<PortInfo>) {
        self.kept.keeping = Some(keeping);
        self.kept.ports = ports;
    }

    /// What keeps backup and journal of work on the unit that is looked at.
    pub fn keeper(&self) -> Option<Box<dyn Keeper>> {
        self.keeper_of(self.current()?)
    }

    /// The same of any unit that was met.
    pub fn keeper_of(&self, key: &UnitKey) -> Option<Box<dyn Keeper>> {
        self.kept.keeper(key, self.firmware_of(key)?)
    }

    /// Looks up what is kept of the unit that is looked at from now on.
    pub(in crate::model::settings) fn look_up(&mut self, key: UnitKey, identity: &Identity) {
        let kept = &mut self.kept;
        let unit = UnitId::new(identity, &kept.ports);
        kept.units.insert(key, unit.clone());
        kept.unit = Some(unit);
        if let (Some(keeping), Some(unit)) = (&kept.keeping, &kept.unit) {
            kept.unfinished = keeping.store().open_journals(unit).0;
            kept.eeprom = keeping.store().eeprom(unit);
            kept.wear = keeping.store().wear(unit);
            kept.backups = keeping.store().backups(Some(unit));
        }
    }

    /// What stands on the disk by now: backups, and how often the EEPROM was written.
    pub fn refresh_kept(&mut self) {
        let kept = &mut self.kept;
        let (Some(keeping), Some(unit)) = (&kept.keeping, &kept.unit) else { return };
        kept.backups = keeping.store().backups(Some(unit));
        kept.wear = keeping.store().wear(unit);
    }

    /// The unit's backups, newest first.
    pub fn backups(&self) -> &[Backup] {
        &self.kept.backups
    }

    /// Where the backups are.
    pub fn backup_folder(&self) -> Option<String> {
        Some(self.kept.keeping.as_ref()?.store().root()?.display().to_string())
    }

    /// EEPROM as it was proven last, with the date.
    pub fn known_eeprom(&self) -> Option<&Profile> {
        self.kept.eeprom.as_ref()
    }

    /// How often the EEPROM was written, and how far that count can be trusted.
    pub fn wear(&self) -> (&Wear, &'static str) {
        (&self.kept.wear, self.kept.unit.as_ref().map_or("", UnitId::limits))
    }

    /// Whether something that was begun on this unit is not known to have ended.
    pub fn has_unfinished(&self) -> bool {
        !self.kept.unfinished.is_empty()
    }

    /// What was cut short, oldest first, as the settings read last tell.
    pub fn aftermaths(&self) -> Vec<Aftermath> {
        let Some(unit) = self.unit() else { return Vec::new() };
        let Some(ram) = unit.ram() else { return Vec::new() };
        aftermaths(&self.kept.unfinished, unit.table(), ram)
    }

    /// What was begun last of what was cut short.
    pub fn newest_unfinished(&self) -> Option<Journal> {
        self.kept.unfinished.last().map(|open| open.journal.clone())
    }

    /// What was cut short is settled, or was told.
    pub fn close_unfinished(&mut self) {
        let Some(keeping) = &self.kept.keeping else { return };
        // A journal that cannot be removed is told once more at the next connection.
        let _ = keeping.store().close_journals(&std::mem::take(&mut self.kept.unfinished));
    }

    /// Takes in what work came to: what was cut short may be settled by it, or has to be told now, which is true then.
    pub(in crate::model::settings) fn note_came(&mut self, came: Option<Came>) -> bool {
        match came {
            Some(Came::Read) => return self.has_unfinished() && !self.aftermaths().is_empty(),
            Some(Came::Reloaded(image)) => {
                self.kept.eeprom = self.unit().map(|unit| unit.profile_of(image));
            }
            Some(Came::Saved { verified }) => {
                self.kept.eeprom = None;
                if verified {
                    self.close_unfinished();
                    self.kept.eeprom = self.unit().and_then(|unit| unit.profile(false));
                }
            }
            Some(Came::Written) => {
                let settled = |aftermath: &Aftermath| {
                    aftermath.act != Act::Save && (aftermath.is_all_new() || aftermath.is_all_old())
                };
                if self.aftermaths().last().is_some_and(settled) {
                    self.close_unfinished();
                }
            }
            Some(Came::Other) | None => {}
        }
        false
    }
}
