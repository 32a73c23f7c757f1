//! What General Settings does with profiles.

use std::path::Path;

use brushwork_link::settings::{OpenedProfile, Profile, Strictness};

use super::{Opened, Purpose, Reported};
use crate::messages::OutcomeMessage;
use crate::model::general::GeneralView;
use crate::model::general::compare::Side;
use crate::model::general::sheet::Sheet;
use brushwork_core::settings::{counted, fitted};

impl GeneralView<'_> {
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
            Ok(read) => {
                let name = path.file_name().map_or_else(|| typed.clone(), |name| name.display().to_string());
                self.take_profile(name, read);
            }
            Err(error) => {
                let can_be_corrected = !mending && Profile::open(path, Strictness::Repair).is_ok();
                self.profiles.fail(&error, can_be_corrected);
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
        let is_agreed = std::mem::take(&mut self.profiles.is_in_the_way);
        let saved =
            if is_agreed { profile.save(Path::new(&path)) } else { profile.save_new(Path::new(&path)) };
        match saved {
            Ok(()) => {
                let settings = counted(profile.settings.len());
                self.profiles.reported =
                    Reported::Done(OutcomeMessage::ProfileSaved { settings, path }.to_string());
            }
            Err(error) => {
                self.profiles.is_in_the_way = !is_agreed && Path::new(&path).is_file();
                self.profiles.fail(&error, false);
            }
        }
    }

    /// A profile that fits is open now; one that does not is shown with what has to be changed of it.
    fn take_profile(&mut self, name: String, read: OpenedProfile) {
        let Some(unit) = self.unit() else { return };
        let corrected = read.corrected.clone();
        let (profile, changes) = fitted(read.clone(), unit.table());
        let opened = Opened { name, profile, read, corrected };
        self.profiles.reported = Reported::Nothing;
        if changes.is_empty() {
            self.show_opened(opened);
        } else {
            self.profiles.pending = Some((opened, changes));
            self.open(Sheet::Upgrade);
        }
    }

    /// Uses the profile with the changes that were shown.
    pub fn use_upgraded(&mut self) {
        if let Some((opened, _)) = self.profiles.pending.take() {
            self.show_opened(opened);
        }
    }

    fn show_opened(&mut self, opened: Opened) {
        self.profiles.opened = Some(opened);
        self.compare_with(Side::Ram, Side::Profile);
        self.open(Sheet::Compare);
    }
}
