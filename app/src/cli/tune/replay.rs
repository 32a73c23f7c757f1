//! `brushwork tune replay`: same record in, same gains out.

use std::path::Path;

use brushwork_tuning::report::Report;

use super::words;
use crate::cli::exit::Exit;
use crate::cli::output::{Output, say};

/// Reads a report, runs the tuner on its record and compares.
pub fn run(path: &Path, json: bool, out: &mut Output) -> Exit {
    let read = std::fs::read_to_string(path)
        .map_err(|error| error.to_string())
        .and_then(|text| serde_json::from_str::<Report>(&text).map_err(|error| error.to_string()));
    let report = match read {
        Ok(report) => report,
        Err(error) => {
            say(format!("Could not read the report {}: {error}.", path.display()));
            return Exit::Failed;
        }
    };
    let Some(again) = report.replay() else {
        say(format!(
            "The record in {} does not belong to this version of the tuner, or was changed: it asks for other steps.",
            path.display()
        ));
        return Exit::Failed;
    };
    let printed = if json { out.json(&words::summary(&again)) } else { words::print(&again, out) };
    if let Err(error) = printed {
        return error.into();
    }
    if again == report {
        say("The replay gives the same result to the last bit.");
        words::exit_of(&again)
    } else {
        say("The replay gives another result than the report holds.");
        Exit::Failed
    }
}
