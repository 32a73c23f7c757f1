//! The terminal: a line as it goes out, or bytes that become triplets, what it means, and what came back in words.

use std::rc::Rc;

use brushwork_link::device::{Event, RiskAccepted};
use brushwork_motorvator_client::{describe_received, describe_sent};
use brushwork_motorvator_wire::host::HostAnswer;
use brushwork_motorvator_wire::{FRAME_BYTES, LINE_END, Order, line_of_host, parse_line_of_board};

use crate::command::Command;
use crate::model::raw_lines::{RawLines, shown};
use crate::motorvator::action::StartProgram;
use crate::motorvator::messages::BoardMessage;

/// Answers to the terminal's lines begin with this number.
const FIRST_ID: u64 = 1 << 44;
/// Bytes of a line that has not ended that are kept.
const MOST_BEGUN: usize = 256;

/// The state of the screen.
#[derive(Debug)]
pub struct Terminal {
    pub lines: RawLines<()>,
    /// The user has the switch of the motors' power at hand, and may start what is in the board's memory.
    pub accepts_risk: bool,
    /// A line that has not ended yet, and frames that may be the answer to one that was sent.
    begun: Vec<u8>,
    heard: Vec<Vec<u8>>,
    /// Frames that were told as answers.
    answered: Vec<Vec<u8>>,
}

impl Default for Terminal {
    fn default() -> Self {
        Self {
            lines: RawLines::from_id(FIRST_ID),
            accepts_risk: false,
            begun: Vec::new(),
            heard: Vec::new(),
            answered: Vec::new(),
        }
    }
}

/// The line that a text stands for, its end included: G, H and I as they are, else bytes as numbers and texts in quotes.
///
/// # Errors
/// A sentence: it is none.
pub fn line_of(typed: &str) -> Result<Vec<u8>, String> {
    let typed = typed.trim();
    if typed.is_empty() {
        return Err("Type G, H, I001002003, or bytes such as 1 2 3 or \"TX\" 5.".to_owned());
    }
    if typed.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
        if !typed.is_ascii() {
            return Err("A line has ASCII characters alone.".to_owned());
        }
        return Ok([typed.as_bytes(), &[LINE_END]].concat());
    }
    let bytes = bytes_of(typed)?;
    if bytes.len() > FRAME_BYTES {
        return Err(BoardMessage::TooLong { bytes: bytes.len(), most: FRAME_BYTES }.to_string());
    }
    Ok(line_of_host(&bytes))
}

/// Numbers from 0 to 255, and texts in quotes.
fn bytes_of(typed: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    for (index, part) in typed.split('"').enumerate() {
        if index % 2 == 1 {
            if !part.is_ascii() {
                return Err("A text has ASCII characters alone.".to_owned());
            }
            bytes.extend(part.bytes());
            continue;
        }
        for word in
            part.split(|letter: char| letter.is_whitespace() || letter == ',').filter(|word| !word.is_empty())
        {
            bytes
                .push(word.parse().map_err(|_| BoardMessage::NoByte { word: word.to_string() }.to_string())?);
        }
    }
    if typed.matches('"').count() % 2 == 1 {
        return Err("The closing quote is missing.".to_owned());
    }
    Ok(bytes)
}

impl Terminal {
    /// What stands in the field means this, or is no line.
    ///
    /// # Errors
    /// A sentence: it is none.
    pub fn meaning(&self) -> Result<String, String> {
        let line = line_of(&self.lines.typed)?;
        Ok(format!("{}: {}", shown(&line), describe_sent(&line).text))
    }

    /// Sends what stands in the field, if it is a line.
    pub fn send(&mut self) -> Option<Command> {
        let bytes = line_of(&self.lines.typed).ok()?;
        let (sent, meaning) = (shown(&bytes), describe_sent(&bytes).text);
        Some(self.lines.send(bytes, (), sent, meaning))
    }

    /// Whether the line in the field starts the program in the board's memory.
    pub fn is_start(&self) -> bool {
        line_of(&self.lines.typed)
            .is_ok_and(|line| Order::of_line(&line[..line.len() - 1]) == Some(Order::Go))
    }

