//! What a controller reports, in all the forms that the manual shows (SuprMotr manual, "Reply Termination").
//!
//! A report is one or more lines, each ended by carriage return and line feed, with one end-of-text byte behind the last. A line
//! of data is address, letter, channel, colon, data: `0P0:+0000020002`. The manual also shows it without the channel
//! (`5T:+0000000000`), with small letters (`5p0:+000300`) and, in its table, with the letter alone (`T:`), which is how the
//! controllers of the same kind from other makers speak. A controller has one [`ReportForm`]; [`parse_report`] reads them all.
//!
//! Assumed: four hexadecimal digits for each half of TC, since two cannot show sixteen channels; analog values without sign or zeros.

use crate::address::Address;
use crate::characters::{END_OF_REPORT, EXECUTE, SELECT};
use crate::line::{Command, Line, parse_listing};
use crate::number::Radix;
use crate::status::Status;
use crate::table::{Mnemonic, Reports};

const LETTER_STATUS: u8 = b'S';
const LETTER_ANALOG: u8 = b'A';
const LETTER_ANALOG_OUTPUT: u8 = b'O';
const LETTER_CHANNELS: u8 = b'H';
/// More than the longest report: fifteen macros of fifteen commands with all their digits.
const LONGEST: usize = 8192;

/// How a controller writes the front of a line of data.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum ReportForm {
    /// Address, letter, channel: `0P0:`.
    #[default]
    Full,
    /// Address and letter: `0P:`.
    Address,
    /// The letter: `P:`.
    Id,
}

impl ReportForm {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Full, Self::Address, Self::Id];

    /// Its name on the command line.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Address => "address",
            Self::Id => "id",
        }
    }

    /// The form of that name.
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.key().eq_ignore_ascii_case(key))
    }
}

/// One line of a report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReportLine {
    /// What a command that reports a number says.
    Number {
        /// The command: its row has the letter.
        of: Mnemonic,
        /// The number.
        value: i32,
    },
    /// The status.
    Status(Status),
    /// Analog inputs.
    Analog {
        /// The input, or 0 for all.
        channel: u8,
        /// 5 V at 255.
        values: Vec<u8>,
    },
    /// All digital channels, channel 1 in bit 0.
    Channels {
        /// The outputs.
        outputs: u16,
        /// The inputs.
        inputs: u16,
    },
    /// One digital input.
    Channel {
        /// Its number, from 1.
        channel: u8,
        /// Whether it is on.
        is_on: bool,
    },
    /// A macro.
    Macro(Line),
    /// Text.
    Text(String),
}

/// A whole report.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Report {
    /// The address in front of the lines; `None` if they have none.
    pub address: Option<Address>,
    /// The lines, in order.
    pub lines: Vec<ReportLine>,
}

/// How far a report has come.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Progress {
    /// More bytes are needed.
    Incomplete,
    /// A whole report.
    Done {
        /// What it says.
        report: Report,
        /// Bytes it took, with the echo in front of it.
        used: usize,
    },
    /// No report to that command.
    Bad(BadReport),
}

/// Why bytes are no report to a command.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BadReport {
    /// The command reports nothing.
    #[error("{0} reports nothing")]
    Silent(&'static str),
    /// A line is not what the command reports.
    #[error("the line \"{0}\" is no answer to this command")]
    Line(String),
    /// It has more or fewer lines than the command reports.
    #[error("{got} lines came, not {expected}")]
    Lines {
        /// As many as the command reports.
        expected: usize,
        /// As many as came.
        got: usize,
    },
    /// Its lines have several addresses: two controllers answered.
    #[error("units {} and {} answered at once", char::from(.0.character()), char::from(.1.character()))]
    TwoUnits(Address, Address),
    /// It does not end.
    #[error("{LONGEST} bytes came without an end")]
    Endless,
}

