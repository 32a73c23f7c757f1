//! The terminal: a line of commands or a command of one character, what it means, and what came back in words.

use std::collections::VecDeque;

use brushwork_link::device::Event;
use brushwork_suprmotr_client::{describe_received, describe_sent};
use brushwork_suprmotr_wire::{EXECUTE, Radix, Single};

use crate::command::Command;
use crate::suprmotr::messages::TerminalMessage;

/// Lines kept; the oldest go first.
const KEPT: usize = 500;
/// Answers to the terminal's lines begin with this number.
const FIRST_ID: u64 = 1 << 45;

/// One line with its answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    id: u64,
    bytes: Vec<u8>,
    radix: Radix,
    /// As it was typed.
    pub sent: String,
    /// In words.
    pub meaning: String,
    /// What came back: as it came, and in words; or why nothing was sent.
    pub answer: Option<Result<(String, String), String>>,
}

/// The state of the screen.
#[derive(Debug, Default)]
pub struct Terminal {
    pub typed: String,
    pub entries: VecDeque<Entry>,
    asked: u64,
}

/// What goes out for a text: a character that is a command by itself, or a line with its end.
///
/// # Errors
/// A sentence: it is neither.
pub fn bytes_of(typed: &str) -> Result<Vec<u8>, String> {
    let typed = typed.trim();
    if typed.is_empty() {
        return Err("Type commands, such as TP or MR 500, WS 100, or one of ' ? \\ % # !".to_owned());
    }
    if !typed.bytes().all(|byte| matches!(byte, b' '..=b'~')) {
        return Err("A line has letters, figures and signs of ASCII alone.".to_owned());
    }
    match typed.as_bytes() {
        [single] if Single::from_character(*single).is_some() => Ok(vec![*single]),
        line => Ok([line, &[EXECUTE]].concat()),
    }
}

impl Terminal {
    /// What stands in the field means this, or is no line.
    ///
    /// # Errors
    /// A sentence: it is none.
    pub fn meaning(&self, radix: Radix) -> Result<String, String> {
        Ok(describe_sent(&bytes_of(&self.typed)?, radix).text)
    }

    /// Whether what stands in the field is a line, which ends a macro.
    pub fn is_line(&self) -> bool {
        bytes_of(&self.typed).is_ok_and(|bytes| bytes.last() == Some(&EXECUTE))
    }

    /// Sends what stands in the field, if it is a line.
    pub fn send(&mut self, radix: Radix) -> Option<Command> {
        let bytes = bytes_of(&self.typed).ok()?;
        let sent = std::mem::take(&mut self.typed).trim().to_owned();
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        let meaning = describe_sent(&bytes, radix).text;
        self.entries.push_back(Entry { id, bytes: bytes.clone(), radix, sent, meaning, answer: None });
        Some(Command::Raw { id, bytes })
    }

    /// Takes note of an answer.
    pub fn note(&mut self, event: &Event) {
        let Event::RawReply { id, result } = event else { return };
        let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == *id) else { return };
        entry.answer = Some(match result {
            Ok(reply) if reply.is_empty() => Ok((String::new(), TerminalMessage::Silence.to_string())),
            Ok(reply) => Ok((shown(reply), describe_received(&entry.bytes, reply, entry.radix).text)),
            Err(why) => Err(why.to_string()),
        });
    }

    /// The line was not taken by the link.
    pub fn not_sent(&mut self, id: u64) {
        self.end(|entry| entry.id == id, &TerminalMessage::NotSent);
    }

    /// The link is gone: nothing more is answered.
    pub fn link_ended(&mut self) {
        self.end(|_| true, &TerminalMessage::LinkEnded);
    }

    fn end(&mut self, is_meant: impl Fn(&Entry) -> bool, why: &TerminalMessage) {
        let open = self.entries.iter_mut().filter(|entry| entry.answer.is_none() && is_meant(entry));
        open.for_each(|entry| entry.answer = Some(Err(why.to_string())));
    }
}

/// An answer on one line: its ends are strokes, and the end of a report is not seen.
fn shown(bytes: &[u8]) -> String {
    let text: String = bytes.iter().filter(|byte| **byte != 3).copied().map(char::from).collect();
    text.trim().replace("\r\n", " | ").replace(['\r', '\n'], " | ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_character_goes_out_alone_and_a_line_with_its_end() {
        for (typed, bytes) in
            [(" % ", &b"%"[..]), ("tp", b"tp\r"), ("MR 500, WS", b"MR 500, WS\r"), ("%TP", b"%TP\r")]
        {
            assert_eq!(bytes_of(typed).unwrap(), bytes, "{typed}");
        }
        for typed in ["", "  ", "MA ö", "TP\rTP"] {
            assert!(bytes_of(typed).is_err(), "{typed}");
        }
    }

    #[test]
    fn an_answer_is_told_as_it_came_and_in_words() {
        let mut terminal = Terminal { typed: "TP".to_owned(), ..Terminal::default() };
        let Some(Command::Raw { id, .. }) = terminal.send(Radix::Decimal) else { panic!("it is a line") };
        let reply = b"TP\r0P0:+0000000020\r\n\x03".to_vec();
        terminal.note(&Event::RawReply { id, result: Ok(reply) });
        let (came, words) = terminal.entries[0].answer.clone().unwrap().unwrap();
        assert_eq!(came, "TP | 0P0:+0000000020");
        assert!(words.contains("20"), "{words}");
    }
}
