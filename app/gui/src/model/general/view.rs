//! The General Settings screen with the settings that it shows: its own state beside that of the unit, which other screens show too.

use std::ops::{Deref, DerefMut};

use brushwork_link::{QueuedJob, Stream};

use crate::messages::OutcomeMessage;
use crate::model::settings::{Calibrating, Ended, Settings, Summary};
use crate::model::{Effect, General, Gravity, SettingsAction, Sheet, UnitSettings};

/// The screen with the settings that it shows.
#[derive(Debug)]
pub struct GeneralView<'s> {
    pub settings: &'s mut Settings,
    screen: &'s mut General,
}

impl Deref for GeneralView<'_> {
    type Target = General;

    fn deref(&self) -> &General {
        self.screen
    }
}

impl DerefMut for GeneralView<'_> {
    fn deref_mut(&mut self) -> &mut General {
        self.screen
    }
}

impl<'s> GeneralView<'s> {
    pub fn new(settings: &'s mut Settings, screen: &'s mut General) -> Self {
        Self { settings, screen }
    }
}

impl GeneralView<'_> {
    pub fn unit(&self) -> Option<&UnitSettings> {
        self.settings.unit()
    }

    pub fn unit_mut(&mut self) -> Option<&mut UnitSettings> {
        self.settings.unit_mut()
    }

    /// The keys of the rows to show, in screen order.
    pub fn shown(&self) -> Vec<String> {
        self.unit().map(|unit| self.shown_of(unit)).unwrap_or_default()
    }

    /// Whether nothing else may be done with the settings for now.
    pub fn is_busy(&self) -> bool {
        self.settings.running().is_some() || self.holds_settings()
    }

    pub fn open(&mut self, sheet: Sheet) {
        if let Some(unit) = self.unit_mut() {
            unit.finish_all_typing();
        }
        self.profiles.forget_reported();
        if matches!(sheet, Sheet::Backups | Sheet::Compare | Sheet::Save) {
            self.settings.refresh_kept();
        }
        self.sheet = Some(sheet);
        self.sheet_is_new = true;
    }

    /// Opens a sheet; if the settings were not read yet, when they have been.
    pub fn open_once_read(&mut self, sheet: Sheet) {
        match self.unit().is_some_and(UnitSettings::was_asked) && self.settings.running().is_none() {
            true => self.open(sheet),
            false => self.waiting_sheet = Some(sheet),
        }
    }

    /// What to ask of the device thread. Nothing while other work with settings runs.
    pub fn begin(&mut self, action: SettingsAction, own_stream: Option<Stream>) -> Option<QueuedJob> {
        let is_calibrating = matches!(action, SettingsAction::OpenInput | SettingsAction::CloseInput);
        if action != SettingsAction::Cancel && self.calibration.is_some() != is_calibrating {
            return None;
        }
        let calibrating = if is_calibrating { Some(self.calibrating(action)?) } else { None };
        let job = self.settings.begin(action, own_stream, calibrating)?;
        self.sheet = None;
        Some(job)
    }

    /// What keeps the journal of the calibration, and what opens or closes its input.
    fn calibrating(&mut self, action: SettingsAction) -> Option<Calibrating> {
        let settings = &*self.settings;
        let run = self.screen.calibration.as_mut()?;
        let unit = run.unit.clone();
        let keeper = run.keeper(|| settings.keeper_of(&unit))?;
        Some(Calibrating { unit: run.unit.clone(), wanted: run.image(action), keeper })
    }

    /// The job was not taken.
    pub fn not_begun(&mut self) {
        self.settings.not_begun();
        self.calibration_not_begun();
    }

    /// Takes in what work with the settings came to.
    pub fn take(&mut self, ended: Ended) -> Vec<Effect> {
        let mut effects = self.take_ended(ended);
        let faults = self.settings.take_kept_faults();
        effects.extend(faults.into_iter().map(|fault| Effect::Say(Gravity::Error, fault)));
        effects
    }

    fn take_ended(&mut self, ended: Ended) -> Vec<Effect> {
        match ended {
            Ended::Said(said) => said.into_iter().map(|(gravity, text)| Effect::say(gravity, text)).collect(),
            Ended::Calibrated(report) => {
                let summary = self.calibration_step_ended(report);
                self.tell(summary)
            }
            Ended::Reported { summary, is_quiet, is_unfinished, .. } => {
                let mut effects = self.tell(summary);
                if is_quiet {
                    effects.clear();
                }
                if is_unfinished {
                    effects.extend(self.tell_unfinished());
                }
                effects
            }
        }
    }

    /// The link is gone: what was begun here ends. Edits stay.
    pub fn link_ended(&mut self) {
        self.sheet = None;
        self.waiting_sheet = None;
        self.calibration_lost();
        self.clamp.forget_job();
        self.settings.link_ended();
    }

    fn tell(&mut self, reported: Summary) -> Vec<Effect> {
        if !reported.sentences.is_empty() {
            self.open(Sheet::Report { title: reported.summary.clone(), sentences: reported.sentences });
        } else if let Some(sheet) = self.waiting_sheet.take() {
            self.open(sheet);
        }
        vec![Effect::say(reported.gravity, reported.summary)]
    }

    fn tell_unfinished(&mut self) -> Vec<Effect> {
        let aftermaths = self.settings.aftermaths();
        let Some(newest) = aftermaths.last() else { return Vec::new() };
        let text = OutcomeMessage::Unfinished { what: newest.headline() };
        self.open(Sheet::Unfinished);
        vec![Effect::say(Gravity::Error, text)]
    }
}
