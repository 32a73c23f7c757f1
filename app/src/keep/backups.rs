//! Backups: one profile for each act that changes settings, named by date and reason, kept within bounds.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::time::SystemTime;

use brushwork_link::settings::{Act, OpenedProfile, Profile, Strictness};

use super::store::{KeepError, Store};
use super::unit::UnitId;

const FOLDER: &str = "backups";
/// The newest of a unit that are all kept.
const NEWEST: usize = 40;
/// Of older ones the first of each day is kept, for so many days.
const DAYS: usize = 60;

/// A backup in the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Backup {
    /// Its file.
    pub path: PathBuf,
    /// What names it in commands: "2026-01-05T10-00-00.000Z-before-write".
    pub name: String,
}

impl Backup {
    fn new(path: PathBuf) -> Option<Self> {
        let name = path.file_stem()?.to_str()?.to_owned();
        Some(Self { path, name })
    }

    /// "2026-01-05 10:00:00 UTC, before write".
    pub fn title(&self) -> String {
        let (date, reason) = self.name.split_at_checked(STAMP_LENGTH).unwrap_or((&self.name, ""));
        let (day, time) = date.split_once('T').unwrap_or((date, ""));
        let time = time.split('.').next().unwrap_or_default().replace('-', ":");
        format!("{day} {time} UTC, {}", reason.trim_start_matches('-').replace('-', " "))
    }

    /// The unit's folder.
    pub fn unit(&self) -> String {
        let folder = self.path.parent().and_then(|folder| folder.file_name());
        folder.map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// What it holds.
    pub fn open(&self) -> Result<OpenedProfile, KeepError> {
        Profile::open(&self.path, Strictness::Repair)
            .map_err(|error| KeepError::Read { path: self.path.clone(), what: error.to_string() })
    }
}

impl Store {
    /// Keeps a profile as a backup of a unit, made before an act. Old backups give way.
    pub fn back_up(&self, unit: &UnitId, act: Act, profile: &Profile) -> Result<Backup, KeepError> {
        let reason = act.label().replace(' ', "-");
        let name = format!("{}-before-{reason}", stamp(SystemTime::now()));
        let folder = unit.file_name();
        let mut path = self.path(&[FOLDER, &folder, &format!("{name}.json")])?;
        let mut again = 2;
        while path.exists() {
            path = self.path(&[FOLDER, &folder, &format!("{name}-{again}.json")])?;
            again += 1;
        }
        self.put(&path, &profile.to_json())?;
        self.thin(&folder);
        Backup::new(path.clone())
            .ok_or_else(|| KeepError::Read { path, what: "its name is not readable".to_owned() })
    }

    /// The backups of a unit, or of all units; newest first.
    pub fn backups(&self, unit: Option<&UnitId>) -> Vec<Backup> {
        let folders = match unit {
            Some(unit) => vec![unit.file_name()],
            None => self.backup_folders(),
        };
        let files = folders.iter().flat_map(|folder| self.files(&[FOLDER, folder]));
        let mut backups: Vec<Backup> = files.filter_map(Backup::new).collect();
        backups.sort_by(|left, right| right.name.cmp(&left.name));
        backups
    }

    fn backup_folders(&self) -> Vec<String> {
        let Ok(entries) = self.path(&[FOLDER]).and_then(|path| {
            fs::read_dir(&path).map_err(|source| KeepError::Read { path, what: source.to_string() })
        }) else {
            return Vec::new();
        };
        entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect()
    }

    fn thin(&self, folder: &str) {
        let files = self.files(&[FOLDER, folder]);
        let names: Vec<String> = files
            .iter()
            .map(|path| path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned()))
            .collect();
        for (path, name) in files.iter().zip(&names) {
            if !kept(&names).contains(name) {
                // One backup too many harms nothing; the next time it is tried again.
                let _ = fs::remove_file(path);
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
        let is_new_day = days.last().is_none_or(|last| last.get(..10) != name.get(..10));
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
        let backup = Backup {
            path: PathBuf::from("x"),
            name: "2026-01-05T10-02-03.456Z-before-firmware-change".to_owned(),
        };
        assert_eq!(backup.title(), "2026-01-05 10:02:03 UTC, before firmware change");
        assert_eq!(stamp(SystemTime::UNIX_EPOCH), "1970-01-01T00-00-00.000Z");
    }
}
