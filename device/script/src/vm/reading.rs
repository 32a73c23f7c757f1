//! Numbers out of characters as they come, by the input modifiers (MCP manual 3.3): what is no digit is skipped until the first one
//! comes; the first character after the digits ends the number and is used up.

use crate::mcl::ast::Format;

/// A number that is being read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    text: String,
    /// The `$` of IHEX has come.
    indicated: bool,
    /// Bytes stored by STR so far.
    pub stored: u32,
}

impl Reading {
    /// Takes a byte; the value once the number is complete. A number has at most `max` digits (0: as many as come).
    pub fn take(&mut self, format: Format, max: u32, byte: u8) -> Option<u32> {
        let letter = char::from(byte).to_ascii_lowercase();
        if format == Format::IHex && !self.indicated {
            self.indicated = letter == '$';
            return None;
        }
        let radix = if matches!(format, Format::Hex | Format::IHex) { 16 } else { 10 };
        let is_digit = letter.is_digit(radix);
        let is_sign = letter == '-' && format == Format::SDec && self.text.is_empty();
        if is_digit || is_sign {
            self.text.push(letter);
            let full = max > 0 && self.digits() >= max as usize;
            return full.then(|| self.value(radix));
        }
        if self.digits() == 0 {
            self.text.clear();
            return None;
        }
        Some(self.value(radix))
    }

    /// The same for a number with a decimal point.
    pub fn take_real(&mut self, byte: u8) -> Option<f32> {
        let letter = char::from(byte);
        let starts = letter == '-' && self.text.is_empty();
        let point = letter == '.' && !self.text.contains('.');
        if letter.is_ascii_digit() || starts || point {
            self.text.push(letter);
            return None;
        }
        if self.digits() == 0 {
            self.text.clear();
            return None;
        }
        Some(self.text.parse().unwrap_or(0.0))
    }

    fn digits(&self) -> usize {
        self.text.chars().filter(char::is_ascii_hexdigit).count()
    }

    /// The low 32 bits of what was read.
    fn value(&self, radix: u32) -> u32 {
        let (digits, negative) = match self.text.strip_prefix('-') {
            Some(digits) => (digits, true),
            None => (&self.text[..], false),
        };
        let add = |value: u32, digit: u32| value.wrapping_mul(radix).wrapping_add(digit);
        let value = digits.chars().filter_map(|letter| letter.to_digit(radix)).fold(0, add);
        if negative { value.wrapping_neg() } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(format: Format, max: u32, text: &str) -> Option<u32> {
        let mut reading = Reading::default();
        text.bytes().find_map(|byte| reading.take(format, max, byte))
    }

    #[test]
    fn digits_are_found_among_other_characters() {
        assert_eq!(read(Format::Dec, 0, "abc 123\r"), Some(123));
        assert_eq!(read(Format::Dec, 3, "123456"), Some(123));
        assert_eq!(read(Format::Dec, 0, "123"), None);
        assert_eq!(read(Format::SDec, 0, "x-42,"), Some((-42i32) as u32));
        assert_eq!(read(Format::Hex, 0, "12aB "), Some(0x12AB));
        assert_eq!(read(Format::IHex, 0, "12 $3f;"), Some(0x3F));
    }

    #[test]
    fn a_real_ends_with_the_first_other_character() {
        let mut reading = Reading::default();
        assert_eq!("x-3.25\n".bytes().find_map(|byte| reading.take_real(byte)), Some(-3.25));
    }
}
