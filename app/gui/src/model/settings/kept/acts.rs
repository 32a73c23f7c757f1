//! What the settings of a unit have to do with what is kept on this computer.

use std::sync::Arc;

use brushwork_link::settings::{Act, Aftermath, Journal};
use brushwork_link::{Identity, Keeper, Message, PortInfo, Profile};

use super::Came;
use crate::messages::PathMessage;
use crate::model::settings::unit_key::UnitKey;
use crate::model::settings::units::Settings;
use brushwork_core::keep::{Backup, Keeping, UnitId, Wear, aftermaths};
use brushwork_core::settings::raw::told_of_cut_off;

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
        kept.keep_notes();
        let unit = UnitId::new(identity, &kept.ports);
        kept.units.insert(key, unit.clone());
        kept.unit = Some(unit.clone());
        kept.cut_off_is_told = false;
        let Some(keeping) = kept.keeping.clone() else { return };
        let (unfinished, damaged) = keeping.store().open_journals(&unit);
        kept.unfinished = unfinished;
        kept.damaged = damaged.into_iter().map(Arc::new).collect();
        kept.untold.extend(kept.damaged.iter().cloned().map(Message::error));
        kept.eeprom = kept.told(keeping.store().eeprom(&unit)).flatten();
        kept.look_at_files();
        kept.untold.extend(kept.wear_fault.clone());
        kept.noted = kept.told(keeping.store().notes(&unit)).unwrap_or_default();
        kept.noted_kept = kept.noted.clone();
    }

    /// What stands on the disk by now: backups, and how often the EEPROM was written.
    pub fn refresh_kept(&mut self) {
        self.kept.look_at_files();
    }

    /// Keeps a copy of the settings of the unit that is looked at, because somebody asked for it.
    ///
    /// # Errors
    /// They were not read, or the disk does not take them.
    pub fn back_up(&mut self) -> Result<Message, Message> {
        let read = self.unit().and_then(|unit| unit.profile(false));
        let (Some(profile), Some(keeping), Some(unit)) = (read, &self.kept.keeping, &self.kept.unit) else {
            return Err(PathMessage::BackupNotRead.into());
        };
        keeping.store().back_up_now(unit, &profile).map_err(Message::error)?;
        self.kept.look_at_files();
        Ok(PathMessage::BackupMade.into())
    }

    /// What could not be kept or read since the last look, in sentences.
    pub fn take_kept_faults(&mut self) -> Vec<Message> {
        let ended = self.kept.keeping.as_ref().map(Keeping::take_faults).unwrap_or_default();
        self.kept.untold.extend(ended.into_iter().map(Message::error));
        std::mem::take(&mut self.kept.untold)
    }

    /// Numbers that were written raw and cut off before they were read back, a sentence each, once the settings are read.
    pub fn take_cut_off(&mut self) -> Vec<Message> {
        if self.kept.cut_off_is_told {
            return Vec::new();
        }
        let read = self.unit().and_then(|unit| Some((unit.table().clone(), unit.ram()?.clone())));
        let (Some((table, ram)), Some(unit), Some(keeping)) = (read, &self.kept.unit, &self.kept.keeping)
        else {
            return Vec::new();
        };
        let told = told_of_cut_off(keeping.store(), unit, &table, &ram);
        self.kept.cut_off_is_told = true;
        self.kept.told(told).unwrap_or_default()
    }

    /// Journals of the unit that cannot be read, each in a sentence.
    pub fn damaged_journals(&self) -> impl Iterator<Item = Message> + '_ {
        self.kept.damaged.iter().cloned().map(Message::error)
    }

    /// The unit's backups, newest first.
    pub fn backups(&self) -> &[Backup] {
        &self.kept.backups
    }

    /// What is noted of the unit that is looked at, to be typed in.
    pub fn notes_mut(&mut self) -> &mut String {
        &mut self.kept.noted
    }

    /// Keeps what was typed, if it is new.
    pub fn keep_notes(&mut self) {
        self.kept.keep_notes();
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
    ///
    /// # Errors
    /// A sentence: its file cannot be read.
    pub fn wear(&self) -> Result<(&Wear, &'static str), &Message> {
        if let Some(fault) = &self.kept.wear_fault {
            return Err(fault);
        }
        Ok((&self.kept.wear, self.kept.unit.as_ref().map_or("", UnitId::limits)))
    }

    /// Whether something that was begun on this unit is not known to have ended.
    pub fn has_unfinished(&self) -> bool {
        !self.kept.unfinished.is_empty() || !self.kept.damaged.is_empty()
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

    /// Puts journals that cannot be read aside: they were told.
    pub fn put_damaged_aside(&mut self) {
        let Some(keeping) = &self.kept.keeping else { return };
        // One that cannot be put aside is told once more at the next connection.
        let damaged = std::mem::take(&mut self.kept.damaged);
        let _ = keeping.store().put_damaged_journals_aside(damaged.iter().map(|fault| &**fault));
    }

    /// Takes in what work came to: what was cut short may be settled by it, or has to be told now, which is true then.
    pub(in crate::model::settings) fn note_came(&mut self, came: Option<Came>) -> bool {
        if matches!(came, Some(Came::Saved { .. } | Came::Written)) {
            self.kept.look_at_files();
        }
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
