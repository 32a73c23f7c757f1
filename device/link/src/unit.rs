//! How a unit is named whatever its family: its address on the bus, and the generation of its firmware.
//!
//! The families' own types are narrower; these are what settings, profiles and screens carry.

use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_motion_mind_wire as motion_mind;
use serde::{Serialize, Serializer};
use std::fmt;

/// The address of one unit. Those of packet serial and of the Motion Mind have no number in common, so the number tells the
/// family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct UnitAddress(u8);

impl UnitAddress {
    /// The factory setting of the MCP and RoboClaw controllers, 0x80.
    pub const DEFAULT: Self = Self(Address::DEFAULT.get());

    /// The unit of that number: 0 to 98 is a Motion Mind, 0x80 to 0x87 an MCP or RoboClaw; `None` is no unit's.
    #[must_use]
    pub fn new(number: u8) -> Option<Self> {
        (Address::new(number).is_some() || motion_mind::Address::unit(number).is_some())
            .then_some(Self(number))
    }

    /// The number on the wire.
    #[must_use]
    pub fn get(self) -> u8 {
        self.0
    }

    /// The address as packet serial has it; `None` for units of other families.
    #[must_use]
    pub fn packets(self) -> Option<Address> {
        Address::new(self.0)
    }

    /// The address as it is written in files and on the command line: "0x80", or "1" for a Motion Mind.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let number = match text.strip_prefix("0x").or(text.strip_prefix("0X")) {
            Some(hex) => u8::from_str_radix(hex, 16).ok()?,
            None => text.parse().ok()?,
        };
        Self::new(number)
    }
}

impl Default for UnitAddress {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl From<Address> for UnitAddress {
    fn from(address: Address) -> Self {
        Self(address.get())
    }
}

impl PartialEq<Address> for UnitAddress {
    fn eq(&self, other: &Address) -> bool {
        self.0 == other.get()
    }
}

impl Serialize for UnitAddress {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.0)
    }
}

impl fmt::Display for UnitAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.packets() {
            Some(address) => address.fmt(f),
            None => write!(f, "{}", self.0),
        }
    }
}

/// What decides which commands and settings a unit has: the generation of packet serial, or the REVISION of a Motion Mind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FirmwareGeneration {
    /// One of the four of packet serial.
    PacketSerial(Generation),
    /// Register 17 of a Motion Mind.
    MotionMind {
        /// As it was read.
        revision: u8,
    },
}

impl FirmwareGeneration {
    /// Its number: 1 to 4, or the revision.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::PacketSerial(generation) => generation.number(),
            Self::MotionMind { revision } => revision,
        }
    }

    /// The generation of packet serial; `None` for other families.
    #[must_use]
    pub fn packet_serial(self) -> Option<Generation> {
        match self {
            Self::PacketSerial(generation) => Some(generation),
            Self::MotionMind { .. } => None,
        }
    }

    /// The generation whose layouts packets have. Only for code that speaks packet serial and nothing else; another family's
    /// unit would get those of the first.
    #[must_use]
    pub fn layout(self) -> Generation {
        self.packet_serial().unwrap_or(Generation::Gen1)
    }
}

impl From<Generation> for FirmwareGeneration {
    fn from(generation: Generation) -> Self {
        Self::PacketSerial(generation)
    }
}

impl PartialEq<Generation> for FirmwareGeneration {
    fn eq(&self, other: &Generation) -> bool {
        self.packet_serial() == Some(*other)
    }
}

impl fmt::Display for FirmwareGeneration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PacketSerial(generation) => generation.fmt(f),
            Self::MotionMind { revision } => write!(f, "revision {revision}"),
        }
    }
}

/// As the generation of packet serial always was written; a revision stands as its number.
impl Serialize for FirmwareGeneration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::PacketSerial(generation) => generation.serialize(serializer),
            Self::MotionMind { revision } => serializer.serialize_u8(*revision),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_written_as_its_family_writes_it_and_read_again() {
        for (number, text) in [(0x80, "0x80"), (0x87, "0x87"), (1, "1"), (98, "98")] {
            let address = UnitAddress::new(number).unwrap();
            assert_eq!(address.to_string(), text);
            assert_eq!(UnitAddress::parse(text), Some(address));
        }
        for number in [99, 127, 0x88, 255] {
            assert_eq!(UnitAddress::new(number), None, "{number} is a broadcast, or nobody's");
        }
    }
}
