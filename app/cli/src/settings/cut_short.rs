//! What acts that were cut short have left on a controller, told whenever its settings were read.

use crate::messages::CliSettingsMessage;
use brushwork_link::settings::{Act, ReadReport};

use crate::output::say;
use brushwork_core::keep::{OpenJournal, Store, UnitId, aftermaths};

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
}

/// What was begun on a unit and not ended; files that cannot be read are told.
pub fn journals(unit: &UnitId) -> Vec<OpenJournal> {
    let (journals, faults) = Store::of_user().open_journals(unit);
    faults.iter().for_each(|fault| say(fault.to_string()));
    journals
}