impl Report {
    /// The number that a command reports, if it is in the report.
    pub fn number(&self, of: Mnemonic) -> Option<i32> {
        self.lines.iter().find_map(|line| match line {
            ReportLine::Number { of: found, value } if *found == of => Some(*value),
            ReportLine::Number { .. }
            | ReportLine::Status(_)
            | ReportLine::Analog { .. }
            | ReportLine::Channels { .. }
            | ReportLine::Channel { .. }
            | ReportLine::Macro(_)
            | ReportLine::Text(_) => None,
        })
    }

    /// The macros that are listed in the report, as the lines that define them.
    pub fn macros(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().filter_map(|line| match line {
            ReportLine::Macro(line) => Some(line),
            ReportLine::Number { .. }
            | ReportLine::Status(_)
            | ReportLine::Analog { .. }
            | ReportLine::Channels { .. }
            | ReportLine::Channel { .. }
            | ReportLine::Text(_) => None,
        })
    }

    /// The status, if it is in the report.
    pub fn status(&self) -> Option<Status> {
        self.lines.iter().find_map(|line| match line {
            ReportLine::Status(status) => Some(*status),
            ReportLine::Number { .. }
            | ReportLine::Analog { .. }
            | ReportLine::Channels { .. }
            | ReportLine::Channel { .. }
            | ReportLine::Macro(_)
            | ReportLine::Text(_) => None,
        })
    }
}

/// A report as the controller of that address sends it.
pub fn encode_report(form: ReportForm, radix: Radix, address: Address, lines: &[ReportLine]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for line in lines {
        bytes.extend_from_slice(line_text(form, radix, address, line).as_bytes());
        bytes.extend_from_slice(b"\r\n");
    }
    if lines.is_empty() {
        bytes.extend_from_slice(b"\r\n");
    }
    bytes.push(END_OF_REPORT);
    bytes
}

fn line_text(form: ReportForm, radix: Radix, address: Address, line: &ReportLine) -> String {
    let front = |letter: u8, channel: u8| {
        let address = char::from(address.character());
        let letter = char::from(letter);
        match form {
            ReportForm::Full => format!("{address}{letter}{channel}:"),
            ReportForm::Address => format!("{address}{letter}:"),
            ReportForm::Id => format!("{letter}:"),
        }
    };
    let plain = |value: u8| match radix {
        Radix::Decimal => value.to_string(),
        Radix::Hexadecimal => format!("{value:02X}"),
    };
    match line {
        ReportLine::Number { of, value } => match of.row().reports {
            Reports::Plain => front(LETTER_ANALOG_OUTPUT, 0) + &radix.short(*value),
            Reports::Number { id, .. } => front(id, 0) + &radix.long(*value),
            Reports::Nothing
            | Reports::Analog
            | Reports::Channels
            | Reports::Status
            | Reports::Each(_)
            | Reports::Text
            | Reports::Macros => String::new(),
        },
        ReportLine::Status(status) => {
            let bytes = status.bytes().map(|byte| format!("{byte:02X}")).join(" ");
            // TS has no channel in any form.
            let form = if form == ReportForm::Full { ReportForm::Address } else { form };
            let address = char::from(address.character());
            match form {
                ReportForm::Full | ReportForm::Address => format!("{address}S:{bytes}"),
                ReportForm::Id => format!("S:{bytes}"),
            }
        }
        ReportLine::Analog { channel, values } => {
            let gap = if *channel == 0 { " " } else { "" };
            let values: Vec<_> = values.iter().copied().map(plain).collect();
            format!("{}{gap}{}", front(LETTER_ANALOG, *channel), values.join(" "))
        }
        ReportLine::Channels { outputs, inputs } => {
            format!("{} {outputs:04X} {inputs:04X}", front(LETTER_CHANNELS, 0))
        }
        ReportLine::Channel { channel, is_on } => {
            format!("{} {}", front(LETTER_CHANNELS, *channel), u8::from(*is_on))
        }
        ReportLine::Macro(line) => line.listing(radix),
        ReportLine::Text(text) => text.clone(),
    }
}

