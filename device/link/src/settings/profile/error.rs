//! What can be wrong with a profile, told with its place.

use std::fmt;
use std::path::PathBuf;

use brushwork_values::Message;
use thiserror::Error;

/// One fault of a profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The member it is about, as a path: "settings.motor1.velocity.p"; empty for the file as a whole.
    pub path: String,
    /// Line and column in the text, both from 1, where known.
    pub position: Option<(usize, usize)>,
    /// The fault as a sentence.
    pub sentence: Message,
}

impl Problem {
    pub(super) fn at_key(path: &str, sentence: impl Into<Message>) -> Self {
        Self { path: path.to_owned(), position: None, sentence: sentence.into() }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.path.as_str(), self.position) {
            ("", None) => {}
            ("", Some((line, column))) => write!(f, "line {line}, column {column}: ")?,
            (path, None) => write!(f, "{path}: ")?,
            (path, Some((line, column))) => write!(f, "{path} (line {line}, column {column}): ")?,
        }
        write!(f, "{}", self.sentence)
    }
}

impl std::error::Error for Problem {}

/// A profile that is not taken, with every fault found.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub struct ProfileError {
    /// The faults, in the order of the text.
    pub problems: Vec<Problem>,
}

impl fmt::Display for ProfileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{problem}")?;
        }
        Ok(())
    }
}

/// A profile file that could not be read or written.
#[derive(Debug, Error)]
pub enum ProfileFileError {
    /// The file could not be read.
    #[error("Reading the profile {} failed: {source}. Check the name and your rights to read it.", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file could not be replaced; an older one of that name is as it was.
    #[error("Writing the profile {} failed: {source}. A file of that name is unchanged.", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file was read and is not a profile to be taken.
    #[error("The profile {} was not taken, nothing was changed:\n{source}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Every fault.
        source: ProfileError,
    },
}
