//! The family by name: addresses, and the one model.

use brushwork_link::device::Identity;
use brushwork_link::family::{Family, FamilyRef, Model};
use brushwork_link::settings::Subject;
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_suprmotr_wire::Address;
use brushwork_values::parse_byte;
use std::sync::LazyLock;

/// SuprMotr controllers.
pub const SUPRMOTR: FamilyRef = FamilyRef::new(&SuprMotrV9);

#[derive(Debug)]
struct SuprMotrV9;

/// Name as printed, and what a unit's version text begins with.
pub const NAME: &str = "SuprMotr V9";
/// The version of the manual; a unit is not asked for its own, since a line would end a running macro.
pub const VERSION: u8 = 9;

static MODELS: LazyLock<Vec<Model>> = LazyLock::new(|| {
    vec![Model {
        key: "suprmotr-v9",
        name: NAME,
        rating: "1x1A",
        family: SUPRMOTR,
        pins: Vec::new(),
        streams: 0,
        douts: 0,
    }]
});

impl Family for SuprMotrV9 {
    fn key(&self) -> &'static str {
        "suprmotr"
    }

    fn label(&self) -> &'static str {
        "SuprMotr"
    }

    fn default_baud(&self) -> u32 {
        9600
    }

    fn models(&self) -> &'static [Model] {
        &MODELS
    }

    fn has_address(&self, number: u8) -> bool {
        Address::new(number).is_some()
    }

    fn addresses(&self) -> &'static str {
        "0 to F"
    }

    fn factory_address(&self) -> u8 {
        Address::FACTORY.get()
    }

    fn address_text(&self, number: u8) -> String {
        Address::new(number)
            .map_or_else(|| number.to_string(), |address| char::from(address.character()).to_string())
    }

    fn address_named(&self, text: &str) -> Option<u8> {
        let [character] = text.as_bytes() else { return parse_byte(text) };
        Address::from_character(*character).map(Address::get)
    }

    fn check_generation(&self, number: i64) -> Result<u8, &'static str> {
        u8::try_from(number).ok().filter(|number| *number == VERSION).ok_or("is no SuprMotr; there is V9")
    }

    fn generation_text(&self, number: u8) -> String {
        format!("V{number}")
    }

    fn facts_key(&self) -> Option<&'static str> {
        Some("suprmotr")
    }
}

/// The firmware of the manual.
#[must_use]
pub fn firmware() -> FirmwareGeneration {
    FirmwareGeneration::new(SUPRMOTR, VERSION)
}

/// A unit as shared code names it.
#[must_use]
pub fn unit_address(number: u8) -> Option<UnitAddress> {
    UnitAddress::new(SUPRMOTR, number)
}

/// What a settings table is made for.
///
/// # Panics
/// Never: the family has a model.
#[must_use]
pub fn subject() -> Subject {
    Subject::new(MODELS.first().expect("the family has a model"), firmware())
}

/// Whether a unit is one.
#[must_use]
pub fn is_suprmotr(identity: &Identity) -> bool {
    identity.family == SUPRMOTR
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_written_as_its_character_and_read_as_that_or_a_number() {
        for (text, number) in [("0", 0), ("9", 9), ("a", 10), ("F", 15), ("10", 10), ("0x0C", 12)] {
            let address = UnitAddress::parse(SUPRMOTR, text).unwrap();
            assert_eq!(address.get(), number, "{text}");
            assert_eq!(address.to_string(), format!("{number:X}"));
        }
        for text in ["G", "16", "V", ""] {
            assert_eq!(UnitAddress::parse(SUPRMOTR, text), None, "{text}");
        }
    }

    #[test]
    fn a_unit_is_known_by_what_it_calls_itself() {
        assert_eq!(SUPRMOTR.identify("SuprMotr V9").map(|model| model.key), Some("suprmotr-v9"));
        assert!(SUPRMOTR.identify("Motion Mind 3 revision 7").is_none());
    }
}
