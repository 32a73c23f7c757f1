//! The variables of a running program: bytes, in which bits and nibbles have places too. A place outside reads as 0 and takes nothing;
//! compiled programs have none.

use crate::mcl::types::VarType;
use crate::op::{Array, Cell};

/// Memory of a machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    bytes: Vec<u8>,
}

impl Memory {
    /// Zeroed memory.
    #[must_use]
    pub fn new(bytes: u32) -> Self {
        Self::of(vec![0; bytes as usize])
    }

    /// Memory that holds these bytes.
    #[must_use]
    pub fn of(bytes: Vec<u8>) -> Self {
        Self { bytes }
    }

    /// Sets everything to zero.
    pub fn clear(&mut self) {
        self.bytes.fill(0);
    }

    /// Every byte, as it is.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// So many bytes from this one on, as far as there are any.
    #[must_use]
    pub fn slice(&self, first: u32, count: u32) -> &[u8] {
        let from = (first as usize).min(self.bytes.len());
        &self.bytes[from..from.saturating_add(count as usize).min(self.bytes.len())]
    }

    /// Stores bytes from this one on, as far as there is room.
    pub fn put(&mut self, first: u32, bytes: &[u8]) {
        let from = (first as usize).min(self.bytes.len());
        let count = bytes.len().min(self.bytes.len() - from);
        self.bytes[from..from + count].copy_from_slice(&bytes[..count]);
    }

    /// The value at a place, its sign spread.
    #[must_use]
    pub fn load(&self, cell: Cell) -> u32 {
        let at = (cell.at / 8) as usize;
        let byte = || u32::from(self.bytes.get(at).copied().unwrap_or(0));
        match cell.kind {
            VarType::Bit | VarType::Nib => cell.kind.keep(byte() >> (cell.at % 8)),
            VarType::Byte => byte(),
            VarType::SByte => cell.kind.keep(byte()),
            VarType::Word => wide::<2>(&self.bytes, at),
            VarType::SWord => cell.kind.keep(wide::<2>(&self.bytes, at)),
            VarType::Long | VarType::SLong | VarType::Float => wide::<4>(&self.bytes, at),
        }
    }

    /// Stores the low bits of a value at a place.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn store(&mut self, cell: Cell, value: u32) {
        let at = (cell.at / 8) as usize;
        let low = value.to_le_bytes();
        match cell.kind {
            VarType::Bit | VarType::Nib => {
                let mask = ((1u16 << cell.kind.bits()) - 1) as u8;
                let shift = cell.at % 8;
                if let Some(byte) = self.bytes.get_mut(at) {
                    *byte = *byte & !(mask << shift) | (low[0] & mask) << shift;
                }
            }
            kind => {
                let length = (kind.bits() / 8) as usize;
                if let Some(place) = self.bytes.get_mut(at..at + length) {
                    place.copy_from_slice(&low[..length]);
                }
            }
        }
    }
}

fn wide<const N: usize>(bytes: &[u8], at: usize) -> u32 {
    let mut wide = [0; 4];
    if let Some(bytes) = bytes.get(at..at + N) {
        wide[..N].copy_from_slice(bytes);
    }
    u32::from_le_bytes(wide)
}

/// The place of an element; `None` outside the array.
#[must_use]
pub fn element(array: Array, index: u32) -> Option<Cell> {
    let inside = index < array.length;
    inside.then(|| Cell { kind: array.first.kind, at: array.first.at + index * array.stride })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(kind: VarType, at: u32) -> Cell {
        Cell { kind, at }
    }

    #[test]
    fn parts_of_a_long_are_its_bytes_from_the_lowest() {
        let mut memory = Memory::new(4);
        memory.store(cell(VarType::Long, 0), 0x8765_43F1);
        assert_eq!(memory.load(cell(VarType::Byte, 8)), 0x43);
        assert_eq!(memory.load(cell(VarType::SByte, 0)), (-15i32) as u32);
        assert_eq!(memory.load(cell(VarType::Word, 16)), 0x8765);
        assert_eq!(memory.load(cell(VarType::SWord, 16)), 0xFFFF_8765);
        assert_eq!(memory.load(cell(VarType::Nib, 4)), 0xF);
        assert_eq!(memory.load(cell(VarType::Bit, 31)), 1);
        memory.store(cell(VarType::Nib, 4), 0xA2);
        memory.store(cell(VarType::Bit, 31), 0);
        assert_eq!(memory.load(cell(VarType::Long, 0)), 0x0765_4321);
    }

    #[test]
    fn outside_there_is_nothing() {
        let mut memory = Memory::new(1);
        memory.store(cell(VarType::Long, 0), 7);
        memory.store(cell(VarType::Bit, 800), 1);
        assert_eq!(memory.bytes(), [0]);
        assert_eq!(memory.load(cell(VarType::Long, 64)), 0);
    }
}
