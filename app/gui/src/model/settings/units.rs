//! The settings of every unit met on one link, what is being read or written of them, and what is kept of them.
//!
//! Edits belong to a unit and stay until they are written or reverted, whatever screen is shown, and over a lost link.

use std::collections::BTreeMap;

use brushwork_link::settings::{Profile, WriteReport};
use brushwork_link::{Event, Identity, JobEnding, Message, QueuedJob, SettingsImage, Stream};

use super::kept::{Came, Kept};
use super::outcome;
use super::summary::Summary;
use super::unit::UnitSettings;
use super::unit_key::UnitKey;
use super::work::{self, Calibrating, Origin, Running, SettingsAction};
use crate::model::message::Gravity;
use brushwork_core::settings::{Act, Done};

/// After so many failures the settings are read no more before somebody asks.
const QUIET_TRIES: usize = 2;

/// The settings of every unit met on one link.
#[derive(Debug, Default)]
pub struct Settings {
    units: BTreeMap<UnitKey, UnitSettings>,
    current: Option<UnitKey>,
    /// What was asked of the device thread and has not ended, in the order in which it runs.
    jobs: Vec<Running>,
    pub(super) kept: Kept,
    /// How often reading that nobody asked for has failed on this link.
    quiet_failures: usize,
}

/// What work that has ended means beyond the settings.
#[derive(Debug)]
pub enum Ended {
    /// For the screen with all settings; quiet where nobody asked for it.
    Reported { summary: Summary, is_quiet: bool, is_unfinished: bool },
    /// An input was opened or closed, or could not be: what was written.
    Calibrated(Option<WriteReport>),
    /// For the message line alone.
    Said(Vec<(Gravity, Message)>),
}

impl Settings {
    /// Turns to the unit that is looked at. Its edits of earlier are there again. True where it is another one.
    pub fn look_at(&mut self, identity: &Identity) -> bool {
        let key = UnitKey::of(identity);
        if self.current.as_ref() == Some(&key) {
            return false;
        }
        self.units.entry(key.clone()).or_insert_with(|| UnitSettings::new(identity));
        self.look_up(key.clone(), identity);
        self.current = Some(key);
        true
    }

    pub fn current(&self) -> Option<&UnitKey> {
        self.current.as_ref()
    }

    pub fn unit(&self) -> Option<&UnitSettings> {
        self.units.get(self.current.as_ref()?)
    }

    pub fn unit_mut(&mut self) -> Option<&mut UnitSettings> {
        self.units.get_mut(self.current.as_ref()?)
    }

    /// What is known of the RAM of a unit that may not be the one that is looked at.
    pub fn profile_at(&self, identity: &Identity) -> Option<Profile> {
        self.units.get(&UnitKey::of(identity))?.profile(false)
    }

    /// A unit that may not be the one that is looked at.
    pub fn unit_at(&mut self, key: &UnitKey) -> Option<&mut UnitSettings> {
        self.units.get_mut(key)
    }

    pub(super) fn firmware_of(&self, key: &UnitKey) -> Option<&str> {
        self.units.get(key).map(UnitSettings::firmware)
    }

    /// Whether any unit has edits that were not written.
    pub fn has_edits(&self) -> bool {
        self.units.values().any(|unit| !unit.edits().is_empty())
    }

    /// Something else than this may have changed the controller's RAM: whoever shows it has it read again.
    pub fn doubt(&mut self) {
        if let Some(unit) = self.unit_mut() {
            unit.doubt();
        }
    }

    /// The work with settings that is to end before other work with them begins.
    pub fn running(&self) -> Option<&Running> {
        self.jobs.iter().find(|job| !job.is_view())
    }

    /// Whether anything was asked for that was not answered.
    pub fn is_at_work(&self) -> bool {
        !self.jobs.is_empty()
    }

    /// The same of what somebody waits for.
    pub fn is_busy(&self) -> bool {
        self.jobs.iter().any(|job| !job.is_quiet)
    }

    /// Whether the settings were not asked for yet, so that opening a screen with all of them reads them.
    pub fn wants_reading(&self) -> bool {
        self.running().is_none() && self.unit().is_some_and(|unit| !unit.was_asked())
    }

