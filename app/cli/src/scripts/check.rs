//! What is wrong with scripts.

use brushwork_script::diagnostic::{PlacedDiagnostic, Severity};
use brushwork_script::mcl::codes;
use serde::Serialize;
use std::path::PathBuf;

use super::language::Language;
use super::source::Source;
use crate::{Exit, Output, say};

/// What is said of one file.
#[derive(Serialize)]
struct Checked {
    file: String,
    ok: bool,
    errors: usize,
    warnings: usize,
    diagnostics: Vec<PlacedDiagnostic>,
}

#[derive(Serialize)]
struct Report {
    files: Vec<Checked>,
}

/// Checks every file, also after one that cannot be read.
pub fn check(
    language: Language,
    paths: &[PathBuf],
    json: bool,
    deny_warnings: bool,
    out: &mut Output,
) -> Result<Exit, Exit> {
    let mut files = Vec::new();
    let mut page = String::new();
    let mut unread = false;
    for path in paths {
        let source = match Source::read(path) {
            Ok(source) => source,
            Err(error) => {
                say(error.to_string());
                unread = true;
                continue;
            }
        };
        let said = (language.compile)(&source.text).1;
        page += &source.rendered(&said);
        let diagnostics = source.placed(&said);
        let listed = || diagnostics.iter().filter(|said| !codes::is_count(said.code));
        let count = |severity| listed().filter(|said| said.severity == severity).count();
        let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
        files.push(Checked { file: source.name, ok: errors == 0, errors, warnings, diagnostics });
    }
    let is_wrong = files.iter().any(|file| !file.ok || deny_warnings && file.warnings > 0);
    for file in &files {
        let (errors, warnings) = (counted(file.errors, "error"), counted(file.warnings, "warning"));
        page += &format!("{}: {errors}, {warnings}\n", file.file);
    }
    let printed = if json { out.json(&Report { files }) } else { out.line(page.trim_end()) };
    printed?;
    Ok(match (unread, is_wrong) {
        (true, _) => Exit::Failed,
        (false, true) => Exit::ScriptWrong,
        (false, false) => Exit::Done,
    })
}

/// "1 error", "2 errors".
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
