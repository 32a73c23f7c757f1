//! A CAN frame, as controllers and adapters pass it on.

use std::fmt;

/// Identifier of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CanId {
    /// Eleven bits.
    Standard(u16),
    /// Twenty-nine bits.
    Extended(u32),
}

impl CanId {
    /// Highest identifier of eleven bits.
    pub const MAX_STANDARD: u16 = 0x7FF;
    /// Highest identifier of twenty-nine bits.
    pub const MAX_EXTENDED: u32 = 0x1FFF_FFFF;

    /// An identifier of eleven bits.
    #[must_use]
    pub const fn standard(id: u16) -> Option<Self> {
        if id <= Self::MAX_STANDARD { Some(Self::Standard(id)) } else { None }
    }

    /// An identifier of twenty-nine bits.
    #[must_use]
    pub const fn extended(id: u32) -> Option<Self> {
        if id <= Self::MAX_EXTENDED { Some(Self::Extended(id)) } else { None }
    }
}

impl fmt::Display for CanId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Standard(id) => write!(f, "{id:03X}"),
            Self::Extended(id) => write!(f, "{id:08X}"),
        }
    }
}

/// A frame with at most eight bytes of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    id: CanId,
    remote: bool,
    length: u8,
    data: [u8; 8],
}

impl Frame {
    /// A frame that carries data; `None` for more than eight bytes.
    #[must_use]
    pub fn data(id: CanId, bytes: &[u8]) -> Option<Self> {
        let mut data = [0; 8];
        data.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(Self { id, remote: false, length: bytes.len() as u8, data })
    }

    /// A frame of eight bytes, as SDO has them.
    #[must_use]
    pub fn full(id: CanId, data: [u8; 8]) -> Self {
        Self { id, remote: false, length: 8, data }
    }

    /// A request for the frame of this identifier; `None` for a length above eight.
    #[must_use]
    pub fn remote(id: CanId, length: u8) -> Option<Self> {
        (length <= 8).then_some(Self { id, remote: true, length, data: [0; 8] })
    }

    /// Its identifier.
    #[must_use]
    pub fn id(&self) -> CanId {
        self.id
    }

    /// Whether it asks for data instead of carrying it.
    #[must_use]
    pub fn is_remote(&self) -> bool {
        self.remote
    }

    /// Its length field, 0 to 8.
    #[must_use]
    pub fn length(&self) -> u8 {
        self.length
    }

    /// Its data; none in a request.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        if self.remote { &[] } else { &self.data[..usize::from(self.length)] }
    }

    /// Bits on the bus, without stuffing: frame fields, data, interframe space (CAN 2.0).
    #[must_use]
    pub fn bits(&self) -> u32 {
        let around = match self.id {
            CanId::Standard(_) => 47,
            CanId::Extended(_) => 67,
        };
        around + 8 * self.bytes().len() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_and_lengths_out_of_range_make_no_frame() {
        assert_eq!(CanId::standard(0x800), None);
        assert_eq!(CanId::extended(0x2000_0000), None);
        let id = CanId::Standard(0x601);
        assert_eq!(Frame::data(id, &[0; 9]), None);
        assert_eq!(Frame::remote(id, 9), None);
        assert_eq!(Frame::data(id, &[1, 2]).unwrap().bytes(), [1, 2]);
        assert!(Frame::remote(id, 8).unwrap().bytes().is_empty());
    }

    #[test]
    fn a_full_standard_frame_has_111_bits() {
        assert_eq!(Frame::full(CanId::Standard(1), [0; 8]).bits(), 111);
    }
}
