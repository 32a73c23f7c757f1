//! Judges the steps of the guided path by what a controller holds and by what was seen of its motors.

use brushwork_link::settings::{Row, SettingsImage};
use brushwork_values::Motor;

use super::Connection;
use super::path::{Judged, Standing};
use super::settings::{Saved, UnitSettings};
use crate::family::path::{PathStep, Place, ShownBy, Step};
use crate::messages::PathMessage;

impl Connection {
    /// The steps of the controller's family, as they stand; empty where it has none. Those whose screen it does not have as it is set are
    /// left out.
    pub fn path_steps(&mut self) -> Vec<Judged> {
        self.compare_backup();
        let screens = self.screens();
        let is_there = |step: &&PathStep| match step.place {
            Place::Screen(screen) => screens.contains(&screen),
            Place::Drawer(screen, tab) => {
                screens.contains(&screen) && self.family().tabs(screen).contains(&tab)
            }
            Place::Settings(groups) => self.first_row_of(groups).is_some(),
            Place::Recipe(_) | Place::Save | Place::BackUp => true,
        };
        self.family().path().iter().filter(is_there).map(|step| self.judged(*step)).collect()
    }

    /// The first row of the first of these groups that the unit has.
    pub fn first_row_of(&self, groups: &[&str]) -> Option<&Row> {
        let rows = self.settings.unit()?.table().rows();
        groups.iter().find_map(|group| rows.iter().find(|row| row.group.label() == *group))
    }

    fn judged(&self, step: PathStep) -> Judged {
        let (standing, note) = self.standing(step);
        let is_left_out = standing == Standing::ToDo && self.path.is_left_out(step.step);
        let standing = if is_left_out { Standing::NotNeeded } else { standing };
        Judged { step, standing, note: note.into() }
    }

    fn standing(&self, step: PathStep) -> (Standing, PathMessage) {
        use PathMessage as M;
        let unread = (Standing::NotKnown, M::Unread);
        match step.shown_by {
            ShownBy::Settings(keys) => match self.set_by(keys) {
                None => unread,
                Some(motors) if motors.is_empty() => (Standing::ToDo, M::Factory),
                Some(motors) => (Standing::Done, M::Set { motors: self.named(&motors) }),
            },
            ShownBy::IfWanted(keys) => match self.set_by(keys) {
                None => unread,
                Some(motors) if motors.is_empty() => (Standing::NotNeeded, M::IfWanted),
                Some(motors) => (Standing::Done, M::Set { motors: self.named(&motors) }),
            },
            ShownBy::Turning => self.direction(),
            ShownBy::Counting => self.counting(),
            ShownBy::Switches => match self.settings.unit().and_then(|unit| unit.ram()) {
                None => unread,
                Some(ram) if self.family().has_pin_actions(ram) => (Standing::Done, M::HasSwitch),
                Some(_) => (Standing::NotNeeded, M::NoSwitch),
            },
            ShownBy::Saved => match self.settings.unit().map(UnitSettings::saved) {
                None => unread,
                Some(Saved::Yes) => (Standing::Done, M::Saved),
                Some(Saved::Differs(1)) => (Standing::ToDo, M::OneDiffers),
                Some(Saved::Differs(count)) => (Standing::ToDo, M::Differs { count }),
                Some(Saved::NotKnown { written: 0 }) => (Standing::NotNeeded, M::NothingWritten),
                Some(Saved::NotKnown { written: 1 }) => (Standing::ToDo, M::OneWritten),
                Some(Saved::NotKnown { written }) => (Standing::ToDo, M::Written { written }),
            },
            ShownBy::BackedUp => match &self.path.compared {
                _ if self.settings.unit().is_none_or(|unit| unit.ram().is_none()) => unread,
                Some((_, _, true)) => (Standing::Done, M::BackedUp),
                Some((_, _, false)) => (Standing::ToDo, M::BackupDiffers),
                None => (Standing::ToDo, M::NoBackup),
            },
        }
    }