    /// What to ask of the device thread; `calibrating` is the input that is opened or closed. Nothing while other work runs.
    pub fn begin(
        &mut self,
        action: SettingsAction,
        stream: Option<Stream>,
        calibrating: Option<Calibrating>,
    ) -> Option<QueuedJob> {
        if action == SettingsAction::Cancel {
            let running = self.jobs.iter_mut().find(|job| !job.is_view())?;
            running.is_cancelled = true;
            // Whoever calls it off is told, and it is not begun again by itself.
            running.is_quiet = false;
            running.ticket.cancel();
            return None;
        }
        if self.running().is_some() {
            return None;
        }
        if let Some(calibrating) = calibrating {
            let unit = self.units.get(&calibrating.unit)?;
            let (table, options) = (unit.table().clone(), unit.options(&calibrating.wanted, stream));
            let begun = work::calibrate(calibrating, action == SettingsAction::OpenInput, table, options);
            return Some(self.asked(begun));
        }
        let unit = self.unit()?;
        let act = match action {
            SettingsAction::Read => Act::Read,
            SettingsAction::Reload => Act::Reload,
            // What the sheet has shown is written over what is read now.
            SettingsAction::Write => Act::Write { wanted: unit.edits().clone(), known: Default::default() },
            SettingsAction::Save => Act::Save,
            SettingsAction::RestoreDefaults => Act::RestoreDefaults,
            SettingsAction::OpenInput | SettingsAction::CloseInput | SettingsAction::Cancel => return None,
        };
        let job = self.begin_act(act, Origin::Settings(action), stream)?;
        self.unit_mut()?.was_asked = true;
        Some(job)
    }

    /// What to ask of the device thread to write values to RAM, edits or not. Nothing while somebody waits for other work;
    /// reading that nobody waits for gives way.
    pub fn apply(&mut self, wanted: SettingsImage, stream: Option<Stream>) -> Option<QueuedJob> {
        if wanted.is_empty() || self.is_busy() {
            return None;
        }
        let known = std::mem::take(&mut self.unit_mut()?.known);
        self.begin_act(Act::Write { wanted, known }, Origin::Loop, stream)
    }

    /// What to ask of the device thread to read what a screen shows: those of the keys that are not known, or in doubt. It is quiet
    /// where nobody waits for it.
    pub fn read(&mut self, keys: &[String], is_quiet: bool) -> Option<QueuedJob> {
        let keys = self.unit()?.unasked(keys);
        if keys.is_empty() {
            return None;
        }
        let job = self.begin_act(Act::ReadKeys(keys.clone()), Origin::View(keys.clone()), None)?;
        self.jobs.iter_mut().rev().take(1).for_each(|job| job.is_quiet = is_quiet);
        self.unit_mut()?.note_keys_asked(&keys);
        Some(job)
    }

    /// Reads what the controller works with, without a word: whoever is connected is to see what is saved and what is not.
    /// It gives way to whatever is asked for meanwhile, and is begun again.
    pub fn begin_quietly(&mut self) -> Option<QueuedJob> {
        if self.quiet_failures >= QUIET_TRIES {
            return None;
        }
        let job = self.begin(SettingsAction::Read, None, None)?;
        self.jobs.iter_mut().rev().take(1).for_each(|job| job.is_quiet = true);
        Some(job)
    }

    fn begin_act(&mut self, act: Act, origin: Origin, stream: Option<Stream>) -> Option<QueuedJob> {
        let key = self.current.clone()?;
        let unit = self.units.get(&key)?;
        let keeper = self.keeper_of(&key)?;
        let nothing = SettingsImage::default();
        let wanted = if let Act::Write { wanted, .. } = &act { wanted } else { &nothing };
        let options = unit.options(wanted, stream);
        let edits = unit.edits().iter().filter(|(key, _)| wanted.get(key).is_some());
        let replaced = edits.map(|(key, value)| (key.to_owned(), value)).collect();
        let (job, mut running) = work::begin(act, key, origin, unit.table().clone(), options, keeper);
        running.replaced = replaced;
        Some(self.asked((job, running)))
    }

