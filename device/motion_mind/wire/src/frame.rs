//! The binary protocol: command, address, data, checksum (Motion Mind manual 5.1.1).

use super::address::Address;
use super::command::{Command, registers_of};
use super::register::{Register, register};
use super::reply::{BadReply, Progress, Reply, Returned, Returns};

/// The acknowledge. It has no checksum.
pub const ACK: u8 = 0x06;

/// The command bytes.
pub(super) mod number {
    pub const CHANGE_SPEED: u8 = 0x14;
    pub const MOVE_TO_ABSOLUTE: u8 = 0x15;
    pub const MOVE_TO_RELATIVE: u8 = 0x16;
    pub const MOVE_AT_VELOCITY: u8 = 0x17;
    pub const WRITE: u8 = 0x18;
    pub const WRITE_STORE: u8 = 0x19;
    pub const READ: u8 = 0x1A;
    pub const RESTORE: u8 = 0x1B;
    pub const RESET: u8 = 0x1C;
    pub const READ_REGISTER: u8 = 0x1D;
}

/// Why a command has no form on the wire.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// A read in text has no binary form, a read by mask none in text.
    #[error("this read belongs to the other protocol")]
    OtherProtocol,
    /// The width of the register is not known.
    #[error("register {0} is not known")]
    UnknownRegister(u8),
    /// The value does not fit the register's bytes.
    #[error("{value} does not fit {name}, which holds {min} to {max}", min = .fits.0, max = .fits.1)]
    Value {
        /// The register.
        name: &'static str,
        /// The value.
        value: i64,
        /// The least and the most that fit.
        fits: (i64, i64),
    },
    /// Nobody would answer.
    #[error("a read from all units is answered by none")]
    BroadcastRead,
    /// In text an address has two digits.
    #[error("address {0} has three digits; in text an address has two")]
    LongAddress(u8),
}

/// The low byte of the sum of all bytes.
pub fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum: u8, byte| sum.wrapping_add(*byte))
}

/// A command as it is sent.
///
/// # Errors
/// If the command has no binary form, or a value does not fit its register.
pub fn encode_frame(address: Address, command: &Command) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = vec![0, address.get()];
    bytes[0] = match *command {
        Command::ChangeSpeed(duty) => put(&mut bytes, &duty.to_le_bytes(), number::CHANGE_SPEED),
        Command::MoveToAbsolute(position) => {
            put(&mut bytes, &position.to_le_bytes(), number::MOVE_TO_ABSOLUTE)
        }
        Command::MoveToRelative(distance) => {
            put(&mut bytes, &distance.to_le_bytes(), number::MOVE_TO_RELATIVE)
        }
        Command::MoveAtVelocity(velocity) => {
            put(&mut bytes, &velocity.to_le_bytes(), number::MOVE_AT_VELOCITY)
        }
        Command::Write { register, value } => put_register(&mut bytes, register, value, number::WRITE)?,
        Command::WriteStore { register, value } => {
            put_register(&mut bytes, register, value, number::WRITE_STORE)?
        }
        Command::Read(_) | Command::ReadRegister(_) if address.is_broadcast() => {
            return Err(EncodeError::BroadcastRead);
        }
        Command::Read(mask) => put(&mut bytes, &mask.to_le_bytes(), number::READ),
        Command::ReadRegister(register) => put(&mut bytes, &[register], number::READ_REGISTER),
        Command::Restore => number::RESTORE,
        Command::Reset => number::RESET,
        Command::ReadText(_) => return Err(EncodeError::OtherProtocol),
    };
    bytes.push(checksum(&bytes));
    Ok(bytes)
}

fn put(bytes: &mut Vec<u8>, data: &[u8], number: u8) -> u8 {
    bytes.extend_from_slice(data);
    number
}

fn put_register(bytes: &mut Vec<u8>, index: u8, value: i64, number: u8) -> Result<u8, EncodeError> {
    let row = fitting(index, value)?;
    bytes.push(index);
    row.kind.put(value, bytes);
    Ok(number)
}

/// The register of that number, if `value` fits its bytes. What the manual's range says is not asked.
pub(super) fn fitting(index: u8, value: i64) -> Result<&'static Register, EncodeError> {
    let row = register(index).ok_or(EncodeError::UnknownRegister(index))?;
    let fits = row.kind.range();
    if fits.contains(&value) {
        return Ok(row);
    }
    Err(EncodeError::Value { name: row.name, value, fits: (*fits.start(), *fits.end()) })
}

