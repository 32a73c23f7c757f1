//! The family by name: addresses, models, revisions of firmware.

use brushwork_link::device::Identity;
use brushwork_link::family::{Family, FamilyRef, Model};
use brushwork_link::settings::Subject;
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_motion_mind_wire::Address;
use std::sync::LazyLock;

/// Motion Mind 3 controllers.
pub const MOTION_MIND: FamilyRef = FamilyRef::new(&MotionMind3);

#[derive(Debug)]
struct MotionMind3;

/// Name as printed, and what a unit's version text begins with.
pub const NAME: &str = "Motion Mind 3";

/// The one controller of the family (Motion Mind manual 3.1).
static MODELS: LazyLock<Vec<Model>> = LazyLock::new(|| {
    vec![Model {
        key: "motion-mind-3",
        name: NAME,
        rating: "1x9A",
        family: MOTION_MIND,
        pins: Vec::new(),
        streams: 0,
        douts: 0,
    }]
});

impl Family for MotionMind3 {
    fn key(&self) -> &'static str {
        "motion-mind"
    }

    fn label(&self) -> &'static str {
        "Motion Mind"
    }

    /// With switch 5 off, which chooses 9600 or 19200.
    fn default_baud(&self) -> u32 {
        19_200
    }

    fn models(&self) -> &'static [Model] {
        &MODELS
    }

    fn has_address(&self, number: u8) -> bool {
        Address::unit(number).is_some()
    }

    fn addresses(&self) -> &'static str {
        "0 to 98"
    }

    fn factory_address(&self) -> u8 {
        Address::FACTORY.get()
    }

    fn check_generation(&self, number: i64) -> Result<u8, &'static str> {
        u8::try_from(number).map_err(|_| "is no revision of firmware; there are 0 to 255")
    }

    fn generation_text(&self, number: u8) -> String {
        format!("revision {number}")
    }

    fn may_be_elsewhere(&self) -> Option<&'static str> {
        Some(
            "For a Motion Mind at another address than 1 choose its family (family=motion-mind), so that all are asked",
        )
    }

    fn facts_key(&self) -> Option<&'static str> {
        Some("motion_mind")
    }
}

/// The firmware of that REVISION, register 17.
#[must_use]
pub fn firmware_of(revision: u8) -> FirmwareGeneration {
    FirmwareGeneration::new(MOTION_MIND, revision)
}

/// A unit as shared code names it; `None` for a broadcast.
#[must_use]
pub fn unit_address(number: u8) -> Option<UnitAddress> {
    UnitAddress::new(MOTION_MIND, number)
}

/// What a settings table is made for.
///
/// # Panics
/// Never: the family has a model.
#[must_use]
pub fn subject(revision: u8) -> Subject {
    Subject::new(MODELS.first().expect("the family has a model"), firmware_of(revision))
}

/// Whether a unit is one.
#[must_use]
pub fn is_motion_mind(identity: &Identity) -> bool {
    identity.family == MOTION_MIND
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_written_as_a_number_and_no_unit_has_that_of_a_broadcast() {
        for (number, text) in [(1, "1"), (98, "98")] {
            let address = unit_address(number).unwrap();
            assert_eq!(address.to_string(), text);
            assert_eq!(UnitAddress::parse(MOTION_MIND, text), Some(address));
        }
        for number in [99, 127, 0x80, 255] {
            assert_eq!(unit_address(number), None, "{number} is a broadcast, or nobody's");
        }
    }

    #[test]
    fn a_unit_is_known_by_what_it_calls_itself() {
        assert_eq!(
            MOTION_MIND.identify("Motion Mind 3 revision 7").map(|model| model.key),
            Some("motion-mind-3")
        );
        assert!(MOTION_MIND.identify("MCP266 2x60A v1.0.0").is_none());
    }
}
