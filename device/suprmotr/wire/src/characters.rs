//! The characters that are no text: selection, end of a line, end of a report.

/// Ctrl-A: the next character is an address.
pub const SELECT: u8 = 0x01;
/// Ends a report: end of text, behind the last line.
pub const END_OF_REPORT: u8 = 0x03;
/// Carriage return: carries out the line.
pub const EXECUTE: u8 = b'\r';
