//! Programs in files: their encoding and line ends, which are kept, and how a file is written.

use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_link::Message;
use std::io;
use std::path::Path;
use std::time::SystemTime;

use brushwork_link::Failure;
use brushwork_link::bounded;
use brushwork_link::files::{self, replace_file};

/// How letters are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    #[default]
    Utf8,
    /// With a byte order mark.
    Utf8Mark,
    Latin1,
    /// With a byte order mark.
    Utf16Le,
    /// With a byte order mark.
    Utf16Be,
}

impl Encoding {
    pub const ALL: [Self; 5] = [Self::Utf8, Self::Utf8Mark, Self::Latin1, Self::Utf16Le, Self::Utf16Be];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Utf8 => "UTF-8",
            Self::Utf8Mark => "UTF-8 with BOM",
            Self::Latin1 => "Latin-1",
            Self::Utf16Le => "UTF-16 LE",
            Self::Utf16Be => "UTF-16 BE",
        }
    }
}

/// How lines end. The text in the editor has "\n", unless the file mixes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LineEnds {
    Lf,
    CrLf,
    Cr,
    /// Several kinds in one file: all stay as they are.
    Mixed,
}

impl LineEnds {
    /// Those that can be chosen.
    pub const ALL: [Self; 3] = [Self::Lf, Self::CrLf, Self::Cr];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Lf => "LF",
            Self::CrLf => "CRLF",
            Self::Cr => "CR",
            Self::Mixed => "mixed",
        }
    }
}

impl Default for LineEnds {
    /// The system's own.
    fn default() -> Self {
        if cfg!(windows) { Self::CrLf } else { Self::Lf }
    }
}

/// Encoding and line ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Format {
    pub encoding: Encoding,
    pub ends: LineEnds,
}

/// A letter that an encoding does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line} has “{letter}”, which Latin-1 does not have")]
pub struct NotInLatin1 {
    letter: char,
    line: usize,
}

/// A file's bytes as text for the editor. What is no UTF is Latin-1, which any bytes are; so nothing is lost.
pub fn decode(bytes: &[u8]) -> (String, Format) {
    let (text, encoding) = letters(bytes);
    let (text, ends) = lines(text);
    (text, Format { encoding, ends })
}

fn letters(bytes: &[u8]) -> (String, Encoding) {
    let utf16 = |bytes: &[u8], read: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| read([pair[0], pair[1]])).collect();
        String::from_utf16(&units).ok().filter(|_| bytes.len().is_multiple_of(2))
    };
    let marked = match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => {
            std::str::from_utf8(rest).ok().map(|text| (text.to_owned(), Encoding::Utf8Mark))
        }
        [0xFF, 0xFE, rest @ ..] => utf16(rest, u16::from_le_bytes).map(|text| (text, Encoding::Utf16Le)),
        [0xFE, 0xFF, rest @ ..] => utf16(rest, u16::from_be_bytes).map(|text| (text, Encoding::Utf16Be)),
        _ => std::str::from_utf8(bytes).ok().map(|text| (text.to_owned(), Encoding::Utf8)),
    };
    marked.unwrap_or_else(|| (bytes.iter().copied().map(char::from).collect(), Encoding::Latin1))
}

fn lines(text: String) -> (String, LineEnds) {
    let pairs = text.matches("\r\n").count();
    let (returns, feeds) = (text.matches('\r').count() - pairs, text.matches('\n').count() - pairs);
    match (pairs, returns, feeds) {
        (0, 0, 0) => (text, LineEnds::default()),
        (0, 0, _) => (text, LineEnds::Lf),
        (_, 0, 0) => (text.replace("\r\n", "\n"), LineEnds::CrLf),
        (0, _, 0) => (text.replace('\r', "\n"), LineEnds::Cr),
        _ => (text, LineEnds::Mixed),
    }
}

/// A text as the bytes of a file.
///
/// # Errors
/// Latin-1 has no such letter.
pub fn encode(text: &str, format: Format) -> Result<Vec<u8>, NotInLatin1> {
    let text = match format.ends {
        LineEnds::Lf | LineEnds::Mixed => text.to_owned(),
        LineEnds::CrLf => text.replace('\n', "\r\n"),
        LineEnds::Cr => text.replace('\n', "\r"),
    };
    let utf16 = |mark: [u8; 2], write: fn(u16) -> [u8; 2]| -> Vec<u8> {
        mark.into_iter().chain(text.encode_utf16().flat_map(write)).collect()
    };
    Ok(match format.encoding {
        Encoding::Utf8 => text.into_bytes(),
        Encoding::Utf8Mark => [&[0xEF, 0xBB, 0xBF], text.as_bytes()].concat(),
        Encoding::Utf16Le => utf16([0xFF, 0xFE], u16::to_le_bytes),
        Encoding::Utf16Be => utf16([0xFE, 0xFF], u16::to_be_bytes),
        Encoding::Latin1 => latin1(&text)?,
    })
}

