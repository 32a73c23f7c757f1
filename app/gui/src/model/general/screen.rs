//! What General Settings shows and searches, which sheet is open, and what is compared or calibrated there.

use brushwork_link::settings::OpenedProfile;

use super::calibrate;
use super::clamp::ClampTest;
use super::compare::Comparing;
use super::profile::Profiles;
use super::section::Section;
use super::sheet::Sheet;
use crate::family::recipe::{Answers, Goal};

/// The state of the screen.
#[derive(Debug, Default)]
pub struct General {
    /// What the list shows while nothing is searched for.
    pub section: Section,
    pub search: String,
    pub only_changed: bool,
    /// The row that is explained below the list, by its key.
    pub explained: Option<String>,
    pub profiles: Profiles,
    pub calibration: Option<calibrate::Run>,
    pub clamp: ClampTest,
    /// The row that is to be scrolled into view.
    pub sought: Option<String>,
    /// Which two copies are set side by side.
    pub comparing: Comparing,
    /// Which recipe is looked at, and what was chosen for it.
    pub recipes: RecipeChoice,
    /// Which motor is copied to the other, 1 or 2.
    pub copied_motor: usize,
    pub sheet: Option<Sheet>,
    pub sheet_is_new: bool,
    pub wants_search: bool,
    /// Opened as soon as the settings were read.
    pub(super) waiting_sheet: Option<Sheet>,
}

/// Which recipe is looked at, and what was chosen of all that recipes ask for.
#[derive(Clone, Debug, Default)]
pub struct RecipeChoice {
    /// None is the first that the controller can do.
    pub job: Option<Goal>,
    pub answers: Answers,
}

impl General {
    /// Another unit is looked at, or none: what is shown of one says nothing of another.
    pub fn forget_unit(&mut self) {
        self.forget_clamp_test();
        self.explained = None;
        self.sheet = None;
    }

    /// The open profile as it was read, and its name.
    pub fn opened_profile(&self) -> Option<(String, OpenedProfile)> {
        self.profiles.opened.as_ref().map(|opened| (opened.name.clone(), opened.read.clone()))
    }

    pub fn close_sheet(&mut self) {
        self.sheet = None;
    }

    /// The keyboard is to go to the search field.
    pub fn find(&mut self) {
        self.close_sheet();
        self.wants_search = true;
    }
}
