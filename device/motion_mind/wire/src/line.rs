//! The protocol in text: one line a command (Motion Mind manual 5.1.2).

use super::address::Address;
use super::command::{Command, Part};
use super::frame::{EncodeError, fitting};
use super::register::{REGISTERS, Register, register, register_number as number};
use super::reply::{BadReply, Progress, Reply, Returned, Returns};

const END: &str = "\r\n";
const ACKNOWLEDGE: &str = "OK";
const NOT_UNDERSTOOD: &str = "BAD COMMAND";

/// A command as it is sent, with its line end.
///
/// # Errors
/// If the command has no form in text, or a value does not fit its register.
pub fn encode_line(address: Address, command: &Command) -> Result<String, EncodeError> {
    let unit = address.get();
    if unit > Address::BROADCAST.get() {
        return Err(EncodeError::LongAddress(unit));
    }
    let line = match *command {
        Command::ChangeSpeed(duty) => format!("C{unit:02} {duty}"),
        Command::MoveToAbsolute(position) => format!("P{unit:02} {position}"),
        Command::MoveToRelative(distance) => format!("M{unit:02} {distance}"),
        Command::MoveAtVelocity(velocity) => format!("V{unit:02} {velocity}"),
        Command::Write { register, value } => written('W', unit, register, value)?,
        Command::WriteStore { register, value } => written('S', unit, register, value)?,
        Command::ReadText(_) if address.is_broadcast() => return Err(EncodeError::BroadcastRead),
        Command::ReadText(part) => format!("R{unit:02} {:02}", part.index()),
        Command::Restore => format!("X{unit:02}"),
        Command::Reset => format!("Y{unit:02}"),
        Command::Read(_) | Command::ReadRegister(_) => return Err(EncodeError::OtherProtocol),
    };
    Ok(line + END)
}

fn written(letter: char, unit: u8, index: u8, value: i64) -> Result<String, EncodeError> {
    fitting(index, value)?;
    Ok(format!("{letter}{unit:02} {index:02} {value}"))
}

/// A reply as a unit sends it. `part` is what the read asked for; without one only what every command may be answered.
pub fn encode_line_reply(part: Option<Part>, reply: &Reply) -> String {
    match reply {
        Reply::Acknowledged => ACKNOWLEDGE.to_owned() + END,
        Reply::NotUnderstood => NOT_UNDERSTOOD.to_owned() + END,
        Reply::Returned(returned) => returned_lines(returned),
        Reply::Bits(bits) => {
            let letter = if part == Some(Part::FunctionBits) { 'F' } else { 'S' };
            let line = |(number, on): (usize, &bool)| {
                format!("{letter}{number}{}{END}", if *on { "ON" } else { "OFF" })
            };
            bits.iter().enumerate().map(line).collect()
        }
        Reply::Registers(values) if part == Some(Part::All) => {
            values.iter().map(|(_, value)| format!("{value},")).collect::<String>() + END
        }
        Reply::Registers(values) => {
            values.iter().filter_map(|(index, value)| coded(*index, *value)).collect()
        }
    }
}

fn coded(index: u8, value: i64) -> Option<String> {
    register(index).map(|row| format!("{}={value}{END}", row.code))
}

/// Assumed: several return bits give one line each.
fn returned_lines(returned: &Returned) -> String {
    let values = [
        (number::POSITION, returned.position.map(i64::from)),
        (number::VELOCITY, returned.velocity.map(i64::from)),
        (number::TIME, returned.time.map(i64::from)),
    ];
    values.into_iter().filter_map(|(index, value)| coded(index, value?)).collect()
}

/// The reply to `command` at the start of `bytes`. `returns` are the return bits that the unit's FUNCTION has when it answers.
/// The letters in front of `=` are not looked at, since the manual names only four codes. Empty lines, spaces at the end of a
/// line, a line feed alone as its end, small letters and zeros in front of a number are taken as they come.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn parse_line_reply(command: &Command, returns: Returns, bytes: &[u8]) -> Progress {
    let mut lines = Lines { bytes, used: 0 };
    // A line end in front of an answer says nothing.
    let Some(first) = lines.find(|line| !line.is_empty()) else { return Progress::Incomplete };
    if first.eq_ignore_ascii_case(NOT_UNDERSTOOD) {
        return Progress::Done { reply: Reply::NotUnderstood, used: lines.used };
    }
    let reply = match *command {
        Command::ReadText(Part::Register(index)) => register(index).and_then(|row| one_register(row, &first)),
        Command::ReadText(Part::All) => all_registers(&first),
        Command::ReadText(part) => return bit_lines(part, first, lines),
        _ if command.takes_returns() && !returns.is_none() => return returned(returns, first, lines),
        _ => first.eq_ignore_ascii_case(ACKNOWLEDGE).then_some(Reply::Acknowledged),
    };
    match reply {
        Some(reply) => Progress::Done { reply, used: lines.used },
        None => Progress::Bad(BadReply::Line(first)),
    }
}

