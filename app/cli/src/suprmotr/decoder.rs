//! SuprMotr traffic of both directions in words. No clock, no IO: bytes and times in, records out.
//!
//! A client selects a unit and goes on with it, so that a report is of the unit that was selected last. Numbers are decimal until a status says
//! otherwise.

use std::collections::VecDeque;
use std::time::Duration;

use brushwork_suprmotr_wire::{
    Command, END_OF_REPORT, Progress, Radix, Reader, Received, Reports, Selection, Single, describe_line,
    describe_report, describe_single, echo_length, operation, parse_line, parse_report,
};

use crate::monitor::awaited::{Awaited, take};
use crate::monitor::follower::{Follower, Stop};
use crate::monitor::record::{Direction, Record};

/// A unit that has not answered after this time will not.
const REPLY_LIMIT: Duration = Duration::from_millis(1500);
/// An answer that stops for so long is over.
const REPLY_GAP: Duration = Duration::from_millis(100);

/// Follows a conversation.
#[derive(Default)]
pub struct Decoder {
    reader: Reader,
    /// What the client has sent since its last command, and since when.
    open: Vec<u8>,
    open_since: Duration,
    /// All that it sent since the last selection: the echo of it may stand in front of a report.
    sent: Vec<u8>,
    /// Commands whose reports are due, oldest first.
    awaited: VecDeque<Awaited<Asked>>,
    radix: Radix,
    selected: Option<Selection>,
    /// Whether something was told to move and not to stop since.
    is_moving: bool,
}

/// A command whose report is due, with what was sent for it.
struct Asked {
    command: Command,
    sent: Vec<u8>,
    selected: Option<Selection>,
}

impl Decoder {
    fn close(&mut self, text: String) -> Record {
        Record::new(self.open_since, Direction::ToController, std::mem::take(&mut self.open), text)
    }

    fn wait_for(&mut self, commands: &[Command], now: Duration) {
        for command in commands.iter().filter(|command| command.row().reports != Reports::Nothing) {
            // The line is echoed before its first report alone.
            let sent = std::mem::take(&mut self.sent);
            let asked = Asked { command: *command, sent, selected: self.selected };
            self.awaited.push_back(Awaited::new(asked, now));
        }
    }

    fn take_single(&mut self, single: Single, now: Duration) -> Record {
        if single == Single::Abort {
            self.is_moving = false;
        }
        let command = single.mnemonic().map(Command::plain);
        self.wait_for(command.as_slice(), now);
        self.close(describe_single(single))
    }

    fn take_line(&mut self, text: &[u8], now: Duration) -> Record {
        let parsed = parse_line(text, self.radix);
        let mut words = describe_line(&parsed.line);
        if let Some(error) = parsed.error {
            words = if words.is_empty() { error.to_string() } else { format!("{words}, {error}") };
        }
        if parsed.line.defines.is_none() {
            let commands = &parsed.line.commands;
            self.is_moving |= commands.iter().any(|command| command.row().effect.may_move());
            self.wait_for(commands, now);
        }
        self.close(words)
    }

    /// The report to the oldest command if it is whole, and the bytes that came after it.
    fn whole_report(&mut self) -> Option<(Record, Vec<u8>)> {
        let awaited = self.awaited.front()?;
        let end = awaited.bytes.iter().position(|byte| *byte == END_OF_REPORT)? + 1;
        let Asked { command, sent, .. } = &awaited.request;
        let (text, status) = match parse_report(command, self.radix, sent, &awaited.bytes) {
            Progress::Done { report, .. } => (describe_report(&report), report.status()),
            Progress::Bad(why) => (format!("bad report ({why})"), None),
            Progress::Incomplete => return None,
        };
        if let Some(status) = status {
            let is_hexadecimal = status.operation & operation::HEXADECIMAL != 0;
            self.radix = if is_hexadecimal { Radix::Hexadecimal } else { Radix::Decimal };
        }
        let Awaited { mut bytes, first_at, .. } = self.awaited.pop_front()?;
        let rest = bytes.split_off(end);
        Some((Record::new(first_at, Direction::FromController, bytes, text), rest))
    }

    fn give_up(&mut self) -> Option<Record> {
        let awaited = self.awaited.pop_front()?;
        let Asked { command, sent, selected } = &awaited.request;
        let what = match awaited.bytes.len() {
            0 => "no answer",
            count if count == echo_length(sent, &awaited.bytes) => "nothing but the echo",
            _ => "a report cut short",
        };
        let who = selected.map_or_else(|| "whoever is selected".to_owned(), |selected| selected.to_string());
        let text = format!("{who}: {what} to {}", command.mnemonic.name());
        Some(Record::new(awaited.first_at, Direction::FromController, awaited.bytes, text))
    }
}

