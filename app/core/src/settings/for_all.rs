//! One profile for several controllers: what each of them gets of it. Nothing is written to any before all are known to take theirs.

use brushwork_link::settings::{Difference, OpenedProfile, ReadReport, diff, plan};
use brushwork_link::{Message, SettingsImage, SettingsTable, WriteOptions};

use super::{fitted, merged, write_options};
use crate::messages::ForAllMessage;

/// What one of several controllers gets of a profile.
#[derive(Clone, Debug)]
pub struct Share {
    /// Its table.
    pub table: SettingsTable,
    /// What is written.
    pub changes: SettingsImage,
    /// How.
    pub options: WriteOptions,
    /// What changes, in screen order.
    pub differences: Vec<Difference>,
    /// What had to be changed of the profile and what is left out of it, a sentence each.
    pub notes: Vec<Message>,
    /// What is to be known before it is written.
    pub warnings: Vec<Message>,
}

impl Share {
    /// What a controller gets of which all settings were read.
    ///
    /// # Errors
    /// Every reason why it cannot take it.
    pub fn new(
        opened: &OpenedProfile,
        ram: &ReadReport,
        options: WriteOptions,
    ) -> Result<Self, Vec<Message>> {
        let (table, image) = (&ram.table, &ram.image);
        let (profile, mut notes) = fitted(opened.clone(), table);
        let asked = profile.changes_for(table, image, options.simulated);
        let asked =
            asked.map_err(|error| error.problems.into_iter().map(Message::error).collect::<Vec<_>>())?;
        let mut changes = asked.wanted;
        notes.extend(asked.left_out);
        notes.extend(keep_addresses(table, &mut changes));
        let sentences = |refusals: Vec<brushwork_link::settings::Refusal>| -> Vec<Message> {
            refusals.into_iter().map(|refusal| refusal.sentence).collect()
        };
        let options = write_options(table, image, &changes, |_, _| true, options).map_err(sentences)?;
        let warnings = plan(table, image, &changes, options).map_err(sentences)?.warnings;
        let differences = diff(table, image, &merged(image, &changes));
        Ok(Self { table: table.clone(), changes, options, differences, notes, warnings })
    }
}

/// Takes the address out of what a profile has for several controllers: with it all of them would answer at the same. A sentence for each setting
/// that is left out.
pub fn keep_addresses(table: &SettingsTable, changes: &mut SettingsImage) -> Vec<Message> {
    let keys = table.subject().family().settings().address_keys();
    let mut kept = Vec::new();
    for row in keys.iter().filter_map(|key| table.row(key)) {
        if changes.get(&row.key).is_some() {
            changes.remove(&row.key);
            kept.push(ForAllMessage::AddressKept { title: row.title() }.into());
        }
    }
    kept
}
