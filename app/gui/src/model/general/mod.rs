//! The General Settings screen's state: what is being looked at, compared, calibrated. The settings themselves are those of the
//! unit, which [`GeneralView`] borrows.

mod calibrate;
mod clamp;
mod compare;
mod list;
mod pins;
mod profile;
mod section;
mod sheet;
mod unfinished;
mod view;

pub use calibrate::Run as CalibrationRun;
pub use clamp::{ClampTest, Verdict};
pub use compare::{Comparing, Comparison, Side, Take};
pub use profile::{Profiles, Purpose, Told};
pub use section::{Section, sections};
pub use sheet::Sheet;
pub use view::GeneralView;

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
    calibration: Option<calibrate::Run>,
    pub clamp: ClampTest,
    /// The row that is to be scrolled into view.
    sought: Option<String>,
    /// Which two copies are set side by side.
    pub comparing: Comparing,
    /// Which motor is copied to the other, 1 or 2.
    pub copied_motor: usize,
    sheet: Option<Sheet>,
    sheet_is_new: bool,
    wants_search: bool,
    /// Opened as soon as the settings were read.
    waiting_sheet: Option<Sheet>,
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
