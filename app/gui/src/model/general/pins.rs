//! Where the General Settings screen is turned to: a section, a pin, a row.

use brushwork_link::settings::Group;

use super::General;
use super::section::{Section, sections};
use super::sheet::Sheet;
use super::view::GeneralView;

impl General {
    /// The input pin that is looked at, from 1.
    pub fn pin(&self) -> Option<usize> {
        match self.section {
            Section::One(Group::PINS, number) if !self.is_filtered() => Some(number),
            Section::Group(_)
            | Section::One(..)
            | Section::Conflicts
            | Section::ClampTest
            | Section::Recipes => None,
        }
    }

    /// Whether the screen, while it is shown, wants the live signals of the pins.
    pub fn wants_signals(&self) -> bool {
        let shows_pins = self.pin().is_some() || self.section == Section::Recipes && !self.is_filtered();
        // What a write does at once depends on where the pins stand.
        let weighs_write = self.sheet == Some(Sheet::Write);
        self.calibration.is_some() || weighs_write || self.sheet.is_none() && shows_pins
    }

    /// Shows a part of the settings.
    pub fn turn_to(&mut self, section: Section) {
        self.section = section;
        self.search.clear();
        self.only_changed = false;
        self.explained = None;
        self.close_sheet();
    }

    /// Whether an input that was opened for a calibration is to be closed again, without anybody asking.
    pub fn wants_closing(&self) -> bool {
        self.calibration.as_ref().is_some_and(super::calibrate::Run::is_closing)
    }
}

impl GeneralView<'_> {
    /// Turns from a group of settings that this controller has none of to the first that it has.
    pub fn leave_missing(&mut self) {
        let Section::Group(_) = self.section else { return };
        let there = self.unit().map(|unit| sections(unit.table())).unwrap_or_default();
        if there.iter().all(|(section, _)| *section != self.section)
            && let Some(first) = there.first().map(|(section, _)| *section)
        {
            self.section = first;
        }
    }

    /// Goes to a row and explains it.
    pub fn go_to(&mut self, key: &str) {
        let section = self.unit().and_then(|unit| unit.table().row(key)).map(Section::of);
        if let Some(section) = section {
            self.turn_to(section);
            self.explained = Some(key.to_owned());
            self.sought = Some(key.to_owned());
        }
    }
}
