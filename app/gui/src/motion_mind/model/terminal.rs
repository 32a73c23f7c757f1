//! The terminal: a command typed in text or in hex, what it means, what it looks like in both protocols, and its answer.
//!
//! What is sent goes out in the protocol that the unit speaks, byte for byte, and what comes back is shown as it came and in words. Only
//! what changes registers takes the way of every other write, with a backup before it. What is no command can be sent as it is typed, in
//! the unit's own protocol; the link lets that through to simulated units alone, but for a line that a unit would answer with BAD COMMAND.
//! The self-test is never sent; commands that move the motor are sent while a screen that drives is armed, which this one is not.

use std::collections::VecDeque;
use std::time::Duration;

use crate::messages::WindowTypedMessage;
use crate::motion_mind::messages::MindMessage;
use brushwork_link::device::Event;
use brushwork_motion_mind_client::{MotionMindFacts, describe_received, describe_sent};
use brushwork_motion_mind_wire::{
    Address, Command, Effect, FrameEvent, FrameReader, LineEvent, LineReader, Part, Protocol, checksum,
    describe_command, encode_frame, encode_line,
};
use brushwork_values::{Value, Values, hex};

/// Lines kept; the oldest go first.
const KEPT: usize = 500;
/// Answers to the terminal's commands begin with this number.
const FIRST_ID: u64 = 1 << 41;

/// How a command is typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// As a line of text: `W01 04 6000`.
    #[default]
    Text,
    /// As bytes: `18 01 04 70 17 A4`.
    Hex,
}

/// What is to be sent; the answer comes with `id`.
#[derive(Clone, Debug, PartialEq)]
pub enum Sending {
    /// A command with its values.
    Transact { id: u64, command: u8, values: Vec<Value> },
    /// Bytes as they are.
    Raw { id: u64, bytes: Vec<u8> },
}

/// One command with its answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    id: u64,
    /// As text and as bytes, where it has the form.
    pub sent: String,
    /// In words.
    pub meaning: String,
    /// The bytes that went out, where the answer comes as bytes, and their protocol.
    raw: Option<(Vec<u8>, Protocol)>,
    /// What came back as it came, where it came as bytes.
    pub received: Option<String>,
    pub answer: Option<Result<String, String>>,
}

/// The state of the screen.
#[derive(Debug, Default)]
pub struct Terminal {
    pub typed: String,
    pub form: Form,
    pub entries: VecDeque<Entry>,
    asked: u64,
    /// Which of the earlier lines the up key shows.
    recalled: Option<usize>,
    history: Vec<String>,
}

/// What was typed, understood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Understood {
    pub address: Address,
    pub command: Command,
}

impl Understood {
    /// In words.
    pub fn meaning(&self) -> String {
        describe_command(self.address, &self.command)
    }