    fn asked(&mut self, (job, running): (QueuedJob, Running)) -> QueuedJob {
        self.jobs.push(running);
        job
    }

    /// Whether the settings are being read without anybody having asked.
    pub fn is_reading_quietly(&self) -> bool {
        self.running().is_some_and(|running| running.is_quiet && !running.is_cancelled)
    }

    /// Makes reading that nobody asked for give way.
    pub fn give_way(&mut self) {
        for running in self.jobs.iter_mut().filter(|job| !job.is_view() && job.is_quiet) {
            running.is_cancelled = true;
            running.ticket.cancel();
        }
    }

    /// The job made last was not taken.
    pub fn not_begun(&mut self) {
        if let Some(job) = self.jobs.pop() {
            self.forget_asked(&job);
        }
    }

    /// Takes in an event of work that was begun here.
    pub fn take(&mut self, event: Event) -> Option<Ended> {
        let id = event.job()?;
        let place = self.jobs.iter().position(|job| job.ticket.id() == id)?;
        if let Event::JobProgress { fraction, text, .. } = event {
            let job = self.jobs.get_mut(place)?;
            (job.fraction, job.text) = (fraction, text);
            return None;
        }
        let Event::JobEnded(report) = event else { return None };
        let job = self.jobs.remove(place);
        self.ended(&job, &report.ending)
    }

    /// Takes in what work gave: the one place where a unit's settings change by what its controller says.
    fn ended(&mut self, job: &Running, ending: &JobEnding) -> Option<Ended> {
        let done = job.ticket.take();
        if done.is_none() {
            self.forget_asked(job);
        }
        let is_current = self.current.as_ref() == Some(&job.unit);
        let unit = self.units.get_mut(&job.unit)?;
        match (&job.origin, done) {
            (Origin::View(keys), done) => Some(Ended::Said(match done {
                Some(Done::Read(report)) => outcome::keys_read(unit, keys, &report, job.is_quiet),
                _ if job.is_quiet => Vec::new(),
                _ => outcome::nothing_came(job, ending).said(),
            })),
            (Origin::Loop, Some(done)) => Some(Ended::Said(outcome::applied(unit, done, &job.replaced))),
            (Origin::Loop, None) => Some(Ended::Said(outcome::nothing_came(job, ending).said())),
            (Origin::Settings(SettingsAction::OpenInput | SettingsAction::CloseInput), done) => {
                Some(Ended::Calibrated(match done {
                    Some(Done::Written(report, known)) => {
                        unit.note_written(&report, &SettingsImage::default(), known);
                        Some(*report)
                    }
                    _ => None,
                }))
            }
            (Origin::Settings(_), done) => {
                let came = done.as_ref().map(Came::of);
                let summary = match done {
                    Some(done) => outcome::take(unit, done, &job.replaced),
                    None => outcome::nothing_came(job, ending),
                };
                self.follow_address(&job.unit, summary.address);
                // Of reading that nobody asked for only what came of it is worth a word.
                let is_quiet = job.is_quiet && (came.is_none() || summary.gravity != Gravity::Warning);
                let failed = job.is_quiet && matches!(ending, JobEnding::Failed(_));
                self.quiet_failures += usize::from(came.is_none() && failed);
                let is_unfinished = is_current && self.note_came(came);
                Some(Ended::Reported { summary, is_quiet, is_unfinished })
            }
        }
    }

    /// Nothing came of it. What was begun by nobody, or for a screen, is begun again.
    fn forget_asked(&mut self, job: &Running) {
        let Some(unit) = self.units.get_mut(&job.unit) else { return };
        match &job.origin {
            Origin::View(keys) => unit.forget_keys_asked(keys),
            Origin::Settings(SettingsAction::Read) if job.is_quiet => unit.was_asked = false,
            Origin::Settings(_) | Origin::Loop => {}
        }
    }

    /// The link is gone: what the controllers hold may change unseen. Edits stay.
    pub fn link_ended(&mut self) {
        self.jobs.clear();
        self.quiet_failures = 0;
        self.current = None;
        self.kept.forget_unit();
        for unit in self.units.values_mut() {
            unit.forget();
        }
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
