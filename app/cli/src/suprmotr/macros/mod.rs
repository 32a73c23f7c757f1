//! `brushwork macro`: macro files, checked, formatted, run, and sent to controllers and back.

mod args;
mod run;
mod source;
mod transfer;

use std::path::Path;

use brushwork_link::files;
use brushwork_script::diagnostic::{PlacedDiagnostic, Severity};
use brushwork_suprmotr_macros::{Macro, format};
use serde::Serialize;

use crate::messages::CliMacroMessage;
use crate::{Exit, Interrupt, Output, say};
pub use args::MacroArgs;
use args::{CheckArgs, FmtArgs, MacroCommand};
use source::{Source, is_standard};

/// Does what is asked.
pub fn run(args: &MacroArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.command {
        MacroCommand::Check(args) => check(args, out),
        MacroCommand::Fmt(args) => fmt(args, out),
        MacroCommand::Run(args) => run::run(args, out, interrupt),
        MacroCommand::Upload(args) => transfer::upload(args, out, interrupt),
        MacroCommand::Read(args) => transfer::read(args, out, interrupt),
    }
}

/// What is said of one file.
#[derive(Serialize)]
struct CheckedFile {
    file: String,
    ok: bool,
    errors: usize,
    warnings: usize,
    diagnostics: Vec<PlacedDiagnostic>,
    macros: Vec<Defined>,
}

/// A macro, and the line that defines it.
#[derive(Serialize)]
struct Defined {
    number: u8,
    name: String,
    line: String,
}

#[derive(Serialize)]
struct Report {
    files: Vec<CheckedFile>,
}

impl Defined {
    fn of(known: &Macro) -> Option<Self> {
        let line = known.line().ok()?;
        let line = String::from_utf8_lossy(&line).trim_end().to_owned();
        Some(Self { number: known.number, name: known.name.clone(), line })
    }
}

/// Checks every file, also after one that cannot be read.
fn check(args: &CheckArgs, out: &mut Output) -> Result<Exit, Exit> {
    let mut report = Report { files: Vec::new() };
    let mut page = String::new();
    let mut exit = Exit::Done;
    for path in &args.files {
        let source = match Source::read(path) {
            Ok(source) => source,
            Err(failed) => {
                exit = failed;
                continue;
            }
        };
        let (errors, warnings) = (source.count(Severity::Error), source.count(Severity::Warning));
        if (errors > 0 || args.deny_warnings && warnings > 0) && exit == Exit::Done {
            exit = Exit::ScriptWrong;
        }
        page += &source.rendered();
        page += &format!("{}: {}, {}\n", source.name, counted(errors, "error"), counted(warnings, "warning"));
        let macros = if errors == 0 { source.checked.macros.as_slice() } else { &[] };
        report.files.push(CheckedFile {
            ok: errors == 0,
            errors,
            warnings,
            diagnostics: source.placed(),
            macros: macros.iter().filter_map(Defined::of).collect(),
            file: source.name,
        });
    }
    if args.json { out.json(&report) } else { out.line(page.trim_end()) }?;
    Ok(exit)
}

/// "1 error", "2 errors".
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Formats every file in its place.
fn fmt(args: &FmtArgs, out: &mut Output) -> Result<Exit, Exit> {
    let mut exit = Exit::Done;
    for path in &args.files {
        exit = match format_one(path, args, out) {
            Ok(Exit::Different) if exit == Exit::Done => Exit::Different,
            Ok(_) => exit,
            Err(failed) => failed,
        };
    }
    Ok(exit)
}

fn format_one(path: &Path, args: &FmtArgs, out: &mut Output) -> Result<Exit, Exit> {
    let source = Source::read(path)?;
    if !source.checked.is_right() {
        say(source.rendered().trim_end());
        return Err(Exit::ScriptWrong);
    }
    let formatted = format(&source.text);
    let changes = formatted != source.text;
    if args.check {
        if changes {
            out.line(&source.name)?;
        }
        return Ok(if changes { Exit::Different } else { Exit::Done });
    }
    if is_standard(path) {
        out.bytes(formatted.as_bytes())?;
    } else if changes {
        let write = files::replace_file(path, formatted.as_bytes());
        write.map_err(|error| {
            let name = path.display().to_string();
            Exit::Failed.saying(CliMacroMessage::NotWritten { name, error: error.to_string() })
        })?;
    }
    Ok(Exit::Done)
}