    /// As a line of text, where it has that form.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn line(&self) -> Option<String> {
        let command = match self.command {
            Command::ReadRegister(number) => Command::ReadText(Part::Register(number)),
            other => other,
        };
        encode_line(self.address, &command).ok().map(|line| line.trim_end().to_owned())
    }

    /// As bytes, where it has that form.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn bytes(&self) -> Option<String> {
        let command = match self.command {
            Command::ReadText(Part::Register(number)) => Command::ReadRegister(number),
            Command::ReadText(Part::All) => Command::Read(u32::MAX),
            other => other,
        };
        encode_frame(self.address, &command).ok().map(|bytes| hex(&bytes))
    }

    /// Why it is not sent; `selected` is the unit that the link speaks to.
    pub fn refusal(&self, selected: u8) -> Option<String> {
        if self.address.is_broadcast() {
            return Some(
                "this goes to every unit of the bus and none answers. Send it unit by unit".to_owned(),
            );
        }
        if self.address.get() != selected {
            return Some(MindMessage::ForOther { address: self.address.to_string(), selected }.to_string());
        }
        matches!(self.command.effect(), Effect::Motion | Effect::RelativeMotion)
            .then(|| "this moves the motor. Use the screens that drive, which are armed first".to_owned())
    }

    /// What should be known before it is sent.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn care(&self) -> Option<&'static str> {
        match self.command {
            Command::Write { .. } => Some("This changes a register in RAM. A backup is made first."),
            Command::WriteStore { .. } => {
                Some("This writes EEPROM and stops the motor. A backup is made first.")
            }
            Command::Restore => Some(
                "This brings back the factory's values in RAM and EEPROM and stops the motor. A backup is made first.",
            ),
            Command::Reset => {
                Some("This restarts the unit and stops the motor: what is in RAM alone is lost.")
            }
            _ => None,
        }
    }

    /// The command's byte and its values, where it changes registers: those are backed up first.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn request(&self) -> Option<(u8, Vec<i64>)> {
        Some(match self.command {
            Command::Write { register, value } => (0x18, vec![register.into(), value]),
            Command::WriteStore { register, value } => (0x19, vec![register.into(), value]),
            Command::Restore => (0x1B, vec![]),
            Command::Reset => (0x1C, vec![]),
            _ => return None,
        })
    }

    /// Its bytes on a wire of the unit's protocol. A read that this protocol does not have becomes the one nearest to it.
    fn on_wire(&self, protocol: Protocol) -> Option<Vec<u8>> {
        let command = match (protocol, self.command) {
            (Protocol::Binary, Command::ReadText(Part::Register(number))) => Command::ReadRegister(number),
            (Protocol::Binary, Command::ReadText(Part::All)) => Command::Read(u32::MAX),
            (Protocol::Binary, Command::ReadText(Part::StatusBits)) => Command::ReadRegister(16),
            (Protocol::Binary, Command::ReadText(Part::FunctionBits)) => Command::ReadRegister(3),
            (Protocol::Text, Command::ReadRegister(number)) => Command::ReadText(Part::Register(number)),
            (Protocol::Text, Command::Read(mask)) if mask.count_ones() == 1 => {
                Command::ReadText(Part::Register(mask.trailing_zeros() as u8))
            }
            (Protocol::Text, Command::Read(_)) => Command::ReadText(Part::All),
            (_, command) => command,
        };
        match protocol {
            Protocol::Binary => encode_frame(self.address, &command).ok(),
            Protocol::Text => encode_line(self.address, &command).ok().map(String::into_bytes),
        }
    }
}

/// Bytes as a person reads them in a protocol.
fn shown(bytes: &[u8], protocol: Protocol) -> String {
    match protocol {
        Protocol::Binary => hex(bytes),
        Protocol::Text => String::from_utf8_lossy(bytes).trim_end().replace("\r\n", " | "),
    }
}

/// What a line of text means, or why it is none.
pub fn of_text(typed: &str) -> Result<Understood, WindowTypedMessage> {
    let mut reader = LineReader::new();
    let mut event = None;
    for byte in typed.trim().bytes().chain(*b"\r\n") {
        event = event.or(reader.feed(byte));
    }
    match event {
        Some(LineEvent::Command(address, command)) => Ok(Understood { address, command }),
        Some(LineEvent::SelfTest(_)) => Err(WindowTypedMessage::SelfTest),
        Some(LineEvent::NotUnderstood { address: None, .. }) => Err(WindowTypedMessage::NoAddress),
        Some(LineEvent::NotUnderstood { .. }) => Err(WindowTypedMessage::BadCommand),
        None => Err(WindowTypedMessage::NoLine),
    }
}