fn latin1(text: &str) -> Result<Vec<u8>, NotInLatin1> {
    let mut line = 1;
    text.chars()
        .map(|letter| {
            line += usize::from(letter == '\n');
            u8::try_from(letter).map_err(|_| NotInLatin1 { letter, line })
        })
        .collect()
}

/// What tells that a file was changed: when, and how long it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    changed: Option<SystemTime>,
    length: u64,
}

impl Stamp {
    pub fn of(path: &Path) -> io::Result<Self> {
        let found = files::look(path)?;
        Ok(Self { changed: found.changed, length: found.bytes })
    }
}

/// What was read from a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loaded {
    pub text: String,
    pub format: Format,
    pub stamp: Option<Stamp>,
}

/// Reads a program.
///
/// # Errors
/// The file cannot be read, or is far too long.
pub fn read(path: &Path) -> Result<Loaded, Failure> {
    let failed = |error: Message| {
        let on = path.display().to_string();
        Failure::new(WindowActMessage::OpenFile, on, error, WindowRemedyMessage::CheckPath)
    };
    let stamp = Stamp::of(path).map_err(|error| failed(Message::error(error)))?;
    // A device or a pipe may never end.
    if !files::look(path).is_ok_and(|found| found.is_file) {
        return Err(failed(WindowCauseMessage::NoFile.into()));
    }
    let bytes = bounded::read_file(path).map_err(|error| failed(Message::error(error)))?;
    let (text, format) = decode(&bytes);
    Ok(Loaded { text, format, stamp: Some(stamp) })
}

/// Replaces a file in one step; a crash in the middle leaves the old one.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<Option<Stamp>, Failure> {
    let failed = |error: io::Error| {
        let (on, error) = (path.display().to_string(), Message::error(error));
        Failure::new(WindowActMessage::SaveFile, on, error, WindowRemedyMessage::SaveElsewhere)
    };
    replace_file(path, bytes).map_err(failed)?;
    Ok(Stamp::of(path).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn format(encoding: Encoding, ends: LineEnds) -> Format {
        Format { encoding, ends }
    }

    #[test]
    fn bytes_come_back_as_they_were_in_every_encoding_and_line_end() {
        let files: [(&[u8], Format); 9] = [
            (b"a\nb\n", format(Encoding::Utf8, LineEnds::Lf)),
            (b"a\r\nb\r\n", format(Encoding::Utf8, LineEnds::CrLf)),
            (b"a\rb\r", format(Encoding::Utf8, LineEnds::Cr)),
            (b"a\r\nb\nc\rd", format(Encoding::Utf8, LineEnds::Mixed)),
            ("a\u{20AC}\n".as_bytes(), format(Encoding::Utf8, LineEnds::Lf)),
            (b"\xEF\xBB\xBFa\n", format(Encoding::Utf8Mark, LineEnds::Lf)),
            // "ü" in Latin-1 is no UTF-8.
            (b"\xFC\r\n", format(Encoding::Latin1, LineEnds::CrLf)),
            (b"\xFF\xFEa\0\r\0\n\0", format(Encoding::Utf16Le, LineEnds::CrLf)),
            (b"\xFE\xFF\0a\0\n", format(Encoding::Utf16Be, LineEnds::Lf)),
        ];
        for (bytes, expected) in files {
            let (text, found) = decode(bytes);
            assert_eq!(found, expected, "{bytes:?}");
            assert_eq!(encode(&text, found).unwrap(), bytes, "{bytes:?}");
        }
    }

    #[test]
    fn any_bytes_at_all_come_back_as_they_were() {
        use proptest::prelude::*;
        proptest!(|(bytes in proptest::collection::vec(any::<u8>(), 0..200), mark in 0usize..4)| {
            let marks: [&[u8]; 4] = [b"", b"\xFF\xFE", b"\xFE\xFF", b"\xEF\xBB\xBF"];
            let bytes = [marks[mark], &bytes].concat();
            let (text, format) = decode(&bytes);
            prop_assert_eq!(encode(&text, format).unwrap(), bytes);
        });
    }

    #[test]
    fn a_letter_that_latin_1_does_not_have_is_named_with_its_line() {
        let error = encode("a\n€", format(Encoding::Latin1, LineEnds::Lf)).unwrap_err();
        assert_eq!(error.to_string(), "line 2 has “€”, which Latin-1 does not have");
    }

    #[test]
    fn a_file_is_replaced_and_its_stamp_tells_later_changes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mcl");
        let stamp = write(&path, b"one").unwrap();
        assert_eq!(read(&path).unwrap().stamp, stamp);
        std::fs::write(&path, "longer").unwrap();
        assert_ne!(read(&path).unwrap().stamp, stamp);
        assert!(read(&folder.path().join("none")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_not_opened() {
        for path in ["/dev/zero", "/tmp"] {
            let failure = read(Path::new(path)).unwrap_err().to_string();
            assert!(failure.contains("it is no file, but a folder, a device or a pipe"), "{failure}");
        }
    }
}
