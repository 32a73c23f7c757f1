//! Images for simulated controllers: one line of text at the start says what the unit calls itself afterwards.
//!
//! This is a format of our own. It exists so that an update can be tried and tested, and so that such an image is known when
//! somebody is about to send it to a real controller.

use super::protocol::{PAGE_BYTES, image_sizes};
use crate::models::{self, Model};
use crate::packet_serial::Generation;

/// How such an image begins.
const MARK: &str = "BRUSHWORK SIMULATED FIRMWARE";
/// Longest line looked at.
const LINE_LIMIT: usize = 128;
/// The filling of each page begins this much higher, so that no two neighbours are alike.
const STRIDE: usize = 37;

/// What a simulated controller becomes by an image.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedImage {
    /// The model it was made for.
    pub model: &'static Model,
    /// The version that the unit reports afterwards, without "v".
    pub version: String,
    /// The generation of its packet serial afterwards.
    pub generation: Generation,
}

/// Why an image cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MarkError {
    /// The version has other letters than digits and dots, or is too long.
    #[error("\"{given}\" is no firmware version: use digits and dots, for example 1.2.0")]
    Version {
        /// As given.
        given: String,
    },
}

impl SimulatedImage {
    /// The bytes of the image, of the smallest size that the model's family takes.
    ///
    /// # Errors
    /// The version cannot be written down.
    pub fn bytes(&self) -> Result<Vec<u8>, MarkError> {
        let is_version = |text: &str| {
            (1..=16).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.')
        };
        if !is_version(&self.version) {
            return Err(MarkError::Version { given: self.version.clone() });
        }
        let Self { model, version, generation } = self;
        let line = format!("{MARK} {} {version} {}\n", model.key, generation.number());
        let length = image_sizes(model.family).first().copied().unwrap_or_default();
        let filling = (0..length).map(|at| (at / PAGE_BYTES * STRIDE + at) as u8);
        Ok(line.bytes().chain(filling).take(length).collect())
    }

    /// Reads the line at the start; `None` if these bytes were not made for simulated controllers.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let start = bytes.get(..LINE_LIMIT.min(bytes.len()))?;
        let end = start.iter().position(|byte| *byte == b'\n')?;
        let line = std::str::from_utf8(&start[..end]).ok()?;
        let mut words = line.strip_prefix(MARK)?.split_ascii_whitespace();
        let model = models::lookup(words.next()?)?;
        let version = words.next()?.to_owned();
        let generation = Generation::from_number(words.next()?.parse().ok()?)?;
        Some(Self { model, version, generation })
    }

    /// Whether bytes begin as an image for simulated controllers does, be the rest readable or not.
    #[must_use]
    pub fn is_marked(bytes: &[u8]) -> bool {
        bytes.starts_with(MARK.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(model: &str, version: &str) -> SimulatedImage {
        let model = models::lookup(model).unwrap();
        SimulatedImage { model, version: version.to_owned(), generation: Generation::Gen3 }
    }

    #[test]
    fn an_image_reads_as_it_was_made() {
        for model in ["mcp266", "mcp2168"] {
            let made = image(model, "1.2.0");
            let bytes = made.bytes().unwrap();
            assert_eq!(bytes.len(), 0xF_0000);
            assert_eq!(SimulatedImage::read(&bytes), Some(made));
            assert!(SimulatedImage::is_marked(&bytes));
        }
    }

    #[test]
    fn what_is_no_version_is_refused() {
        for version in ["", "1.2 ", "v1", "11111111111111111"] {
            assert!(image("mcp266", version).bytes().is_err(), "{version:?}");
        }
    }

    #[test]
    fn other_bytes_are_not_taken_for_one() {
        for bytes in
            [&b""[..], b"\n", b"BRUSHWORK SIMULATED FIRMWARE", b"BRUSHWORK SIMULATED FIRMWARE x 1 9\n"]
        {
            assert_eq!(SimulatedImage::read(bytes), None);
        }
        assert_eq!(SimulatedImage::read(&[0xFF; 300]), None);
    }
}
