//! Lines of commands, in both directions (SuprMotr manual, "Compound Commands" and "Macro Commands").
//!
//! Assumed: a line longer than [`LINE_BUFFER`] is refused (error 09); a macro definition stands first in its line, elsewhere it is no
//! command (01); a definition without commands lacks one (03), as does a comma with nothing behind it.

use crate::characters::EXECUTE;
use crate::number::Radix;
use crate::status::ErrorCode;
use crate::table::{Absent, COMMANDS, CommandRow, LAST_MACRO, MOST_COMMANDS, Mnemonic, Parameter};

/// Characters of the longest line. Assumed: fifteen commands with all their digits fit.
pub const LINE_BUFFER: usize = 255;

/// One command with its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Command {
    /// Which one.
    pub mnemonic: Mnemonic,
    /// The number behind it, if there is one.
    pub number: Option<i32>,
}

/// A line without its end: commands that are carried out, or a macro that is defined.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Line {
    /// The number of the macro that the commands become; `None` if they are carried out.
    pub defines: Option<u8>,
    /// The commands, in order.
    pub commands: Vec<Command>,
}

/// What a controller makes of a line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Parsed {
    /// The commands before the first that is refused.
    pub line: Line,
    /// The first that is refused.
    pub error: Option<LineError>,
}

/// Why a line is refused, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("character {}: {code}", .at + 1)]
pub struct LineError {
    /// The controller's number for it.
    pub code: ErrorCode,
    /// Which byte of the line, from 0.
    pub at: usize,
}

/// Why a line cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum EncodeError {
    /// A carriage return alone would repeat the last line.
    #[error("a line needs a command")]
    Empty,
    /// There are more commands than a line or a macro holds.
    #[error("{0} commands are too many; a line and a macro hold {MOST_COMMANDS}")]
    TooManyCommands(usize),
    /// It would not fit the controller's buffer.
    #[error("{0} characters are too many for a line; it holds {LINE_BUFFER}")]
    TooLong(usize),
    /// There is no macro of that number.
    #[error("{0} is no macro; there are 0 to {LAST_MACRO}")]
    Macro(u8),
    /// The number does not fit the command.
    #[error("{name} takes {low} to {high}, not {number}")]
    Number {
        /// The command.
        name: &'static str,
        /// The least.
        low: i32,
        /// The most.
        high: i32,
        /// What was wanted.
        number: i32,
    },
    /// The command takes no number.
    #[error("{0} takes no number")]
    TakesNone(&'static str),
    /// The command needs its number.
    #[error("{0} needs a number")]
    NeedsNumber(&'static str),
    /// A definition within a line.
    #[error("MD stands first in its line or not at all")]
    Definition,
}

impl Command {
    /// A command without a number.
    pub const fn plain(mnemonic: Mnemonic) -> Self {
        Self { mnemonic, number: None }
    }

    /// A command with its number.
    pub const fn with(mnemonic: Mnemonic, number: i32) -> Self {
        Self { mnemonic, number: Some(number) }
    }

    /// Its row in the table.
    pub fn row(&self) -> &'static CommandRow {
        self.mnemonic.row()
    }

    /// The number that counts: the one given, or the one that is meant without; `None` if there is no such number.
    pub fn value(&self) -> Option<i32> {
        self.number.or_else(|| match self.row().takes?.absent {
            Absent::Means(number) => Some(number),
            Absent::Refused | Absent::All => None,
        })
    }

    /// Whether the controller takes the number.
    ///
    /// # Errors
    /// If the number is missing, out of range or one too many.
    pub fn check(&self) -> Result<(), EncodeError> {
        let name = self.mnemonic.name();
        match (self.row().takes, self.number) {
            (None, None) => Ok(()),
            (None, Some(_)) => Err(EncodeError::TakesNone(name)),
            (Some(Parameter { absent: Absent::Refused, .. }), None) => Err(EncodeError::NeedsNumber(name)),
            (Some(_), None) => Ok(()),
            (Some(takes), Some(number)) if takes.allows(number) => Ok(()),
            (Some(Parameter { low, high, .. }), Some(number)) => {
                Err(EncodeError::Number { name, low, high, number })
            }
        }
    }

    /// As it is sent: `MR500`.
    pub fn text(&self, radix: Radix) -> String {
        let number = self.number.map(|number| radix.short(number)).unwrap_or_default();
        format!("{}{number}", self.mnemonic.name())
    }
}

