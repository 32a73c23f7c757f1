//! The languages of programs, for those who edit them: which one a file is in, and what is asked of each.

use crate::mcl::index as mcl;
use crate::mcl::index::{Class, Completions, Help, Index, RenameError, SyntaxHint};
use crate::mecc::index as mecc;
use crate::text::Span;
use std::hash::{Hash, Hasher};
use std::ops::Range;
use std::sync::OnceLock;

/// The pieces of a line.
pub type Pieces = Vec<(Range<usize>, Class)>;

/// A language that another crate brings along: all that an editor asks of it.
#[derive(Debug)]
pub struct Grammar {
    /// What it is called.
    pub name: &'static str,
    /// How the names of its files end.
    pub ending: &'static str,
    /// As [`Language::index`].
    pub index: fn(&str) -> Index,
    /// As [`Language::classes`].
    pub classes: fn(&str) -> Pieces,
    /// As [`Language::help`].
    pub help: fn(&str) -> Option<Help>,
    /// As [`Language::completions`].
    pub completions: fn(&Index, &str, usize) -> Completions,
    /// Whether no name of a program may be this word.
    pub is_reserved: fn(&str) -> bool,
    /// As [`Language::format`].
    pub format: fn(&str) -> String,
}

impl PartialEq for Grammar {
    fn eq(&self, other: &Self) -> bool {
        self.ending == other.ending
    }
}

impl Eq for Grammar {}

impl Hash for Grammar {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.ending.hash(state);
    }
}

static BROUGHT: OnceLock<Vec<&'static Grammar>> = OnceLock::new();

/// A language of programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Language {
    /// That of packet serial controllers.
    #[default]
    Mcl,
    /// That of boards whose programs are run by events.
    Mecc,
    /// One that another crate brings along.
    Brought(&'static Grammar),
}

impl Language {
    /// The language of a file, by the end of its name.
    #[must_use]
    pub fn of_file(name: &str) -> Self {
        let ends_so =
            |ending: &str| name.rsplit_once('.').is_some_and(|(_, end)| end.eq_ignore_ascii_case(ending));
        let brought = BROUGHT.get().into_iter().flatten().find(|grammar| ends_so(grammar.ending));
        match brought {
            Some(grammar) => Self::Brought(grammar),
            None if ends_so("mecc") => Self::Mecc,
            None => Self::Mcl,
        }
    }

    /// Names the languages that others bring along. Only the first list counts.
    pub fn bring(grammars: Vec<&'static Grammar>) {
        // A second list is that of another test.
        let _ = BROUGHT.set(grammars);
    }

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mcl => "MCL",
            Self::Mecc => "MeccCode",
            Self::Brought(grammar) => grammar.name,
        }
    }

    /// How the names of its files end.
    #[must_use]
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Mcl => "mcl",
            Self::Mecc => "mecc",
            Self::Brought(grammar) => grammar.ending,
        }
    }

    /// All there is to say about a text.
    #[must_use]
    pub fn index(self, text: &str) -> Index {
        match self {
            Self::Mcl => Index::of(text),
            Self::Mecc => mecc::index(text),
            Self::Brought(grammar) => (grammar.index)(text),
        }
    }

    /// The pieces of a line.
    #[must_use]
    pub fn classes(self, line: &str) -> Pieces {
        match self {
            Self::Mcl => mcl::classes(line),
            Self::Mecc => mecc::classes(line),
            Self::Brought(grammar) => (grammar.classes)(line),
        }
    }

    /// What a word of the language means.
    #[must_use]
    pub fn help(self, word: &str) -> Option<Help> {
        match self {
            Self::Mcl => mcl::help(word),
            Self::Mecc => mecc::help(word),
            Self::Brought(grammar) => (grammar.help)(word),
        }
    }

    /// The command that is being typed at byte `at` of a line.
    #[must_use]
    pub fn syntax_at(self, line: &str, at: usize) -> Option<SyntaxHint> {
        match self {
            Self::Mcl => mcl::syntax_at(line, at),
            Self::Mecc | Self::Brought(_) => None,
        }
    }

    /// What could be typed at byte `at` of `text`.
    #[must_use]
    pub fn completions(self, index: &Index, text: &str, at: usize) -> Completions {
        match self {
            Self::Mcl => index.completions(text, at),
            Self::Mecc => mecc::completions(index, text, at),
            Self::Brought(grammar) => (grammar.completions)(index, text, at),
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
            Self::Brought(grammar) => index.rename_unless(at, new, grammar.is_reserved),
        }
    }

    /// The text in one style; `None` where it cannot be.
    #[must_use]
    pub fn format(self, text: &str) -> String {
        match self {
            Self::Mcl => crate::mcl::format::format(text),
            Self::Mecc => crate::mecc::format::format(text),
            Self::Brought(grammar) => (grammar.format)(text),
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
