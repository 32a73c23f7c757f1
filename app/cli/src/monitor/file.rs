//! Decoding requests from a file of hexadecimal bytes.
//!
//! The end of a line is a pause, unless a packet that may still become whole is open there; an empty line always is one. So
//! both one packet a line and the lines of a hex dump are understood.

use crate::messages::CliMonitorMessage;
use std::path::Path;
use std::time::Duration;

use super::args::MonitorArgs;
use super::chosen::follower;
use super::follower::Follower;
use super::record::{Direction, Record, print};
use crate::{Exit, Output};
use brushwork_link::bounded;

/// Prints what the requests in the file mean.
pub fn run(args: &MonitorArgs, path: &Path, out: &mut Output) -> Result<(), Exit> {
    let name = if is_standard_input(path) { "standard input".into() } else { path.display().to_string() };
    let failed = |sentence: String| {
        Exit::Failed.saying(CliMonitorMessage::NotDecoded { name: name.to_string(), sentence })
    };
    let text = read(path).map_err(|error| failed(error.to_string()))?;
    let lines = parse(&text).map_err(|error| failed(error.to_string()))?;
    let mut decoder = follower(args)?;
    for record in decode(decoder.as_mut(), &lines) {
        print(args.json, &record, out)?;
    }
    Ok(())
}

/// What the requests in a text of bytes mean, a sentence each.
///
/// # Errors
/// Something is no byte; a clause names it with its place.
pub fn meanings(text: &str, decoder: &mut dyn Follower) -> Result<Vec<String>, String> {
    let lines = parse(text).map_err(|error| error.to_string())?;
    Ok(decode(decoder, &lines).into_iter().map(|record| record.text).collect())
}

fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

fn read(path: &Path) -> std::io::Result<String> {
    if !is_standard_input(path) {
        return bounded::read_text(path);
    }
    bounded::text(bounded::read(std::io::stdin().lock(), bounded::MOST_BYTES)?)
}

/// What is wrong with a file of hexadecimal bytes, and where.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: \"{found}\" {what}")]
struct HexError {
    line: usize,
    column: usize,
    found: String,
    what: &'static str,
}

/// The bytes of each line.
fn parse(text: &str) -> Result<Vec<Vec<u8>>, HexError> {
    text.lines().enumerate().map(|(index, line)| parse_line(line, index + 1)).collect()
}

fn parse_line(text: &str, line: usize) -> Result<Vec<u8>, HexError> {
    let content = text.split('#').next().unwrap_or_default();
    let mut bytes = Vec::new();
    let mut column = 1;
    for token in content.split(|c: char| c.is_whitespace() || c == ',') {
        let digits = token.strip_prefix("0x").or_else(|| token.strip_prefix("0X")).unwrap_or(token);
        let start = column + token.len() - digits.len();
        take_token(digits, &mut bytes).map_err(|(at, found, what)| HexError {
            line,
            column: start + at,
            found,
            what,
        })?;
        column += token.chars().count() + 1;
    }
    Ok(bytes)
}

/// Digits in pairs, or a single one. An error says at which digit, what stands there, and what is wrong.
fn take_token(digits: &str, bytes: &mut Vec<u8>) -> Result<(), (usize, String, &'static str)> {
    let mut nibbles = Vec::new();
    for (at, digit) in digits.chars().enumerate() {
        let value = digit.to_digit(16).ok_or((at, digit.to_string(), "is no hexadecimal digit"))?;
        nibbles.push(value as u8);
    }
    if nibbles.len() > 1 && nibbles.len() % 2 == 1 {
        return Err((0, start_of(digits), "has an odd number of digits: write two for each byte"));
    }
    bytes.extend(nibbles.chunks(2).map(|pair| pair.iter().fold(0, |byte, nibble| byte << 4 | nibble)));
    Ok(())
}

/// A token as an error names it: one that fills a line is not repeated whole.
fn start_of(digits: &str) -> String {
    const MOST: usize = 40;
    if digits.len() <= MOST { digits.to_owned() } else { digits.chars().take(MOST).chain(['…']).collect() }
}

fn decode(decoder: &mut dyn Follower, lines: &[Vec<u8>]) -> Vec<Record> {
    const PAUSE: Duration = Duration::from_secs(1);
    let mut now = Duration::ZERO;
    let mut records = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        records.extend(decoder.client_sent(line, now));
        if line.is_empty() || index + 1 == lines.len() || !decoder.may_become_whole() {
            now += PAUSE;
            records.extend(decoder.client_silence(now));
        }
    }
    // A file holds requests alone, so that an answer is missed nowhere.
    let requests = records.into_iter().filter(|record| record.direction == Direction::ToController);
    requests.map(|record| Record { at: None, ..record }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(text: &str) -> Vec<String> {
        meanings(text, &mut crate::mcp::decoder::Decoder::new(None)).unwrap()
    }

    fn error(text: &str) -> String {
        parse(text).unwrap_err().to_string()
    }

    #[test]
    fn every_way_to_write_a_byte_is_read() {
        let bytes = [0x80, 0x15, 0x0A, 5];
        for text in
            ["80 15 0A 5", "0x80,0x15,0x0a,0x5", "8015 0a\t05 # a comment", "80150A05", "0X80, 15, 0A,5"]
        {
            assert_eq!(parse(text).unwrap().concat(), bytes, "{text}");
        }
    }

    #[test]
    fn a_bad_digit_is_named_with_its_line_and_column() {
        assert_eq!(error("80 15\n80 1G"), "line 2, column 5: \"G\" is no hexadecimal digit");
        assert_eq!(error("0x8Z"), "line 1, column 4: \"Z\" is no hexadecimal digit");
        assert_eq!(error("80, é"), "line 1, column 5: \"é\" is no hexadecimal digit");
        assert!(error("80 801").starts_with("line 1, column 4: \"801\" has an odd number of digits"));
    }

    #[test]
    fn a_packet_may_go_over_lines_and_a_bad_one_costs_only_its_own() {
        // 0x80, command 28 with D 0.25, P 1, I 0.5, QPPS 44000 and its CRC, over three lines.
        let crc = brushwork_mcp_wire::crc::crc16_xmodem(&[
            0x80, 28, 0, 0, 0x40, 0, 0, 1, 0, 0, 0, 0, 0x80, 0, 0, 0, 0xAB, 0xE0,
        ]);
        let text =
            format!("80 1C 00 00 40 00\n00 01 00 00 00 00 80 00\n00 00 AB E0 {crc:04X}\n80 AA 01\n80 18");
        let reported = reported(&text);
        assert_eq!(reported[0], "0x80 M1 velocity PID: P 1.0, I 0.5, D 0.25, QPPS 44000");
        assert!(reported[1].contains("unknown command"), "{reported:?}");
        assert_eq!(reported[2], "0x80 read main battery");
    }

    #[test]
    fn an_empty_line_ends_a_packet_that_stopped_half_way() {
        let reported = reported("80 20 12\n\n80 18");
        assert!(reported[0].contains("stopped half way"), "{reported:?}");
        assert_eq!(reported[1], "0x80 read main battery");
    }
}
