//! The open profile, and the way to it: a path that was typed or chosen, and what came of it.
//!
//! Opening a profile changes nothing but this screen; taking its values over makes them edits, to be written like any
//! other.

use brushwork_link::Message;
use brushwork_link::settings::{OpenedProfile, Problem, Profile, ProfileFileError};

use crate::files::{FileAction, FileAnswer, FileDialog, FileKind};

mod acts;

/// Profiles as files.
#[derive(Debug, Default)]
pub struct Profiles {
    /// The path that stands in the field.
    pub path: String,
    /// Whether a saved profile has the edits that are not written instead of what the controller has.
    pub with_edits: bool,
    dialog: Option<(FileDialog, Purpose)>,
    pub opened: Option<Opened>,
    /// A profile that has to be changed before it fits, until that is agreed to.
    pending: Option<(Opened, Vec<Message>)>,
    /// What came of the last attempt.
    pub reported: Reported,
    /// A file of the name that was typed is there already; it is replaced once that is agreed to.
    pub is_in_the_way: bool,
}

/// What a path is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Open,
    Save,
}

/// What came of opening or saving.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Reported {
    #[default]
    Nothing,
    Done(String),
    Failed {
        sentences: Vec<String>,
        /// Whether the file can be opened without its faulty settings.
        can_be_corrected: bool,
    },
}

/// A profile that was opened.
#[derive(Debug)]
pub struct Opened {
    pub name: String,
    pub profile: Profile,
    /// The same as it was read, for units of other models and firmwares.
    pub read: OpenedProfile,
    /// What was corrected or left out in reading it.
    pub corrected: Vec<Problem>,
}

impl Profiles {
    /// What would be changed of the profile that was read, a sentence each, and its name.
    pub fn pending(&self) -> Option<(&str, &[Message])> {
        self.pending.as_ref().map(|(opened, changes)| (opened.name.as_str(), changes.as_slice()))
    }

    pub fn forget_reported(&mut self) {
        self.reported = Reported::Nothing;
        self.is_in_the_way = false;
    }

    /// Whether the desktop's own dialog is open.
    pub fn is_browsing(&self) -> bool {
        self.dialog.is_some()
    }

    /// Opens the desktop's own dialog.
    pub fn browse(&mut self, purpose: Purpose) {
        let action = match purpose {
            Purpose::Open => FileAction::Open,
            Purpose::Save => FileAction::Save { name: "controller.json".to_owned() },
        };
        let kind = FileKind { title: "Profile".to_owned(), extension: "json".to_owned() };
        self.dialog = Some((FileDialog::ask(action, kind), purpose));
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
                // The desktop's dialog has asked already.
                self.is_in_the_way = true;
                return Some(purpose);
            }
        }
        None
    }

    fn fail(&mut self, error: &ProfileFileError, can_be_corrected: bool) {
        let sentences = error.to_string().lines().map(str::to_owned).collect();
        self.reported = Reported::Failed { sentences, can_be_corrected };
    }
}
