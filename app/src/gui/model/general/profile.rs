//! The open profile, and the way to it: a path that was typed or chosen, and what came of it.
//!
//! Opening a profile changes nothing but this screen; taking its values over makes them edits, to be written like any
//! other.

use std::path::Path;
use std::time::SystemTime;

use brushwork_link::settings::{Difference, OpenedProfile, Profile, ProfileFileError, Strictness, diff};
use brushwork_protocol::packet_serial::Address;

use super::{General, Sheet, UnitSettings};
use crate::gui::files::{FileAnswer, FileDialog, FileKind, FileWish};

/// Profiles as files.
#[derive(Debug, Default)]
pub struct Profiles {
    /// The path that stands in the field.
    pub path: String,
    /// Whether a saved profile has the edits that are not written instead of what the controller has.
    pub with_edits: bool,
    dialog: Option<(FileDialog, Purpose)>,
    opened: Option<Opened>,
    /// What came of the last attempt.
    told: Told,
}

/// What a path is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Open,
    Save,
}

/// What came of opening or saving.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Told {
    #[default]
    Nothing,
    Done(String),
    Failed {
        sentences: Vec<String>,
        /// Whether the file can be opened without its faulty settings.
        can_be_mended: bool,
    },
}

/// A profile that was opened.
#[derive(Debug)]
pub struct Opened {
    pub name: String,
    pub profile: Profile,
    /// What was mended or left out in reading it.
    pub mended: Vec<String>,
}

/// An open profile beside the controller.
#[derive(Debug, Default)]
pub struct Comparison {
    /// What the controller has, then what the profile has.
    pub differences: Vec<Difference>,
    /// Why nothing can be taken over.
    pub misfits: Vec<String>,
    /// What differs and cannot be written here.
    pub left_out: Vec<String>,
}

impl Profiles {
    pub fn opened(&self) -> Option<&Opened> {
        self.opened.as_ref()
    }

    pub fn told(&self) -> &Told {
        &self.told
    }

    pub fn forget_told(&mut self) {
        self.told = Told::Nothing;
    }

    /// Whether the desktop's own dialog is open.
    pub fn is_browsing(&self) -> bool {
        self.dialog.is_some()
    }

    /// Opens the desktop's own dialog.
    pub fn browse(&mut self, purpose: Purpose) {
        let wish = match purpose {
            Purpose::Open => FileWish::Open,
            Purpose::Save => FileWish::Save { name: "controller.json".to_owned() },
        };
        let kind = FileKind { title: "Profile".to_owned(), extension: "json".to_owned() };
        self.dialog = Some((FileDialog::ask(wish, kind), purpose));
    }

    fn answer(&mut self) -> Option<Purpose> {
        let (dialog, purpose) = self.dialog.as_ref()?;
        let (answer, purpose) = (dialog.answer(), *purpose);
        match answer {
            FileAnswer::Waiting => return None,
            FileAnswer::None => self.dialog = None,
            FileAnswer::Chosen(path) => {
                self.dialog = None;
                self.path = path.display().to_string();
                return Some(purpose);
            }
        }
        None
    }

    fn fail(&mut self, error: &ProfileFileError, can_be_mended: bool) {
        let sentences = error.to_string().lines().map(str::to_owned).collect();
        self.told = Told::Failed { sentences, can_be_mended };
    }
}

impl General {
    /// Looks whether the desktop's dialog gave a file, and opens or saves it then. Never waits for the user.
    pub fn follow_dialog(&mut self) {
        match self.profiles.answer() {
            Some(Purpose::Open) => self.open_profile(false),
            Some(Purpose::Save) => self.save_profile(),
            None => {}
        }
    }

    /// Reads the file at the path in the field and shows it beside the controller. `mending` leaves out faulty
    /// settings instead of refusing the file.
    pub fn open_profile(&mut self, mending: bool) {
        let typed = self.profiles.path.trim().to_owned();
        let path = Path::new(&typed);
        let strictness = if mending { Strictness::Repair } else { Strictness::Refuse };
        match Profile::open(path, strictness) {
            Ok(OpenedProfile { profile, mended, .. }) => {
                let name = path.file_name().map_or_else(|| typed.clone(), |name| name.display().to_string());
                let mended = mended.iter().map(ToString::to_string).collect();
                self.profiles.opened = Some(Opened { name, profile, mended });
                self.profiles.told = Told::Nothing;
                self.open(Sheet::Compare);
            }
            Err(error) => {
                let can_be_mended = !mending && Profile::open(path, Strictness::Repair).is_ok();
                self.profiles.fail(&error, can_be_mended);
            }
        }
    }

    /// Writes what the controller has, or what is wanted of it, to the file at the path in the field.
    pub fn save_profile(&mut self) {
        let with_edits = self.profiles.with_edits;
        let Some(profile) = self.unit().and_then(|unit| unit.profile(with_edits)) else { return };
        let typed = self.profiles.path.trim();
        let path =
            if Path::new(typed).extension().is_some() { typed.to_owned() } else { format!("{typed}.json") };
        match profile.save(Path::new(&path)) {
            Ok(()) => {
                let settings = super::outcome::settings(profile.settings.len());
                self.profiles.told = Told::Done(format!("{settings} are in {path}."));
            }
            Err(error) => self.profiles.fail(&error, false),
        }
    }

    /// The open profile beside the controller that is looked at.
    pub fn comparison(&self) -> Comparison {
        let (Some(opened), Some(unit)) = (self.profiles.opened(), self.unit()) else {
            return Comparison::default();
        };
        unit.compare(&opened.profile)
    }

    /// Makes one setting of the open profile an edit, or all that differ.
    pub fn take_over(&mut self, key: Option<&str>) {
        let (Some(opened), Some(unit)) = (self.profiles.opened(), self.unit()) else { return };
        let Ok(changes) = unit.changes_for(&opened.profile) else { return };
        let wanted = changes.wanted;
        let Some(unit) = self.unit_mut() else { return };
        for (own, value) in wanted.iter().filter(|(own, _)| key.is_none_or(|key| key == *own)) {
            unit.set(own, value);
        }
    }
}

impl UnitSettings {
    /// What a file can keep of the controller: what it has, or what is wanted of it.
    fn profile(&self, with_edits: bool) -> Option<Profile> {
        let mut settings = self.ram()?.clone();
        if with_edits {
            settings.merge(self.edits());
        }
        Some(Profile {
            subject: *self.table().subject(),
            firmware: self.firmware().to_owned(),
            address: Address::new(self.address()).unwrap_or(Address::DEFAULT),
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            unit: String::new(),
            note: String::new(),
            settings,
        })
    }

    fn compare(&self, profile: &Profile) -> Comparison {
        let nothing = brushwork_link::settings::SettingsImage::default();
        let ram = self.ram().unwrap_or(&nothing);
        let in_profile = |difference: &Difference| difference.right.is_some();
        let differences = diff(self.table(), ram, &profile.settings).into_iter().filter(in_profile).collect();
        match self.changes_for(profile) {
            Ok(changes) => Comparison { differences, misfits: Vec::new(), left_out: changes.left_out },
            Err(error) => {
                let misfits = error.problems.iter().map(ToString::to_string).collect();
                Comparison { differences, misfits, left_out: Vec::new() }
            }
        }
    }
}
