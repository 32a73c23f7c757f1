//! The General Settings screen's state: the settings of each unit, what runs, and what is being looked at.
//!
//! Edits belong to a unit and stay until they are written or reverted, whatever screen is shown, and over a lost link.

use std::collections::BTreeMap;

use brushwork_link::device::{Event, Identity, JobEnding, QueuedJob};
use brushwork_link::settings::WriteReport;
use brushwork_link::transport::Stream;

use super::link::Effect;
use super::message::Gravity;
use kept::{Came, Kept};
use summary::Summary;
use unit_key::UnitKey;

mod applicable;
mod calibrate;
mod clamp;
mod compare;
mod kept;
mod list;
mod outcome;
mod pins;
mod profile;
mod section;
mod sheet;
mod summary;
mod unit;
mod unit_key;
mod work;

pub use calibrate::Run as CalibrationRun;
pub use clamp::{ClampTest, Verdict};
pub use compare::{Comparing, Comparison, Side, Take};
pub use kept::Settle;
pub use profile::{Profiles, Purpose, Told};
pub use section::{Section, sections};
pub use sheet::Sheet;
pub use unit::{Saved, UnitSettings};
pub use work::{Running, SettingsWish};

/// After so many failures the settings are read no more before somebody asks.
const QUIET_TRIES: usize = 2;

/// The state of the screen.
#[derive(Debug, Default)]
pub struct General {
    units: BTreeMap<UnitKey, UnitSettings>,
    current: Option<UnitKey>,
    running: Option<Running>,
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
    kept: Kept,
    sheet: Option<Sheet>,
    sheet_is_new: bool,
    wants_search: bool,
    /// How often reading that nobody asked for has failed on this link.
    quiet_failures: usize,
    /// Opened as soon as the settings were read.
    waiting_sheet: Option<Sheet>,
}

impl General {
    /// Turns to the unit that is looked at. Its edits of earlier are there again.
    pub fn look_at(&mut self, identity: &Identity) {
        let key = UnitKey::of(identity);
        if self.current.as_ref() == Some(&key) {
            return;
        }
        self.units.entry(key.clone()).or_insert_with(|| UnitSettings::new(identity));
        self.look_up(key.clone(), identity);
        self.current = Some(key);
        self.forget_clamp_test();
        self.explained = None;
        self.sheet = None;
    }

    pub fn unit(&self) -> Option<&UnitSettings> {
        self.units.get(self.current.as_ref()?)
    }

    /// Another screen has written to the controller's RAM.
    pub fn note_written_elsewhere(&mut self, report: &WriteReport) {
        if let Some(unit) = self.unit_mut().filter(|unit| unit.is_read()) {
            unit.note_written(report);
        }
    }

    /// The controller's RAM may be another one now: it is read again.
    pub fn ram_changes(&mut self) {
        if let Some(unit) = self.unit_mut() {
            unit.forget_ram();
        }
    }

    pub fn unit_mut(&mut self) -> Option<&mut UnitSettings> {
        self.units.get_mut(self.current.as_ref()?)
    }

    pub fn running(&self) -> Option<&Running> {
        self.running.as_ref()
    }

    /// Whether the settings were not asked for yet, so that opening the screen reads them.
    pub fn wants_reading(&self) -> bool {
        self.running.is_none() && self.unit().is_some_and(|unit| !unit.was_asked())
    }

    pub fn sheet(&self) -> Option<&Sheet> {
        self.sheet.as_ref()
    }

    pub fn open(&mut self, sheet: Sheet) {
        self.profiles.forget_told();
        self.refresh_for(&sheet);
        self.sheet = Some(sheet);
        self.sheet_is_new = true;
    }

    /// Whether a row is to be scrolled into view.
    pub fn is_seeking(&self) -> bool {
        self.sought.is_some()
    }

    /// The row that is to be scrolled into view, once.
    pub fn take_sought(&mut self) -> Option<String> {
        self.sought.take()
    }

    /// Opens a sheet; if the settings were not read yet, when they have been.
    pub fn open_once_read(&mut self, sheet: Sheet) {
        match self.unit().is_some_and(UnitSettings::was_asked) && self.running.is_none() {
            true => self.open(sheet),
            false => self.waiting_sheet = Some(sheet),
        }
    }

    pub fn close_sheet(&mut self) {
        self.sheet = None;
    }

