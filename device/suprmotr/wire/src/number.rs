//! Numbers as they are written, in both directions (SuprMotr manual, "Command Reference", DM and HM).
//!
//! Decimal: a sign and ten digits. Assumed, for hexadecimal: eight digits in two's complement, without a sign; in a listed
//! macro a sign and ten digits, since a line that could not be sent again would be of no use.

/// How numbers are written, both ways: DM and HM.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Radix {
    /// Decimal, as after power-up.
    #[default]
    Decimal,
    /// Hexadecimal.
    Hexadecimal,
}

impl Radix {
    pub(crate) const fn base(self) -> u32 {
        match self {
            Self::Decimal => 10,
            Self::Hexadecimal => 16,
        }
    }

    /// Whether a byte is a digit.
    pub const fn is_digit(self, byte: u8) -> bool {
        (byte as char).is_digit(self.base())
    }

    /// A number with its sign and all digits, as reports have it: `+0000020000`.
    pub fn long(self, value: i32) -> String {
        match self {
            Self::Decimal => format!("{value:+011}"),
            Self::Hexadecimal => format!("{value:08X}"),
        }
    }

    /// A number as a listed macro has it, with its sign and ten digits, which a line may have too: `+0000000500`.
    pub fn listed(self, value: i32) -> String {
        let sign = if value < 0 { '-' } else { '+' };
        match self {
            Self::Decimal => format!("{sign}{:010}", value.unsigned_abs()),
            Self::Hexadecimal => format!("{sign}{:010X}", value.unsigned_abs()),
        }
    }

    /// A number as it is: `255`, `-20`.
    pub fn short(self, value: i32) -> String {
        match self {
            Self::Decimal => value.to_string(),
            Self::Hexadecimal if value < 0 => format!("-{:X}", value.unsigned_abs()),
            Self::Hexadecimal => format!("{value:X}"),
        }
    }

    /// The number that a report writes: a sign or none, any count of digits. Hexadecimal without a sign is two's complement.
    pub(crate) fn reported(self, text: &str) -> Option<i32> {
        let (sign, digits) = match text.as_bytes().first()? {
            b'+' => (1, &text[1..]),
            b'-' => (-1, &text[1..]),
            _ if self == Self::Hexadecimal => {
                let all = digits_only(self, text)?;
                return u32::from_str_radix(all, 16).ok().map(u32::cast_signed);
            }
            _ => (1, text),
        };
        let magnitude = i64::from_str_radix(digits_only(self, digits)?, self.base()).ok()?;
        i32::try_from(sign * magnitude).ok()
    }
}

/// The text, if it is one or more digits and nothing else: `from_str_radix` takes signs too.
fn digits_only(radix: Radix, text: &str) -> Option<&str> {
    (!text.is_empty() && text.bytes().all(|byte| radix.is_digit(byte))).then_some(text)
}
