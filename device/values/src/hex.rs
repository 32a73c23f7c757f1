//! Bytes as people read them.

use std::fmt::Write as _;

/// Bytes as upper-case hexadecimal pairs with spaces between.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() * 3);
    for (index, byte) in bytes.iter().enumerate() {
        let space = if index == 0 { "" } else { " " };
        // Writing into a String cannot fail.
        let _ = write!(text, "{space}{byte:02X}");
    }
    text
}

/// Reads a number of one byte, in hexadecimal with 0x or in decimal.
#[must_use]
pub fn parse_byte(text: &str) -> Option<u8> {
    let digits = text.trim();
    let hexadecimal = digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X"));
    hexadecimal.map_or_else(|| digits.parse().ok(), |digits| u8::from_str_radix(digits, 16).ok())
}
