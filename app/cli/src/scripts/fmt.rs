//! Scripts in one style.

use std::path::{Path, PathBuf};

use brushwork_script::mcl::{LONGEST_TEXT, too_long};
use brushwork_script::text::Lines;

use super::language::Language;
use super::source::{Source, is_standard};
use crate::{Exit, Output};

/// Formats every file in its place.
pub fn fmt(language: Language, paths: &[PathBuf], is_check: bool, out: &mut Output) -> Result<Exit, Exit> {
    let mut exit = Exit::Done;
    for path in paths {
        match one(language, path, is_check, out) {
            Ok(false) => {}
            Ok(true) => exit = if exit == Exit::Done { Exit::Different } else { exit },
            Err(failed) => exit = failed,
        }
    }
    Ok(exit)
}

/// Whether a file would change, which only matters when it is not written.
fn one(language: Language, path: &Path, is_check: bool, out: &mut Output) -> Result<bool, Exit> {
    let failed = |sentence: String| Exit::Failed.saying(sentence);
    let source = Source::read(path).map_err(|error| failed(error.to_string()))?;
    if let Some(refused) = too_long(&source.text) {
        return Err(Exit::ScriptWrong
            .saying(refused.render(&source.name, &source.text, &Lines::of(&source.text)).trim_end()));
    }
    let formatted = (language.format)(&source.text);
    if too_long(&formatted).is_some() {
        return Err(failed(format!(
            "Could not format {}: with its indentation it would be longer than the {LONGEST_TEXT} bytes that a program has at most.",
            source.name
        )));
    }
    let changes = formatted != source.text;
    if is_check {
        if changes {
            out.line(&source.name)?;
        }
        return Ok(changes);
    }
    if is_standard(path) {
        out.bytes(&source.encoded(&formatted))?;
    } else if changes {
        let write = brushwork_link::files::replace_file(path, &source.encoded(&formatted));
        write.map_err(|error| failed(format!("Could not write {}: {error}.", path.display())))?;
    }
    Ok(false)
}
