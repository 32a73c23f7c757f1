//! The terminal of a script: what PUTS sent on each stream, and a line to type for GETS.

use crate::messages::WindowTypedMessage;
use brushwork_script::debug::{Chunk, View};

/// Characters that are kept.
const KEPT: usize = 256 * 1024;

/// What follows a typed line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineEnd {
    #[default]
    Cr,
    Lf,
    CrLf,
    None,
}

impl LineEnd {
    pub const ALL: [Self; 4] = [Self::Cr, Self::Lf, Self::CrLf, Self::None];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Cr => "CR",
            Self::Lf => "LF",
            Self::CrLf => "CR LF",
            Self::None => "No line end",
        }
    }

    const fn bytes(self) -> &'static [u8] {
        match self {
            Self::Cr => b"\r",
            Self::Lf => b"\n",
            Self::CrLf => b"\r\n",
            Self::None => b"",
        }
    }
}

/// The terminal.
#[derive(Debug, Default)]
pub struct Terminal {
    /// The bytes so far, with the streams they were sent to.
    chunks: Vec<Chunk>,
    kept: usize,
    seen: u64,
    /// Only this stream is shown; all of them without one.
    pub stream: Option<u32>,
    pub hex: bool,
    pub line_end: LineEnd,
    /// Bytes are typed in hex.
    pub hex_input: bool,
    pub input: String,
    /// The stream that is typed to.
    pub to_stream: u32,
    /// What could not be understood of what was typed.
    pub refused: Option<WindowTypedMessage>,
    shown: Shown,
}

/// The text as it was laid out last, so that it is not made anew in each frame.
#[derive(Debug, Default)]
struct Shown {
    of: Option<(u64, Option<u32>, bool)>,
    text: String,
}

impl Terminal {
    /// How many bytes of the script's output were taken over.
    pub fn seen(&self) -> u64 {
        self.seen
    }

    /// Takes over what is new.
    pub fn take(&mut self, view: &View) {
        if view.output_count < self.seen {
            // Another debugger, which began from nothing.
            self.seen = 0;
            return;
        }
        let new: u64 = view.output.iter().map(|chunk| chunk.bytes.len() as u64).sum();
        // Two looks may overlap, since one is asked for before the other is answered.
        let mut skip = (self.seen + new).saturating_sub(view.output_count).min(new) as usize;
        for chunk in &view.output {
            let known = skip.min(chunk.bytes.len());
            skip -= known;
            self.push(chunk.stream, &chunk.bytes[known..]);
        }
        self.seen = view.output_count;
    }

    fn push(&mut self, stream: u32, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        match self.chunks.last_mut().filter(|chunk| chunk.stream == stream) {
            Some(chunk) => chunk.bytes.extend(bytes),
            None => self.chunks.push(Chunk { stream, bytes: bytes.to_vec() }),
        }
        self.kept += bytes.len();
        while self.kept > KEPT && !self.chunks.is_empty() {
            let first = &mut self.chunks[0].bytes;
            let goes = first.len().min(self.kept - KEPT);
            first.drain(..goes);
            self.kept -= goes;
            if first.is_empty() {
                self.chunks.remove(0);
            }
        }
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.chunks.clear();
        self.kept = 0;
        self.shown = Shown::default();
    }

    /// The link is another one; what was received stays.
    pub fn forget(&mut self) {
        self.seen = 0;
    }

    /// The streams that something was sent to.
    pub fn streams(&self) -> Vec<u32> {
        let mut streams: Vec<u32> = self.chunks.iter().map(|chunk| chunk.stream).collect();
        streams.sort_unstable();
        streams.dedup();
        streams
    }

    /// What is shown.
    pub fn text(&mut self) -> &str {
        let of = Some((self.seen, self.stream, self.hex));
        if self.shown.of != of || self.kept == 0 {
            let shown =
                self.chunks.iter().filter(|chunk| self.stream.is_none_or(|stream| chunk.stream == stream));
            let bytes: Vec<u8> = shown.flat_map(|chunk| chunk.bytes.iter().copied()).collect();
            self.shown = Shown { of, text: if self.hex { hex(&bytes) } else { plain(&bytes) } };
        }
        &self.shown.text
    }

