//! Which controllers of a line listen (SuprMotr manual, "Address Selection").

use std::fmt;

use crate::characters::SELECT;
use serde::{Deserialize, Serialize};

/// The address of one controller, 0 to 15: on the wire one character, `0` to `9` and `A` to `F`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct Address(u8);

/// The number is no controller's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{0} is no address of a SuprMotr; there are 0 to 15, written 0 to F")]
pub struct InvalidAddress(pub u8);

/// What the character behind Ctrl-A chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Selection {
    /// One controller; all others no longer listen.
    Unit(Address),
    /// Every controller of the line, until the next selection. No report may be asked for then.
    All,
    /// The address of nobody: no controller listens.
    Nobody(u8),
}

impl Address {
    /// Every address, lowest first.
    pub const ALL: [Self; 16] = {
        let mut all = [Self(0); 16];
        let mut number = 0;
        while number < 16 {
            all[number as usize] = Self(number);
            number += 1;
        }
        all
    };
    /// Assumed: what a controller answers to when it leaves the factory. The manual's examples have it.
    pub const FACTORY: Self = Self(0);

    /// The address of that number, 0 to 15.
    pub const fn new(number: u8) -> Option<Self> {
        if number < 16 { Some(Self(number)) } else { None }
    }

    /// Its number.
    pub const fn get(self) -> u8 {
        self.0
    }

    /// The character on the wire, a capital from ten on.
    pub const fn character(self) -> u8 {
        if self.0 < 10 { b'0' + self.0 } else { b'A' + self.0 - 10 }
    }

    /// The address that a character stands for, in either case.
    pub const fn from_character(character: u8) -> Option<Self> {
        match character {
            b'0'..=b'9' => Some(Self(character - b'0')),
            b'A'..=b'F' => Some(Self(character - b'A' + 10)),
            b'a'..=b'f' => Some(Self(character - b'a' + 10)),
            _ => None,
        }
    }
}

impl TryFrom<u8> for Address {
    type Error = InvalidAddress;

    fn try_from(number: u8) -> Result<Self, Self::Error> {
        Self::new(number).ok_or(InvalidAddress(number))
    }
}

impl From<Address> for u8 {
    fn from(address: Address) -> Self {
        address.0
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unit {}", char::from(self.character()))
    }
}

impl Selection {
    const ALL_UNITS: u8 = b'V';

    /// What the character behind Ctrl-A chooses.
    pub const fn from_character(character: u8) -> Self {
        match Address::from_character(character) {
            Some(address) => Self::Unit(address),
            None if character.eq_ignore_ascii_case(&Self::ALL_UNITS) => Self::All,
            None => Self::Nobody(character),
        }
    }

    /// The character behind Ctrl-A.
    pub const fn character(self) -> u8 {
        match self {
            Self::Unit(address) => address.character(),
            Self::All => Self::ALL_UNITS,
            Self::Nobody(character) => character,
        }
    }

    /// The two bytes that select. No carriage return follows them: it would repeat the last line.
    pub const fn bytes(self) -> [u8; 2] {
        [SELECT, self.character()]
    }

    /// Whether the controller of that address listens from now on.
    pub fn selects(self, address: Address) -> bool {
        match self {
            Self::Unit(selected) => selected == address,
            Self::All => true,
            Self::Nobody(_) => false,
        }
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unit(address) => address.fmt(f),
            Self::All => f.write_str("all units"),
            Self::Nobody(character) => write!(f, "no unit ({character:02X})"),
        }
    }
}