/// What bytes in hex mean, or why they are no command. A checksum that is missing is told.
pub fn of_hex(typed: &str) -> Result<Understood, WindowTypedMessage> {
    let Some(bytes) = bytes_of(typed) else {
        return Err(WindowTypedMessage::NoPairs);
    };
    if bytes.is_empty() {
        return Err(WindowTypedMessage::NoBytes);
    }
    let mut reader = FrameReader::new();
    for (index, byte) in bytes.iter().enumerate() {
        if let Some(FrameEvent::Command(address, command)) = reader.feed(*byte, Duration::ZERO) {
            let rest = bytes.len() - index - 1;
            return match rest {
                0 => Ok(Understood { address, command }),
                _ => Err(WindowTypedMessage::MoreBytes { bytes: rest }),
            };
        }
    }
    let mut with_sum = bytes.clone();
    with_sum.push(checksum(&bytes));
    let mut reader = FrameReader::new();
    let is_whole = with_sum.iter().any(|byte| reader.feed(*byte, Duration::ZERO).is_some());
    Err(match (is_whole, bytes.split_last()) {
        (true, _) => WindowTypedMessage::NoChecksum { checksum: checksum(&bytes) },
        (false, Some((last, rest))) if rest.len() >= 2 && checksum(rest) != *last => {
            WindowTypedMessage::OtherChecksum { checksum: checksum(rest) }
        }
        _ => WindowTypedMessage::NotYet,
    })
}

/// Pairs of hexadecimal digits as bytes; none where they are not that.
fn bytes_of(typed: &str) -> Option<Vec<u8>> {
    let digits: String = typed.chars().filter(|letter| !letter.is_whitespace() && *letter != ',').collect();
    let digits = digits.replace("0x", "").replace("0X", "");
    let pair = |at: usize| digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok());
    (0..digits.len()).step_by(2).map(pair).collect()
}

impl Terminal {
    /// What stands in the field.
    pub fn understood(&self) -> Result<Understood, WindowTypedMessage> {
        match self.form {
            Form::Text => of_text(&self.typed),
            Form::Hex => of_hex(&self.typed),
        }
    }

    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Sends what stands in the field, if it can be. `selected` is the unit that the link speaks to.
    pub fn send(&mut self, selected: u8, facts: MotionMindFacts) -> Option<Sending> {
        let understood =
            self.understood().ok().filter(|understood| understood.refusal(selected).is_none())?;
        if let Some((command, values)) = understood.request() {
            let forms = [understood.line(), understood.bytes()].into_iter().flatten().collect::<Vec<_>>();
            let id = self.note_sent(forms.join("  |  "), understood.meaning(), None);
            return Some(Sending::Transact {
                id,
                command,
                values: values.into_iter().map(Value::Int).collect(),
            });
        }
        let bytes = understood.on_wire(facts.protocol)?;
        Some(self.send_bytes(bytes, facts.protocol, understood.meaning()))
    }

