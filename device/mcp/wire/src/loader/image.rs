//! A firmware image: bytes that fill whole pages.

use super::protocol::{PAGE_BYTES, image_sizes};
use super::simulated::SimulatedImage;
use crate::models::Family;

/// An image that can be sent. What its bytes mean is not public.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    bytes: Vec<u8>,
}

/// Why bytes are no image for a controller.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// Another length than any known image of the family.
    #[error("it has {bytes} bytes, and images for {} controllers have {}", family.name(), Sizes(*family))]
    Size {
        /// Its length.
        bytes: usize,
        /// The controller's family.
        family: Family,
    },
    /// All bytes are the same, as in erased memory.
    #[error("all of its bytes are 0x{byte:02X}: it is empty")]
    Blank {
        /// The byte.
        byte: u8,
    },
}

impl Image {
    /// Takes the bytes of a file as they are, for a controller of `family`.
    ///
    /// # Errors
    /// The length is none that such a controller is known to take, or there is nothing in it.
    pub fn new(bytes: Vec<u8>, family: Family) -> Result<Self, ImageError> {
        if !image_sizes(family).contains(&bytes.len()) {
            return Err(ImageError::Size { bytes: bytes.len(), family });
        }
        match bytes.first() {
            Some(&byte) if bytes.iter().all(|other| *other == byte) => Err(ImageError::Blank { byte }),
            _ => Ok(Self { bytes }),
        }
    }

    /// How many pages it has.
    #[must_use]
    pub fn page_count(&self) -> usize {
        self.bytes.len() / PAGE_BYTES
    }

    /// A page, counted from 0; empty behind the last.
    #[must_use]
    pub fn page(&self, number: usize) -> &[u8] {
        self.bytes.chunks_exact(PAGE_BYTES).nth(number).unwrap_or_default()
    }

    /// All of it.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// What it says of itself, if it was made for simulated controllers. Such an image must never reach a real one.
    #[must_use]
    pub fn simulated(&self) -> Option<SimulatedImage> {
        SimulatedImage::read(&self.bytes)
    }
}

/// Prints as "32768 or 65536 bytes".
struct Sizes(Family);

impl std::fmt::Display for Sizes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sizes: Vec<_> = image_sizes(self.0).iter().map(ToString::to_string).collect();
        write!(f, "{} bytes", sizes.join(" or "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_published_sizes_are_taken() {
        let with = |length: usize, family| {
            let mut bytes = vec![0; length];
            if let Some(first) = bytes.first_mut() {
                *first = 1;
            }
            Image::new(bytes, family)
        };
        assert_eq!(with(0xF_0000, Family::Mcp).unwrap().page_count(), 3840);
        assert_eq!(with(0x8000, Family::RoboClaw).unwrap().page_count(), 128);
        assert_eq!(with(0x1_0000, Family::RoboClaw).unwrap().page_count(), 256);
        for (length, family) in [(0, Family::Mcp), (0x8000, Family::Mcp), (0xF_0000, Family::RoboClaw)] {
            let error = with(length, family).unwrap_err();
            assert_eq!(error, ImageError::Size { bytes: length, family });
        }
        let sentence = with(5, Family::RoboClaw).unwrap_err().to_string();
        assert_eq!(sentence, "it has 5 bytes, and images for RoboClaw controllers have 32768 or 65536 bytes");
    }

    #[test]
    fn an_empty_image_is_no_image() {
        let blank = Image::new(vec![0xFF; 0x8000], Family::RoboClaw).unwrap_err();
        assert_eq!(blank.to_string(), "all of its bytes are 0xFF: it is empty");
    }

    #[test]
    fn pages_follow_each_other_and_end() {
        let bytes: Vec<u8> = (0..0x8000_usize).map(|at| (at / PAGE_BYTES) as u8).collect();
        let image = Image::new(bytes, Family::RoboClaw).unwrap();
        assert_eq!(image.page(7), [7; PAGE_BYTES]);
        assert_eq!(image.page(127), [127; PAGE_BYTES]);
        assert!(image.page(128).is_empty());
    }
}
