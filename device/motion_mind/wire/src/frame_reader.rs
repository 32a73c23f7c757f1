//! Finding binary commands in the bytes that a controller receives (Motion Mind manual 5.1.1).
//!
//! The first byte tells the command and with it the length; a write tells its length with the register. A frame is taken as soon as
//! it is whole. Whatever cannot become one is dropped together with all that follows it, until the line is silent for 5 ms.
//!
//! Assumed: a whole frame is taken at once, though the manual says that a buffer is judged after 5 ms of silence. So commands
//! sent without a pause are taken one by one.

use std::time::Duration;

use super::address::Address;
use super::buffer::RECEIVE_BUFFER;
use super::command::Command;
use super::frame::{checksum, number};
use super::register::register;

/// A longer pause between two bytes ends a frame, whole or not.
pub const BYTE_GAP: Duration = Duration::from_millis(5);

/// Command and address, in front of the data.
const HEAD: usize = 2;

/// Finds commands in a stream of bytes.
#[derive(Debug, Clone, Default)]
pub struct FrameReader {
    bytes: Vec<u8>,
    is_skipping: bool,
    last_byte_at: Duration,
}

/// What the reader found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FrameEvent {
    /// A whole command, of whatever address.
    Command(Address, Command),
    /// Bytes that were no command. The controller is silent about them.
    Dropped(Vec<u8>),
}

/// What the bytes at hand are.
enum Judged {
    Command(Command),
    Incomplete,
    Impossible,
}

impl FrameReader {
    /// A reader that has received nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the byte that came at `now`.
    pub fn feed(&mut self, byte: u8, now: Duration) -> Option<FrameEvent> {
        let dropped = self.silent_until(now);
        self.last_byte_at = now;
        self.bytes.push(byte);
        if dropped.is_some() {
            // The byte begins a frame; no frame has only one byte.
            self.judge();
            return dropped;
        }
        self.judge()
    }

    /// Tells the reader that nothing came until `now`: a frame that stopped half way is dropped.
    pub fn silent_until(&mut self, now: Duration) -> Option<FrameEvent> {
        if now.saturating_sub(self.last_byte_at) <= BYTE_GAP {
            return None;
        }
        self.is_skipping = false;
        let dropped = std::mem::take(&mut self.bytes);
        (!dropped.is_empty()).then_some(FrameEvent::Dropped(dropped))
    }

    fn judge(&mut self) -> Option<FrameEvent> {
        if self.is_skipping {
            self.bytes.truncate(RECEIVE_BUFFER);
            return None;
        }
        match judged(&self.bytes) {
            Judged::Command(command) => {
                let address = Address::from_wire(self.bytes[1]);
                self.bytes.clear();
                Some(FrameEvent::Command(address, command))
            }
            Judged::Impossible => {
                self.is_skipping = true;
                None
            }
            Judged::Incomplete => None,
        }
    }
}

fn judged(bytes: &[u8]) -> Judged {
    let Some(width) = data_width(bytes) else { return Judged::Impossible };
    let Some(width) = width else { return Judged::Incomplete };
    let (Some(summed), Some(&sum)) = (bytes.get(..HEAD + width), bytes.get(HEAD + width)) else {
        return Judged::Incomplete;
    };
    if checksum(summed) != sum {
        return Judged::Impossible;
    }
    command_of(summed[0], &summed[HEAD..]).map_or(Judged::Impossible, Judged::Command)
}

/// Bytes of data of the frame that starts so: `None` if no frame does, `Some(None)` if more bytes must tell.
fn data_width(bytes: &[u8]) -> Option<Option<usize>> {
    let Some(&first) = bytes.first() else { return Some(None) };
    Some(Some(match first {
        number::CHANGE_SPEED | number::MOVE_AT_VELOCITY => 2,
        number::MOVE_TO_ABSOLUTE | number::MOVE_TO_RELATIVE | number::READ => 4,
        number::WRITE | number::WRITE_STORE => match bytes.get(HEAD) {
            None => return Some(None),
            Some(&index) => 1 + register(index)?.kind.bytes(),
        },
        number::RESTORE | number::RESET => 0,
        number::READ_REGISTER => 1,
        _ => return None,
    }))
}

fn command_of(first: u8, data: &[u8]) -> Option<Command> {
    let pair = || data.first_chunk::<2>().map(|bytes| i16::from_le_bytes(*bytes));
    let four = || data.first_chunk::<4>().copied();
    Some(match first {
        number::CHANGE_SPEED => Command::ChangeSpeed(pair()?),
        number::MOVE_AT_VELOCITY => Command::MoveAtVelocity(pair()?),
        number::MOVE_TO_ABSOLUTE => Command::MoveToAbsolute(i32::from_le_bytes(four()?)),
        number::MOVE_TO_RELATIVE => Command::MoveToRelative(i32::from_le_bytes(four()?)),
        number::READ => Command::Read(u32::from_le_bytes(four()?)),
        number::READ_REGISTER => Command::ReadRegister(*data.first()?),
        number::RESTORE => Command::Restore,
        number::RESET => Command::Reset,
        number::WRITE | number::WRITE_STORE => {
            let (&index, value) = data.split_first()?;
            let value = register(index)?.kind.get(value)?;
            if first == number::WRITE {
                Command::Write { register: index, value }
            } else {
                Command::WriteStore { register: index, value }
            }
        }
        _ => return None,
    })
}