    /// The bytes of what stands in the field where it is no command, in the unit's own protocol; why not, as a sentence.
    pub fn as_typed(&self, facts: MotionMindFacts) -> Result<Vec<u8>, &'static str> {
        if self.understood().is_ok() || self.typed.trim().is_empty() {
            return Err("");
        }
        match (self.form, facts.protocol) {
            (Form::Text, Protocol::Binary) => {
                Err("The unit speaks binary: type bytes in hex to send them as they are.")
            }
            (Form::Hex, Protocol::Text) => Err("The unit speaks text: type a line to send it as it is."),
            (Form::Text, Protocol::Text) if self.typed.to_ascii_uppercase().contains('Z') => Err(""),
            (Form::Text, Protocol::Text) => Ok(format!("{}\r\n", self.typed.trim()).into_bytes()),
            (Form::Hex, Protocol::Binary) => {
                bytes_of(&self.typed).filter(|bytes| !bytes.is_empty()).ok_or("")
            }
        }
    }

    /// Sends what stands in the field as it is typed, command or not.
    pub fn send_as_typed(&mut self, facts: MotionMindFacts) -> Option<Sending> {
        let bytes = self.as_typed(facts).ok()?;
        let meaning = describe_sent(&bytes, facts.protocol).text;
        Some(self.send_bytes(bytes, facts.protocol, MindMessage::AsTyped { meaning }.to_string()))
    }

    fn send_bytes(&mut self, bytes: Vec<u8>, protocol: Protocol, meaning: String) -> Sending {
        let id = self.note_sent(shown(&bytes, protocol), meaning, Some((bytes.clone(), protocol)));
        Sending::Raw { id, bytes }
    }

    /// Takes what was typed into the list and the history; the number of its answer.
    fn note_sent(&mut self, sent: String, meaning: String, raw: Option<(Vec<u8>, Protocol)>) -> u64 {
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        self.push(Entry { id, sent, meaning, raw, received: None, answer: None });
        self.history.push(std::mem::take(&mut self.typed));
        self.recalled = None;
        id
    }

    /// The line before the one that is shown, or after it.
    pub fn recall(&mut self, older: bool) {
        let at = match (self.recalled, older) {
            (None, true) => self.history.len().checked_sub(1),
            (Some(at), true) => Some(at.saturating_sub(1)),
            (Some(at), false) if at + 1 < self.history.len() => Some(at + 1),
            (_, false) => None,
        };
        self.recalled = at;
        self.typed = at.and_then(|at| self.history.get(at).cloned()).unwrap_or_default();
    }

    /// The command was not taken by the link.
    pub fn not_sent(&mut self, id: u64) {
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == id) {
            entry.answer = Some(Err("Not sent: the link is busy. Send it again in a moment.".to_owned()));
        }
    }

    /// Takes note of an answer.
    pub fn note(&mut self, event: &Event) {
        if let Event::Transacted { id, result } = event
            && let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == *id)
        {
            entry.answer = Some(result.as_ref().map(reported).map_err(ToString::to_string));
        }
        if let Event::RawReply { id, result } = event
            && let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == *id)
        {
            entry.note_bytes(result.as_ref().map_err(ToString::to_string));
        }
    }

    /// The link is gone: nothing more is answered.
    pub fn link_ended(&mut self) {
        for entry in self.entries.iter_mut().filter(|entry| entry.answer.is_none()) {
            entry.answer = Some(Err("The link ended before an answer came.".to_owned()));
        }
    }

    fn push(&mut self, entry: Entry) {
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(entry);
    }
}

impl Entry {
    fn note_bytes(&mut self, result: Result<&Vec<u8>, String>) {
        let Some((sent, protocol)) = &self.raw else { return };
        self.answer = Some(match result {
            Ok(reply) if reply.is_empty() => Ok("silence".to_owned()),
            Ok(reply) => {
                self.received = Some(shown(reply, *protocol));
                Ok(describe_received(sent, reply, *protocol).text)
            }
            Err(why) => Err(why),
        });
    }
}

