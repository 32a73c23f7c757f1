//! Finding commands in the text that a controller receives (Motion Mind manual 5.1.2).
//!
//! A command ends with carriage return and line feed; a backspace takes the character before it away; there is no limit of time.
//!
//! Assumed: letters may be small, spaces may be more than one, a line feed alone ends a line too, and an empty line is nothing.
//! A line longer than the receive buffer is not a command. Numbers may have zeros in front, and a sign.

use super::address::Address;
use super::buffer::RECEIVE_BUFFER;
use super::command::{Command, Part};
use super::frame::fitting;

const BACKSPACE: u8 = 0x08;

/// Finds commands in a stream of characters.
#[derive(Debug, Clone, Default)]
pub struct LineReader {
    line: Vec<u8>,
    is_too_long: bool,
}

/// What the reader found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LineEvent {
    /// A whole command, of whatever address.
    Command(Address, Command),
    /// The self-test, which no client should send.
    SelfTest(Address),
    /// A line that is no command. `address` is there if the line has one.
    NotUnderstood {
        /// Whom the line was for.
        address: Option<Address>,
        /// The line.
        line: String,
    },
}

impl LineReader {
    /// A reader that has received nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next character.
    pub fn feed(&mut self, byte: u8) -> Option<LineEvent> {
        match byte {
            b'\n' => return self.end(),
            BACKSPACE => {
                self.line.pop();
            }
            _ if self.line.len() >= RECEIVE_BUFFER => self.is_too_long = true,
            _ => self.line.push(byte),
        }
        None
    }

    fn end(&mut self) -> Option<LineEvent> {
        let is_too_long = std::mem::take(&mut self.is_too_long);
        let line: String = std::mem::take(&mut self.line).into_iter().map(char::from).collect();
        let line = line.trim_end_matches('\r');
        if line.trim().is_empty() {
            return None;
        }
        let address = address_of(line);
        let event = address.filter(|_| !is_too_long).and_then(|address| understood(address, line));
        Some(event.unwrap_or_else(|| LineEvent::NotUnderstood { address, line: line.to_owned() }))
    }
}

/// The address behind the letter: two digits.
fn address_of(line: &str) -> Option<Address> {
    let digits = line.get(1..3).filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()))?;
    digits.parse().ok().map(Address::from_wire)
}

fn understood(address: Address, line: &str) -> Option<LineEvent> {
    let letter = line.chars().next()?.to_ascii_uppercase();
    let rest = line.get(3..)?;
    if !rest.is_empty() && !rest.starts_with(' ') {
        return None;
    }
    let words: Vec<&str> = rest.split_whitespace().collect();
    if letter == 'Z' && words.is_empty() {
        return Some(LineEvent::SelfTest(address));
    }
    command_of(letter, &words).map(|command| LineEvent::Command(address, command))
}

fn command_of(letter: char, words: &[&str]) -> Option<Command> {
    Some(match (letter, words) {
        ('C', [duty]) => Command::ChangeSpeed(number(duty)?),
        ('P', [position]) => Command::MoveToAbsolute(number(position)?),
        ('M', [distance]) => Command::MoveToRelative(number(distance)?),
        ('V', [velocity]) => Command::MoveAtVelocity(number(velocity)?),
        ('W', [index, value]) => {
            let (register, value) = register_value(index, value)?;
            Command::Write { register, value }
        }
        ('S', [index, value]) => {
            let (register, value) = register_value(index, value)?;
            Command::WriteStore { register, value }
        }
        ('R', [index]) => Command::ReadText(Part::from_index(number(index)?)?),
        ('X', []) => Command::Restore,
        ('Y', []) => Command::Reset,
        _ => return None,
    })
}

fn number<T: TryFrom<i64>>(word: &str) -> Option<T> {
    T::try_from(word.parse::<i64>().ok()?).ok()
}

fn register_value(index: &str, value: &str) -> Option<(u8, i64)> {
    let (index, value) = (number(index)?, number(value)?);
    fitting(index, value).ok().map(|_| (index, value))
}
