//! Which unit of a bus a command is for.

use std::fmt;
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

/// The address in a command: a unit, or every unit at once (Motion Mind manual 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct Address(u8);

/// The number names every unit of the bus, not one of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{0} addresses every unit at once; a unit has an address from 0 to {last}", last = Address::LAST_UNIT)]
pub struct InvalidAddress(pub u8);

impl Address {
    /// Addresses worth scanning: the ones that both protocols can write and that name one unit.
    pub const UNITS: RangeInclusive<u8> = 1..=Self::LAST_UNIT;
    /// Every unit listens to it and none answers.
    pub const BROADCAST: Self = Self(99);
    /// What a unit answers to when it leaves the factory.
    pub const FACTORY: Self = Self(1);
    const LAST_UNIT: u8 = 98;

    /// The address of one unit, 0 to 98.
    pub fn unit(number: u8) -> Option<Self> {
        (number <= Self::LAST_UNIT).then_some(Self(number))
    }

    /// An address as it came over the wire: from 99 on it is a broadcast.
    pub fn from_wire(number: u8) -> Self {
        Self(number)
    }

    /// The number on the wire.
    pub fn get(self) -> u8 {
        self.0
    }

    /// Whether every unit executes the command and none answers.
    pub fn is_broadcast(self) -> bool {
        self.0 > Self::LAST_UNIT
    }
}

impl TryFrom<u8> for Address {
    type Error = InvalidAddress;

    fn try_from(number: u8) -> Result<Self, Self::Error> {
        Self::unit(number).ok_or(InvalidAddress(number))
    }
}

impl From<Address> for u8 {
    fn from(address: Address) -> Self {
        address.0
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_broadcast() { f.write_str("all units") } else { write!(f, "unit {}", self.0) }
    }
}
