//! The variables of a running program: bytes, in which bits and nibbles have places too. A place outside reads as 0 and takes nothing;
//! compiled programs have none.

use crate::mcl::types::VarType;
use crate::op::{Array, Cell};

/// Memory of a machine.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    bytes: Vec<u8>,
    /// Bytes of variables; what is behind them is the machine's own.
    visible: usize,
}

impl PartialEq for Memory {
    fn eq(&self, other: &Self) -> bool {
        self.bytes() == other.bytes()
    }
}

impl Eq for Memory {}

impl Memory {
    /// Zeroed memory.
    #[must_use]
    pub fn new(bytes: u32) -> Self {
        Self::of(vec![0; bytes as usize])
    }

    /// Zeroed memory with cells behind it that only the machine sees, filled up to [`SPAN`].
    pub(super) fn with_hidden(bytes: u32, cells: impl IntoIterator<Item = u32>) -> Self {
        let visible = bytes as usize;
        let mut bytes = vec![0; visible];
        bytes.extend(cells.into_iter().flat_map(u32::to_le_bytes));
        bytes.resize(SPAN.max(bytes.len()), 0);
        Self { bytes, visible }
    }

    /// Every byte, hidden ones included; `None` if it has none, as memory that was lent.
    pub(super) fn all(&mut self) -> Option<&mut [u8; SPAN]> {
        self.bytes.as_mut_slice().try_into().ok()
    }

    fn seen(&mut self) -> &mut [u8] {
        &mut self.bytes[..self.visible]
    }

    /// Memory that holds these bytes.
    #[must_use]
    pub fn of(bytes: Vec<u8>) -> Self {
        Self { visible: bytes.len(), bytes }
    }

    /// Sets everything to zero.
    pub fn clear(&mut self) {
        self.seen().fill(0);
    }

    /// Every byte, as it is.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.visible]
    }

    /// The value at a place, its sign spread.
    #[must_use]
    pub fn load(&self, cell: Cell) -> u32 {
        load(self.bytes(), cell)
    }

    /// Stores the low bits of a value at a place.
    pub fn store(&mut self, cell: Cell, value: u32) {
        store(self.seen(), cell, value);
    }
}

/// Bytes of memory with hidden cells: as many as let a place of 16 bits be used without looking whether it is inside.
pub(super) const SPAN: usize = u16::MAX as usize + 4;

/// The 32 bits at a byte.
#[inline(always)]
pub(super) fn cell(bytes: &[u8; SPAN], at: u16) -> u32 {
    let at = usize::from(at);
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

/// Sets the 32 bits at a byte.
#[inline(always)]
pub(super) fn set_cell(bytes: &mut [u8; SPAN], at: u16, value: u32) {
    let at = usize::from(at);
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

/// The value at a place, its sign spread.
#[inline]
pub(super) fn load(bytes: &[u8], cell: Cell) -> u32 {
    let at = (cell.at / 8) as usize;
    let byte = || u32::from(bytes.get(at).copied().unwrap_or(0));
    match cell.kind {
        VarType::Bit | VarType::Nib => cell.kind.keep(byte() >> (cell.at % 8)),
        VarType::Byte => byte(),
        VarType::SByte => cell.kind.keep(byte()),
        VarType::Word => wide::<2>(bytes, at),
        VarType::SWord => cell.kind.keep(wide::<2>(bytes, at)),
        VarType::Long | VarType::SLong | VarType::Float => wide::<4>(bytes, at),
    }
}

fn wide<const N: usize>(bytes: &[u8], at: usize) -> u32 {
    let mut wide = [0; 4];
    if let Some(bytes) = bytes.get(at..at + N) {
        wide[..N].copy_from_slice(bytes);
    }
    u32::from_le_bytes(wide)
}

/// Stores the low bits of a value at a place.
#[inline]
pub(super) fn store(bytes: &mut [u8], cell: Cell, value: u32) {
    let at = (cell.at / 8) as usize;
    let low = value.to_le_bytes();
    match cell.kind {
        VarType::Bit | VarType::Nib => {
            let mask = ((1u16 << cell.kind.bits()) - 1) as u8;
            let shift = cell.at % 8;
            if let Some(byte) = bytes.get_mut(at) {
                *byte = *byte & !(mask << shift) | (low[0] & mask) << shift;
            }
        }
        kind => {
            let length = (kind.bits() / 8) as usize;
            if let Some(place) = bytes.get_mut(at..at + length) {
                place.copy_from_slice(&low[..length]);
            }
        }
    }
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
