//! Types of variables and the modifiers that name a part of one (MCP manual 3.1.1, 3.1.8, 3.1.13).

use crate::listed::listed;
use serde::Serialize;

listed! {
    /// The type of a variable, a register or a table.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
    #[serde(rename_all = "lowercase")]
    pub enum VarType {
        /// 0 or 1.
        Bit "Bit",
        /// 0 to 15.
        Nib "Nib",
        /// 0 to 255.
        Byte "Byte",
        /// -128 to 127.
        SByte "SByte",
        /// 0 to 65535.
        Word "Word",
        /// -32768 to 32767. The manual's table says 32 bits but gives this range, so 16 it is.
        SWord "SWord",
        /// 0 to 4294967295.
        Long "Long",
        /// -2147483648 to 2147483647.
        SLong "SLong",
        /// A 32 bit floating point number.
        Float "Float",
    }
    /// As the manual writes it.
    #[must_use]
    fn name;
}

impl VarType {
    /// The type of this name, in any case.
    #[must_use]
    pub fn lookup(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name().eq_ignore_ascii_case(name))
    }

    /// How many bits a value takes.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Bit => 1,
            Self::Nib => 4,
            Self::Byte | Self::SByte => 8,
            Self::Word | Self::SWord => 16,
            Self::Long | Self::SLong | Self::Float => 32,
        }
    }

    /// Whether values may be negative.
    #[must_use]
    pub const fn is_signed(self) -> bool {
        matches!(self, Self::SByte | Self::SWord | Self::SLong | Self::Float)
    }

    /// Smallest and largest whole number; `None` for floats.
    #[must_use]
    pub const fn range(self) -> Option<(i64, i64)> {
        let top = 1i64 << self.bits();
        match self {
            Self::Float => None,
            Self::SByte | Self::SWord | Self::SLong => Some((-top / 2, top / 2 - 1)),
            Self::Bit | Self::Nib | Self::Byte | Self::Word | Self::Long => Some((0, top - 1)),
        }
    }

    /// What is left of a value that is stored in this type: its low bits, with the sign spread again.
    #[must_use]
    pub const fn keep(self, value: u32) -> u32 {
        match self {
            Self::Bit => value & 1,
            Self::Nib => value & 0xF,
            Self::Byte => value & 0xFF,
            Self::SByte => value as i8 as i32 as u32,
            Self::Word => value & 0xFFFF,
            Self::SWord => value as i16 as i32 as u32,
            Self::Long | Self::SLong | Self::Float => value,
        }
    }
}

/// The names of tables and the type of their entries (MCP manual 3.1.13).
pub const TABLES: [(&str, VarType); 7] = [
    ("ByteTable", VarType::Byte),
    ("SByteTable", VarType::SByte),
    ("WordTable", VarType::Word),
    ("SWordTable", VarType::SWord),
    ("LongTable", VarType::Long),
    ("SLongTable", VarType::SLong),
    ("FloatTable", VarType::Float),
];

/// A part of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Part {
    /// Type of the part.
    pub kind: VarType,
    /// First bit, counted from the lowest.
    pub first_bit: u32,
}

/// Why a modifier does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartError {
    /// There is no such modifier.
    Unknown,
    /// The variable has no such part.
    Outside,
}

/// The part of a variable of type `of` that `modifier` names (MCP manual 3.1.8).
///
/// # Errors
/// The modifier is unknown, or the variable is too small for it.
pub fn part(of: VarType, modifier: &str) -> Result<Part, PartError> {
    let name = modifier.to_ascii_lowercase();
    let (word, end) = match (name.strip_prefix("low"), name.strip_prefix("high")) {
        (Some(word), _) => (word, Some(false)),
        (_, Some(word)) => (word, Some(true)),
        _ => (name.trim_end_matches(|letter: char| letter.is_ascii_digit()), None),
    };
    let kind = part_kind(word).ok_or(PartError::Unknown)?;
    let bits = kind.bits();
    let count = of.bits() / bits;
    let index = match end {
        Some(_) if kind.is_signed() => return Err(PartError::Unknown),
        Some(false) => 0,
        Some(true) => count.saturating_sub(1),
        None => name[word.len()..].parse().map_err(|_| PartError::Unknown)?,
    };
    if index < count { Ok(Part { kind, first_bit: index * bits }) } else { Err(PartError::Outside) }
}

fn part_kind(word: &str) -> Option<VarType> {
    Some(match word {
        "bit" => VarType::Bit,
        "nib" => VarType::Nib,
        "byte" => VarType::Byte,
        "sbyte" => VarType::SByte,
        "word" => VarType::Word,
        "sword" => VarType::SWord,
        _ => return None,
    })
}

/// Every modifier that fits a variable of this type, for completion.
#[must_use]
pub fn parts(of: VarType) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in ["Bit", "Nib", "Byte", "SByte", "Word", "SWord"] {
        let low_high = ["Low", "High"].into_iter().map(|end| format!("{end}{word}"));
        let numbered = (0..32).map(|index| format!("{word}{index}"));
        names.extend(low_high.chain(numbered).filter(|name| part(of, name).is_ok()));
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(of: VarType, modifier: &str) -> Result<(VarType, u32), PartError> {
        part(of, modifier).map(|part| (part.kind, part.first_bit))
    }

    #[test]
    fn each_modifier_names_its_bits() {
        let long = |modifier| named(VarType::Long, modifier);
        assert_eq!(long("LowBit"), Ok((VarType::Bit, 0)));
        assert_eq!(long("HighBit"), Ok((VarType::Bit, 31)));
        assert_eq!(long("bit7"), Ok((VarType::Bit, 7)));
        assert_eq!(long("HighNib"), Ok((VarType::Nib, 28)));
        assert_eq!(long("nib2"), Ok((VarType::Nib, 8)));
        assert_eq!(long("Byte3"), Ok((VarType::Byte, 24)));
        assert_eq!(long("sbyte1"), Ok((VarType::SByte, 8)));
        assert_eq!(long("HIGHWORD"), Ok((VarType::Word, 16)));
        assert_eq!(long("sword1"), Ok((VarType::SWord, 16)));
        assert_eq!(named(VarType::Word, "HighByte"), Ok((VarType::Byte, 8)));
    }

    #[test]
    fn what_does_not_fit_is_outside_and_what_is_not_there_is_unknown() {
        assert_eq!(named(VarType::Word, "byte2"), Err(PartError::Outside));
        assert_eq!(named(VarType::Byte, "lowword"), Err(PartError::Outside));
        assert_eq!(named(VarType::Long, "bit32"), Err(PartError::Outside));
        for modifier in ["", "byte", "lowlong", "bits", "low", "highsbyte", "byte99999999999"] {
            assert_eq!(named(VarType::Long, modifier), Err(PartError::Unknown), "{modifier}");
        }
    }

    #[test]
    fn a_store_keeps_the_low_bits() {
        assert_eq!(VarType::Byte.keep(0x1FF), 0xFF);
        assert_eq!(VarType::SByte.keep(0x180), (-128i32) as u32);
        assert_eq!(VarType::SWord.keep(0x1_8000), (-32768i32) as u32);
        assert_eq!(VarType::Nib.keep(0x12), 2);
        assert_eq!(VarType::Word.range(), Some((0, 65_535)));
        assert_eq!(VarType::SLong.range(), Some((-2_147_483_648, 2_147_483_647)));
    }
}
