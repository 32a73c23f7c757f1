//! Another name for a variable, constant, table, alias or label, in all its places.

use super::whole::Index;
use crate::mcl::lexer::LONGEST_NAME;
use crate::mcl::words;
use crate::text::Span;

/// Why a name cannot be changed so.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenameError {
    /// No name of the program stands there.
    #[error("there is no name of the program here")]
    NoName,
    /// The new name is none.
    #[error("`{0}` is no name: a letter or _ and then letters, digits and _")]
    NotAName(String),
    /// The new name is a word of the language.
    #[error("`{0}` is a word of the language")]
    Reserved(String),
    /// Something else has this name.
    #[error("`{name}` is defined already in line {line}")]
    Taken {
        /// The name.
        name: String,
        /// Where it is defined.
        line: u32,
    },
}

impl Index {
    /// The places to be replaced by `new`, in the order of the text, when the name at byte `at` is changed to it.
    ///
    /// # Errors
    /// There is no name here, or the program would mean something else or nothing with the new one.
    pub fn rename(&self, at: u32, new: &str) -> Result<Vec<Span>, RenameError> {
        self.rename_unless(at, new, words::is_reserved)
    }

    /// The same in a language whose own words are `is_reserved`.
    ///
    /// # Errors
    /// As [`Index::rename`].
    pub fn rename_unless(
        &self,
        at: u32,
        new: &str,
        is_reserved: impl Fn(&str) -> bool,
    ) -> Result<Vec<Span>, RenameError> {
        let symbol = self.symbol_at(at).ok_or(RenameError::NoName)?;
        let begins = new.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_');
        let is_name = new.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !begins || !is_name || new.len() > LONGEST_NAME {
            return Err(RenameError::NotAName(new.to_owned()));
        }
        if is_reserved(new) {
            return Err(RenameError::Reserved(new.to_owned()));
        }
        if let Some(other) = self.symbol(new).filter(|other| other.key != symbol.key) {
            let line = self.lines.line_of(other.defined.start);
            return Err(RenameError::Taken { name: new.to_owned(), line });
        }
        let mut places: Vec<Span> = symbol.uses.iter().copied().chain([symbol.defined]).collect();
        places.sort_unstable();
        Ok(places)
    }
}
