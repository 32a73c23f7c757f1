//! Files of scripts: read with their encoding, `-` is standard input.

use std::io;
use std::path::{Path, PathBuf};

use brushwork_link::bounded;
use brushwork_script::diagnostic::{Diagnostic, PlacedDiagnostic};
use brushwork_script::text::Lines;

/// How the bytes of a file stand for characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Utf8,
    Utf8WithMark,
    /// A byte for a character, as old editors write it.
    Latin1,
}

const MARK: &[u8] = b"\xEF\xBB\xBF";

/// A script as it was read.
#[derive(Debug)]
pub struct Source {
    /// Its name for messages.
    pub name: String,
    /// Its text.
    pub text: String,
    encoding: Encoding,
}

/// A file that could not be read.
#[derive(Debug, thiserror::Error)]
#[error("Could not read {path}: {source}.")]
pub struct ReadError {
    path: PathBuf,
    source: io::Error,
}

/// Whether the argument stands for standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// The bytes of a file or of standard input.
///
/// # Errors
/// A sentence that names the file.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let read = if is_standard(path) {
        bounded::read(io::stdin().lock(), bounded::MOST_BYTES)
    } else {
        bounded::read_file(path)
    };
    read.map_err(|source| ReadError { path: path.to_owned(), source })
}

impl Source {
    /// Reads a script.
    ///
    /// # Errors
    /// A sentence that names the file.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let name = if is_standard(path) { "standard input".to_owned() } else { path.display().to_string() };
        Ok(Self::of(name, read_bytes(path)?))
    }

    /// A script from its bytes.
    pub fn of(name: String, bytes: Vec<u8>) -> Self {
        let has_mark = bytes.starts_with(MARK);
        let body = if has_mark { bytes[MARK.len()..].to_vec() } else { bytes };
        match (String::from_utf8(body), has_mark) {
            (Ok(text), true) => Self { name, text, encoding: Encoding::Utf8WithMark },
            (Ok(text), false) => Self { name, text, encoding: Encoding::Utf8 },
            (Err(error), _) => {
                let text = error.into_bytes().into_iter().map(char::from).collect();
                Self { name, text, encoding: Encoding::Latin1 }
            }
        }
    }

    /// Another text in the encoding of this file.
    pub fn encoded(&self, text: &str) -> Vec<u8> {
        match self.encoding {
            Encoding::Utf8 => text.as_bytes().to_vec(),
            Encoding::Utf8WithMark => [MARK, text.as_bytes()].concat(),
            Encoding::Latin1 => text.chars().map(|letter| u8::try_from(letter).unwrap_or(b'?')).collect(),
        }
    }

    /// What a compiler said, as compilers print it.
    pub fn rendered(&self, diagnostics: &[Diagnostic]) -> String {
        let lines = Lines::of(&self.text);
        diagnostics.iter().map(|diagnostic| diagnostic.render(&self.name, &self.text, &lines)).collect()
    }

    /// What a compiler said, with lines and columns.
    pub fn placed(&self, diagnostics: &[Diagnostic]) -> Vec<PlacedDiagnostic> {
        let lines = Lines::of(&self.text);
        diagnostics.iter().map(|diagnostic| diagnostic.placed(&self.text, &lines)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_encoding_of_a_file_is_kept() {
        for bytes in [&b"puts 0,[\"\xE4\"]\r\n"[..], b"\xEF\xBB\xBFend\n", "puts 0,[\"ä\"]\n".as_bytes()] {
            let source = Source::of("x".into(), bytes.to_vec());
            assert_eq!(source.encoded(&source.text), bytes);
            assert!(!source.text.starts_with('\u{feff}'));
        }
        assert_eq!(Source::of("x".into(), b"\"\xE4\"".to_vec()).text, "\"ä\"");
    }
}