/// The whole lines of the bytes at hand, without their ends. Bytes that are no text stand as their code points.
struct Lines<'a> {
    bytes: &'a [u8],
    used: usize,
}

impl Iterator for Lines<'_> {
    type Item = String;

    fn next(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.used..)?;
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        self.used += end + 1;
        Some(rest[..end].trim_ascii().iter().map(|byte| char::from(*byte)).collect())
    }
}

fn one_register(row: &Register, line: &str) -> Option<Reply> {
    Some(Reply::Registers(vec![(row.number, coded_value(row, line)?)]))
}

fn coded_value(row: &Register, line: &str) -> Option<i64> {
    let (_, value) = line.split_once('=')?;
    let value = value.trim().parse().ok()?;
    row.kind.range().contains(&value).then_some(value)
}

fn all_registers(line: &str) -> Option<Reply> {
    let values = values_of_line(line)?;
    let fits = |(row, (_, value)): (&Register, &(u8, i64))| row.kind.range().contains(value);
    REGISTERS.iter().zip(&values).all(fits).then_some(Reply::Registers(values))
}

fn values_of_line(line: &str) -> Option<Vec<(u8, i64)>> {
    let values: Vec<&str> = line.strip_suffix(',').unwrap_or(line).split(',').collect();
    if values.len() != REGISTERS.len() {
        return None;
    }
    let one = |(row, value): (&Register, &&str)| Some((row.number, value.trim().parse().ok()?));
    REGISTERS.iter().zip(&values).map(one).collect()
}

/// The reply to a read of all registers at the start of `bytes`, whatever the values: simulators of other people fill them with numbers
/// that no register can hold. Other lines in front of it are passed over.
pub fn parse_all_loosely(bytes: &[u8]) -> Progress {
    let mut lines = Lines { bytes, used: 0 };
    while let Some(line) = lines.next() {
        if let Some(values) = values_of_line(&line) {
            return Progress::Done { reply: Reply::Registers(values), used: lines.used };
        }
    }
    Progress::Incomplete
}

/// STATUS is listed with ten bits by the manual's sample and has eleven; an eleventh line is taken when it is there.
const STATUS_LINES: usize = 10;
const FUNCTION_LINES: usize = 16;

fn bit_lines(part: Part, first: String, mut lines: Lines<'_>) -> Progress {
    let (letter, count) =
        if part == Part::FunctionBits { ('F', FUNCTION_LINES) } else { ('S', STATUS_LINES) };
    let mut bits = Vec::with_capacity(count);
    let mut line = first;
    loop {
        match bit_line(letter, bits.len(), &line) {
            Some(bit) => bits.push(bit),
            None => return Progress::Bad(BadReply::Line(line)),
        }
        if bits.len() >= count {
            break;
        }
        match lines.next() {
            Some(next) => line = next,
            None => return Progress::Incomplete,
        }
    }
    let used = lines.used;
    if part == Part::StatusBits
        && let Some(bit) = lines.next().and_then(|line| bit_line(letter, bits.len(), &line))
    {
        bits.push(bit);
        return Progress::Done { reply: Reply::Bits(bits), used: lines.used };
    }
    Progress::Done { reply: Reply::Bits(bits), used }
}

fn bit_line(letter: char, number: usize, line: &str) -> Option<bool> {
    match line.to_ascii_uppercase().strip_prefix(letter)?.strip_prefix(&number.to_string())? {
        "ON" => Some(true),
        "OFF" => Some(false),
        _ => None,
    }
}

fn returned(returns: Returns, first: String, mut lines: Lines<'_>) -> Progress {
    let wanted = [
        (returns.position, number::POSITION),
        (returns.velocity, number::VELOCITY),
        (returns.time, number::TIME),
    ];
    let mut values = [None; 3];
    let mut line = Some(first);
    for (slot, (is_wanted, index)) in values.iter_mut().zip(wanted) {
        if !is_wanted {
            continue;
        }
        let Some(text) = line.take().or_else(|| lines.next()) else { return Progress::Incomplete };
        *slot = register(index).and_then(|row| coded_value(row, &text));
        if slot.is_none() {
            return Progress::Bad(BadReply::Line(text));
        }
    }
    let [position, velocity, time] = values;
    let returned = Returned {
        position: position.and_then(|value| i32::try_from(value).ok()),
        velocity: velocity.and_then(|value| i16::try_from(value).ok()),
        time: time.and_then(|value| u32::try_from(value).ok()),
    };
    Progress::Done { reply: Reply::Returned(returned), used: lines.used }
}
