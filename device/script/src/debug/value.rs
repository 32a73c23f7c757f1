//! Values as a person reads them.

use crate::mcl::types::VarType;
use crate::vm::digits;
use serde::{Deserialize, Serialize};

/// A value, or those of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Value {
    /// The type of each.
    pub kind: VarType,
    /// The cells.
    pub cells: Vec<u32>,
    /// Whether it is an array.
    pub is_array: bool,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Show {
    /// As the type says: decimal with its sign, or with a point.
    #[default]
    Decimal,
    /// `0x00ff`.
    Hex,
    /// `%00001111`.
    Binary,
    /// Characters in quotes.
    Text,
}

/// Elements of an array that are written out.
const WRITTEN: usize = 256;

impl Show {
    /// Every form.
    pub const ALL: [Self; 4] = [Self::Decimal, Self::Hex, Self::Binary, Self::Text];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Decimal => "Decimal",
            Self::Hex => "Hex",
            Self::Binary => "Binary",
            Self::Text => "Text",
        }
    }
}

impl Value {
    /// A single value.
    #[must_use]
    pub fn single(kind: VarType, cell: u32) -> Self {
        Self { kind, cells: vec![cell], is_array: false }
    }

    /// The value as text.
    #[must_use]
    pub fn text(&self, show: Show) -> String {
        match (&self.cells[..], self.is_array) {
            ([cell], false) => one(self.kind, *cell, show),
            (cells, _) if show == Show::Text => quoted(cells),
            (cells, _) => {
                let mut text: Vec<String> =
                    cells.iter().take(WRITTEN).map(|cell| one(self.kind, *cell, show)).collect();
                if cells.len() > WRITTEN {
                    text.push(format!("… {} more", cells.len() - WRITTEN));
                }
                format!("[{}]", text.join(", "))
            }
        }
    }
}

/// One cell as text.
#[must_use]
pub fn one(kind: VarType, cell: u32, show: Show) -> String {
    let bits = kind.bits();
    let kept = u64::from(cell) & ((1 << bits) - 1);
    match (show, kind) {
        (Show::Hex, _) => format!("0x{kept:0width$x}", width = bits.div_ceil(4) as usize),
        (Show::Binary, _) => format!("%{kept:0width$b}", width = bits as usize),
        (Show::Text, _) => quoted(&[cell]),
        (Show::Decimal, VarType::Float) => digits::real(f32::from_bits(cell), 0, u32::MAX),
        (Show::Decimal, kind) if kind.is_signed() => (cell as i32).to_string(),
        (Show::Decimal, _) => cell.to_string(),
    }
}

/// Bytes as characters, up to a zero that only zeros follow.
fn quoted(cells: &[u32]) -> String {
    let end = cells.iter().rposition(|cell| *cell != 0).map_or(0, |last| last + 1);
    let mut text = String::from("\"");
    for cell in &cells[..end] {
        match (*cell & 0xFF) as u8 {
            b'"' => text.push_str("\\\""),
            b'\\' => text.push_str("\\\\"),
            b'\r' => text.push_str("\\r"),
            b'\n' => text.push_str("\\n"),
            b'\t' => text.push_str("\\t"),
            byte @ 0x20..=0x7E => text.push(char::from(byte)),
            byte => text.push_str(&format!("\\x{byte:02x}")),
        }
    }
    text.push('"');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_writes_a_cell_by_its_type() {
        assert_eq!(one(VarType::SWord, (-2i32) as u32, Show::Decimal), "-2");
        assert_eq!(one(VarType::SWord, (-2i32) as u32, Show::Hex), "0xfffe");
        assert_eq!(one(VarType::Byte, 5, Show::Binary), "%00000101");
        assert_eq!(one(VarType::Long, u32::MAX, Show::Decimal), "4294967295");
        assert_eq!(one(VarType::Float, 1.5f32.to_bits(), Show::Decimal), "1.5");
        assert_eq!(one(VarType::Bit, 1, Show::Hex), "0x1");
        assert_eq!(one(VarType::Byte, 65, Show::Text), "\"A\"");
    }

    #[test]
    fn arrays_are_lists_or_texts() {
        let cells = b"Hi\r\0\0".iter().copied().map(u32::from).collect();
        let value = Value { kind: VarType::Byte, cells, is_array: true };
        assert_eq!(value.text(Show::Text), "\"Hi\\r\"");
        assert_eq!(value.text(Show::Decimal), "[72, 105, 13, 0, 0]");
        let long = Value { kind: VarType::Byte, cells: vec![0; 300], is_array: true };
        assert!(long.text(Show::Decimal).ends_with("… 44 more]"));
    }
}
