//! What acts that were cut short have left on a controller, told whenever its settings were read.

use crate::messages::CliSettingsMessage;
use brushwork_link::settings::{Act, ReadReport};

use crate::output::say;
use brushwork_core::examine::RawWrite;
use brushwork_core::keep::{KeepError, OpenJournal, Store, UnitId, aftermaths};
use brushwork_core::settings::raw::told_of_cut_off;

/// More sentences than this are told by `unfinished` alone.
const TOLD_IN_PASSING: usize = 30;

/// Says on standard error what an act that was cut short has left of the settings just read.
pub fn tell(unit: &UnitId, ram: &ReadReport) {
    let journals = journals(unit);
    for aftermath in aftermaths(&journals, &ram.table, &ram.image) {
        say(aftermath.headline());
        let sentences = aftermath.sentences(&ram.table);
        sentences
            .iter()
            .take(TOLD_IN_PASSING)
            .for_each(|sentence| say(CliSettingsMessage::Listed { sentence: sentence.to_string() }));
        if sentences.len() > TOLD_IN_PASSING {
            say(CliSettingsMessage::AndMore { count: sentences.len() - TOLD_IN_PASSING });
        }
    }
    if !journals.is_empty() {
        say(CliSettingsMessage::SeeUnfinished);
    }
    tell_raw(unit, ram);
}

/// Says on standard error what the registers hold whose raw numbers were cut off before they were read back, once.
pub fn tell_raw(unit: &UnitId, ram: &ReadReport) {
    match told_of_cut_off(&Store::of_user(), unit, &ram.table, &ram.image) {
        Ok(sentences) => sentences.into_iter().for_each(say),
        // A user without a home has kept nothing.
        Err(KeepError::NoFolder) => {}
        Err(fault) => say(fault.to_string()),
    }
}

/// Says on standard error that something which was begun on a unit did not end, for commands that do not read its settings.
pub fn announce(unit: &UnitId, port: &str) {
    for open in journals(unit) {
        let (act, begun, port) = (open.journal.act, open.journal.begun(), port.to_owned());
        say(match act {
            Act::Trial => CliSettingsMessage::NotGivenBack { begun, port },
            Act::Write | Act::Save | Act::Defaults | Act::Reload | Act::Firmware => {
                CliSettingsMessage::DidNotEnd { act: act.label(), begun, port }
            }
        });
    }
    // A list that cannot be read is told by whoever reads the settings.
    let raw = Store::of_user().raw_writes(unit).unwrap_or_default();
    for write in raw.into_iter().filter(|write| write.is_open) {
        let RawWrite { key, date, wanted, .. } = write;
        say(CliSettingsMessage::RawNotReadBack { key, date, wanted, port: port.to_owned() });
    }
}

/// What was begun on a unit and not ended; files that cannot be read are told.
pub fn journals(unit: &UnitId) -> Vec<OpenJournal> {
    let (journals, faults) = Store::of_user().open_journals(unit);
    faults.iter().for_each(|fault| say(fault.to_string()));
    journals
}