    /// Starts the program in the board's memory, if its risk was accepted.
    pub fn start(&mut self) -> Option<Command> {
        if !std::mem::take(&mut self.accepts_risk) || !self.is_start() {
            return None;
        }
        self.lines.typed.clear();
        Some(Command::Own(Rc::new(StartProgram(RiskAccepted::by_the_user()))))
    }

    /// Takes note of an answer, and of what comes by itself.
    #[allow(clippy::wildcard_enum_match_arm, reason = "no other event has bytes")]
    pub fn note(&mut self, event: &Event) {
        self.lines.note(event, |(), reply| describe_received(reply).text);
        match event {
            Event::RawReply { result: Ok(reply), .. } => {
                self.answered = frames(&mut reply.clone());
                self.tell_unasked();
            }
            Event::RawReply { result: Err(_), .. } => self.tell_unasked(),
            Event::Traffic { traffic, .. } if !traffic.sent => {
                self.begun.extend(&traffic.bytes);
                // A line that never ends is none.
                let surplus = self.begun.len().saturating_sub(MOST_BEGUN);
                self.begun.drain(..surplus);
                self.heard.extend(frames(&mut self.begun));
                self.tell_unasked();
            }
            _ => {}
        }
    }

    /// Tells frames that a program on the board has sent by itself, once it is known that they answer nothing.
    fn tell_unasked(&mut self) {
        if self.lines.is_waiting() {
            return;
        }
        for frame in std::mem::take(&mut self.heard) {
            if let Some(place) = self.answered.iter().position(|answer| *answer == frame) {
                self.answered.remove(place);
                continue;
            }
            self.lines.hear((), shown(&frame), describe_received(&frame).text);
        }
    }

    /// The link is gone.
    pub fn link_ended(&mut self) {
        self.lines.link_ended();
        (self.begun, self.heard, self.answered) = (Vec::new(), Vec::new(), Vec::new());
    }
}

/// Takes the lines that have ended, and keeps those that are frames of a program that is not the host library.
fn frames(bytes: &mut Vec<u8>) -> Vec<Vec<u8>> {
    let end = bytes.iter().rposition(|byte| *byte == LINE_END).map_or(0, |place| place + 1);
    let whole: Vec<u8> = bytes.drain(..end).collect();
    let lines =
        whole.split_inclusive(|byte| *byte == LINE_END).map(|line| line.strip_prefix(b"\n").unwrap_or(line));
    let is_frame = |line: &&[u8]| {
        let inside = &line[..line.len() - 1];
        HostAnswer::parse(inside).is_none() && parse_line_of_board(inside).is_some()
    };
    lines.filter(is_frame).map(<[u8]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_go_out_as_they_are_and_bytes_as_triplets() {
        for (typed, line) in [
            ("G", "G\r"),
            ("I001002003", "I001002003\r"),
            ("1 2, 3", "I001002003\r"),
            ("\"TX\" 5", "I084088005\r"),
            ("255", "I255\r"),
        ] {
            assert_eq!(line_of(typed).unwrap(), line.as_bytes(), "{typed}");
        }
        for (typed, clause) in [
            ("", "Type G"),
            ("256", "0 to 255"),
            ("\"TX", "closing quote"),
            ("1 2 3 4 5 6 7 8 9", "9 bytes"),
            ("1 x", "\"x\" is no byte"),
        ] {
            let why = line_of(typed).unwrap_err();
            assert!(why.contains(clause), "{typed}: {why}");
        }
    }

    #[test]
    fn an_answer_is_told_as_it_came_and_in_words() {
        let mut terminal = Terminal::default();
        "I080001".clone_into(&mut terminal.lines.typed);
        let Some(Command::Raw { id, bytes }) = terminal.send() else { panic!("it is a line") };
        assert_eq!(bytes, b"I080001\r");
        terminal.note(&Event::RawReply { id, result: Ok(b"073082080001002000000000000\r".to_vec()) });
        let answer = terminal.lines.entries[0].answer.clone().unwrap().unwrap();
        assert_eq!(answer.1, "host library, version 2, answer 1");
    }
}