/// "PTERM 6000, ITERM 35", or that it was taken.
fn reported(values: &Values) -> String {
    if values.is_empty() {
        return "OK".to_owned();
    }
    let each = values.iter().map(|(field, value)| match value {
        Value::Int(value) => format!("{} {value}", field.name),
        other @ (Value::Text(_) | Value::Bytes(_) | Value::Records(_)) => {
            format!("{} {other:?}", field.name)
        }
    });
    each.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meaning(result: Result<Understood, WindowTypedMessage>) -> String {
        result.map_or_else(|why| why.to_string(), |understood| understood.meaning())
    }

    #[test]
    fn the_same_command_is_understood_in_text_and_in_hex() {
        for (text, bytes) in [("W01 04 6000", "18 01 04 70 17 A4"), ("X01", "1B 01 1C"), ("Y01", "1c011d")] {
            assert_eq!(of_text(text).unwrap(), of_hex(bytes).unwrap(), "{text}");
        }
        assert_eq!(meaning(of_text("r01 04")), "unit 1: read PTERM");
        assert_eq!(of_text("R01 04").unwrap().bytes().as_deref(), Some("1D 01 04 22"));
        assert_eq!(of_hex("1D 01 04 22").unwrap().line().as_deref(), Some("R01 04"));
    }

    #[test]
    fn what_is_no_command_says_what_the_unit_would_do() {
        assert!(meaning(of_text("W01 04")).contains("BAD COMMAND"));
        assert!(meaning(of_text("hello")).contains("would not answer"));
        assert!(meaning(of_hex("1D 01 04")).contains("it is 22"));
        assert!(meaning(of_hex("1D 01 04 23")).contains("should be 22"));
        assert!(meaning(of_hex("1D 0")).contains("pairs"));
    }

    #[test]
    fn the_self_test_motion_and_other_units_are_not_sent() {
        assert!(meaning(of_text("Z01")).contains("self-test"));
        let refusal = |text: &str| of_text(text).unwrap().refusal(1).unwrap_or_default();
        assert!(refusal("C01 100").contains("moves the motor"));
        assert!(refusal("R02 04").contains("unit 2"));
        assert!(refusal("W99 04 5").contains("every unit"));
        assert_eq!(refusal("R01 04"), "");
        let mut terminal = Terminal { typed: "P01 1000".to_owned(), ..Terminal::default() };
        assert_eq!(terminal.send(1, facts(Protocol::Text)), None);
    }

    #[test]
    fn what_is_sent_is_in_the_units_protocol_and_only_writes_take_the_way_with_a_backup() {
        let sent = |typed: &str, form, protocol| {
            let mut terminal = Terminal { typed: typed.to_owned(), form, ..Terminal::default() };
            terminal.send(1, facts(protocol))
        };
        let bytes = |action| match action {
            Some(Sending::Raw { bytes, .. }) => bytes,
            other => panic!("{other:?}"),
        };
        // READ REGISTER 4 of unit 1, sum 22.
        assert_eq!(bytes(sent("R01 04", Form::Text, Protocol::Binary)), [0x1D, 0x01, 0x04, 0x22]);
        assert_eq!(bytes(sent("1D 01 04 22", Form::Hex, Protocol::Text)), b"R01 04\r\n");
        assert!(matches!(sent("W01 04 6000", Form::Text, Protocol::Binary), Some(Sending::Transact { .. })));
    }

    #[test]
    fn what_is_no_command_goes_out_as_typed_in_the_units_own_protocol_and_never_z() {
        let typed = |typed: &str, form, protocol| {
            Terminal { typed: typed.to_owned(), form, ..Terminal::default() }.as_typed(facts(protocol))
        };
        assert_eq!(typed("1D 01 04 23", Form::Hex, Protocol::Binary), Ok(vec![0x1D, 0x01, 0x04, 0x23]));
        assert_eq!(typed("hello", Form::Text, Protocol::Text), Ok(b"hello\r\n".to_vec()));
        assert!(typed("hello", Form::Text, Protocol::Binary).unwrap_err().contains("speaks binary"));
        for dead in ["Z01", "z01", "x Z"] {
            assert!(typed(dead, Form::Text, Protocol::Text).is_err(), "{dead}");
        }
        assert!(typed("1D 01 04 22", Form::Hex, Protocol::Binary).is_err(), "a command is sent as one");
    }

    fn facts(protocol: Protocol) -> MotionMindFacts {
        MotionMindFacts { protocol, mode: brushwork_motion_mind_wire::Mode::SerialPid }
    }

    #[test]
    fn lines_of_before_come_back_by_key() {
        let mut terminal = Terminal::default();
        for line in ["R01 04", "R01 05"] {
            terminal.typed = line.to_owned();
            assert!(terminal.send(1, facts(Protocol::Binary)).is_some());
        }
        terminal.recall(true);
        assert_eq!(terminal.typed, "R01 05");
        terminal.recall(true);
        terminal.recall(true);
        assert_eq!(terminal.typed, "R01 04");
        terminal.recall(false);
        assert_eq!(terminal.typed, "R01 05");
    }
}
