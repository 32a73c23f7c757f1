//! Backups: one profile for each act that changes settings, named by number, date and reason, kept within bounds.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use brushwork_link::files::{Disk, Files};
use brushwork_link::settings::{Act, OpenedProfile, Profile, ReadReport, Strictness};
use brushwork_link::{Identity, clock};

use super::sequence;
use super::store::{KeepError, Record, Store};
use super::unit::{UnitId, profile_of};

pub(super) const FOLDER: &str = "backups";
/// Held while a backup is made; in the root of the store.
const LOCK: &str = ".lock";
/// Why a backup was made that belongs to no act.
const ASKED_FOR: &str = "asked-for";
/// The newest of a unit that are all kept.
const NEWEST: usize = 40;
/// Of older ones the first of each day is kept, for so many days.
const DAYS: usize = 60;

/// A backup in the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Backup {
    /// Its file.
    pub path: PathBuf,
    /// What names it in commands: "000012-2026-01-05T10-00-00.000Z-before-write".
    pub name: String,
}

impl Backup {
    fn new(path: PathBuf) -> Option<Self> {
        let name = path.file_stem()?.to_str()?.to_owned();
        Some(Self { path, name })
    }

    /// "2026-01-05 10:00:00 UTC, before write".
    pub fn title(&self) -> String {
        let dated = sequence::split(&self.name).1;
        let (date, reason) = dated.split_at_checked(STAMP_LENGTH).unwrap_or((dated, ""));
        let (day, time) = date.split_once('T').unwrap_or((date, ""));
        let time = time.split('.').next().unwrap_or_default().replace('-', ":");
        format!("{day} {time} UTC, {}", reason.trim_start_matches('-').replace('-', " "))
    }

    /// Whether its name begins so, with its number or with its date.
    pub fn begins_with(&self, name: &str) -> bool {
        self.name.starts_with(name) || sequence::split(&self.name).1.starts_with(name)
    }

    /// When it was made among others.
    fn order(&self) -> (u64, &str) {
        sequence::split(&self.name)
    }

    /// The unit's folder.
    pub fn unit(&self) -> String {
        let folder = self.path.parent().and_then(|folder| folder.file_name());
        folder.map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// What it holds.
    pub fn open(&self) -> Result<OpenedProfile, KeepError> {
        self.open_on(&Disk)
    }
}

impl Backup {
    /// What it holds, on a disk of choice.
    pub(super) fn open_on(&self, files: &dyn Files) -> Result<OpenedProfile, KeepError> {
        let (record, path) = (Record::Backup, self.path.clone());
        let text = files.read(&path).map_err(|error| KeepError::Read {
            record,
            path: path.clone(),
            what: error.to_string(),
        })?;
        Profile::read(&text, Strictness::Repair).map_err(|error| KeepError::Damaged {
            record,
            path,
            what: error.to_string(),
        })
    }
}

impl Store {
    /// Keeps a profile as a backup of a unit, made before an act. Old backups give way.
    pub fn back_up(&self, unit: &UnitId, act: Act, profile: &Profile) -> Result<Backup, KeepError> {
        self.back_up_at(clock::today(), unit, act, profile)
    }

    /// Keeps a profile as a backup of a unit because somebody asked for it. Old backups give way.
    pub fn back_up_now(&self, unit: &UnitId, profile: &Profile) -> Result<Backup, KeepError> {
        self.back_up_called(clock::today(), unit, ASKED_FOR, profile)
    }

    /// Keeps all settings of a unit before its firmware is replaced.
    pub fn back_up_for_firmware(
        &self,
        unit: &UnitId,
        identity: &Identity,
        report: &ReadReport,
    ) -> Result<(Profile, Backup), KeepError> {
        if !report.is_whole() {
            return Err(KeepError::NotWhole);
        }
        let (subject, address) = (*report.table.subject(), identity.unit_address());
        let settings = report.image.clone();
        let mut profile = profile_of(subject, address, &identity.version_text, &unit.place, settings);
        profile.note = format!("before {}", Act::Firmware.label());
        let backup = self.back_up(unit, Act::Firmware, &profile)?;
        Ok((profile, backup))
    }

    /// As [`Store::back_up`], at the time that the computer's clock shows, whatever time it is.
    pub(super) fn back_up_at(
        &self,
        clock: SystemTime,
        unit: &UnitId,
        act: Act,
        profile: &Profile,
    ) -> Result<Backup, KeepError> {
        self.back_up_called(clock, unit, &format!("before-{}", act.label().replace(' ', "-")), profile)
    }

