//! Adapters that put CAN frames on a serial port, in the two forms that GridConnect's have.
//!
//! ASCII (CAN USB-232 manual): `:S601N4018100000000000;`: `S` and up to three hexadecimal digits or `X` and up to eight, `N` for data
//! or `R` for a request, the data, a semicolon. A digit after `R` is read as the length that is asked for.
//!
//! Binary (public clients, 2015-2020): FF 00, flags (bit 6 request, low nibble length), identifier high, low, data; any later FF
//! is followed by 01. It has no extended identifiers. Neither form has a checksum.

use super::{CanId, Frame};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// How an adapter writes frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// GridConnect ASCII.
    #[default]
    Ascii,
    /// The binary form of the adapter in the vendor's class library.
    Binary,
}

impl Form {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Ascii, Self::Binary];

    /// Name in command lines: "ascii", "binary".
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Ascii => "ascii",
            Self::Binary => "binary",
        }
    }

    /// The form of that name.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.key().eq_ignore_ascii_case(key))
    }

    /// A frame as bytes. The binary form has none for an extended identifier.
    #[must_use]
    pub fn encode(self, frame: &Frame) -> Option<Vec<u8>> {
        match self {
            Self::Ascii => Some(ascii(frame)),
            Self::Binary => binary(frame),
        }
    }
}

/// Highest number of bytes that a frame takes: `:X1FFFFFFFN` and sixteen digits and `;`.
pub const LONGEST: usize = 28;

const MARK: u8 = 0xFF;
const START: u8 = 0x00;
const ESCAPED: u8 = 0x01;
const REMOTE_FLAG: u8 = 0x40;
const LENGTH_MASK: u8 = 0x0F;

fn ascii(frame: &Frame) -> Vec<u8> {
    let mut text = String::with_capacity(LONGEST);
    // Writing to a string cannot fail.
    let _ = match frame.id() {
        CanId::Standard(id) => write!(text, ":S{id:03X}"),
        CanId::Extended(id) => write!(text, ":X{id:08X}"),
    };
    if frame.is_remote() {
        let _ = write!(text, "R{}", frame.length());
    } else {
        text.push('N');
        for byte in frame.bytes() {
            let _ = write!(text, "{byte:02X}");
        }
    }
    text.push(';');
    text.into_bytes()
}

fn binary(frame: &Frame) -> Option<Vec<u8>> {
    let CanId::Standard(id) = frame.id() else { return None };
    let flags = frame.length() | if frame.is_remote() { REMOTE_FLAG } else { 0 };
    let [high, low] = id.to_be_bytes();
    let mut bytes = vec![MARK, START];
    for byte in [flags, high, low].iter().chain(frame.bytes()) {
        bytes.push(*byte);
        if *byte == MARK {
            bytes.push(ESCAPED);
        }
    }
    Some(bytes)
}

/// Reads frames from a stream of bytes and finds its way again after noise.
#[derive(Clone, Debug)]
pub struct Decoder {
    form: Form,
    kept: Vec<u8>,
    inside: bool,
    after_mark: bool,
    /// Bytes that belonged to no frame.
    discarded: u64,
}

impl Decoder {
    /// A decoder between two frames.
    #[must_use]
    pub fn new(form: Form) -> Self {
        Self { form, kept: Vec::with_capacity(LONGEST), inside: false, after_mark: false, discarded: 0 }
    }

    /// Takes one byte; a frame that is whole now comes back.
    pub fn feed(&mut self, byte: u8) -> Option<Frame> {
        match self.form {
            Form::Ascii => self.feed_ascii(byte),
            Form::Binary => self.feed_binary(byte),
        }
    }

    /// Takes many.
    pub fn feed_all(&mut self, bytes: &[u8]) -> Vec<Frame> {
        bytes.iter().filter_map(|byte| self.feed(*byte)).collect()
    }

    /// Forgets a frame that is not whole.
    pub fn reset(&mut self) {
        self.drop_kept();
        self.inside = false;
        self.after_mark = false;
    }

    /// How many bytes belonged to no frame so far.
    #[must_use]
    pub fn discarded(&self) -> u64 {
        self.discarded
    }

    fn drop_kept(&mut self) {
        self.discarded += self.kept.len() as u64;
        self.kept.clear();
    }

