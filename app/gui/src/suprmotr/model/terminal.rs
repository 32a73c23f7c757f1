//! The terminal: a line of commands or a command of one character, what it means, and what came back in words.

use brushwork_link::device::Event;
use brushwork_suprmotr_client::{describe_received, describe_sent};
use brushwork_suprmotr_wire::{EXECUTE, Radix, Single};

use crate::command::Command;
use crate::model::raw_lines::RawLines;

/// Answers to the terminal's lines begin with this number.
const FIRST_ID: u64 = 1 << 45;

/// The state of the screen: each line with its bytes and with how the board writes its numbers, which its answer is read by.
#[derive(Debug)]
pub struct Terminal(pub RawLines<(Vec<u8>, Radix)>);

impl Default for Terminal {
    fn default() -> Self {
        Self(RawLines::from_id(FIRST_ID))
    }
}

/// What goes out for a text: a character that is a command by itself, or a line with its end.
///
/// # Errors
/// A sentence: it is neither.
pub fn bytes_of(typed: &str) -> Result<Vec<u8>, String> {
    let typed = typed.trim();
    if typed.is_empty() {
        return Err("Type commands, such as TP or DV 20000, GV, or one of ' ? \\ % # !".to_owned());
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
        Ok(describe_sent(&bytes_of(&self.0.typed)?, radix).text)
    }

    /// Whether what stands in the field is a line, which ends a macro.
    pub fn is_line(&self) -> bool {
        bytes_of(&self.0.typed).is_ok_and(|bytes| bytes.last() == Some(&EXECUTE))
    }

    /// Sends what stands in the field, if it is a line.
    pub fn send(&mut self, radix: Radix) -> Option<Command> {
        let bytes = bytes_of(&self.0.typed).ok()?;
        let (sent, meaning) = (self.0.typed.trim().to_owned(), describe_sent(&bytes, radix).text);
        Some(self.0.send(bytes.clone(), (bytes, radix), sent, meaning))
    }

    /// Takes note of an answer.
    pub fn note(&mut self, event: &Event) {
        self.0.note(event, |(sent, radix), reply| describe_received(sent, reply, *radix).text);
    }
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
        let mut terminal = Terminal::default();
        "TP".clone_into(&mut terminal.0.typed);
        let Some(Command::Raw { id, .. }) = terminal.send(Radix::Decimal) else { panic!("it is a line") };
        let reply = b"TP\r0P0:+0000000020\r\n\x03".to_vec();
        terminal.note(&Event::RawReply { id, result: Ok(reply) });
        let (came, words) = terminal.0.entries[0].answer.clone().unwrap().unwrap();
        assert_eq!(came, "TP | 0P0:+0000000020");
        assert!(words.contains("20"), "{words}");
    }
}
