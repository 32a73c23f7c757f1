//! Files that are opened from anywhere in the window: the path that was typed or chosen, what was opened before, and settings that are looked
//! at without a controller.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use brushwork_core::keep::Backup;
use brushwork_core::known_file::KnownFile;
use brushwork_link::Message;
use brushwork_link::settings::{ListedSetting, OpenedProfile, Profile, list};

use crate::files::{FileAction, FileDialog, FileKind};

/// Files that are remembered.
const RECENT_KEPT: usize = 8;

/// Opening files.
#[derive(Debug, Default)]
pub struct OpenFiles {
    /// What stands in the field for a path.
    pub path: String,
    dialog: Option<FileDialog>,
    /// What was opened before, newest first.
    pub recent: Vec<String>,
    /// Settings from a file, looked at without a controller.
    pub settings: Option<SettingsFile>,
    /// The backups of every unit, once they were asked for.
    pub backups: Option<Vec<Backup>>,
    /// What was noted of each unit, by the name that its backups have.
    pub noted: BTreeMap<String, String>,
}

/// Settings from a profile or a backup.
#[derive(Debug)]
pub struct SettingsFile {
    /// What it is called: "Backup 2026-01-05 10:00:00 UTC, before write".
    pub title: String,
    pub path: PathBuf,
    pub profile: Profile,
    /// What was changed in reading it, a sentence each.
    pub notes: Vec<Message>,
    /// Every setting that such a controller has, in screen order.
    pub rows: Vec<ListedSetting>,
    pub search: String,
    pub only_changed: bool,
}

impl OpenFiles {
    /// Opens the desktop's own dialog.
    pub fn browse(&mut self) {
        let mut endings: Vec<&str> = KnownFile::ALL.iter().flat_map(|kind| kind.endings()).copied().collect();
        endings.dedup();
        let kind = FileKind { title: "Files that can be opened".to_owned(), extension: endings.join(",") };
        self.dialog = Some(FileDialog::ask(FileAction::OpenSeveral, kind));
    }

    /// Whether the desktop's own dialog is open.
    pub fn is_browsing(&self) -> bool {
        self.dialog.is_some()
    }

    /// The files that were chosen in the dialog, once.
    pub fn chosen(&mut self) -> Vec<PathBuf> {
        let answer = self.dialog.as_ref().and_then(FileDialog::chosen);
        if answer.is_some() {
            self.dialog = None;
        }
        answer.unwrap_or_default()
    }

    /// Looks at no file and no backups any more.
    pub fn close(&mut self) {
        (self.settings, self.backups) = (None, None);
    }

    pub fn set_recent(&mut self, recent: Vec<String>) {
        self.recent = recent;
        self.recent.truncate(RECENT_KEPT);
    }

    /// A file was opened: it is now the newest.
    pub fn remember(&mut self, path: &Path) {
        let path = path.display().to_string();
        self.recent.retain(|known| *known != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT_KEPT);
    }
}

impl SettingsFile {
    pub fn new(title: String, path: PathBuf, read: OpenedProfile) -> Self {
        let OpenedProfile { profile, upgraded, corrected } = read;
        let rows = list(&profile.table(), &profile.settings, false);
        let notes = upgraded.into_iter().chain(corrected.into_iter().map(Message::error)).collect();
        Self { title, path, profile, notes, rows, search: String::new(), only_changed: false }
    }

    /// The settings to show.
    pub fn shown(&self) -> Vec<&ListedSetting> {
        let words: Vec<String> = self.search.split_whitespace().map(str::to_lowercase).collect();
        let is_shown = |row: &&ListedSetting| {
            let text = format!("{} {} {}", row.title, row.key, row.group.label()).to_lowercase();
            row.value.is_some()
                && (!self.only_changed || row.is_default == Some(false))
                && words.iter().all(|word| text.contains(word))
        };
        self.rows.iter().filter(is_shown).collect()
    }

    /// How many of its settings are not the factory's.
    pub fn changed(&self) -> usize {
        self.rows.iter().filter(|row| row.is_default == Some(false)).count()
    }
}
