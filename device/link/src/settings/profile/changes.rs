//! What brings a controller to a profile, and why a profile is not for it.

use super::super::difference::changes;
use super::super::image::SettingsImage;
use super::super::subject::Subject;
use super::super::table::SettingsTable;
use super::content::Profile;
use super::error::{Problem, ProfileError};
use crate::family::Model;
use crate::messages::ProfileMessage;
use crate::unit::FirmwareGeneration;
use brushwork_values::Message;

/// What a profile asks of a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileChanges {
    /// The values that differ and can be written.
    pub wanted: SettingsImage,
    /// Those that differ and cannot be written on this controller, a sentence each.
    pub left_out: Vec<Message>,
}

impl Profile {
    /// What brings a controller to this profile, values out of range as they stand. Refuses, with every reason, when the profile
    /// was made for another model or generation, or holds what that controller does not have or cannot hold.
    pub fn changes_for(
        &self,
        table: &SettingsTable,
        ram: &SettingsImage,
        simulated: bool,
    ) -> Result<ProfileChanges, ProfileError> {
        let mut problems = self.misfits(table.subject());
        let is_foreign = !problems.is_empty();
        let mut left_out = Vec::new();
        let mut wanted = changes(table, ram, &self.settings);
        for (key, value) in self.settings.iter() {
            match table.row(key) {
                None => problems.push(Problem::at_key(key, ProfileMessage::NoSuchSettingConnected)),
                Some(_) if wanted.get(key).is_none() => {}
                Some(row) => match row.locked(simulated) {
                    Some(reason) => {
                        let (title, value) = (row.title(), row.format(value));
                        left_out.push(ProfileMessage::Locked { title, value, reason }.into());
                        wanted.remove(key);
                    }
                    None => {
                        let why =
                            if is_foreign { row.check(value).err() } else { row.check_as_read(value).err() };
                        problems.extend(why.map(|why| Problem::at_key(key, why)));
                    }
                },
            }
        }
        if problems.is_empty() {
            Ok(ProfileChanges { wanted, left_out })
        } else {
            Err(ProfileError { problems })
        }
    }

    /// Why the profile is not for that controller as a whole.
    fn misfits(&self, other: &Subject) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.subject.model != other.model {
            problems.push(Problem::at_key("model", model_misfit(self.subject.model, other.model)));
        }
        if self.subject.generation != other.generation {
            problems.push(Problem::at_key(
                "generation",
                generation_misfit(self.subject.generation, other.generation),
            ));
        }
        problems
    }
}

pub fn model_misfit(profile: &Model, connected: &Model) -> Message {
    ProfileMessage::OtherModel {
        made_for: profile.name,
        its_rating: profile.rating,
        connected: connected.name,
        rating: connected.rating,
    }
    .into()
}

pub fn generation_misfit(made_for: FirmwareGeneration, connected: FirmwareGeneration) -> Message {
    ProfileMessage::OtherGeneration { made_for, connected }.into()
}
