//! `brushwork tune replay`: same record in, same gains out.

use crate::messages::CliTuneMessage;
use std::path::Path;

use super::words;
use crate::{Exit, Output, say};
use brushwork_core::tune::file;
use brushwork_core::tune::law::Report;

/// Reads a report, runs the tuner on its record and compares.
pub fn run(path: &Path, json: bool, out: &mut Output) -> Exit {
    let report = match file::read(path) {
        Ok(report) => report,
        Err(sentence) => {
            say(sentence);
            return Exit::Failed;
        }
    };
    let again = match report.replay_or_stray() {
        Ok(again) => again,
        Err(entry) => {
            say(CliTuneMessage::OtherRecord {
                file: path.display().to_string(),
                entry: entry + 1,
                of: report.record.len(),
            });
            return Exit::Failed;
        }
    };
    let printed = if json { out.json(&words::summary(&again)) } else { words::print(&again, out) };
    if let Err(error) = printed {
        return error.into();
    }
    if again == report {
        say(CliTuneMessage::SameResult);
        words::exit_of(&again)
    } else {
        say(CliTuneMessage::OtherResult {
            file: path.display().to_string(),
            parts: differing(&report, &again),
        });
        Exit::Failed
    }
}

/// The names of the fields that differ.
fn differing(held: &Report, found: &Report) -> String {
    let (held, found) = (words::summary(held), words::summary(found));
    let Some(fields) = held.as_object() else { return "all of it".to_owned() };
    let names = fields.iter().filter(|(name, value)| found.get(name.as_str()) != Some(*value));
    let names: Vec<String> = names.map(|(name, _)| format!("\"{name}\"")).collect();
    if names.is_empty() { "its record".to_owned() } else { names.join(", ") }
}
