//! Lines that are typed for a controller: what went out, what it means, and what came back as it came and in words.

use std::collections::VecDeque;

use brushwork_link::device::Event;

use super::messages::RawLineMessage;
use crate::command::Command;

/// Lines kept; the oldest go first.
const KEPT: usize = 500;

/// One line with its answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawLine<K> {
    id: u64,
    /// What its answer is read by.
    kept: K,
    /// As it was typed or went out.
    pub sent: String,
    /// In words.
    pub meaning: String,
    /// What came back: as it came, and in words; or why nothing was sent.
    pub answer: Option<Result<(String, String), String>>,
}

/// What stands in the field, and the lines so far.
#[derive(Debug)]
pub struct RawLines<K> {
    pub typed: String,
    pub entries: VecDeque<RawLine<K>>,
    next_id: u64,
}

impl<K> RawLines<K> {
    /// None yet; answers have this number and those behind it.
    pub fn from_id(first_id: u64) -> Self {
        Self { typed: String::new(), entries: VecDeque::new(), next_id: first_id }
    }

    /// Sends bytes, for which the field is emptied.
    pub fn send(&mut self, bytes: Vec<u8>, kept: K, sent: String, meaning: String) -> Command {
        self.typed.clear();
        let id = self.next_id;
        self.next_id += 1;
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(RawLine { id, kept, sent, meaning, answer: None });
        Command::Raw { id, bytes }
    }

    /// Whether a line waits for its answer.
    pub fn is_waiting(&self) -> bool {
        self.entries.iter().any(|entry| entry.answer.is_none())
    }

    /// Adds what came in without being asked for, as it came and in words.
    pub fn hear(&mut self, kept: K, received: String, words: String) {
        let id = self.next_id;
        self.next_id += 1;
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        let answer = Some(Ok((received, words)));
        self.entries.push_back(RawLine { id, kept, sent: String::new(), meaning: String::new(), answer });
    }

    /// Takes note of an answer, in words that `in_words` has for it.
    pub fn note(&mut self, event: &Event, in_words: impl FnOnce(&K, &[u8]) -> String) {
        let Event::RawReply { id, result } = event else { return };
        let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == *id) else { return };
        entry.answer = Some(match result {
            Ok(reply) if reply.is_empty() => Ok((String::new(), RawLineMessage::Silence.to_string())),
            Ok(reply) => Ok((shown(reply), in_words(&entry.kept, reply))),
            Err(why) => Err(why.to_string()),
        });
    }

    /// The line was not taken by the link.
    pub fn not_sent(&mut self, id: u64) {
        self.end(|entry| entry.id == id, &RawLineMessage::NotSent);
    }

    /// The link is gone: nothing more is answered.
    pub fn link_ended(&mut self) {
        self.end(|_| true, &RawLineMessage::LinkEnded);
    }

    fn end(&mut self, is_meant: impl Fn(&RawLine<K>) -> bool, why: &RawLineMessage) {
        let open = self.entries.iter_mut().filter(|entry| entry.answer.is_none() && is_meant(entry));
        open.for_each(|entry| entry.answer = Some(Err(why.to_string())));
    }
}

/// Bytes of text on one line: line ends are strokes, and a mark that ends a text is not seen.
pub fn shown(bytes: &[u8]) -> String {
    const END_OF_TEXT: u8 = 3;
    let is_seen = |byte: &u8| *byte != END_OF_TEXT;
    let text: String = bytes.iter().copied().filter(is_seen).map(char::from).collect();
    text.trim().replace("\r\n", " | ").replace(['\r', '\n'], " | ")
}