    /// Whether any unit has edits that were not written.
    pub fn has_edits(&self) -> bool {
        self.units.values().any(|unit| !unit.edits().is_empty())
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

    /// What to ask of the device thread. Nothing while other work with settings runs.
    pub fn begin(&mut self, wish: SettingsWish, own_stream: Option<Stream>) -> Option<QueuedJob> {
        if wish == SettingsWish::Cancel {
            let running = self.running.as_mut()?;
            running.is_cancelled = true;
            // Whoever calls it off is told, and it is not begun again by itself.
            running.is_quiet = false;
            running.ticket.cancel();
            return None;
        }
        let is_calibrating = matches!(wish, SettingsWish::OpenInput | SettingsWish::CloseInput);
        if self.running.is_some() || self.calibration.is_some() != is_calibrating {
            return None;
        }
        let calibrated = self.calibration.as_ref().map(|run| run.unit.clone());
        let key = calibrated.or_else(|| self.current.clone())?;
        let unit = self.units.get_mut(&key)?;
        unit.note_asked();
        let keep = || self.kept.keeper(&key, unit.firmware());
        let keeper = keep()?;
        let input = match &mut self.calibration {
            Some(run) => Some((run.image(wish), run.keeper(keep)?)),
            None => None,
        };
        let (job, running) = work::begin(wish, key, unit, input, own_stream, keeper)?;
        self.running = Some(running);
        self.sheet = None;
        Some(job)
    }

    /// Reads what the controller works with, without a word: whoever is connected is to see what is saved and what is not.
    /// It gives way to whatever is asked for meanwhile, and is begun again.
    pub fn begin_quietly(&mut self) -> Option<QueuedJob> {
        if self.quiet_failures >= QUIET_TRIES {
            return None;
        }
        let sheet = self.sheet.clone();
        let job = self.begin(SettingsWish::Read, None);
        self.sheet = sheet;
        if let Some(running) = self.running.as_mut().filter(|_| job.is_some()) {
            running.is_quiet = true;
        }
        job
    }

    /// Whether the settings are being read without anybody having asked.
    pub fn is_reading_quietly(&self) -> bool {
        self.running.as_ref().is_some_and(|running| running.is_quiet && !running.is_cancelled)
    }

    /// Makes reading that nobody asked for give way.
    pub fn give_way(&mut self) {
        if let Some(running) = self.running.as_mut().filter(|running| running.is_quiet) {
            running.is_cancelled = true;
            running.ticket.cancel();
        }
    }

    /// The job was not taken.
    pub fn not_begun(&mut self) {
        self.running = None;
        self.calibration_not_begun();
    }

    /// Takes in an event of the work that was begun here.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let is_of_it = |running: &&mut Running| event.job() == Some(running.ticket.id());
        let Some(running) = self.running.as_mut().filter(is_of_it) else { return Vec::new() };
        if let Event::JobEnded(report) = event {
            return self.ended(&report.ending);
        }
        if let Event::JobProgress { fraction, text, .. } = event {
            running.fraction = fraction;
            running.text = text;
        }
        Vec::new()
    }

    /// The link is gone: what the controllers hold may change unseen. Edits stay.
    pub fn link_ended(&mut self) {
        self.running = None;
        self.quiet_failures = 0;
        self.current = None;
        self.kept.forget_unit();
        self.sheet = None;
        self.waiting_sheet = None;
        self.calibration_lost();
        self.clamp_test_lost();
        for unit in self.units.values_mut() {
            unit.forget();
        }
    }

    fn ended(&mut self, ending: &JobEnding) -> Vec<Effect> {
        let Some(running) = self.running.take() else { return Vec::new() };
        if matches!(running.wish, SettingsWish::OpenInput | SettingsWish::CloseInput) {
            let report = match running.ticket.take() {
                Some(work::Outcome::Written(report)) => Some(*report),
                _ => None,
            };
            let told = self.calibration_step_ended(report);
            return self.told(told);
        }
        let Some(unit) = self.units.get_mut(&running.unit) else { return Vec::new() };
        let result = running.ticket.take();
        let came_of = result.as_ref().map(Came::of);
        let told = match result {
            Some(outcome) => outcome::take(unit, outcome),
            None => outcome::nothing_came(&running, ending),
        };
        if running.is_quiet && came_of.is_none() {
            unit.forget_asked();
            self.quiet_failures += usize::from(matches!(ending, JobEnding::Failed(_)));
        }
        let is_current = self.current.as_ref() == Some(&running.unit);
        self.follow_address(&running.unit, told.address);
        let mut effects = self.told(told);
        if running.is_quiet {
            effects.retain(|effect| matches!(effect, Effect::Say(Gravity::Warning, _)) && came_of.is_some());
        }
        if is_current {
            effects.extend(self.note_came(came_of));
        }
        effects
    }

    fn told(&mut self, told: Summary) -> Vec<Effect> {
        if !told.sentences.is_empty() {
            self.open(Sheet::Report { title: told.summary.clone(), sentences: told.sentences });
        } else if let Some(sheet) = self.waiting_sheet.take() {
            self.open(sheet);
        }
        vec![Effect::Say(told.gravity, told.summary)]
    }

    /// A unit that got another address keeps its settings here.
    fn follow_address(&mut self, old: &UnitKey, address: Option<u8>) {
        let Some(address) = address.filter(|address| *address != old.address) else { return };
        if let Some(unit) = self.units.remove(old) {
            let new = UnitKey { address, ..old.clone() };
            self.kept.follow_address(old, new.clone());
            if self.current.as_ref() == Some(old) || self.current.as_ref() == Some(&new) {
                self.current = Some(new.clone());
            }
            self.units.insert(new, unit.at(address));
        }
    }
}