    fn back_up_called(
        &self,
        clock: SystemTime,
        unit: &UnitId,
        reason: &str,
        profile: &Profile,
    ) -> Result<Backup, KeepError> {
        let rest = format!("{}-{reason}", stamp(clock));
        let folder = unit.file_name();
        let lock = sequence::lock(self.files(), &self.path(&[LOCK])?);
        // One sequence for all units, so that a number names one backup.
        let all = self.listed_backups(None)?;
        let mut number = sequence::next(all.iter().map(|backup| backup.name.as_str()));
        let path_of =
            |number| self.path(&[FOLDER, &folder, &format!("{}.json", sequence::numbered(number, &rest))]);
        let mut path = path_of(number)?;
        while self.files().read(&path).is_ok() {
            number += 1;
            path = path_of(number)?;
        }
        self.put(Record::Backup, &path, &profile.to_json())?;
        self.thin(unit, &path);
        drop(lock);
        Backup::new(path.clone()).ok_or_else(|| KeepError::Read {
            record: Record::Backup,
            path,
            what: "its name is not readable".to_owned(),
        })
    }

    /// The backups of a unit, or of all units; newest first. None where they cannot be listed: see [`Store::listed_backups`].
    pub fn backups(&self, unit: Option<&UnitId>) -> Vec<Backup> {
        self.listed_backups(unit).unwrap_or_default()
    }

    /// The backups of a unit, or of all units; newest first.
    ///
    /// # Errors
    /// A folder cannot be read: there may be backups that nobody sees.
    pub fn listed_backups(&self, unit: Option<&UnitId>) -> Result<Vec<Backup>, KeepError> {
        let folders = match unit {
            Some(unit) => vec![unit.file_name()],
            None => self.backup_folders()?,
        };
        let mut backups = Vec::new();
        for folder in folders {
            backups
                .extend(self.list(Record::Backup, &[FOLDER, &folder])?.into_iter().filter_map(Backup::new));
        }
        backups.sort_by(|left, right| right.order().cmp(&left.order()));
        Ok(backups)
    }

    fn backup_folders(&self) -> Result<Vec<String>, KeepError> {
        let entries = self.entries(Record::Backup, &self.path(&[FOLDER])?)?;
        let name = |path: &PathBuf| Some(path.file_name()?.to_str()?.to_owned());
        // A file that somebody has put among the folders is none of them.
        Ok(entries
            .iter()
            .filter(|path| path.extension().is_none_or(|end| end != "json"))
            .filter_map(name)
            .collect())
    }

    /// Removes what is too much of a unit, never the file that was just made.
    fn thin(&self, unit: &UnitId, just_made: &Path) {
        let mut backups = self.backups(Some(unit));
        backups.reverse();
        let names: Vec<String> = backups.iter().map(|backup| backup.name.clone()).collect();
        let kept = kept(&names);
        for backup in backups.iter().filter(|backup| backup.path != just_made) {
            if !kept.contains(&backup.name) {
                // One backup too many harms nothing; the next time it is tried again.
                let _ = self.take_away(Record::Backup, &backup.path);
            }
        }
    }
}

/// Which of the names, oldest first, are kept.
fn kept(names: &[String]) -> BTreeSet<String> {
    let (old, newest) = names.split_at(names.len().saturating_sub(NEWEST));
    let mut kept: BTreeSet<String> = newest.iter().cloned().collect();
    let mut days: Vec<&String> = Vec::new();
    for name in old {
        let day = |name: &str| sequence::split(name).1.get(..10).map(str::to_owned);
        let is_new_day = days.last().is_none_or(|last| day(last) != day(name));
        if is_new_day {
            days.push(name);
        }
    }
    kept.extend(days.into_iter().rev().take(DAYS).cloned());
    kept
}

const STAMP_LENGTH: usize = "2026-01-05T10-00-00.000Z".len();

/// A date that is also a file name everywhere.
pub(super) fn stamp(time: SystemTime) -> String {
    humantime::format_rfc3339_millis(time).to_string().replace(':', "-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_are_kept_and_of_older_ones_the_first_of_each_day() {
        let mut names = Vec::new();
        for day in 0..200 {
            for hour in 0..5 {
                let (month, day) = (1 + day / 28, 1 + day % 28);
                names.push(format!("2026-{month:02}-{day:02}T{hour:02}-00-00.000Z-before-write"));
            }
        }
        let kept = kept(&names);
        assert_eq!(kept.len(), NEWEST + DAYS);
        assert!(names[names.len() - NEWEST..].iter().all(|name| kept.contains(name)));
        assert!(kept.iter().take(DAYS).all(|name| name.contains("T00-")));
    }

    #[test]
    fn a_backup_is_named_by_date_and_reason() {
        for name in [
            "2026-01-05T10-02-03.456Z-before-firmware-change",
            "000007-2026-01-05T10-02-03.456Z-before-firmware-change",
        ] {
            let backup = Backup { path: PathBuf::from("x"), name: name.to_owned() };
            assert_eq!(backup.title(), "2026-01-05 10:02:03 UTC, before firmware change");
            assert!(backup.begins_with("2026-01-05T10") && backup.begins_with(name));
        }
        assert_eq!(stamp(SystemTime::UNIX_EPOCH), "1970-01-01T00-00-00.000Z");
    }
}
