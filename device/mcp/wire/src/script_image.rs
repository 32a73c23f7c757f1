//! A compiled script on its way into a controller's flash memory: what of its file is sent, in which blocks, in which byte order
//! (public clients, 2015-2020).
//!
//! The maker's byte code is not public: this module moves bytes and understands none of them. Images of this project's own
//! compiler begin with [`OWN_MAGIC`], so that both ends can tell them from the maker's.

/// Bytes at the beginning of a compiled file that are not sent.
pub const HEADER_BYTES: usize = 0x100;
/// Bytes that command 251 carries.
pub const BLOCK_BYTES: usize = 16;
/// Largest image that the three bytes of the address could reach. What a controller holds is not public.
pub const MOST_BYTES: usize = 1 << 24;
/// What fills the last block: the value of erased flash memory. Assumed.
pub const FILLER: u8 = 0xFF;
/// First bytes, in flash memory, of an image that this project's compiler made.
pub const OWN_MAGIC: [u8; 8] = *b"BWMCLIMG";

/// One command 251.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Where it goes.
    pub address: u32,
    /// Its bytes as they stand in the file and in flash memory.
    pub bytes: [u8; BLOCK_BYTES],
}

impl Block {
    /// The bytes as the command carries them.
    #[must_use]
    pub fn wire_bytes(&self) -> [u8; BLOCK_BYTES] {
        reversed_words(self.bytes)
    }
}

/// Turns the bytes of each 32-bit word round: from file to wire and back.
#[must_use]
pub fn reversed_words(mut bytes: [u8; BLOCK_BYTES]) -> [u8; BLOCK_BYTES] {
    bytes.chunks_exact_mut(4).for_each(<[u8]>::reverse);
    bytes
}

/// The part of a compiled file that is sent: what follows its header, or all of it if it is a bare image of our own. `None` if the file
/// is not longer than the header.
#[must_use]
pub fn body(file: &[u8]) -> Option<&[u8]> {
    if is_own(file) {
        return Some(file);
    }
    file.get(HEADER_BYTES..).filter(|body| !body.is_empty())
}

/// The blocks of what is sent, from address 0 on; the last is filled up.
pub fn blocks(body: &[u8]) -> impl ExactSizeIterator<Item = Block> + '_ {
    body.chunks(BLOCK_BYTES).enumerate().map(|(index, chunk)| {
        let mut bytes = [FILLER; BLOCK_BYTES];
        bytes[..chunk.len()].copy_from_slice(chunk);
        Block { address: (index * BLOCK_BYTES) as u32, bytes }
    })
}

/// Whether bytes of flash memory are an image of this project's own format.
#[must_use]
pub fn is_own(body: &[u8]) -> bool {
    body.starts_with(&OWN_MAGIC)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_reversed_and_the_header_is_left_out() {
        let mut file = vec![0xEE; HEADER_BYTES];
        file.extend(0..18);
        let blocks: Vec<Block> = blocks(body(&file).unwrap()).collect();
        assert_eq!(blocks.len(), 2);
        // Word by word: 00 01 02 03 goes out as 03 02 01 00.
        assert_eq!(blocks[0].wire_bytes(), [3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12]);
        assert_eq!(blocks[1].address, 16);
        // Two bytes are left; the rest is filled as erased flash memory is.
        assert_eq!(blocks[1].wire_bytes()[..4], [0xFF, 0xFF, 17, 16]);
        assert_eq!(reversed_words(blocks[0].wire_bytes()), blocks[0].bytes);
    }

    #[test]
    fn a_file_that_is_all_header_has_no_body() {
        assert_eq!(body(&[0; HEADER_BYTES]), None);
        assert_eq!(body(b"short"), None);
        assert!(is_own(b"BWMCLIMG and more") && !is_own(b"BWMCL"));
    }
}
