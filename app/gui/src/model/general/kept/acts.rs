//! What General Settings does with what is kept on this computer.

use brushwork_link::device::Identity;
use brushwork_link::settings::{Act, Aftermath, Keeper, Profile};
use brushwork_link::transport::PortInfo;

use super::{Came, Settle};
use crate::model::general::General;
use crate::model::general::sheet::Sheet;
use crate::model::general::unit_key::UnitKey;
use crate::model::link::Effect;
use crate::model::message::Gravity;
use brushwork_core::keep::{Backup, Keeping, UnitId, Wear};

impl General {
    /// Where backups and journals go from now on; the ports tell serial numbers.
    pub fn keep_in(&mut self, keeping: Keeping, ports: Vec<PortInfo>) {
        self.kept.keeping = Some(keeping);
        self.kept.ports = ports;
    }

    /// What keeps backup and journal of work on the unit that is looked at.
    pub fn keeper(&self) -> Option<Box<dyn Keeper>> {
        self.kept.keeper(self.current.as_ref()?, self.unit()?.firmware())
    }

    /// Looks up what is kept of the unit that is looked at from now on.
    pub(in crate::model::general) fn look_up(&mut self, key: UnitKey, identity: &Identity) {
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

    /// What a sheet shows of the disk, read once when it is opened.
    pub(in crate::model::general) fn refresh_for(&mut self, sheet: &Sheet) {
        let kept = &mut self.kept;
        let (Some(keeping), Some(unit)) = (&kept.keeping, &kept.unit) else { return };
        match sheet {
            Sheet::Backups | Sheet::Compare => kept.backups = keeping.store().backups(Some(unit)),
            Sheet::Save => kept.wear = keeping.store().wear(unit),
            _ => {}
        }
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
        self.kept.unfinished.iter().map(|open| open.aftermath(unit.table(), ram)).collect()
    }

    /// Settles what was cut short. The newest alone is finished or undone; those before were overtaken by it.
    pub fn settle(&mut self, how: Settle) {
        let Some(newest) = self.kept.unfinished.last().map(|open| open.journal.clone()) else { return };
        if how == Settle::Leave {
            self.close_unfinished();
            return self.close_sheet();
        }
        let Some(unit) = self.unit_mut() else { return };
        let Some(ram) = unit.ram().cloned() else { return };
        let remedy = newest.remedy(&ram, how == Settle::Undo);
        for (key, value) in remedy.iter() {
            let is_writable = unit.table().row(key).is_some_and(|row| unit.is_writable(row));
            if is_writable {
                unit.take(key, value);
            }
        }
        match (unit.edits().is_empty(), newest.act) {
            (false, _) => self.open(Sheet::Write),
            (true, Act::Save) => self.open(Sheet::Save),
            (true, _) => {
                self.close_unfinished();
                self.close_sheet();
            }
        }
    }

    fn close_unfinished(&mut self) {
        let Some(keeping) = &self.kept.keeping else { return };
        for open in self.kept.unfinished.drain(..) {
            // A journal that cannot be removed is told once more at the next connection.
            let _ = keeping.store().close_journal(&open.path);
        }
    }

    /// Takes in what work came to: what was cut short may be settled by it, or has to be told now.
    pub(in crate::model::general) fn note_came(&mut self, came: Option<Came>) -> Vec<Effect> {
        match came {
            Some(Came::Read) if self.has_unfinished() => return self.tell_unfinished(),
            Some(Came::Reloaded(image)) => {
                self.kept.eeprom = self.unit().and_then(|unit| unit.profile_of(image));
            }
            Some(Came::Saved { verified }) => {
                self.kept.eeprom = None;
                if verified {
                    self.close_unfinished();
                    self.kept.eeprom = self.unit().and_then(|unit| unit.profile_of(unit.ram()?.clone()));
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
            _ => {}
        }
        Vec::new()
    }

    fn tell_unfinished(&mut self) -> Vec<Effect> {
        let aftermaths = self.aftermaths();
        let Some(newest) = aftermaths.last() else { return Vec::new() };
        let text =
            format!("{} General Settings says which settings are old and which are new.", newest.headline());
        self.open(Sheet::Unfinished);
        vec![Effect::Say(Gravity::Error, text)]
    }
}
