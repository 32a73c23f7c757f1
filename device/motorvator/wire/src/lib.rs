//! The serial line of the MotorVator V3 (MotorVator manual, Receive and Transmit): data travels as "Ascii triplets", three decimal digits for a
//! byte, beside the letters that the board's command line takes.
//!
//! The two directions differ. The board sends `073`, the number of the letter I, eight triplets and a carriage return, so that another board's
//! command line ignores it. A host sends the letter `I`, one to eight triplets and a carriage return; what is missing is 0. Two of the
//! manual's three worked examples are wrong: "TX123456" has 27 digits that spell TX012345, and `I003` is shown with 23 of them.

#![doc = include_str!("../README.md")]
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod host;
pub mod reference;

use std::fmt::Write as _;

/// Bytes of a frame.
pub const FRAME_BYTES: usize = 8;
/// What ends a line.
pub const LINE_END: u8 = b'\r';
/// What a frame of the board begins with: the triplet of the letter I.
pub const PREFIX: &str = "073";
/// Bits per second. Assumed: no page gives the rate.
pub const BITS_PER_SECOND: u32 = 9600;
/// Bytes of a line that the board keeps; more are lost. Assumed: a frame takes 26.
pub const LINE_BYTES: usize = 64;

/// A frame.
pub type Frame = [u8; FRAME_BYTES];

/// The line that the board sends for a frame, its end included.
#[must_use]
pub fn line_of_board(frame: &Frame) -> Vec<u8> {
    let mut line = PREFIX.to_owned();
    push_triplets(&mut line, frame);
    line.push(char::from(LINE_END));
    line.into_bytes()
}

/// The line that a host sends for one to eight bytes, its end included; more are left out.
#[must_use]
pub fn line_of_host(bytes: &[u8]) -> Vec<u8> {
    let mut line = "I".to_owned();
    push_triplets(&mut line, &bytes[..bytes.len().min(FRAME_BYTES)]);
    line.push(char::from(LINE_END));
    line.into_bytes()
}

fn push_triplets(line: &mut String, bytes: &[u8]) {
    for byte in bytes {
        let _ = write!(line, "{byte:03}");
    }
}

/// The bytes of triplets, of which there are one to eight; those beyond are left out.
fn triplets(digits: &[u8]) -> Option<Vec<u8>> {
    if digits.is_empty() || !digits.len().is_multiple_of(3) || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let byte = |digits: &[u8]| {
        let value = digits.iter().fold(0u16, |value, digit| value * 10 + u16::from(digit - b'0'));
        u8::try_from(value).ok()
    };
    digits.chunks(3).take(FRAME_BYTES).map(byte).collect()
}

/// The bytes of a line that a board sent, without its end. Boards send eight; one to eight are taken.
#[must_use]
pub fn parse_line_of_board(line: &[u8]) -> Option<Vec<u8>> {
    triplets(line.strip_prefix(PREFIX.as_bytes())?)
}

/// What a line is to the board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// `I` and triplets: data for the program.
    Data(Frame),
    /// `G`: the program begins.
    Go,
    /// `H`: the version, and what the command line takes.
    Help,
    /// A frame of another board, which it ignores.
    Ignored,
    /// Anything else, and data that makes no frame: dropped without a word to the program. Assumed: a value beyond 255, a group of one or two
    /// digits, or another character.
    Unknown,
}

impl Order {
    /// What a line without its end asks for. Letters are taken in either case (assumed), as a person types them.
    #[must_use]
    pub fn of_line(line: &[u8]) -> Option<Self> {
        let (first, rest) = line.split_first()?;
        Some(match (first.to_ascii_uppercase(), rest) {
            (b'I', digits) => match triplets(digits) {
                Some(bytes) => {
                    let mut frame = [0; FRAME_BYTES];
                    frame[..bytes.len()].copy_from_slice(&bytes);
                    Self::Data(frame)
                }
                None => Self::Unknown,
            },
            (b'G', []) => Self::Go,
            (b'H', []) => Self::Help,
            _ if line.starts_with(PREFIX.as_bytes()) => Self::Ignored,
            _ => Self::Unknown,
        })
    }

    /// What it is, in a sentence of a trace.
    #[must_use]
    pub fn describe(&self) -> String {
        match self {
            Self::Data(frame) => format!("data for the program: {}", bytes_text(frame)),
            Self::Go => "start the program".to_owned(),
            Self::Help => "version and help".to_owned(),
            Self::Ignored => "a frame of a board, which the command line ignores".to_owned(),
            Self::Unknown => "nothing that the command line takes".to_owned(),
        }
    }
}