/// The report to `command` at the start of `bytes`. `sent` is what was written to ask for it, whose echo may stand in front.
pub fn parse_report(command: &Command, radix: Radix, sent: &[u8], bytes: &[u8]) -> Progress {
    if command.row().reports == Reports::Nothing {
        return Progress::Bad(BadReport::Silent(command.mnemonic.name()));
    }
    let Some(end) = bytes.iter().position(|byte| *byte == END_OF_REPORT) else {
        return if bytes.len() > LONGEST { Progress::Bad(BadReport::Endless) } else { Progress::Incomplete };
    };
    let body = &bytes[echo_length(sent, &bytes[..end])..end];
    let text: String = body.iter().copied().map(char::from).collect();
    let lines: Vec<&str> = text.split(['\r', '\n']).map(str::trim).filter(|line| !line.is_empty()).collect();
    match parse_lines(command, radix, &lines) {
        Ok(report) => Progress::Done { report, used: end + 1 },
        Err(bad) => Progress::Bad(bad),
    }
}

/// Bytes at the start of `received` that are the echo of `sent`, if the whole of it is there: with the selection in front of it or
/// without, since a controller may have been selected only by it; up to the end of a line or from there, since a line may switch the
/// echo; and with a line feed behind a carriage return or without.
pub fn echo_length(sent: &[u8], received: &[u8]) -> usize {
    let is_selection = |begin: usize| begin == 0 || sent.first() == Some(&SELECT);
    let ends: Vec<usize> = (0..sent.len()).filter(|at| sent[*at] == EXECUTE).map(|at| at + 1).collect();
    let begins = (0..sent.len().min(3)).filter(|begin| is_selection(*begin)).chain(ends.iter().copied());
    let echoes = begins.flat_map(|begin| {
        let ends = ends.iter().copied().chain([sent.len()]);
        ends.filter(move |end| *end > begin).map(move |end| &sent[begin..end])
    });
    let Some(echo) = echoes.filter(|echo| received.starts_with(echo)).max_by_key(|echo| echo.len()) else {
        return 0;
    };
    let behind = received.get(echo.len());
    echo.len() + usize::from(echo.ends_with(&[EXECUTE]) && behind == Some(&b'\n'))
}

fn parse_lines(command: &Command, radix: Radix, lines: &[&str]) -> Result<Report, BadReport> {
    let row = command.row();
    let mut report = Report::default();
    match row.reports {
        Reports::Text => {
            report.lines = lines.iter().map(|line| ReportLine::Text((*line).to_owned())).collect();
        }
        Reports::Macros => {
            for line in lines {
                let listed = parse_listing(line, radix).ok_or_else(|| bad_line(line))?;
                report.lines.push(ReportLine::Macro(listed));
            }
        }
        Reports::Each(parts) => {
            expect(parts.len(), lines)?;
            for (part, line) in parts.iter().zip(lines) {
                data_line(&Command::plain(*part), radix, line, &mut report)?;
            }
        }
        Reports::Nothing
        | Reports::Number { .. }
        | Reports::Plain
        | Reports::Analog
        | Reports::Channels
        | Reports::Status => {
            expect(1, lines)?;
            lines.iter().try_for_each(|line| data_line(command, radix, line, &mut report))?;
        }
    }
    Ok(report)
}

fn expect(expected: usize, lines: &[&str]) -> Result<(), BadReport> {
    if lines.len() == expected { Ok(()) } else { Err(BadReport::Lines { expected, got: lines.len() }) }
}

fn bad_line(line: &str) -> BadReport {
    BadReport::Line(line.chars().take(80).collect())
}

/// Adds what one line of data says.
fn data_line(command: &Command, radix: Radix, line: &str, report: &mut Report) -> Result<(), BadReport> {
    let bad = || bad_line(line);
    let (front, data) = line.split_once(':').ok_or_else(bad)?;
    let front = Front::of(command.row().reports, front).ok_or_else(bad)?;
    match (report.address, front.address) {
        (Some(first), Some(second)) if first != second => return Err(BadReport::TwoUnits(first, second)),
        (None, Some(address)) => report.address = Some(address),
        _ => {}
    }
    let asked = command.value().and_then(|value| u8::try_from(value).ok()).unwrap_or_default();
    if front.channel.is_some_and(|channel| channel != asked) {
        return Err(bad());
    }
    report.lines.push(data_of(command, radix, asked, data.trim()).ok_or_else(bad)?);
    Ok(())
}

