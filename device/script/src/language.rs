//! The languages of programs, for those who edit them: which one a file is in, and what is asked of each.

use crate::mcl::index as mcl;
use crate::mcl::index::{Class, Completions, Help, Index, RenameError, SyntaxHint};
use crate::mecc::index as mecc;
use crate::text::Span;
use std::ops::Range;

/// A language of programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Language {
    /// That of packet serial controllers.
    #[default]
    Mcl,
    /// That of boards whose programs are run by events.
    Mecc,
}

impl Language {
    /// The language of a file, by the end of its name.
    #[must_use]
    pub fn of_file(name: &str) -> Self {
        let is_mecc = name.rsplit_once('.').is_some_and(|(_, end)| end.eq_ignore_ascii_case("mecc"));
        if is_mecc { Self::Mecc } else { Self::Mcl }
    }

    /// All there is to say about a text.
    #[must_use]
    pub fn index(self, text: &str) -> Index {
        match self {
            Self::Mcl => Index::of(text),
            Self::Mecc => mecc::index(text),
        }
    }

    /// The pieces of a line.
    #[must_use]
    pub fn classes(self, line: &str) -> Vec<(Range<usize>, Class)> {
        match self {
            Self::Mcl => mcl::classes(line),
            Self::Mecc => mecc::classes(line),
        }
    }

    /// What a word of the language means.
    #[must_use]
    pub fn help(self, word: &str) -> Option<Help> {
        match self {
            Self::Mcl => mcl::help(word),
            Self::Mecc => mecc::help(word),
        }
    }

    /// The command that is being typed at byte `at` of a line.
    #[must_use]
    pub fn syntax_at(self, line: &str, at: usize) -> Option<SyntaxHint> {
        match self {
            Self::Mcl => mcl::syntax_at(line, at),
            Self::Mecc => None,
        }
    }

    /// What could be typed at byte `at` of `text`.
    #[must_use]
    pub fn completions(self, index: &Index, text: &str, at: usize) -> Completions {
        match self {
            Self::Mcl => index.completions(text, at),
            Self::Mecc => mecc::completions(index, text, at),
        }
    }

    /// The places to be replaced when the name at byte `at` gets another.
    ///
    /// # Errors
    /// There is no name here, or the program would mean something else or nothing with the new one.
    pub fn rename(self, index: &Index, at: u32, new: &str) -> Result<Vec<Span>, RenameError> {
        match self {
            Self::Mcl => index.rename(at, new),
            Self::Mecc => mecc::rename(index, at, new),
        }
    }

    /// The text in one style; `None` where it cannot be.
    #[must_use]
    pub fn format(self, text: &str) -> String {
        match self {
            Self::Mcl => crate::mcl::format::format(text),
            Self::Mecc => crate::mecc::format::format(text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_in_the_language_that_its_name_ends_with() {
        for (name, language) in [
            ("crane.mecc", Language::Mecc),
            ("Crane.MECC", Language::Mecc),
            ("crane.mcl", Language::Mcl),
            ("mecc", Language::Mcl),
            ("", Language::Mcl),
        ] {
            assert_eq!(Language::of_file(name), language, "{name}");
        }
        assert_eq!(Language::Mecc.index("Begin Program\nEnd Program\n").diagnostics, []);
        assert!(Language::Mecc.syntax_at("Beep 1", 6).is_none());
    }
}