impl Line {
    /// A line that carries out one command.
    pub fn of(command: Command) -> Self {
        Self { defines: None, commands: vec![command] }
    }

    /// As it is sent, without its end: `MD3,MR1000,WS500`. A change of radix within the line counts for what follows.
    pub fn text(&self, radix: Radix) -> String {
        self.written(radix, Radix::short)
    }

    /// The line with its carriage return.
    ///
    /// # Errors
    /// If it is empty or too long, or a number does not fit its command.
    pub fn encode(&self, radix: Radix) -> Result<Vec<u8>, EncodeError> {
        if self.commands.is_empty() {
            return Err(EncodeError::Empty);
        }
        if self.commands.len() > MOST_COMMANDS {
            return Err(EncodeError::TooManyCommands(self.commands.len()));
        }
        if let Some(number) = self.defines.filter(|number| *number > LAST_MACRO) {
            return Err(EncodeError::Macro(number));
        }
        for command in &self.commands {
            if command.mnemonic == Mnemonic::MD {
                return Err(EncodeError::Definition);
            }
            command.check()?;
        }
        let mut bytes = self.text(radix).into_bytes();
        if bytes.len() > LINE_BUFFER {
            return Err(EncodeError::TooLong(bytes.len()));
        }
        bytes.push(EXECUTE);
        Ok(bytes)
    }

    /// A macro as TM lists it: `MD11, MR+0000000500,WS+0000000100,RP+0000000009`.
    pub fn listing(&self, radix: Radix) -> String {
        let listed = self.written(radix, Radix::listed);
        match self.defines {
            Some(_) => listed.replacen(',', ", ", 1),
            None => listed,
        }
    }

    fn written(&self, mut radix: Radix, number: fn(Radix, i32) -> String) -> String {
        let mut parts = Vec::with_capacity(self.commands.len() + 1);
        if let Some(defines) = self.defines {
            parts.push(format!("MD{}", radix.short(defines.into())));
        }
        for command in &self.commands {
            let digits = command.number.map(|value| number(radix, value)).unwrap_or_default();
            parts.push(format!("{}{digits}", command.mnemonic.name()));
            radix = radix_after(command.mnemonic, radix);
        }
        parts.join(",")
    }
}

fn radix_after(mnemonic: Mnemonic, radix: Radix) -> Radix {
    if mnemonic == Mnemonic::DM {
        Radix::Decimal
    } else if mnemonic == Mnemonic::HM {
        Radix::Hexadecimal
    } else {
        radix
    }
}

/// Reads a line without its end, as a controller does: letters in either case, spaces anywhere.
pub fn parse_line(text: &[u8], radix: Radix) -> Parsed {
    let mut reader = LineParser { text, at: 0, radix };
    let mut line = Line::default();
    let error = if text.len() > LINE_BUFFER {
        Some(LineError { code: ErrorCode::LineOverflow, at: LINE_BUFFER })
    } else {
        reader.read(&mut line).err()
    };
    Parsed { line, error }
}

/// A macro as TM lists it, in either of the manual's forms; `None` if the line is no macro.
pub fn parse_listing(text: &str, radix: Radix) -> Option<Line> {
    let text = text.trim();
    let letters = text.get(..2)?;
    // The section of TM shows "mc1,mr555,ws,gh" for macro 1.
    let as_definition =
        if letters.eq_ignore_ascii_case("MC") { format!("MD{}", &text[2..]) } else { text.to_owned() };
    let parsed = parse_line(as_definition.as_bytes(), radix);
    (parsed.error.is_none() && parsed.line.defines.is_some()).then_some(parsed.line)
}

struct LineParser<'a> {
    text: &'a [u8],
    at: usize,
    radix: Radix,
}

