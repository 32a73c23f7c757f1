//! One stretch of traffic with its meaning, and how it is printed.

use std::time::Duration;

use brushwork_values::hex;
use serde_json::json;

use crate::output::{Output, OutputError};

/// Room for the bytes in a line of text; more push the meaning to the right.
const HEX_COLUMN: usize = 32;
/// Bytes that a line of text shows; JSON has all.
const SHOWN_BYTES: usize = 32;

/// Bytes that went one way, and what they mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Since the start of the monitor, for the first of the bytes; none from a file.
    pub at: Option<Duration>,
    pub direction: Direction,
    /// None where an answer is missing.
    pub bytes: Vec<u8>,
    pub text: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    ToController,
    FromController,
}

impl Record {
    /// Of a live line.
    pub fn new(at: Duration, direction: Direction, bytes: Vec<u8>, text: String) -> Self {
        Self { at: Some(at), direction, bytes, text }
    }
}

/// Prints a record as the arguments ask for it.
pub fn print(as_json: bool, record: &Record, out: &mut Output) -> Result<(), OutputError> {
    if as_json {
        return out.json_line(&json!({
            "time_s": record.at.map(|at| at.as_secs_f64()),
            "direction": record.direction.key(),
            "hex": hex(&record.bytes),
            "text": record.text,
        }));
    }
    let time = record.at.map(|at| format!("{:11.6}  ", at.as_secs_f64())).unwrap_or_default();
    let (arrow, bytes) = (record.direction.arrow(), shortened(&record.bytes));
    out.line(format!("{time}{arrow} {bytes:<HEX_COLUMN$}  {}", record.text))
}

fn shortened(bytes: &[u8]) -> String {
    match bytes.split_at_checked(SHOWN_BYTES) {
        Some((shown, rest)) if !rest.is_empty() => format!("{} … and {} more", hex(shown), rest.len()),
        _ => hex(bytes),
    }
}

impl Direction {
    pub fn key(self) -> &'static str {
        match self {
            Self::ToController => "to_controller",
            Self::FromController => "from_controller",
        }
    }

    pub fn arrow(self) -> char {
        match self {
            Self::ToController => '>',
            Self::FromController => '<',
        }
    }
}