fn data_of(command: &Command, radix: Radix, asked: u8, data: &str) -> Option<ReportLine> {
    let byte = |text: &str| u8::try_from(radix.reported(text)?).ok();
    let mut words = data.split_ascii_whitespace();
    Some(match command.row().reports {
        Reports::Number { .. } | Reports::Plain => {
            ReportLine::Number { of: command.mnemonic, value: radix.reported(data)? }
        }
        Reports::Status => {
            let bytes: Option<Vec<u8>> = words.map(hex_byte).collect();
            ReportLine::Status(Status::from_bytes(&bytes?)?)
        }
        Reports::Analog => {
            let values: Vec<u8> = words.map(byte).collect::<Option<_>>()?;
            let expected = if asked == 0 { 2 } else { 1 };
            (values.len() == expected).then_some(ReportLine::Analog { channel: asked, values })?
        }
        Reports::Channels if asked == 0 => {
            let (outputs, inputs) = (hex_word(words.next()?)?, hex_word(words.next()?)?);
            words.next().is_none().then_some(ReportLine::Channels { outputs, inputs })?
        }
        Reports::Channels => {
            let is_on = match radix.reported(data)? {
                0 => false,
                1 => true,
                _ => return None,
            };
            ReportLine::Channel { channel: asked, is_on }
        }
        Reports::Nothing | Reports::Each(_) | Reports::Text | Reports::Macros => return None,
    })
}

fn hex_byte(text: &str) -> Option<u8> {
    u8::try_from(hex_word(text)?).ok()
}

fn hex_word(text: &str) -> Option<u16> {
    let is_hex = text.bytes().all(|byte| byte.is_ascii_hexdigit());
    if is_hex { u16::from_str_radix(text, 16).ok() } else { None }
}

/// What stands before the colon.
struct Front {
    address: Option<Address>,
    channel: Option<u8>,
}

impl Front {
    fn of(reports: Reports, front: &str) -> Option<Self> {
        let (id, also) = match reports {
            Reports::Number { id, also } => (id, also),
            Reports::Plain => (LETTER_ANALOG_OUTPUT, None),
            Reports::Analog => (LETTER_ANALOG, None),
            Reports::Channels => (LETTER_CHANNELS, None),
            Reports::Status => (LETTER_STATUS, None),
            Reports::Nothing | Reports::Each(_) | Reports::Text | Reports::Macros => return None,
        };
        let is_id = |letter: u8| {
            let letter = letter.to_ascii_uppercase();
            letter == id || Some(letter) == also
        };
        let front: Vec<u8> = front.bytes().filter(|byte| *byte != b' ').collect();
        // An address may be a letter that is the id of another report, so that the whole front is compared with each form.
        match *front.as_slice() {
            [letter] if is_id(letter) => Some(Self { address: None, channel: None }),
            [address, letter, ref channel @ ..]
                if is_id(letter) && Address::from_character(address).is_some() && channel.len() <= 2 =>
            {
                let address = Address::from_character(address);
                let channel = if channel.is_empty() { None } else { Some(number_of(channel)?) };
                Some(Self { address, channel })
            }
            [letter, ref channel @ ..] if is_id(letter) && channel.len() <= 2 => {
                Some(Self { address: None, channel: Some(number_of(channel)?) })
            }
            _ => None,
        }
    }
}

fn number_of(digits: &[u8]) -> Option<u8> {
    digits.iter().try_fold(0_u8, |number, byte| {
        let digit = byte.is_ascii_digit().then(|| byte - b'0')?;
        number.checked_mul(10)?.checked_add(digit)
    })
}