    /// The motors of which one of these settings is not the factory's; all of them where it is a setting of the unit. `None` before they
    /// were read.
    fn set_by(&self, keys: &[&str]) -> Option<Vec<Motor>> {
        let unit = self.settings.unit()?;
        let ram = unit.ram()?;
        let is_set = |key: &str| {
            let factory = unit.table().row(key).map(|row| row.default);
            factory.is_some_and(|factory| ram.get(key).is_some_and(|held| held != factory))
        };
        let of = |motor: &Motor| {
            let number = (motor.index() + 1).to_string();
            keys.iter().any(|key| is_set(&key.replace("{n}", &number)))
        };
        Some(self.motors().iter().copied().filter(of).collect())
    }

    /// "M1 and M2", or what a controller with one motor calls it.
    fn named(&self, motors: &[Motor]) -> String {
        if self.motors().len() < 2 {
            return "the motor".to_owned();
        }
        motors.iter().map(Motor::to_string).collect::<Vec<_>>().join(" and ")
    }

    /// Whether a loop was set, which works with no wrong direction and no dead encoder.
    fn has_loop(&self) -> bool {
        let is_loop = |step: &&PathStep| matches!(step.step, Step::Velocity | Step::Position);
        let loops = self.family().path().iter().filter(is_loop);
        let keys = loops.filter_map(|step| match step.shown_by {
            ShownBy::Settings(keys) => Some(keys),
            ShownBy::IfWanted(_)
            | ShownBy::Turning
            | ShownBy::Counting
            | ShownBy::Switches
            | ShownBy::Saved
            | ShownBy::BackedUp => None,
        });
        keys.filter_map(|keys| self.set_by(keys)).any(|motors| !motors.is_empty())
    }

    fn direction(&self) -> (Standing, PathMessage) {
        let of = |wanted: bool| -> Vec<Motor> {
            let seen = |motor: &Motor| self.path.turning.agrees(*motor) == Some(wanted);
            self.motors().iter().copied().filter(seen).collect()
        };
        let (against, along) = (of(false), of(true));
        if !against.is_empty() {
            return (Standing::Wrong, PathMessage::Against { motors: self.named(&against) });
        }
        match along.is_empty() {
            false => (Standing::Done, PathMessage::Along { motors: self.named(&along) }),
            true if self.has_loop() => (Standing::Done, PathMessage::LoopIsSet),
            true => (Standing::ToDo, PathMessage::NotTurned),
        }
    }

    fn counting(&self) -> (Standing, PathMessage) {
        let counts = |motor: &Motor| self.path.turning.counts(*motor);
        let motors: Vec<Motor> = self.motors().iter().copied().filter(counts).collect();
        match motors.is_empty() {
            false => (Standing::Done, PathMessage::Counts { motors: self.named(&motors) }),
            true if self.has_loop() => (Standing::Done, PathMessage::LoopIsSet),
            true => (Standing::ToDo, PathMessage::NoCount),
        }
    }

    /// Looks whether the newest backup holds what the controller works with, once for each backup and each change of settings.
    fn compare_backup(&mut self) {
        let newest = self.settings.backups().first();
        let (Some(backup), Some(unit)) = (newest, self.settings.unit()) else {
            self.path.compared = None;
            return;
        };
        let Some(ram) = unit.ram() else { return };
        let is_known =
            |(name, revision, _): &(String, u64, bool)| *name == backup.name && *revision == unit.revision();
        if self.path.compared.as_ref().is_some_and(is_known) {
            return;
        }
        let kept = backup.open().ok().map(|opened| opened.profile.settings);
        let holds = kept.is_some_and(|kept| holds_all(&kept, ram));
        self.path.compared = Some((backup.name.clone(), unit.revision(), holds));
    }
}

fn holds_all(kept: &SettingsImage, ram: &SettingsImage) -> bool {
    ram.iter().all(|(key, value)| kept.get(key) == Some(value))
}
