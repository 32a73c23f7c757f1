//! What a controller finds in the characters that it receives.
//!
//! Assumed: a selection drops what was typed of a line; bytes that the manual does not allow for entry (line feed, end of text) are
//! passed over.

use crate::address::Selection;
use crate::characters::{END_OF_REPORT, EXECUTE, SELECT};
use crate::line::LINE_BUFFER;
use crate::single::Single;

/// Finds selections, single characters and lines in a stream of characters.
#[derive(Debug, Clone, Default)]
pub struct Reader {
    line: Vec<u8>,
    is_selecting: bool,
}

/// What the reader found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Received {
    /// Ctrl-A and the character behind it.
    Selection(Selection),
    /// A command of one character.
    Single(Single),
    /// A line, without its carriage return. [`parse_line`](crate::parse_line) reads it.
    Line(Vec<u8>),
    /// A carriage return before any other character: the last line once more.
    Repeat,
}

impl Reader {
    /// A reader that has received nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next character. A controller that is not selected takes selections and `!` alone.
    pub fn feed(&mut self, byte: u8, is_selected: bool) -> Option<Received> {
        if std::mem::take(&mut self.is_selecting) {
            return Some(Received::Selection(Selection::from_character(byte)));
        }
        if byte == SELECT {
            self.is_selecting = true;
            self.line.clear();
            return None;
        }
        match Single::from_character(byte) {
            Some(single) if is_selected || single == Single::Abort => return Some(Received::Single(single)),
            Some(_) => return None,
            None => {}
        }
        match byte {
            _ if !is_selected => {}
            EXECUTE if self.line.is_empty() => return Some(Received::Repeat),
            EXECUTE => return Some(Received::Line(std::mem::take(&mut self.line))),
            b'\n' | END_OF_REPORT => {}
            // One more than fits is enough to refuse the line.
            _ if self.line.len() > LINE_BUFFER => {}
            _ => self.line.push(byte),
        }
        None
    }
}
