//! CRC-16/XMODEM, the checksum of packet serial: polynomial 0x1021, start 0, nothing reflected, no final xor.
//!
//! The listing in MCP manual 2.2.6 returns inside its loop and leaves out the start value; the form here is the one
//! that every public client computes. It is sent high byte first.

const POLYNOMIAL: u16 = 0x1021;

static TABLE: [u16; 256] = table();

/// The checksum of a whole run of bytes.
///
/// ```
/// assert_eq!(brushwork_mcp_wire::crc::crc16_xmodem(b"123456789"), 0x31C3);
/// ```
pub fn crc16_xmodem(bytes: &[u8]) -> u16 {
    let mut crc = Crc16::new();
    crc.update(bytes);
    crc.value()
}

/// The same checksum, taken in as the bytes come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Crc16(u16);

impl Crc16 {
    /// A checksum over nothing yet.
    pub const fn new() -> Self {
        Self(0)
    }

    /// Takes in one more byte.
    pub fn push(&mut self, byte: u8) {
        let [high, low] = self.0.to_be_bytes();
        self.0 = (u16::from(low) << 8) ^ TABLE[usize::from(high ^ byte)];
    }

    /// Takes in more bytes.
    pub fn update(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.push(byte);
        }
    }

    /// The checksum of all bytes so far.
    pub const fn value(self) -> u16 {
        self.0
    }
}

const fn table() -> [u16; 256] {
    let mut table = [0; 256];
    let mut index = 0;
    while index < 256 {
        let mut crc = (index as u16) << 8;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 0x8000 == 0 { crc << 1 } else { (crc << 1) ^ POLYNOMIAL };
            bit += 1;
        }
        table[index] = crc;
        index += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_gives_the_values_that_other_programs_give() {
        // The check value of CRC-16/XMODEM in the public catalogue of CRC parameters.
        assert_eq!(crc16_xmodem(b"123456789"), 0x31C3);
        // Python's binascii.crc_hqx(data, 0) is the same checksum.
        assert_eq!(crc16_xmodem(b""), 0x0000);
        assert_eq!(crc16_xmodem(b"A"), 0x58E5);
        assert_eq!(crc16_xmodem(&[0x00]), 0x0000);
        assert_eq!(crc16_xmodem(&[0xFF]), 0x1EF0);
        assert_eq!(crc16_xmodem(b"The quick brown fox jumps over the lazy dog"), 0xF0C8);
        // Bytes that real clients put on the wire (public clients, 2015-2025).
        assert_eq!(crc16_xmodem(&[0x80, 0x10]), 0x09A9);
        assert_eq!(crc16_xmodem(&[0x80, 0x5A]), 0xE027);
    }

    #[test]
    fn byte_by_byte_equals_all_at_once() {
        let bytes: Vec<u8> = (0..=255).collect();
        let mut crc = Crc16::new();
        for &byte in &bytes {
            crc.push(byte);
        }
        assert_eq!(crc.value(), crc16_xmodem(&bytes));
    }

    #[test]
    fn a_message_followed_by_its_checksum_has_checksum_zero() {
        let mut bytes = vec![0x80, 0x22, 0x0C, 0xCC, 0x0C, 0xCC];
        bytes.extend(crc16_xmodem(&bytes).to_be_bytes());
        assert_eq!(crc16_xmodem(&bytes), 0);
    }
}