impl LineParser<'_> {
    fn read(&mut self, line: &mut Line) -> Result<(), LineError> {
        loop {
            let at = self.skip_spaces();
            let command = self.command()?;
            if command.mnemonic == Mnemonic::MD {
                if line.defines.is_some() || !line.commands.is_empty() {
                    return Err(LineError { code: ErrorCode::NotAvailable, at });
                }
                line.defines = command.number.and_then(|number| u8::try_from(number).ok());
            } else if line.commands.len() == MOST_COMMANDS {
                let code = match line.defines {
                    Some(_) => ErrorCode::MacroOverflow,
                    None => ErrorCode::LineOverflow,
                };
                return Err(LineError { code, at });
            } else {
                line.commands.push(command);
            }
            match self.peek() {
                Some(b',') => self.at += 1,
                Some(_) => return self.refuse(ErrorCode::NoComma),
                None if line.commands.is_empty() => return self.refuse(ErrorCode::NoCommand),
                None => return Ok(()),
            }
        }
    }

    fn command(&mut self) -> Result<Command, LineError> {
        let start = self.at;
        let first = match self.peek() {
            None | Some(b',') => return self.refuse(ErrorCode::NoCommand),
            Some(byte) if byte.is_ascii_alphabetic() => byte,
            Some(_) => return self.refuse(ErrorCode::NotALetter),
        };
        self.at += 1;
        let second = self.peek();
        let known = second.and_then(|second| Mnemonic::from_letters([first, second]));
        let Some(mnemonic) = known else {
            return Err(LineError { code: ErrorCode::NotAvailable, at: start });
        };
        self.at += 1;
        let number = match mnemonic.row().takes {
            None => None,
            Some(takes) => self.number(&takes)?,
        };
        self.radix = radix_after(mnemonic, self.radix);
        Ok(Command { mnemonic, number })
    }

    fn number(&mut self, takes: &Parameter) -> Result<Option<i32>, LineError> {
        let begins = self.skip_spaces();
        let refused = |code| Err(LineError { code, at: begins });
        let is_negative = match self.peek() {
            None | Some(b',') if takes.absent == Absent::Refused => return refused(ErrorCode::NotANumber),
            None | Some(b',') => return Ok(None),
            Some(sign @ (b'+' | b'-')) => {
                self.at += 1;
                sign == b'-'
            }
            Some(_) => false,
        };
        let mut magnitude: i64 = 0;
        let mut digits = 0;
        while let Some(digit) = self.peek().and_then(|byte| char::from(byte).to_digit(self.radix.base())) {
            magnitude = magnitude.saturating_mul(self.radix.base().into()).saturating_add(digit.into());
            digits += 1;
            self.at += 1;
        }
        if digits == 0 {
            return self.refuse(ErrorCode::NotANumber);
        }
        let value = if is_negative { -magnitude } else { magnitude };
        if is_negative && takes.low >= 0 && value != 0 {
            refused(ErrorCode::Negative)
        } else if value > takes.high.into() {
            refused(ErrorCode::TooLarge)
        } else if value < takes.low.into() {
            refused(ErrorCode::TooSmall)
        } else {
            match i32::try_from(value) {
                Ok(number) if takes.allows(number) => Ok(Some(number)),
                // FE takes 0, 1 and 4 alone. Assumed: 2 and 3 are too large for it as 5 is.
                Ok(_) | Err(_) => refused(ErrorCode::TooLarge),
            }
        }
    }

    fn refuse<T>(&self, code: ErrorCode) -> Result<T, LineError> {
        Err(LineError { code, at: self.at })
    }

    /// The next byte that is no space.
    fn peek(&mut self) -> Option<u8> {
        self.skip_spaces();
        self.text.get(self.at).copied()
    }

    fn skip_spaces(&mut self) -> usize {
        while self.text.get(self.at) == Some(&b' ') {
            self.at += 1;
        }
        self.at
    }
}

/// How the letters of all commands are listed by HE: five to a line. Assumed, since the manual does not show it.
pub fn help_lines() -> Vec<String> {
    let row = |rows: &[CommandRow]| {
        rows.iter().map(|row| format!("{} {}", row.name, row.title)).collect::<Vec<_>>().join(", ")
    };
    COMMANDS.chunks(5).map(row).collect()
}
