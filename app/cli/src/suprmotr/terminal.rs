//! Commands of a SuprMotr as they are typed in a terminal: one line, whose carriage return is added, or commands of one character.

use brushwork_link::device::Described;
use brushwork_suprmotr_client::{SuprMotrFacts, describe_received, describe_sent};
use brushwork_suprmotr_wire::{EXECUTE, Effect, Reader, Received, Single, parse_line};

use crate::family::Terminal;

/// What is typed for a unit that was set up so when it was found.
pub struct Typed(pub SuprMotrFacts);

impl Terminal for Typed {
    fn set_up(&self) -> String {
        let echo = if self.0.has_echo() { "on" } else { "off" };
        format!("a line of commands, or one of ' ? \\ % # !, echo {echo}")
    }

    fn bytes_of(&self, line: &str) -> Result<Vec<u8>, String> {
        Ok(bytes_of(line))
    }

    fn stops_the_motor(&self, bytes: &[u8]) -> bool {
        let mut reader = Reader::new();
        let found: Vec<_> = bytes.iter().filter_map(|byte| reader.feed(*byte, true)).collect();
        found.iter().any(|found| match found {
            Received::Single(single) => matches!(single, Single::Abort | Single::EndMacro),
            Received::Line(line) => {
                let commands = parse_line(line, self.0.radix()).line.commands;
                commands.iter().any(|command| command.row().effect == Effect::Stop)
            }
            Received::Selection(_) | Received::Repeat => false,
        })
    }

    fn shown(&self, bytes: &[u8]) -> String {
        let text: String = bytes.iter().copied().filter(|byte| *byte != 0x03).map(char::from).collect();
        text.trim_end().replace("\r\n", " | ").replace('\r', " | ").replace('\u{8}', "^H")
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes, self.0.radix())
    }

    fn describe_received(&self, sent: &[u8], reply: &[u8]) -> Described {
        describe_received(sent, reply, self.0.radix())
    }
}

/// What is typed, with its carriage return where it is a line.
fn bytes_of(line: &str) -> Vec<u8> {
    let mut bytes = line.trim().as_bytes().to_vec();
    let is_single = |byte: &u8| Single::from_character(*byte).is_some();
    if !bytes.iter().all(is_single) {
        bytes.push(EXECUTE);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_gets_its_end_and_characters_need_none() {
        assert_eq!(bytes_of(" tp,tt "), b"tp,tt\r");
        assert_eq!(bytes_of("'%"), b"'%");
        assert_eq!(bytes_of("MA5'"), b"MA5'\r");
    }

    #[test]
    fn what_ends_a_move_is_known() {
        let typed = Typed(SuprMotrFacts { status: brushwork_suprmotr_wire::Status::default() });
        assert!(
            typed.stops_the_motor(b"!")
                && typed.stops_the_motor(b"MF\r")
                && typed.stops_the_motor(b"TP,ab1\r")
        );
        assert!(!typed.stops_the_motor(b"TP\r'"));
        assert_eq!(typed.shown(b"TP\r0P0:+0000000001\r\n\x03"), "TP | 0P0:+0000000001");
    }
}
