//! The names of a program, whatever its language: what a debugger needs of the text beside the instructions.

use crate::debug::{Setting, Watch};
use crate::language::Language;
use crate::program::Program;
use crate::{mcl, mecc};
use std::sync::Arc;

/// The names of a program that compiles.
#[derive(Clone, Debug)]
pub enum Names {
    /// Of an MCL script.
    Mcl(mcl::Names),
    /// Of a MeccCode program.
    Mecc(mecc::Names),
}

impl Names {
    /// The names of a program; `None` if it does not compile.
    #[must_use]
    pub fn of(language: Language, text: &str) -> Option<Self> {
        match language {
            Language::Mcl => mcl::Names::of(text).map(Self::Mcl),
            Language::Mecc => mecc::Names::of(text).map(Self::Mecc),
            Language::Brought(_) => None,
        }
    }

    /// The language.
    #[must_use]
    pub fn language(&self) -> Language {
        match self {
            Self::Mcl(_) => Language::Mcl,
            Self::Mecc(_) => Language::Mecc,
        }
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        match self {
            Self::Mcl(names) => names.program(),
            Self::Mecc(names) => names.program(),
        }
    }

    /// An expression to be worked out while the program runs or stands.
    ///
    /// # Errors
    /// A sentence: what is wrong with it.
    pub fn watch(&mut self, text: &str) -> Result<Watch, String> {
        match self {
            Self::Mcl(names) => names.watch(text),
            Self::Mecc(names) => names.watch(text),
        }
    }

    /// A place to be set while the program stands.
    ///
    /// # Errors
    /// A sentence: there is no such place, it is read-only, or the value is no expression.
    pub fn setting(&mut self, place: &str, value: &str) -> Result<Setting, String> {
        match self {
            Self::Mcl(names) => names.setting(place, value),
            Self::Mecc(names) => names.setting(place, value),
        }
    }
}
