//! What work with settings gave, taken over into a unit's settings and told in sentences.

use brushwork_link::messages::SaveMessage;
use brushwork_link::settings::{
    DefaultsReport, Known, ReadFailure, RowState, SaveReport, SaveVerdict, WriteError, WriteReport,
};
use brushwork_link::{Failure, JobEnding, Message, ReadReport, SettingsImage, SettingsTable};
use brushwork_values::Sentences;

use super::summary::Summary;
use super::unit::UnitSettings;
use super::work::Running;
use crate::messages::OutcomeMessage;
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
) -> Vec<(Gravity, Message)> {
    unit.note_keys(keys, &report.image);
    let failures = report.unread().filter(|_| !is_quiet);
    failures.map(|unread| (Gravity::Error, unread.failure.message())).collect()
}

/// For whoever writes single values to RAM.
pub(super) fn applied(
    unit: &mut UnitSettings,
    done: Done,
    replaced: &SettingsImage,
) -> Vec<(Gravity, Message)> {
    let (report, known) = match done {
        Done::Written(report, known) => (report, known),
        Done::NotWritten(error) => return vec![(Gravity::Error, Message::error(error))],
        Done::Read(_) | Done::Reloaded(_) | Done::Saved(_) | Done::Restored(_) => return Vec::new(),
    };
    unit.note_written(&report, replaced, known);
    let mut said: Vec<(Gravity, Message)> =
        report.warnings.iter().map(|text| (Gravity::Warning, text.clone())).collect();
    let wrong = report.sentences(unit.table());
    let taken = report.rows.iter().filter(|row| row.state == RowState::Taken).count();
    said.push(match wrong.is_empty() {
        true => (Gravity::Note, OutcomeMessage::Applied { settings: counted(taken) }.into()),
        false => (Gravity::Error, OutcomeMessage::Wrong { sentences: Sentences(wrong) }.into()),
    });
    said
}

/// The work ended without a result.
pub(super) fn nothing_came(running: &Running, ending: &JobEnding) -> Summary {
    let (gravity, summary) = match ending {
        JobEnding::Interrupted(cause) => {
            (Gravity::Warning, OutcomeMessage::NotDone { act: running.name().clone(), cause: *cause }.into())
        }
        JobEnding::Failed(failure) => (Gravity::Error, failure.message()),
        JobEnding::Panicked(word) => (
            Gravity::Error,
            OutcomeMessage::Panicked { act: running.name().clone(), word: word.clone() }.into(),
        ),
        JobEnding::Done(()) => {
            (Gravity::Error, OutcomeMessage::NoResult { act: running.name().clone() }.into())
        }
    };
    Summary { gravity, summary, sentences: Vec::new(), address: None }
}

fn read(unit: &mut UnitSettings, report: ReadReport, from_eeprom: bool) -> Summary {
    let (known, failed) = (report.image.len(), unread(&report));
    let absent = rows_of(report.failures.iter().filter(|failure| failure.is_absent));
    unit.note_read(report, from_eeprom);
    let (gravity, rest) = match (failed, absent) {
        (0, 0) => (Gravity::Note, Message::default()),
        (0, _) => (Gravity::Note, OutcomeMessage::Absent { settings: counted(absent) }.into()),
        _ => (Gravity::Warning, OutcomeMessage::Unread { settings: capital(&counted(failed)) }.into()),
    };
    let settings = capital(&counted(known));
    let summary = match from_eeprom {
        true => OutcomeMessage::Loaded { settings, rest },
        false => OutcomeMessage::Read { settings, rest },
    };
    Summary { gravity, summary: summary.into(), sentences: Vec::new(), address: None }
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
        (Gravity::Note, OutcomeMessage::Written { settings: capital(&counted(wanted)) })
    } else {
        sentences.extend(report.warnings.iter().cloned());
        (Gravity::Error, OutcomeMessage::NotTaken { failed, settings: counted(wanted) })
    };
    Summary { gravity, summary: summary.into(), sentences, address: Some(report.address.get()) }
}

fn not_written(error: WriteError) -> Summary {
    let (summary, sentences) = match error {
        WriteError::Refused { refusals } => {
            (OutcomeMessage::SomeCannotBe, refusals.into_iter().map(|refusal| refusal.sentence).collect())
        }
        WriteError::NotRead { failure } | WriteError::NotKept { failure } => {
            (OutcomeMessage::NothingWritten { failure: failure.message() }, Vec::new())
        }
    };
    Summary { gravity: Gravity::Error, summary: summary.into(), sentences, address: None }
}

fn saved(unit: &mut UnitSettings, report: &SaveReport) -> Summary {
    let gravity = match report.verdict {
        SaveVerdict::Verified | SaveVerdict::Stored => Gravity::Note,
        SaveVerdict::Acknowledged => Gravity::Warning,
        SaveVerdict::NotSaved | SaveVerdict::Unknown => Gravity::Error,
    };
    let sentences = differences(unit.table(), report);
    unit.note_saved(report);
    Summary { gravity, summary: report.sentence(), sentences, address: None }
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
    let summary = match own {
        0 => OutcomeMessage::Defaults,
        _ => OutcomeMessage::OwnDefaults { settings: capital(&counted(own)) },
    };
    Summary { gravity: Gravity::Note, summary: summary.into(), sentences: Vec::new(), address: Some(address) }
}