    fn feed_ascii(&mut self, byte: u8) -> Option<Frame> {
        match byte {
            b':' => {
                self.drop_kept();
                self.inside = true;
            }
            b';' if self.inside => {
                self.inside = false;
                let frame = read_ascii(&self.kept);
                if frame.is_some() {
                    self.kept.clear();
                } else {
                    self.drop_kept();
                }
                return frame;
            }
            // Line ends between frames are a habit of some programs.
            b'\r' | b'\n' if !self.inside => {}
            _ if self.inside && self.kept.len() < LONGEST => self.kept.push(byte),
            _ => {
                self.drop_kept();
                self.discarded += 1;
                self.inside = false;
            }
        }
        None
    }

    fn feed_binary(&mut self, byte: u8) -> Option<Frame> {
        if std::mem::take(&mut self.after_mark) {
            match byte {
                START => {
                    self.drop_kept();
                    self.inside = true;
                    return None;
                }
                ESCAPED => return self.take_binary(MARK),
                _ => self.inside = false,
            }
        }
        if byte == MARK {
            self.after_mark = true;
            return None;
        }
        self.take_binary(byte)
    }

    fn take_binary(&mut self, byte: u8) -> Option<Frame> {
        if !self.inside {
            self.drop_kept();
            self.discarded += 1;
            return None;
        }
        self.kept.push(byte);
        let frame = match read_binary(&self.kept) {
            Reading::More => return None,
            Reading::Frame(frame) => Some(frame),
            Reading::Nonsense => None,
        };
        self.inside = false;
        if frame.is_some() {
            self.kept.clear();
        } else {
            self.drop_kept();
        }
        frame
    }
}

/// Reads what stands between the colon and the semicolon.
fn read_ascii(text: &[u8]) -> Option<Frame> {
    let (kind, rest) = text.split_first()?;
    let at = rest.iter().position(|byte| matches!(byte, b'N' | b'R' | b'n' | b'r'))?;
    let (digits, payload) = rest.split_at(at);
    let id = match kind {
        b'S' | b's' if digits.len() <= 3 => CanId::standard(u16::try_from(hex(digits)?).ok()?)?,
        b'X' | b'x' if digits.len() <= 8 => CanId::extended(hex(digits)?)?,
        _ => return None,
    };
    let (direction, data) = payload.split_first()?;
    if direction.eq_ignore_ascii_case(&b'R') {
        let length = if data.is_empty() { 0 } else { hex(data)? };
        return Frame::remote(id, u8::try_from(length).ok()?);
    }
    if !data.len().is_multiple_of(2) {
        return None;
    }
    let bytes: Option<Vec<u8>> = data.chunks(2).map(|pair| u8::try_from(hex(pair)?).ok()).collect();
    Frame::data(id, &bytes?)
}

/// The number of at least one and at most eight hexadecimal digits.
fn hex(digits: &[u8]) -> Option<u32> {
    if digits.is_empty() || digits.len() > 8 || !digits.iter().all(u8::is_ascii_hexdigit) {
        return None;
    }
    u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()
}

enum Reading {
    More,
    Frame(Frame),
    Nonsense,
}

