//! The flash memory behind commands 250 and 251: it takes an image and keeps it without power.
//!
//! Assumed: erase and write times, the size of the memory, and status 0xFF for "done" and 0 for "not done" (the meaning of the
//! second byte is not public; the libraries of 2015 and 2020 only wait for it).

use brushwork_mcp_wire::script_image::{BLOCK_BYTES, FILLER, is_own, reversed_words};
use brushwork_plant::world::Content;
use std::time::Duration;

/// Time an erase takes; libraries wait 2 to 5 s for it.
pub const ERASE_TIME: Duration = Duration::from_millis(1500);
/// Time to write one block.
pub const BLOCK_WRITE_TIME: Duration = Duration::from_millis(2);
/// Bytes of the memory.
pub const MEMORY_BYTES: usize = 0x1_0000;

/// Second byte of the answers to 250 and 251.
pub const STATUS_DONE: u8 = 0xff;
/// Second byte when the block lies outside the memory.
pub const STATUS_NOT_DONE: u8 = 0;

/// What the flash memory holds. It survives a power cycle.
#[derive(Clone, Debug, Default)]
pub struct ScriptMemory {
    bytes: Vec<u8>,
}

impl ScriptMemory {
    /// Erases everything.
    pub fn erase(&mut self) {
        self.bytes.clear();
    }

    /// Stores one block as it came over the wire, the bytes of each word reversed, and says whether it lies in the memory.
    pub fn write(&mut self, address: usize, block: [u8; BLOCK_BYTES]) -> bool {
        let Some(end) = address.checked_add(block.len()).filter(|end| *end <= MEMORY_BYTES) else {
            return false;
        };
        if self.bytes.len() < end {
            self.bytes.resize(end, FILLER);
        }
        self.bytes[address..end].copy_from_slice(&reversed_words(block));
        true
    }

    /// Holds this image, past the wire; what does not fit is cut off.
    pub fn install(&mut self, image: &[u8]) {
        self.bytes = image[..image.len().min(MEMORY_BYTES)].to_vec();
    }

    /// What it holds.
    pub fn content(&self) -> Content {
        if self.bytes.is_empty() {
            Content::Nothing
        } else if is_own(&self.bytes) {
            Content::Own
        } else {
            Content::Foreign
        }
    }

    /// The image as far as it was written.
    pub fn image(&self) -> &[u8] {
        &self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_kept_where_they_were_written_until_an_erase() {
        let mut memory = ScriptMemory::default();
        // Two words on the wire, and the same in flash memory with their bytes turned round.
        let wire = [1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 9, 9, 9, 9, 9];
        assert!(memory.write(16, wire));
        assert_eq!(memory.image()[..16], [0xff; 16]);
        assert_eq!(memory.image()[16..24], [4, 3, 2, 1, 8, 7, 6, 5]);
        assert!(!memory.write(MEMORY_BYTES - 15, [1; 16]));
        assert!(!memory.write(usize::MAX, [1; 16]));
        assert_eq!(memory.content(), Content::Foreign);
        memory.erase();
        assert_eq!(memory.content(), Content::Nothing);
    }
}
