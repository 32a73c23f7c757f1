//! Recordings of samples: files of every reading with the host times of its request and its reply.
//!
//! [`csv`] is for other programs and for eyes, [`compact`] for hours; both are written as data comes in ([`recorder`])
//! and read back ([`open`]) with nothing lost but the parts of a microsecond. Nothing here knows the window.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

pub mod compact;
pub mod csv;
pub mod open;
pub mod recorder;

/// The two forms of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Comma separated values.
    Csv,
    /// Differences of neighbouring readings, in blocks.
    Compact,
}

impl Form {
    /// A file name's ending, without the dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Compact => "bwr",
        }
    }
}

/// What a column of a recording is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Snake case; the same signal has the same key in every recording.
    pub key: String,
    /// For people.
    pub label: String,
    /// Empty where it has none.
    pub unit: String,
}

impl Column {
    /// A column of that name; the key follows from it.
    #[must_use]
    pub fn new(label: &str, unit: &str) -> Self {
        let key = label.trim().to_lowercase().replace([' ', '.', '-'], "_");
        Self { key, label: label.trim().to_owned(), unit: unit.trim().to_owned() }
    }
}

/// What stands at the beginning of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// What is recorded.
    pub columns: Vec<Column>,
    /// The moment that the times are counted from.
    pub began: SystemTime,
    /// What was recorded from; empty where the file does not tell.
    pub device: String,
}

/// One reading: whole microseconds since the beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Place in [`Head::columns`].
    pub column: usize,
    /// In the column's unit.
    pub value: f64,
    /// When the request for it was written.
    pub requested_us: u64,
    /// When the reply with it was complete.
    pub replied_us: u64,
}

/// One thing in a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// The readings of one sweep, by column.
    Sample(Vec<Reading>),
    /// Readings were lost here.
    Gap {
        /// After this.
        at_us: u64,
    },
    /// Something happened.
    Mark {
        /// When.
        at_us: u64,
        /// What kind of thing: one word.
        kind: String,
        /// What.
        text: String,
    },
}

impl Record {
    /// The time of its first request, or of itself.
    #[must_use]
    pub fn begins_us(&self) -> u64 {
        match self {
            Self::Sample(readings) => readings.iter().map(|reading| reading.requested_us).min().unwrap_or(0),
            Self::Gap { at_us } | Self::Mark { at_us, .. } => *at_us,
        }
    }

    /// The time of its last reply, or of itself.
    #[must_use]
    pub fn ends_us(&self) -> u64 {
        match self {
            Self::Sample(readings) => readings.iter().map(|reading| reading.replied_us).max().unwrap_or(0),
            Self::Gap { at_us } | Self::Mark { at_us, .. } => *at_us,
        }
    }
}

/// Why a recording cannot be opened. The text is a sentence.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be read.
    #[error("Could not open the recording {path}: {source}. Check the path.")]
    Io {
        /// The file.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// A line of a CSV file is not as it should be.
    #[error("Could not open the recording {path}: line {line}: {what}. {remedy}.")]
    Line {
        /// The file.
        path: String,
        /// Counted from 1.
        line: u64,
        /// What is wrong with it.
        what: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A compact file is not one, or its head is damaged.
    #[error("Could not open the recording {path}: {what}. Choose a file that Brushwork has recorded.")]
    Compact {
        /// The file.
        path: String,
        /// What is wrong with it.
        what: String,
    },
}

/// A file that `is_free`: `name` in `folder` with the extension, or with a number behind the name.
#[must_use]
pub fn free_path(folder: &Path, name: &str, extension: &str, is_free: impl Fn(&Path) -> bool) -> PathBuf {
    let numbered = |number: u32| match number {
        1 => folder.join(format!("{name}.{extension}")),
        _ => folder.join(format!("{name}-{number}.{extension}")),
    };
    (1..10_000).map(numbered).find(|path| is_free(path)).unwrap_or_else(|| numbered(10_000))
}

/// A name for a file made now: the date and the time in UTC.
#[must_use]
pub fn dated_name(now: SystemTime) -> String {
    let text = humantime::format_rfc3339_seconds(now).to_string();
    let digits: String = text.chars().filter(char::is_ascii_digit).collect();
    let (day, time) = digits.split_at(8.min(digits.len()));
    format!("brushwork-{day}-{time}")
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn files_are_named_by_date_and_never_written_over() {
        let name = dated_name(SystemTime::UNIX_EPOCH + Duration::from_secs(1_800_000_000));
        assert_eq!(name, "brushwork-20270115-080000");
        let folder = tempfile::tempdir().unwrap();
        let is_free = |path: &Path| !path.exists();
        let first = free_path(folder.path(), &name, "csv", is_free);
        std::fs::write(&first, "").unwrap();
        let second = free_path(folder.path(), &name, "csv", is_free);
        assert!(second.to_string_lossy().ends_with("080000-2.csv"), "{second:?}");
    }

    #[test]
    fn the_key_of_a_column_follows_from_its_name() {
        assert_eq!(Column::new("M1 Speed Error", "counts/s").key, "m1_speed_error");
    }
}
