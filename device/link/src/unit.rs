//! How a unit is named whatever its family: its address on the bus, and the number of its firmware.
//!
//! The families' own types are narrower; these are what settings, profiles and screens carry.

use crate::family::{FamilyRef, families};
use serde::{Serialize, Serializer};
use std::fmt;

/// The address of one unit: its family, and its number there. The numbers of two families may be the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct UnitAddress {
    family: FamilyRef,
    number: u8,
}

impl UnitAddress {
    /// The unit of that number; `None` if no unit of the family can have it.
    #[must_use]
    pub fn new(family: FamilyRef, number: u8) -> Option<Self> {
        family.has_address(number).then_some(Self { family, number })
    }

    /// That of a unit as it comes from the factory.
    #[must_use]
    pub fn factory(family: FamilyRef) -> Self {
        Self { family, number: family.factory_address() }
    }

    /// The unit's family.
    #[must_use]
    pub fn family(self) -> FamilyRef {
        self.family
    }

    /// The number on the wire.
    #[must_use]
    pub fn get(self) -> u8 {
        self.number
    }

    /// The address as the family writes it in files and on the command line.
    #[must_use]
    pub fn parse(family: FamilyRef, text: &str) -> Option<Self> {
        Self::new(family, family.address_named(text)?)
    }
}

/// The number of a unit as it is typed, if a unit of any family can have it.
#[must_use]
pub fn parse_number(text: &str) -> Option<u8> {
    let named = families().iter().filter_map(|family| UnitAddress::parse(*family, text));
    named.map(UnitAddress::get).next()
}

impl Serialize for UnitAddress {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.number)
    }
}

impl fmt::Display for UnitAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.family.address_text(self.number))
    }
}

/// What decides which commands and settings a unit has, as a number that means something to its family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FirmwareGeneration {
    family: FamilyRef,
    number: u8,
}

impl FirmwareGeneration {
    /// The firmware of that number.
    #[must_use]
    pub const fn new(family: FamilyRef, number: u8) -> Self {
        Self { family, number }
    }

    /// The family whose number it is.
    #[must_use]
    pub fn family(self) -> FamilyRef {
        self.family
    }

    /// Its number.
    #[must_use]
    pub fn number(self) -> u8 {
        self.number
    }
}

impl fmt::Display for FirmwareGeneration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.family.generation_text(self.number))
    }
}

/// As its number.
impl Serialize for FirmwareGeneration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.number)
    }
}
