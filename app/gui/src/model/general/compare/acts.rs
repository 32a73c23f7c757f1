//! What General Settings does to set two copies side by side.

use std::collections::BTreeMap;

use brushwork_core::messages::SideMessage;
use brushwork_link::Message;
use brushwork_link::messages::ProfileMessage;
use brushwork_link::settings::{CopiedMotor, Profile, SettingsImage, copy_motor, diff};

use super::{Comparing, Comparison, Fitted, Side, Take};
use crate::messages::{CompareMessage, NameMessage};
use crate::model::general::GeneralView;
use brushwork_core::keep::Backup;
use brushwork_core::settings::for_all::keep_addresses;
use brushwork_core::settings::{eeprom_title, fitted, known_defaults};

impl GeneralView<'_> {
    /// What a side is called.
    pub fn side_title(&self, side: &Side) -> String {
        match side {
            Side::Ram => "Controller (RAM)".to_owned(),
            Side::Eeprom => {
                self.settings.known_eeprom().map_or("EEPROM (not known)".to_owned(), eeprom_title)
            }
            Side::Profile => match &self.profiles.opened {
                Some(opened) => NameMessage::Profile { name: opened.name.clone() }.to_string(),
                None => "Profile (none is open)".to_owned(),
            },
            Side::Default => "Defaults".to_owned(),
            Side::Backup(name) => {
                let backup = self.settings.backups().iter().find(|backup| backup.name == *name);
                NameMessage::Backup { title: backup.map_or_else(|| name.clone(), Backup::title) }.to_string()
            }
            Side::Unit(name) => name.clone(),
        }
    }

    /// Every side that there is.
    pub fn sides(&self) -> Vec<Side> {
        let mut sides = vec![Side::Ram, Side::Eeprom, Side::Profile, Side::Default];
        sides.extend(self.comparing.others.keys().cloned().map(Side::Unit));
        sides.extend(self.settings.backups().iter().map(|backup| Side::Backup(backup.name.clone())));
        sides
    }

    /// Sets a side; a backup is read now.
    pub fn compare_with(&mut self, left: Side, right: Side) {
        for side in [&left, &right] {
            if let Side::Backup(name) = side {
                let fitted = self.fit_backup(name);
                self.comparing.opened.insert(name.clone(), fitted);
            }
        }
        self.comparing.left = left;
        self.comparing.right = right;
    }

    fn fit_backup(&self, name: &str) -> Result<Fitted, Message> {
        let backup = self.settings.backups().iter().find(|backup| backup.name == name);
        let Some((backup, unit)) = backup.zip(self.unit()) else {
            return Err(CompareMessage::BackupGone.into());
        };
        let opened = backup.open().map_err(Message::error)?;
        let corrected: Vec<Message> = opened.corrected.iter().cloned().map(Message::error).collect();
        let upgrades = opened.upgraded.len();
        let (profile, mut changes) = fitted(opened, unit.table());
        changes.splice(upgrades..upgrades, corrected);
        Ok(Fitted { image: profile.settings, changes })
    }

    /// Takes in which other units there are to be compared with. One that is gone is compared with no more.
    pub fn set_others(&mut self, others: BTreeMap<String, Profile>) {
        let gone = |side: &Side| matches!(side, Side::Unit(name) if !others.contains_key(name));
        let usual = Comparing::default();
        if gone(&self.comparing.left) {
            self.comparing.left = usual.left;
        }
        if gone(&self.comparing.right) {
            self.comparing.right = usual.right;
        }
        self.comparing.others = others;
    }

    /// The two sides that are chosen, side by side.
    pub fn comparison(&self) -> Comparison {
        let Some(unit) = self.unit() else { return Comparison::default() };
        let mut comparison = Comparison::default();
        let mut images = Vec::new();
        for side in [&self.comparing.left, &self.comparing.right] {
            match self.image_of(side) {
                Ok(fitted) => {
                    comparison.notes.extend(fitted.changes);
                    images.push(fitted.image);
                }
                Err(why) => comparison.missing.push(why),
            }
        }
        let [left, right] = &images[..] else { return comparison };
        let mut one_sided: Vec<&str> = Vec::new();
        for difference in diff(unit.table(), left, right) {
            let Some(row) = unit.table().row(&difference.key) else { continue };
            // What one side does not have cannot differ.
            if difference.left.is_none() || difference.right.is_none() {
                if difference.right.is_some() && !one_sided.contains(&row.group.label()) {
                    one_sided.push(row.group.label());
                }
                continue;
            }
            match comparison.groups.last_mut().filter(|(group, _)| *group == row.group) {
                Some((_, list)) => list.push(difference),
                None => comparison.groups.push((row.group, vec![difference])),
            }
        }
        if !one_sided.is_empty() {
            let groups = one_sided.join(", ");
            comparison.notes.push(ProfileMessage::OneSided { groups }.into());
        }
        comparison
    }

    fn image_of(&self, side: &Side) -> Result<Fitted, Message> {
        let plain = |image: &SettingsImage| Fitted { image: image.clone(), changes: Vec::new() };
        let unit = self.unit().ok_or(CompareMessage::NoUnit)?;
        match side {
            Side::Ram => unit.ram().map(plain).ok_or(CompareMessage::NotRead.into()),
            Side::Eeprom => match (unit.eeprom(), self.settings.known_eeprom()) {
                (Some(image), _) => Ok(plain(image)),
                (None, Some(known)) => Ok(plain(&known.fitted_to(unit.table()).profile.settings)),
                (None, None) => Err(SideMessage::EepromUnknown.into()),
            },
            Side::Profile => {
                let opened = self.profiles.opened.as_ref();
                opened.map(|opened| plain(&opened.profile.settings)).ok_or(CompareMessage::NoProfile.into())
            }
            Side::Default => {
                let image = match unit.ram() {
                    Some(ram) => known_defaults(unit.table(), ram),
                    None => unit.table().default_image(),
                };
                Ok(plain(&image))
            }
            Side::Backup(name) => {
                let opened = self.comparing.opened.get(name).cloned();
                opened.unwrap_or_else(|| Err(CompareMessage::BackupNotOpened.into()))
            }
            Side::Unit(name) => {
                let other = self.comparing.others.get(name).ok_or(CompareMessage::UnitGone)?;
                let (mut fitted, table) = (other.fitted_to(unit.table()), unit.table());
                let kept = keep_addresses(table, &mut fitted.profile.settings);
                fitted.changes.extend(kept);
                Ok(Fitted { image: fitted.profile.settings, changes: fitted.changes })
            }
        }
    }

    /// Makes values of the right side changes here, to be written like any others. What cannot be written stays.
    pub fn take_over(&mut self, what: &Take) {
        let comparison = self.comparison();
        let Some(unit) = self.unit_mut() else { return };
        for (group, differences) in comparison.groups {
            for difference in differences {
                let is_wanted = match what {
                    Take::All => true,
                    Take::Group(wanted) => *wanted == group,
                    Take::Key(wanted) => *wanted == difference.key,
                };
                let is_writable = unit.table().row(&difference.key).is_some_and(|row| unit.is_writable(row));
                if let (true, true, Some(value)) = (is_wanted, is_writable, difference.right) {
                    unit.take(&difference.key, value);
                }
            }
        }
    }

    /// Brings back a backup: its values become changes here, shown in the write sheet.
    pub fn restore(&mut self, name: &str) -> bool {
        self.compare_with(Side::Ram, Side::Backup(name.to_owned()));
        if !self.comparison().missing.is_empty() {
            return false;
        }
        self.take_over(&Take::All);
        true
    }

    /// What copying a motor to the other one would change.
    pub fn motor_copy(&self) -> Option<CopiedMotor> {
        let unit = self.unit()?;
        let mut image = unit.ram()?.clone();
        image.merge(unit.edits());
        Some(copy_motor(unit.table(), &image, self.motor_to_copy(), unit.is_simulated))
    }

    /// The motor that is copied: 1 or 2.
    pub fn motor_to_copy(&self) -> usize {
        if self.copied_motor == 2 { 2 } else { 1 }
    }

    /// Makes one motor's settings changes of the other's.
    pub fn copy_motor(&mut self) {
        let Some(copied) = self.motor_copy() else { return };
        let Some(unit) = self.unit_mut() else { return };
        for (key, value) in copied.wanted.iter() {
            unit.set(key, value);
        }
    }
}
