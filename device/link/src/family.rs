//! A family of controllers by its names, addresses and models, and the list of those that this program has.

use brushwork_values::parse_byte;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

/// A family of controllers: its names, addresses and models.
pub trait Family: Send + Sync {
    /// Name on the command line and in files, in lower case.
    fn key(&self) -> &'static str;

    /// Name for people.
    fn label(&self) -> &'static str;

    /// Baud rate of a serial port when none is given.
    fn default_baud(&self) -> u32;

    /// The models that are known, as files and settings name them.
    fn models(&self) -> &'static [Model];

    /// The model with this key or printed name, whatever its case; there may be models beyond [`Family::models`], for boards that no manual lists.
    fn model(&self, name: &str) -> Option<&'static Model> {
        let is_it = |model: &&Model| [model.key, model.name].iter().any(|own| own.eq_ignore_ascii_case(name));
        self.models().iter().find(is_it)
    }

    /// The model of a unit that calls itself so: that whose printed name the text begins with.
    fn identify(&self, version_text: &str) -> Option<&'static Model> {
        let text = version_text.trim().to_ascii_lowercase();
        self.models().iter().find(|model| text.starts_with(&model.name.to_ascii_lowercase()))
    }

    /// Whether a unit can have this address.
    fn has_address(&self, number: u8) -> bool;

    /// The addresses that units can have, for sentences: "0x80 to 0x87".
    fn addresses(&self) -> &'static str;

    /// The address of a unit as it comes from the factory.
    fn factory_address(&self) -> u8;

    /// An address as it is written in files and on the command line.
    fn address_text(&self, number: u8) -> String {
        number.to_string()
    }

    /// The number of an address as it is written in files and on the command line, decimal or hexadecimal, whether a unit can have it or not.
    fn address_named(&self, text: &str) -> Option<u8> {
        parse_byte(text)
    }

    /// Whether there is firmware of this number, and if not, why, as a clause: "is no firmware generation; there are 1 to 4".
    fn check_generation(&self, number: i64) -> Result<u8, &'static str>;

    /// A firmware's number in words: "generation 1".
    fn generation_text(&self, number: u8) -> String;

    /// Whether its units can be nodes of a CAN bus.
    fn is_on_can_buses(&self) -> bool {
        false
    }

    /// What a USB device of this product name is, if it is the family's.
    fn usb_product(&self, _name: &str) -> Option<UsbProduct> {
        None
    }

    /// What to do when no family was found on a line, if this one could be there all the same: a sentence without its full stop.
    fn may_be_elsewhere(&self) -> Option<&'static str> {
        None
    }

    /// The member under which a unit's own facts stand in JSON; `None` for a family that has none to tell.
    fn facts_key(&self) -> Option<&'static str> {
        None
    }
}

/// What hangs on a USB port, as its name tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UsbProduct {
    /// A controller.
    Controller,
    /// A controller that waits for firmware.
    Loader,
}

/// A model as settings and files name it. What else its family knows of it, the family finds by the key.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name in command lines and files: lower case, no spaces.
    pub key: &'static str,
    /// Name as printed on the board.
    pub name: &'static str,
    /// Its current channels as on the label, e.g. "2x60A".
    pub rating: &'static str,
    /// Its family.
    pub family: FamilyRef,
    /// Labels of its configurable input pins.
    pub pins: Vec<&'static str>,
    /// How many serial streams it has that can be configured.
    pub streams: usize,
    /// How many digital outputs it has that can be configured.
    pub douts: usize,
}

impl PartialEq for Model {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

/// A family, compared by its key.
#[derive(Clone, Copy)]
pub struct FamilyRef(&'static dyn Family);

impl FamilyRef {
    /// The handle of a family object.
    #[must_use]
    pub const fn new(family: &'static dyn Family) -> Self {
        Self(family)
    }
}

impl std::ops::Deref for FamilyRef {
    type Target = dyn Family;

    fn deref(&self) -> &Self::Target {
        self.0
    }
}

impl PartialEq for FamilyRef {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for FamilyRef {}

impl std::hash::Hash for FamilyRef {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl fmt::Debug for FamilyRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}

static FAMILIES: OnceLock<Vec<FamilyRef>> = OnceLock::new();

/// Sets the families that this program has, once.
pub(crate) fn list(families: Vec<FamilyRef>) {
    // A second list is that of another test.
    let _ = FAMILIES.set(families);
}

/// The families that this program has.
#[must_use]
pub fn families() -> &'static [FamilyRef] {
    FAMILIES.get().map_or(&[], Vec::as_slice)
}

/// The addresses that units of each family can have, for sentences: "MCP or RoboClaw at 0x80 to 0x87, Motion Mind at 0 to 98".
#[must_use]
pub fn addresses_text() -> String {
    let each = families().iter().map(|family| format!("{} at {}", family.label(), family.addresses()));
    each.collect::<Vec<_>>().join(", ")
}

/// The model with this key or printed name, whatever its case, in any family.
#[must_use]
pub fn model_named(name: &str) -> Option<&'static Model> {
    families().iter().find_map(|family| family.model(name))
}

/// The family that a user chooses for a link, or leaves to be found out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FamilyChoice(Option<FamilyRef>);

impl FamilyChoice {
    /// Each family is looked for, in the order of the list.
    pub const AUTO: Self = Self(None);

    /// One family.
    #[must_use]
    pub const fn of(family: FamilyRef) -> Self {
        Self(Some(family))
    }

    /// The family that was chosen; `None` is to be found out.
    #[must_use]
    pub fn family(self) -> Option<FamilyRef> {
        self.0
    }

    /// All choices there are, to be found out first.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::AUTO).chain(families().iter().copied().map(Self::of))
    }

    /// Name on the command line and in files.
    #[must_use]
    pub fn key(self) -> &'static str {
        self.0.map_or("auto", |family| family.key())
    }

    /// Name for people.
    #[must_use]
    pub fn label(self) -> &'static str {
        self.0.map_or("Find out", |family| family.label())
    }

    /// Baud rate of a serial port when none is given: that of the first family where none is chosen.
    #[must_use]
    pub fn default_baud(self) -> u32 {
        self.0.or(families().first().copied()).map_or(UNKNOWN_BAUD, |family| family.default_baud())
    }
}

/// Of a program without any family.
const UNKNOWN_BAUD: u32 = 9600;

impl fmt::Display for FamilyChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}

impl FromStr for FamilyChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::all().find(|choice| choice.key().eq_ignore_ascii_case(text));
        found.ok_or_else(|| {
            let mut keys: Vec<_> = Self::all().map(Self::key).collect();
            let last = keys.pop().unwrap_or_default();
            format!("\"{text}\" is no protocol family. Use {} or {last}", keys.join(", "))
        })
    }
}

impl Serialize for FamilyChoice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

impl<'de> Deserialize<'de> for FamilyChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}