    /// What was typed as bytes.
    ///
    /// # Errors
    /// A sentence: what is typed in hex is not hex.
    pub fn typed(&mut self) -> Result<Vec<u8>, WindowTypedMessage> {
        let mut bytes = if self.hex_input { of_hex(&self.input)? } else { self.input.as_bytes().to_vec() };
        if !self.hex_input {
            bytes.extend(self.line_end.bytes());
        }
        Ok(bytes)
    }
}

/// Bytes as text: CR, LF and both together end a line, what is no character shows as its number.
fn plain(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    let mut before = 0;
    for byte in bytes {
        match byte {
            b'\n' if before == b'\r' => {}
            b'\r' | b'\n' => text.push('\n'),
            b'\t' | 0x20..=0x7E => text.push(char::from(*byte)),
            other => text.push_str(&format!("\\x{other:02x}")),
        }
        before = *byte;
    }
    text
}

fn hex(bytes: &[u8]) -> String {
    let row = |row: &[u8]| {
        let numbers: Vec<String> = row.iter().map(|byte| format!("{byte:02x}")).collect();
        let letters: String = row
            .iter()
            .map(|byte| if (0x20..0x7F).contains(byte) { char::from(*byte) } else { '.' })
            .collect();
        format!("{:<48}{letters}\n", numbers.join(" "))
    };
    bytes.chunks(16).map(row).collect()
}

fn of_hex(text: &str) -> Result<Vec<u8>, WindowTypedMessage> {
    let digits: String = text.replace("0x", " ").split([' ', ',']).collect();
    let wrong = || WindowTypedMessage::NoScriptBytes { text: text.to_owned() };
    if digits.is_empty() || !digits.len().is_multiple_of(2) || !digits.is_ascii() {
        return Err(wrong());
    }
    let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).map_err(|_| wrong());
    (0..digits.len()).step_by(2).map(byte).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(from: u64, bytes: &[u8]) -> View {
        let output = vec![Chunk { stream: 0, bytes: bytes.to_vec() }];
        View { output, output_count: from + bytes.len() as u64, ..View::default() }
    }

    #[test]
    fn output_is_shown_once_even_if_two_looks_overlap() {
        let mut terminal = Terminal::default();
        terminal.take(&view(0, b"ab"));
        terminal.take(&view(0, b"abc"));
        terminal.take(&view(3, b"d\r\ne\x01"));
        assert_eq!(terminal.text(), "abcd\ne\\x01");
        assert_eq!(terminal.seen(), 8);
        // Bytes in between that nobody kept.
        terminal.take(&view(20, b"!"));
        assert!(terminal.text().ends_with('!'));
        terminal.take(&view(0, b""));
        assert_eq!(terminal.seen(), 0, "a new script counts from nothing");
    }

    #[test]
    fn bytes_can_be_typed_as_text_or_in_hex() {
        let mut terminal = Terminal { input: "12".into(), line_end: LineEnd::CrLf, ..Terminal::default() };
        assert_eq!(terminal.typed(), Ok(b"12\r\n".to_vec()));
        terminal.hex_input = true;
        assert_eq!(terminal.typed(), Ok(vec![0x12]));
        terminal.input = "48 0x65,6C".into();
        assert_eq!(terminal.typed(), Ok(b"Hel".to_vec()));
        terminal.input = "4".into();
        assert!(terminal.typed().is_err());
        terminal.input = "zz".into();
        assert!(terminal.typed().unwrap_err().to_string().contains("48 65"));
    }

    #[test]
    fn hex_shows_numbers_and_letters_side_by_side() {
        let mut terminal = Terminal { hex: true, ..Terminal::default() };
        terminal.take(&view(0, b"Hi\r"));
        assert_eq!(terminal.text(), format!("{:<48}Hi.\n", "48 69 0d"));
    }

    #[test]
    fn one_stream_can_be_shown_alone() {
        let mut terminal = Terminal::default();
        let chunk = |stream, text: &[u8]| Chunk { stream, bytes: text.to_vec() };
        let output = vec![chunk(0, b"a"), chunk(2, b"b"), chunk(0, b"c")];
        terminal.take(&View { output, output_count: 3, ..View::default() });
        assert_eq!((terminal.streams(), terminal.text()), (vec![0, 2], "abc"));
        terminal.stream = Some(2);
        assert_eq!(terminal.text(), "b");
    }
}
