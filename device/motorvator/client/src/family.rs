//! The family by name: the one model, and the two halves of a board as its units.
//!
//! A board has no address. It has four motor outputs, in pairs: A and B, which stepper 1 takes too, and C and D, or stepper 2. Each pair is a
//! unit here, so that what drives two motors drives them all.

use brushwork_link::device::Identity;
use brushwork_link::family::{Family, FamilyRef, Model};
use brushwork_link::settings::Subject;
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_values::Motor;
use std::sync::LazyLock;

/// MotorVator boards.
pub const MOTORVATOR: FamilyRef = FamilyRef::new(&MotorvatorV3);

#[derive(Debug)]
struct MotorvatorV3;

/// Name as printed.
pub const NAME: &str = "MotorVator V3";
/// The version of the manual.
pub const VERSION: u8 = 3;

static MODELS: LazyLock<Vec<Model>> = LazyLock::new(|| {
    vec![Model {
        key: "motorvator-3",
        name: NAME,
        rating: "4 motors or 2 steppers",
        family: MOTORVATOR,
        pins: Vec::new(),
        streams: 0,
        douts: 0,
    }]
});

/// Half of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// Motors A and B, or stepper 1.
    First,
    /// Motors C and D, or stepper 2.
    Second,
}

impl Half {
    /// Both.
    pub const ALL: [Self; 2] = [Self::First, Self::Second];

    /// Its number, which is that of its stepper.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::First => 1,
            Self::Second => 2,
        }
    }

    /// The half of this number.
    #[must_use]
    pub fn of(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|half| half.number() == number)
    }

    /// The number of a motor on the board, 1 to 4.
    #[must_use]
    pub fn motor(self, motor: Motor) -> u8 {
        match (self, motor) {
            (Self::First, Motor::M1) => 1,
            (Self::First, Motor::M2) => 2,
            (Self::Second, Motor::M1) => 3,
            (Self::Second, Motor::M2) => 4,
        }
    }

    /// What hangs on it: "A and B".
    #[must_use]
    pub fn letters(self) -> &'static str {
        match self {
            Self::First => "A and B",
            Self::Second => "C and D",
        }
    }
}

impl Family for MotorvatorV3 {
    fn key(&self) -> &'static str {
        "motorvator"
    }

    fn label(&self) -> &'static str {
        "MotorVator"
    }

    fn default_baud(&self) -> u32 {
        brushwork_motorvator_wire::BITS_PER_SECOND
    }

    fn models(&self) -> &'static [Model] {
        &MODELS
    }

    fn model(&self, name: &str) -> Option<&'static Model> {
        MODELS
            .iter()
            .find(|model| [model.key, model.name].iter().any(|known| known.eq_ignore_ascii_case(name)))
    }

    fn identify(&self, version_text: &str) -> Option<&'static Model> {
        let begins = version_text.trim().to_ascii_lowercase().starts_with(&NAME.to_ascii_lowercase());
        MODELS.first().filter(|_| begins)
    }

    fn has_address(&self, number: u8) -> bool {
        Half::of(number).is_some()
    }

    fn addresses(&self) -> &'static str {
        "1 (motors A and B) and 2 (C and D)"
    }

    fn factory_address(&self) -> u8 {
        Half::First.number()
    }

    fn check_generation(&self, number: i64) -> Result<u8, &'static str> {
        u8::try_from(number).ok().filter(|number| *number == VERSION).ok_or("is no MotorVator; there is V3")
    }

    fn generation_text(&self, number: u8) -> String {
        format!("V{number}")
    }

    fn facts_key(&self) -> Option<&'static str> {
        Some("motorvator")
    }
}

/// The firmware of the manual.
#[must_use]
pub fn firmware() -> FirmwareGeneration {
    FirmwareGeneration::new(MOTORVATOR, VERSION)
}

/// Half a board as shared code names it.
#[must_use]
pub fn unit_address(half: Half) -> UnitAddress {
    UnitAddress::new(MOTORVATOR, half.number()).unwrap_or(UnitAddress::factory(MOTORVATOR))
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
pub fn is_motorvator(identity: &Identity) -> bool {
    identity.family == MOTORVATOR
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_motors_of_a_board_are_those_of_its_halves() {
        let motors = Half::ALL.map(|half| Motor::BOTH.map(|motor| half.motor(motor)));
        assert_eq!(motors, [[1, 2], [3, 4]]);
        assert_eq!(Half::of(2), Some(Half::Second));
        assert_eq!(Half::of(0), None);
        assert_eq!(unit_address(Half::Second).get(), 2);
        assert_eq!(MOTORVATOR.identify("MotorVator V3").map(|model| model.key), Some("motorvator-3"));
    }
}
