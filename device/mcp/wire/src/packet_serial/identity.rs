//! Who speaks: the address of a unit and the generation of its firmware.

use std::fmt;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A family of firmware that uses the same widths. The manual is generation 1; see [`Form`](super::Form).
///
/// Nothing on the wire names the generation: a client finds it by the length of replies.
/// Source: public clients of 2015 (1), 2016-2017 (2, weakest evidence), 2018-2020 (3) and 2025 (4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub enum Generation {
    /// The manual's own, and the vendor's library of 2015.
    Gen1,
    /// The vendor's library of 2016-2017.
    Gen2,
    /// The vendor's library of 2018-2020 and the RoboClaw manual of 2018.
    Gen3,
    /// The vendor's libraries of 2025.
    Gen4,
}

impl Generation {
    /// All four, oldest first.
    pub const ALL: [Self; 4] = [Self::Gen1, Self::Gen2, Self::Gen3, Self::Gen4];

    /// 1 to 4.
    pub const fn number(self) -> u8 {
        match self {
            Self::Gen1 => 1,
            Self::Gen2 => 2,
            Self::Gen3 => 3,
            Self::Gen4 => 4,
        }
    }

    /// The generation with this number; `None` outside 1 to 4.
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            1 => Some(Self::Gen1),
            2 => Some(Self::Gen2),
            3 => Some(Self::Gen3),
            4 => Some(Self::Gen4),
            _ => None,
        }
    }
}

impl fmt::Display for Generation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "generation {}", self.number())
    }
}

/// A number that is no firmware generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("there is no firmware generation {number}: generations are 1 to 4")]
pub struct InvalidGeneration {
    /// The number given.
    pub number: u8,
}

impl TryFrom<u8> for Generation {
    type Error = InvalidGeneration;

    fn try_from(number: u8) -> Result<Self, InvalidGeneration> {
        Self::from_number(number).ok_or(InvalidGeneration { number })
    }
}

impl From<Generation> for u8 {
    fn from(generation: Generation) -> Self {
        generation.number()
    }
}

/// The address of a unit on the wire, 0x80 to 0x87 (MCP manual 2.2.2). Over USB a unit answers all eight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct Address(u8);

impl Address {
    /// The lowest, 0x80.
    pub const FIRST: Self = Self(0x80);
    /// The highest, 0x87.
    pub const LAST: Self = Self(0x87);
    /// The factory setting, 0x80.
    pub const DEFAULT: Self = Self::FIRST;
    /// All eight, lowest first.
    pub const ALL: [Self; 8] =
        [Self(0x80), Self(0x81), Self(0x82), Self(0x83), Self(0x84), Self(0x85), Self(0x86), Self(0x87)];

    /// The address with this byte; `None` outside 0x80 to 0x87.
    pub const fn new(byte: u8) -> Option<Self> {
        if byte >= Self::FIRST.0 && byte <= Self::LAST.0 { Some(Self(byte)) } else { None }
    }

    /// The byte on the wire.
    pub const fn get(self) -> u8 {
        self.0
    }

    /// 0 for 0x80 to 7 for 0x87.
    pub const fn index(self) -> usize {
        (self.0 - Self::FIRST.0) as usize
    }
}

impl Default for Address {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "0x{:02X}", self.0)
    }
}

/// A byte that is no address of packet serial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("0x{byte:02X} is no packet serial address: addresses are 0x80 to 0x87")]
pub struct InvalidAddress {
    /// The byte given.
    pub byte: u8,
}

impl TryFrom<u8> for Address {
    type Error = InvalidAddress;

    fn try_from(byte: u8) -> Result<Self, InvalidAddress> {
        Self::new(byte).ok_or(InvalidAddress { byte })
    }
}

impl From<Address> for u8 {
    fn from(address: Address) -> Self {
        address.get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exactly_the_eight_bytes_from_0x80_are_addresses() {
        for byte in 0..=255 {
            assert_eq!(Address::new(byte).is_some(), (0x80..=0x87).contains(&byte));
            assert_eq!(Address::new(byte).map(Address::get), Address::try_from(byte).ok().map(u8::from));
        }
        assert_eq!(Address::ALL.map(Address::index), [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(Address::DEFAULT.to_string(), "0x80");
    }

    #[test]
    fn generations_are_numbered_one_to_four_in_order() {
        assert_eq!(Generation::ALL.map(Generation::number), [1, 2, 3, 4]);
        for number in 0..=255 {
            assert_eq!(
                Generation::from_number(number).map(Generation::number),
                (1..=4).contains(&number).then_some(number)
            );
        }
        assert!(Generation::Gen1 < Generation::Gen4);
        assert_eq!(Generation::Gen3.to_string(), "generation 3");
    }
}
