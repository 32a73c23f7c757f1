//! MeccCode as commands compile and format it.

use std::path::Path;

use brushwork_script::diagnostic::Severity;
use brushwork_script::mecc;
use brushwork_script::program::Program;

use crate::scripts::{Language, Source};
use crate::{Exit, say};

/// The language.
pub const MECC: Language = Language {
    compile: |text| {
        let compiled = mecc::compile(text);
        (compiled.program, compiled.diagnostics)
    },
    format: mecc::format::format,
};

/// The program of a file; what is wrong with it is said.
pub fn compiled(file: &Path, is_quiet: bool) -> Result<Program, Exit> {
    let source = Source::read(file).map_err(|error| Exit::Failed.saying(error))?;
    let (program, mut said) = (MECC.compile)(&source.text);
    if is_quiet {
        said.retain(|said| said.severity() == Severity::Error);
    }
    let page = source.rendered(&said);
    if !page.is_empty() {
        say(page.trim_end());
    }
    program.ok_or(Exit::ScriptWrong)
}
