//! What a language is to commands.

use brushwork_script::diagnostic::Diagnostic;
use brushwork_script::program::Program;

/// What commands ask of a language.
#[derive(Clone, Copy)]
pub struct Language {
    /// A text into a program, unless it has errors, with what there is to say.
    pub compile: fn(&str) -> (Option<Program>, Vec<Diagnostic>),
    /// A text in one style.
    pub format: fn(&str) -> String,
}
