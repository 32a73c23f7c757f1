//! Macro files, read and looked at.

use std::io;
use std::path::Path;

use brushwork_link::bounded;
use brushwork_script::diagnostic::{PlacedDiagnostic, Severity};
use brushwork_script::text::Lines;
use brushwork_suprmotr_macros::{Checked, check};

use crate::Exit;
use crate::messages::CliMacroMessage;

/// A macro file, and what is said about it.
pub struct Source {
    /// Its name for messages.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Its macros and what is said about them.
    pub checked: Checked,
    /// Where its lines begin.
    pub lines: Lines,
}

/// Whether the argument stands for standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

impl Source {
    /// Reads a file or standard input.
    ///
    /// # Errors
    /// Says on standard error what is wrong, and gives the exit code.
    pub fn read(path: &Path) -> Result<Self, Exit> {
        let (name, text) = if is_standard(path) {
            let bytes = bounded::read(io::stdin().lock(), bounded::MOST_BYTES);
            ("standard input".to_owned(), bytes.and_then(bounded::text))
        } else {
            (path.display().to_string(), bounded::read_text(path))
        };
        let text = text.map_err(|error| {
            let (name, error) = (name.clone(), error.to_string());
            Exit::Failed.saying(CliMacroMessage::NotRead { name, error })
        })?;
        Ok(Self { checked: check(&text), lines: Lines::of(&text), name, text })
    }

    /// What is said about it, as compilers print it.
    pub fn rendered(&self) -> String {
        let all = self.checked.diagnostics.iter();
        all.map(|said| said.render(&self.name, &self.text, &self.lines)).collect()
    }

    /// The same with lines and columns.
    pub fn placed(&self) -> Vec<PlacedDiagnostic> {
        self.checked.diagnostics.iter().map(|said| said.placed(&self.text, &self.lines)).collect()
    }

    /// How many of a kind are said.
    pub fn count(&self, severity: Severity) -> usize {
        self.checked.diagnostics.iter().filter(|said| said.severity() == severity).count()
    }
}
