//! What work with settings gave, taken over into a unit's settings and told in sentences.

use brushwork_link::messages::SaveMessage;
use brushwork_link::settings::{
    DefaultsReport, Known, ReadFailure, RowState, SaveReport, SaveVerdict, WriteError, WriteReport,
};
use brushwork_link::{Failure, JobEnding, Message, ReadReport, SettingsImage, SettingsTable};

use super::summary::Summary;
use super::unit::UnitSettings;
use super::work::Running;
use crate::model::message::Gravity;
use brushwork_core::settings::{Done, counted};
use brushwork_core::words::capital;

/// For the screen with all settings.
pub(super) fn take(unit: &mut UnitSettings, done: Done, replaced: &SettingsImage) -> Summary {
    match done {
        Done::Read(report) => read(unit, *report, false),
        Done::Reloaded(report) => read(unit, *report, true),
        Done::Written(report, known) => written(unit, &report, replaced, known),
        Done::NotWritten(error) => not_written(error),
        Done::Saved(report) => saved(unit, &report),
        Done::Restored(report) => restored(unit, *report),
    }
}

/// For a screen that shows some settings: what could not be read, unless nobody waits for it.
pub(super) fn keys_read(
    unit: &mut UnitSettings,
    keys: &[String],
    report: &ReadReport,
    is_quiet: bool,
) -> Vec<(Gravity, String)> {
    unit.note_keys(keys, &report.image);
    let failures = report.unread().filter(|_| !is_quiet);
    failures.map(|unread| (Gravity::Error, unread.failure.to_string())).collect()
}

/// For whoever writes single values to RAM.
pub(super) fn applied(
    unit: &mut UnitSettings,
    done: Done,
    replaced: &SettingsImage,
) -> Vec<(Gravity, String)> {
    let (report, known) = match done {
        Done::Written(report, known) => (report, known),
        Done::NotWritten(error) => return vec![(Gravity::Error, error.to_string())],
        Done::Read(_) | Done::Reloaded(_) | Done::Saved(_) | Done::Restored(_) => return Vec::new(),
    };
    unit.note_written(&report, replaced, known);
    let mut said: Vec<(Gravity, String)> =
        report.warnings.iter().map(|text| (Gravity::Warning, text.to_string())).collect();
    let wrong = report.sentences(unit.table());
    let taken = report.rows.iter().filter(|row| row.state == RowState::Taken).count();
    said.push(match wrong.is_empty() {
        true => (
            Gravity::Note,
            format!(
                "Applied and read back: {} in the controller's RAM. Until they are saved to EEPROM they last \
                 until it is switched off.",
                counted(taken)
            ),
        ),
        false => (Gravity::Error, wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")),
    });
    said
}

/// The work ended without a result.
pub(super) fn nothing_came(running: &Running, ending: &JobEnding) -> Summary {
    let (gravity, summary) = match ending {
        JobEnding::Interrupted(cause) => (
            Gravity::Warning,
            format!("Did not {}: {cause}. What the screen shows is from before.", running.name()),
        ),
        JobEnding::Failed(failure) => (Gravity::Error, failure.to_string()),
        JobEnding::Panicked(word) => (
            Gravity::Error,
            format!(
                "Could not {}: the program has a fault ({word}). Read the settings to see what they are.",
                running.name()
            ),
        ),
        JobEnding::Done(()) => (Gravity::Error, format!("Could not {}: no result came.", running.name())),
    };
    Summary { gravity, summary, sentences: Vec::new(), address: None }
}

fn read(unit: &mut UnitSettings, report: ReadReport, from_eeprom: bool) -> Summary {
    let (known, failed) = (report.image.len(), unread(&report));
    let absent = rows_of(report.failures.iter().filter(|failure| failure.is_absent));
    let from = if from_eeprom { "loaded from EEPROM and read" } else { "read" };
    unit.note_read(report, from_eeprom);
    let (gravity, rest) = match (failed, absent) {
        (0, 0) => (Gravity::Note, String::new()),
        (0, _) => (Gravity::Note, format!(" This firmware does not have {}.", counted(absent))),
        _ => (
            Gravity::Warning,
            format!(" {} could not be read; each row says why.", capital(&counted(failed))),
        ),
    };
    let summary = format!("{} {from}.{rest}", capital(&counted(known)));
    Summary { gravity, summary, sentences: Vec::new(), address: None }
}

fn unread(report: &ReadReport) -> usize {
    rows_of(report.unread())
}

fn rows_of<'r>(failures: impl Iterator<Item = &'r ReadFailure>) -> usize {
    failures.map(|failure| failure.keys.len()).sum()
}

fn written(unit: &mut UnitSettings, report: &WriteReport, replaced: &SettingsImage, known: Known) -> Summary {
    let wanted = report.rows.len();
    let failed = report.did_not_take().count();
    let mut sentences = report.sentences(unit.table());
    sentences.extend(report.ended_early.iter().map(Failure::message));
    unit.note_written(report, replaced, known);
    let (gravity, summary) = if failed == 0 {
        let text = format!(
            "{} written and read back as wanted. Save to EEPROM to keep them over a power cycle.",
            capital(&counted(wanted))
        );
        (Gravity::Note, text)
    } else {
        sentences.extend(report.warnings.iter().cloned());
        let text = format!("{failed} of {} did not take; their rows keep the change.", counted(wanted));
        (Gravity::Error, text)
    };
    Summary { gravity, summary, sentences, address: Some(report.address.get()) }
}

fn not_written(error: WriteError) -> Summary {
    let (summary, sentences) = match error {
        WriteError::Refused { refusals } => (
            "Nothing was written: some of the changes cannot be.".to_owned(),
            refusals.into_iter().map(|refusal| refusal.sentence).collect(),
        ),
        WriteError::NotRead { failure } | WriteError::NotKept { failure } => {
            (format!("Nothing was written. {failure}"), Vec::new())
        }
    };
    Summary { gravity: Gravity::Error, summary, sentences, address: None }
}

fn saved(unit: &mut UnitSettings, report: &SaveReport) -> Summary {
    let gravity = match report.verdict {
        SaveVerdict::Verified | SaveVerdict::Stored => Gravity::Note,
        SaveVerdict::Acknowledged => Gravity::Warning,
        SaveVerdict::NotSaved | SaveVerdict::Unknown => Gravity::Error,
    };
    let sentences = differences(unit.table(), report);
    unit.note_saved(report);
    Summary { gravity, summary: report.sentence().to_string(), sentences, address: None }
}

fn differences(table: &SettingsTable, report: &SaveReport) -> Vec<Message> {
    let wanted = report.differences.iter();
    let mut sentences: Vec<Message> = wanted
        .filter_map(|difference| {
            let row = table.row(&difference.key)?;
            Some(SaveMessage::Differs { difference: difference.describe(row) }.into())
        })
        .collect();
    sentences.extend(report.put_back.iter().flat_map(|put_back| put_back.sentences(table)));
    sentences
}

fn restored(unit: &mut UnitSettings, report: DefaultsReport) -> Summary {
    let own = report.differences.len();
    let address = report.address.get();
    unit.note_read(report.read, false);
    let mut summary =
        "The controller works with its default settings. Save to EEPROM to keep them.".to_owned();
    if own > 0 {
        summary += &format!(" {} came back with another value than listed here.", capital(&counted(own)));
    }
    Summary { gravity: Gravity::Note, summary, sentences: Vec::new(), address: Some(address) }
}