/// Bytes as numbers, and as characters where all of them are.
#[must_use]
pub fn bytes_text(bytes: &[u8]) -> String {
    let numbers: Vec<String> = bytes.iter().map(u8::to_string).collect();
    let letters = bytes.iter().all(|byte| byte.is_ascii_graphic() || *byte == b' ');
    let text = if letters && !bytes.is_empty() {
        format!(" (\"{}\")", String::from_utf8_lossy(bytes))
    } else {
        String::new()
    };
    numbers.join(" ") + &text
}

/// Lines out of bytes as they come. A line feed is no part of a line; one that is too long loses its end.
#[derive(Clone, Debug, Default)]
pub struct LineReader {
    line: Vec<u8>,
    is_too_long: bool,
}

impl LineReader {
    /// Takes a byte; the line that it ends, if it ends one. A line that was too long is given as one that means nothing.
    pub fn take(&mut self, byte: u8) -> Option<Vec<u8>> {
        match byte {
            LINE_END => {
                let line = std::mem::take(&mut self.line);
                Some(if std::mem::take(&mut self.is_too_long) { b"?".to_vec() } else { line })
            }
            b'\n' => None,
            _ if self.line.len() >= LINE_BYTES => {
                self.is_too_long = true;
                None
            }
            byte => {
                self.line.push(byte);
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sent(frame: &Frame) -> String {
        String::from_utf8(line_of_board(frame)).unwrap()
    }

    #[test]
    fn the_manuals_examples_with_their_two_mistakes_corrected() {
        assert_eq!(sent(b"TX123456"), "073084088049050051052053054\r");
        assert_eq!(sent(&[3, 0, 0, 0, 0, 0, 0, 0]), "073003000000000000000000000\r");
        assert_eq!(sent(b"TX \x15RX \x01"), "073084088032021082088032001\r");
        assert_eq!(Order::of_line(b"I001002003"), Some(Order::Data([1, 2, 3, 0, 0, 0, 0, 0])));
        assert_eq!(Order::of_line(b"I048"), Some(Order::Data([0x30, 0, 0, 0, 0, 0, 0, 0])));
        assert_eq!(line_of_host(&[1, 2, 3]), b"I001002003\r");
    }

    #[test]
    fn what_makes_no_frame_is_dropped_and_more_than_eight_triplets_are_cut() {
        for line in ["I", "I01", "I0010", "I256", "I00a", "I 01", "X", "G1", "0", "I001 002"] {
            assert_eq!(Order::of_line(line.as_bytes()), Some(Order::Unknown), "{line}");
        }
        assert_eq!(Order::of_line(b""), None);
        assert_eq!(
            Order::of_line(b"I001002003004005006007008009"),
            Some(Order::Data([1, 2, 3, 4, 5, 6, 7, 8]))
        );
        assert_eq!(Order::of_line(b"073001"), Some(Order::Ignored));
        assert_eq!((Order::of_line(b"g"), Order::of_line(b"H")), (Some(Order::Go), Some(Order::Help)));
    }

    #[test]
    fn a_host_takes_one_to_eight_triplets_behind_the_prefix() {
        assert_eq!(parse_line_of_board(b"073001"), Some(vec![1]));
        assert_eq!(parse_line_of_board(b"073"), None);
        assert_eq!(parse_line_of_board(b"074001"), None);
    }

    #[test]
    fn lines_end_with_a_carriage_return_and_have_a_longest() {
        let mut reader = LineReader::default();
        let mut read = |text: &[u8]| text.iter().filter_map(|byte| reader.take(*byte)).collect::<Vec<_>>();
        assert_eq!(read(b"G\r\nI0"), [b"G".to_vec()]);
        assert_eq!(read(b"01\r"), [b"I001".to_vec()]);
        assert_eq!(read(&[b"0".repeat(65), b"\rH\r".to_vec()].concat()), [b"?".to_vec(), b"H".to_vec()]);
    }

    proptest! {
        #[test]
        fn frames_come_back(bytes in proptest::collection::vec(any::<u8>(), 1..=8)) {
            let mut frame = [0; FRAME_BYTES];
            frame[..bytes.len()].copy_from_slice(&bytes);
            let line = line_of_host(&bytes);
            prop_assert_eq!(Order::of_line(&line[..line.len() - 1]), Some(Order::Data(frame)));
            let line = line_of_board(&frame);
            prop_assert_eq!(line.len(), 28);
            prop_assert_eq!(parse_line_of_board(&line[..27]), Some(frame.to_vec()));
        }

        #[test]
        fn any_line_is_answered(line in proptest::collection::vec(any::<u8>(), 0..100)) {
            let _ = (Order::of_line(&line), parse_line_of_board(&line));
        }
    }
}