/// A reply as the unit `address` sends it; nothing where the binary protocol is silent.
pub fn encode_frame_reply(address: Address, reply: &Reply) -> Vec<u8> {
    let mut bytes = vec![address.get()];
    match reply {
        Reply::Acknowledged => return vec![ACK],
        Reply::NotUnderstood | Reply::Bits(_) => return Vec::new(),
        Reply::Returned(returned) => {
            bytes.extend(returned.position.iter().flat_map(|position| position.to_le_bytes()));
            bytes.extend(returned.velocity.iter().flat_map(|velocity| velocity.to_le_bytes()));
            bytes.extend(returned.time.iter().flat_map(|time| time.to_le_bytes()));
        }
        Reply::Registers(registers) => {
            for (row, value) in
                registers.iter().filter_map(|(index, value)| Some((register(*index)?, *value)))
            {
                row.kind.put(value, &mut bytes);
            }
        }
    }
    bytes.push(checksum(&bytes));
    bytes
}

/// The reply to `command` of the unit `address` at the start of `bytes`. `returns` are the return bits that the unit's FUNCTION
/// has when it answers.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn parse_frame_reply(address: Address, command: &Command, returns: Returns, bytes: &[u8]) -> Progress {
    if address.is_broadcast() {
        return Progress::Bad(BadReply::Broadcast);
    }
    match *command {
        Command::Read(mask) => parse_registers(address, registers_of(mask), bytes),
        Command::ReadRegister(index) => match register(index) {
            Some(row) => parse_registers(address, std::iter::once(row), bytes),
            None => Progress::Bad(BadReply::UnknownRegister(index)),
        },
        _ if command.takes_returns() && !returns.is_none() => parse_returned(address, returns, bytes),
        _ => match bytes.first() {
            None => Progress::Incomplete,
            Some(&ACK) => Progress::Done { reply: Reply::Acknowledged, used: 1 },
            Some(&got) => Progress::Bad(BadReply::Start { expected: ACK, got }),
        },
    }
}

fn parse_registers(
    address: Address,
    rows: impl Iterator<Item = &'static Register>,
    bytes: &[u8],
) -> Progress {
    let rows: Vec<_> = rows.collect();
    let width = rows.iter().map(|row| row.kind.bytes()).sum();
    checked(address, width, bytes, |mut data| {
        let mut values = Vec::with_capacity(rows.len());
        for row in &rows {
            values.push((row.number, row.kind.get(data).unwrap_or_default()));
            data = data.get(row.kind.bytes()..).unwrap_or_default();
        }
        Reply::Registers(values)
    })
}

fn parse_returned(address: Address, returns: Returns, bytes: &[u8]) -> Progress {
    let width =
        4 * usize::from(returns.position) + 2 * usize::from(returns.velocity) + 4 * usize::from(returns.time);
    checked(address, width, bytes, |data| {
        let (position, rest) = split::<4>(data, returns.position);
        let (velocity, rest) = split::<2>(rest, returns.velocity);
        let (time, _) = split::<4>(rest, returns.time);
        Reply::Returned(Returned {
            position: position.map(i32::from_le_bytes),
            velocity: velocity.map(i16::from_le_bytes),
            time: time.map(u32::from_le_bytes),
        })
    })
}

fn split<const N: usize>(data: &[u8], is_there: bool) -> (Option<[u8; N]>, &[u8]) {
    match data.split_first_chunk::<N>() {
        Some((first, rest)) if is_there => (Some(*first), rest),
        _ => (None, data),
    }
}

/// Address, `width` bytes of data, checksum.
fn checked(address: Address, width: usize, bytes: &[u8], reply: impl FnOnce(&[u8]) -> Reply) -> Progress {
    match bytes.first() {
        Some(&got) if got != address.get() => {
            return Progress::Bad(BadReply::Start { expected: address.get(), got });
        }
        _ => {}
    }
    let (Some(summed), Some(&got)) = (bytes.get(..=width), bytes.get(width + 1)) else {
        return Progress::Incomplete;
    };
    let expected = checksum(summed);
    if got != expected {
        return Progress::Bad(BadReply::Checksum { expected, got });
    }
    Progress::Done { reply: reply(&summed[1..]), used: width + 2 }
}