impl Follower for Decoder {
    fn client_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        for byte in bytes {
            if self.open.is_empty() {
                self.open_since = now;
            }
            self.open.push(*byte);
            self.sent.push(*byte);
            match self.reader.feed(*byte, true) {
                None => {}
                Some(Received::Selection(selection)) => {
                    self.selected = Some(selection);
                    self.sent = self.open.clone();
                    records.push(self.close(format!("select {selection}")));
                }
                Some(Received::Single(single)) => records.push(self.take_single(single, now)),
                Some(Received::Line(text)) => records.push(self.take_line(&text, now)),
                Some(Received::Repeat) => {
                    records.push(
                        self.close("the last line once more: whatever it was is done again".to_owned()),
                    );
                }
            }
        }
        records
    }

    fn controller_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        let is_echo = self.awaited.is_empty() && self.sent.ends_with(bytes) && !bytes.is_empty();
        if is_echo {
            let text = "echo".to_owned();
            return vec![Record::new(now, Direction::FromController, bytes.to_vec(), text)];
        }
        if let Some(unasked) = take(&mut self.awaited, bytes, now) {
            return vec![unasked];
        }
        let mut records = Vec::new();
        if let Some((record, rest)) = self.whole_report() {
            records.push(record);
            if !rest.is_empty() {
                records.extend(self.controller_sent(&rest, now));
            }
        }
        records
    }

    fn awaits_reply(&self) -> bool {
        !self.awaited.is_empty()
    }

    fn may_become_whole(&self) -> bool {
        !self.open.is_empty()
    }

    fn silence(&mut self, now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        while self.awaited.front().is_some_and(|due| due.is_over(now, REPLY_LIMIT, REPLY_GAP)) {
            records.extend(self.give_up());
        }
        records
    }

    /// A line has no limit of time.
    fn client_silence(&mut self, _now: Duration) -> Vec<Record> {
        Vec::new()
    }

    fn client_left(&mut self, now: Duration) -> Vec<Record> {
        let mut records = Vec::new();
        if !self.open.is_empty() {
            records.push(self.close("no command: a line without its end".to_owned()));
        }
        records.extend(std::iter::from_fn(|| self.give_up()));
        self.reader = Reader::new();
        records.iter_mut().for_each(|record| record.at = record.at.map(|at| at.min(now)));
        records
    }

    /// The character that all units hear, on both sides of the end of macros.
    fn stops(&self) -> Vec<Stop> {
        if !self.is_moving {
            return Vec::new();
        }
        let abort = Single::Abort.character();
        let [select, all] = Selection::All.bytes();
        vec![Stop {
            who: "the motors of all units".to_owned(),
            writes: vec![vec![abort, select, all, Single::EndMacro.character(), abort]],
            acknowledge: &[],
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn texts(records: Vec<Record>) -> Vec<String> {
        records.into_iter().map(|record| record.text).collect()
    }

    #[test]
    fn a_conversation_with_echo_is_told_in_words() {
        let mut decoder = Decoder::default();
        let sent = decoder.client_sent(b"\x015'", ms(0));
        assert_eq!(texts(sent), ["select unit 5", "Tell Position"]);
        assert_eq!(texts(decoder.controller_sent(b"'5P0:+00000", ms(5))), Vec::<String>::new());
        let heard = decoder.controller_sent(b"20002\r\n\x03", ms(9));
        assert_eq!(texts(heard), ["unit 5: Tell Position 20002"]);
        let line = decoder.client_sent(b"MR500,WS\r", ms(20));
        assert_eq!(texts(line), ["Move Relative 500 counts, Wait for Stop"]);
        assert_eq!(texts(decoder.controller_sent(b"MR500,WS\r", ms(22))), ["echo"]);
        assert_eq!(decoder.stops()[0].writes, [b"!\x01V\x08!".to_vec()]);
        assert_eq!(texts(decoder.client_sent(b"!", ms(30))), ["stop all units"]);
        assert!(decoder.stops().is_empty());
    }

    #[test]
    fn several_reports_to_one_line_and_none_are_told() {
        let mut decoder = Decoder::default();
        decoder.client_sent(b"\x010TP,TT\r", ms(0));
        let heard = decoder.controller_sent(b"0P0:+0000000001\r\n\x030T0:+0000000002\r\n\x03", ms(4));
        assert_eq!(texts(heard), ["unit 0: Tell Position 1", "unit 0: Tell Target 2"]);
        decoder.client_sent(b"%", ms(10));
        assert_eq!(texts(decoder.silence(ms(2000))), ["unit 0: no answer to TS"]);
        assert_eq!(
            texts(decoder.client_sent(b"\r", ms(2100))),
            ["the last line once more: whatever it was is done again"]
        );
        assert_eq!(texts(decoder.controller_sent(b"0X", ms(2200))), ["answer to nothing"]);
    }

    #[test]
    fn a_status_tells_how_numbers_are_written() {
        let mut decoder = Decoder::default();
        decoder.client_sent(b"\x010%", ms(0));
        decoder.controller_sent(b"0S:C0 80 01 00 00 00\r\n\x03", ms(4));
        assert_eq!(texts(decoder.client_sent(b"MA4E20\r", ms(10))), ["Move Absolute 20000 counts"]);
    }
}
