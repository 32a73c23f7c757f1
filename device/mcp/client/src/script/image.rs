//! A compiled script: whose format it is, and to whom it may be sent.

use std::time::Duration;

use crate::messages::{McpCauseMessage, McpRemedyMessage};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::script_image;
use brushwork_mcp_wire::script_image::{Block, MOST_BYTES};

/// A compiled script, without the header that is not sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptImage {
    body: Vec<u8>,
    origin: Origin,
}

/// Who compiled it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// This project's compiler: simulated controllers run it.
    Own,
    /// Somebody else's, presumably the maker's: what is in it is not public, and no simulated controller runs it.
    Foreign,
}

/// Why bytes are no image that can be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// There is nothing behind the header.
    #[error(
        "it is no compiled script: it has {0} bytes, and the first 256 of a compiled file are a header that is not sent"
    )]
    Short(usize),
    /// The address has three bytes.
    #[error("it is too long for a script: {0} bytes")]
    Long(usize),
}

impl ScriptImage {
    /// The image in a compiled file: the maker's, one of our own, or one of our own without a header.
    ///
    /// # Errors
    /// The file is too short or too long to be one.
    pub fn from_file(file: &[u8]) -> Result<Self, ImageError> {
        let body = script_image::body(file).ok_or(ImageError::Short(file.len()))?;
        if body.len() > MOST_BYTES {
            return Err(ImageError::Long(body.len()));
        }
        let origin = if script_image::is_own(body) { Origin::Own } else { Origin::Foreign };
        Ok(Self { body: body.to_vec(), origin })
    }

    /// Who compiled it.
    #[must_use]
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// How many bytes are sent, the filling of the last block not counted.
    #[must_use]
    pub fn len(&self) -> usize {
        self.body.len()
    }

    /// Never, since an image has at least one byte.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.body.is_empty()
    }

    /// What is sent, block by block.
    pub fn blocks(&self) -> impl ExactSizeIterator<Item = Block> + '_ {
        script_image::blocks(&self.body)
    }

    /// How long a download of it may take: a wire of 2400 bit/s takes most of that.
    #[must_use]
    pub fn download_limit(&self) -> Duration {
        let blocks = u32::try_from(self.blocks().len()).unwrap_or(u32::MAX);
        Duration::from_secs(60) + Duration::from_millis(200).saturating_mul(blocks)
    }

    /// The CRC-16 of the memory that holds it, the filling of the last block included.
    #[must_use]
    pub fn checksum(&self) -> u16 {
        let filled: Vec<u8> = self.blocks().flat_map(|block| block.bytes).collect();
        crc16_xmodem(&filled)
    }

    /// Why it is not sent to this controller, if it is not.
    #[must_use]
    pub fn objection(&self, is_simulated: bool) -> Option<(McpCauseMessage, McpRemedyMessage)> {
        (self.origin == Origin::Own && !is_simulated)
            .then_some((McpCauseMessage::NotPublic, McpRemedyMessage::UseIonStudio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::script_image::{HEADER_BYTES, OWN_MAGIC};

    #[test]
    fn whose_an_image_is_shows_in_its_first_bytes() {
        let own = [OWN_MAGIC.as_slice(), &[1; 24]].concat();
        let with_header = [vec![0x1A; HEADER_BYTES], own.clone()].concat();
        for file in [&own, &with_header] {
            let image = ScriptImage::from_file(file).unwrap();
            assert_eq!((image.origin(), image.len(), image.blocks().len()), (Origin::Own, 32, 2));
            assert!(image.objection(false).is_some() && image.objection(true).is_none());
        }
        let foreign = ScriptImage::from_file(&[0x1A; HEADER_BYTES + 1]).unwrap();
        assert_eq!((foreign.origin(), foreign.len(), foreign.blocks().len()), (Origin::Foreign, 1, 1));
        assert!(foreign.objection(false).is_none());
    }

    #[test]
    fn what_is_no_compiled_file_is_refused() {
        assert_eq!(ScriptImage::from_file(&[0; HEADER_BYTES]), Err(ImageError::Short(256)));
        let long = vec![0; HEADER_BYTES + MOST_BYTES + 1];
        assert_eq!(ScriptImage::from_file(&long), Err(ImageError::Long(MOST_BYTES + 1)));
    }

    #[test]
    fn the_checksum_is_that_of_whole_blocks() {
        let image = ScriptImage::from_file(&[OWN_MAGIC.as_slice(), &[7]].concat()).unwrap();
        let filled = [OWN_MAGIC.as_slice(), &[7], &[0xFF; 7]].concat();
        assert_eq!(image.checksum(), crc16_xmodem(&filled));
    }
}
