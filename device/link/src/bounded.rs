//! Reading what others have written, up to a bound: a device or a pipe may never end, and a file may be any file.

use std::io::{self, BufRead, Read};
use std::path::Path;

/// No profile, report, script, image or state of the window is longer: the longest that this program writes is a report of a run of half
/// an hour, of less than half of it.
pub const MOST_BYTES: u64 = 16 * 1024 * 1024;

/// The bound that was met. A clause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it goes on after {} MiB, and nothing that belongs here is as long", most_bytes >> 20)]
pub struct TooLong {
    most_bytes: u64,
}

/// All there is to read.
///
/// # Errors
/// The reader's own, and [`TooLong`] as `InvalidData` where it goes on after `most_bytes`.
pub fn read(source: impl Read, most_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(most_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes {
        return Err(io::Error::new(io::ErrorKind::InvalidData, TooLong { most_bytes }));
    }
    Ok(bytes)
}

/// The bytes of a file.
///
/// # Errors
/// As for [`read`].
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    #[cfg(not(target_family = "wasm"))]
    let source = std::fs::File::open(path)?;
    #[cfg(target_family = "wasm")]
    let source = crate::files::page::open(path)?;
    read(source, MOST_BYTES)
}

/// The text of a file.
///
/// # Errors
/// As for [`read`], and `InvalidData` where it is no UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    text(read_file(path)?)
}

/// Bytes as text.
///
/// # Errors
/// `InvalidData` where they are no UTF-8: at which byte.
pub fn text(bytes: Vec<u8>) -> io::Result<String> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        io::Error::new(io::ErrorKind::InvalidData, format!("it is no text: byte {at} is not UTF-8"))
    })
}

/// A reader of lines of which none is longer than a bound, so that a file without line ends takes no memory. The whole may be of any
/// length.
#[derive(Debug)]
pub struct BoundedLines<R> {
    inner: R,
    most_bytes: u64,
    line_bytes: u64,
    is_at_end: bool,
}

impl<R: BufRead> BoundedLines<R> {
    /// No line of `inner` may have more than `most_bytes`.
    pub fn new(inner: R, most_bytes: u64) -> Self {
        Self { inner, most_bytes, line_bytes: 0, is_at_end: false }
    }

    /// Whether all was read, and its last line has no end.
    pub fn ended_within_a_line(&self) -> bool {
        self.is_at_end && self.line_bytes > 0
    }
}

impl<R: BufRead> Read for BoundedLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.is_at_end = count == 0 && !buffer.is_empty();
        for byte in &buffer[..count] {
            self.line_bytes = if *byte == b'\n' { 0 } else { self.line_bytes + 1 };
            if self.line_bytes > self.most_bytes {
                let most_bytes = self.most_bytes;
                return Err(io::Error::new(io::ErrorKind::InvalidData, LongLine { most_bytes }));
            }
        }
        Ok(count)
    }
}

/// A line met its bound. A clause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a line of it has more than {} KiB", most_bytes >> 10)]
struct LongLine {
    most_bytes: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_never_ends_is_given_up_at_the_bound() {
        assert_eq!(read(io::repeat(7).take(100), 100).expect("it fits").len(), 100);
        let error = read(io::repeat(7), 3 << 20).expect_err("it never ends");
        assert_eq!(error.to_string(), "it goes on after 3 MiB, and nothing that belongs here is as long");
    }

    #[test]
    fn lines_are_bounded_and_the_whole_is_not() {
        let lines = b"0123456789\n".repeat(10_000);
        let mut text = String::new();
        BoundedLines::new(&lines[..], 10).read_to_string(&mut text).expect("each fits");
        assert_eq!(text.len(), lines.len());
        let error = BoundedLines::new(io::BufReader::new(io::repeat(b'x')), 4096).read_to_string(&mut text);
        assert_eq!(error.expect_err("no line end").to_string(), "a line of it has more than 4 KiB");
    }

    #[test]
    fn what_is_no_text_is_named_by_its_byte() {
        let error = text(b"ab\xff".to_vec()).expect_err("0xFF is none");
        assert_eq!(error.to_string(), "it is no text: byte 2 is not UTF-8");
    }
}
