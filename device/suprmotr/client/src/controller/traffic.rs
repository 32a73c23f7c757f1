//! What bytes on the wire mean, for the traffic view and the terminal.

use brushwork_link::device::Described;
use brushwork_suprmotr_wire::{
    Command, Progress, Radix, Reader, Received, Reports, describe_line, describe_report, describe_single,
    echo_length, parse_line, parse_report,
};
use brushwork_values::hex;

/// Characters as people type them.
fn plain(bytes: &[u8]) -> String {
    let is_text = |byte: &u8| matches!(byte, 0x20..=0x7E | b'\r' | b'\n' | 0x01 | 0x03 | 0x08);
    if !bytes.iter().all(is_text) {
        return hex(bytes);
    }
    let shown = |byte: &u8| match byte {
        b'\r' => "<CR>".to_owned(),
        b'\n' => "<LF>".to_owned(),
        0x01 => "^A".to_owned(),
        0x03 => "<ETX>".to_owned(),
        0x08 => "^H".to_owned(),
        other => char::from(*other).to_string(),
    };
    bytes.iter().map(shown).collect()
}

/// What a write holds, in words, and its last command that reports.
fn read(bytes: &[u8], radix: Radix) -> (Vec<String>, Option<Command>, bool) {
    let mut reader = Reader::new();
    let mut words = Vec::new();
    let mut asked = None;
    let mut sound = true;
    let mut open = false;
    let reports = |command: &Command| command.row().reports != Reports::Nothing;
    for byte in bytes {
        let found = reader.feed(*byte, true);
        open = found.is_none();
        match found {
            None => {}
            Some(Received::Selection(selection)) => words.push(format!("select {selection}")),
            Some(Received::Single(single)) => {
                words.push(describe_single(single));
                asked = single.mnemonic().map(Command::plain).filter(reports).or(asked);
            }
            Some(Received::Repeat) => words.push("repeat the last line".to_owned()),
            Some(Received::Line(line)) => {
                let parsed = parse_line(&line, radix);
                words.push(describe_line(&parsed.line));
                asked = parsed.line.commands.iter().rev().find(|command| reports(command)).copied().or(asked);
                if let Some(error) = parsed.error {
                    words.push(error.to_string());
                    sound = false;
                }
            }
        }
    }
    (words, asked, sound && !open)
}

/// The commands that a write holds, in words.
#[must_use]
pub fn describe_sent(bytes: &[u8], radix: Radix) -> Described {
    let (words, _, sound) = read(bytes, radix);
    let text = if words.is_empty() { plain(bytes) } else { words.join(", ") };
    Described { text, sound: sound && !bytes.is_empty() }
}

/// What came after a write, in words: read as the report to its last command that reports, else as it stands.
#[must_use]
pub fn describe_received(sent: &[u8], reply: &[u8], radix: Radix) -> Described {
    let (_, asked, _) = read(sent, radix);
    let why = match asked.map(|asked| parse_report(&asked, radix, sent, reply)) {
        Some(Progress::Done { report, used }) if used == reply.len() => {
            return Described { text: describe_report(&report), sound: true };
        }
        Some(Progress::Done { .. }) => "a report and more: ".to_owned(),
        Some(Progress::Bad(bad)) => format!("{bad}: "),
        Some(Progress::Incomplete) => "part of a report: ".to_owned(),
        None if echo_length(sent, reply) == reply.len() => {
            return Described { text: format!("echo: {}", plain(reply)), sound: true };
        }
        None => String::new(),
    };
    Described { text: why + &plain(reply), sound: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_over_the_line_is_told_in_words() {
        let sent = b"\x010MR500,WS\r%";
        let told = describe_sent(sent, Radix::Decimal);
        assert_eq!(
            (told.text.as_str(), told.sound),
            ("select unit 0, Move Relative 500 counts, Wait for Stop, Tell Status", true)
        );
        let heard = describe_received(sent, b"0S:80 80 01 00 00 00\r\n\x03", Radix::Decimal);
        assert_eq!(heard.text, "unit 0: status: Addressed, Trajectory complete, Limits on");
        assert!(heard.sound && !describe_received(sent, b"0S:80", Radix::Decimal).sound);
        assert_eq!(describe_sent(b"\r", Radix::Decimal).text, "repeat the last line");
        assert_eq!(describe_received(b"MF\r", b"MF\r", Radix::Decimal).text, "echo: MF<CR>");
        assert!(!describe_sent(b"XX\r", Radix::Decimal).sound);
    }
}
