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
