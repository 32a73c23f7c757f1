//! What General Settings shows and searches, which sheet is open, and what is compared or calibrated there.

use super::calibrate;
use super::clamp::ClampTest;
use super::compare::Comparing;
use super::profile::Profiles;
use super::section::Section;
use super::sheet::Sheet;

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
    pub(super) calibration: Option<calibrate::Run>,
    pub clamp: ClampTest,
    /// The row that is to be scrolled into view.
    pub(super) sought: Option<String>,
    /// Which two copies are set side by side.
    pub comparing: Comparing,
    /// Which motor is copied to the other, 1 or 2.
    pub copied_motor: usize,
    pub(super) sheet: Option<Sheet>,
    pub(super) sheet_is_new: bool,
    pub(super) wants_search: bool,
    /// Opened as soon as the settings were read.
    pub(super) waiting_sheet: Option<Sheet>,
}

impl General {
    /// Another unit is looked at, or none: what is shown of one says nothing of another.
    pub fn forget_unit(&mut self) {
        self.forget_clamp_test();
        self.explained = None;
        self.sheet = None;
    }

    pub fn sheet(&self) -> Option<&Sheet> {
        self.sheet.as_ref()
    }

    /// Whether a row is to be scrolled into view.
    pub fn is_seeking(&self) -> bool {
        self.sought.is_some()
    }

    /// The row that is to be scrolled into view, once.
    pub fn take_sought(&mut self) -> Option<String> {
        self.sought.take()
    }

    pub fn close_sheet(&mut self) {
        self.sheet = None;
    }

    /// The keyboard is to go to the search field.
    pub fn find(&mut self) {
        self.close_sheet();
        self.wants_search = true;
    }

    /// True once for each [`General::find`].
    pub fn take_search_focus(&mut self) -> bool {
        std::mem::take(&mut self.wants_search)
    }

    /// True once for each sheet: then the keyboard goes to its button.
    pub fn take_sheet_focus(&mut self) -> bool {
        std::mem::take(&mut self.sheet_is_new)
    }
}