/// Reads flags, identifier and data without their escapes.
fn read_binary(bytes: &[u8]) -> Reading {
    let [flags, rest @ ..] = bytes else { return Reading::More };
    let (length, is_remote) = (flags & LENGTH_MASK, flags & REMOTE_FLAG != 0);
    if length > 8 || flags & !(LENGTH_MASK | REMOTE_FLAG) != 0 {
        return Reading::Nonsense;
    }
    let [high, low, data @ ..] = rest else { return Reading::More };
    let Some(id) = CanId::standard(u16::from_be_bytes([*high, *low])) else { return Reading::Nonsense };
    let wanted = if is_remote { 0 } else { usize::from(length) };
    if data.len() < wanted {
        return Reading::More;
    }
    let frame = if is_remote { Frame::remote(id, length) } else { Frame::data(id, data) };
    frame.map_or(Reading::Nonsense, Reading::Frame)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u16, bytes: &[u8]) -> Frame {
        Frame::data(CanId::Standard(id), bytes).unwrap()
    }

    fn read(form: Form, bytes: &[u8]) -> Vec<Frame> {
        Decoder::new(form).feed_all(bytes)
    }

    #[test]
    fn ascii_frames_are_written_as_the_adapters_manual_has_them() {
        let upload = frame(0x601, &[0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0]);
        assert_eq!(Form::Ascii.encode(&upload).unwrap(), b":S601N4018100100000000;");
        let extended = Frame::data(CanId::Extended(0x1234_5678), &[0xAB]).unwrap();
        assert_eq!(Form::Ascii.encode(&extended).unwrap(), b":X12345678NAB;");
        let request = Frame::remote(CanId::Standard(0x701), 1).unwrap();
        assert_eq!(Form::Ascii.encode(&request).unwrap(), b":S701R1;");
        for sent in [upload, extended, request] {
            assert_eq!(read(Form::Ascii, &Form::Ascii.encode(&sent).unwrap()), [sent]);
        }
    }

    #[test]
    fn short_identifiers_small_letters_and_line_ends_are_read() {
        assert_eq!(read(Form::Ascii, b":s1n0a;\r\n:SFN;"), [frame(0x001, &[0x0A]), frame(0x00F, &[])]);
        assert_eq!(read(Form::Ascii, b":S7FFR;"), [Frame::remote(CanId::Standard(0x7FF), 0).unwrap()]);
    }

    #[test]
    fn what_is_no_ascii_frame_is_left_out_and_the_next_one_is_found() {
        let next = frame(0x701, &[5]);
        for noise in [
            &b":S800N;"[..],
            b":S0001N;",
            b":SN00;",
            b":S123N0;",
            b":S123N000000000000000000;",
            b":S123",
            b":X20000000N;",
            b":S12",
            b"garbage;;",
            b":S1X3N00;",
            b":S+01N00;",
            b":S123N+1;",
        ] {
            assert_eq!(read(Form::Ascii, &[noise, b":S701N05;"].concat()), [next], "{noise:?}");
        }
    }

    #[test]
    fn binary_frames_are_written_as_the_vendors_library_has_them() {
        // FF 00: start; 08: eight bytes; 06 01: COB-ID; then the data.
        let upload = frame(0x601, &[0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0]);
        let bytes = [0xFF, 0x00, 0x08, 0x06, 0x01, 0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0];
        assert_eq!(Form::Binary.encode(&upload).unwrap(), bytes);
        // A data byte FF is sent as FF 01.
        let full = frame(0x181, &[0xFF, 0x00]);
        assert_eq!(Form::Binary.encode(&full).unwrap(), [0xFF, 0x00, 0x02, 0x01, 0x81, 0xFF, 0x01, 0x00]);
        // 41: bit 6 asks for data, length 1.
        let request = Frame::remote(CanId::Standard(0x701), 1).unwrap();
        assert_eq!(Form::Binary.encode(&request).unwrap(), [0xFF, 0x00, 0x41, 0x07, 0x01]);
        // Assumed: an FF in the identifier is treated like one in the data: answers of node 127 have COB-ID 5FF.
        let last = frame(0x5FF, &[1]);
        assert_eq!(Form::Binary.encode(&last).unwrap(), [0xFF, 0x00, 0x01, 0x05, 0xFF, 0x01, 0x01]);
        for sent in [upload, full, request, last] {
            assert_eq!(read(Form::Binary, &Form::Binary.encode(&sent).unwrap()), [sent]);
        }
        assert_eq!(Form::Binary.encode(&Frame::data(CanId::Extended(1), &[]).unwrap()), None);
    }

    #[test]
    fn what_is_no_binary_frame_is_left_out_and_the_next_one_is_found() {
        let next = frame(0x701, &[5]);
        let good = Form::Binary.encode(&next).unwrap();
        for noise in [
            &[1, 2, 3][..],
            &[0xFF],
            &[0xFF, 0x00, 0x09],
            &[0xFF, 0x00, 0x80],
            &[0xFF, 0x00, 0x01, 0x08, 0x00, 1],
            &[0xFF, 0x00, 0x08, 0x06],
            &[0xFF, 0x02, 7],
        ] {
            assert_eq!(read(Form::Binary, &[noise, &good].concat()), [next], "{noise:?}");
        }
    }
}
