//! The registers of the loop by the keys of their settings (SuprMotr manual, Define P-Term and those after it).

use super::registers::{MOST_GAIN, SuprMotrHeld, SuprMotrProposal, SuprMotrRegisters};
use brushwork_tuning::registers::{RegisterField, RegisterTable};

const BYTE: (f64, f64) = (0.0, MOST_GAIN);

static FIELDS: [RegisterField; 4] = [
    RegisterField::number("loop.p", "DP", BYTE, "On the distance from the trajectory"),
    RegisterField::number("loop.i", "DI", BYTE, "On the sum of the distances, /256"),
    RegisterField::number("loop.d", "DD", BYTE, "On the change of the distance in one turn of the loop"),
    RegisterField::number(
        "loop.integral_limit",
        "DL",
        BYTE,
        "The most that the integral gives, of 255; 0 switches it off",
    ),
];

/// Where the register of a key is held.
fn place<'r>(of: &'r mut SuprMotrRegisters, key: &str) -> Option<&'r mut u8> {
    match key {
        "loop.p" => Some(&mut of.p),
        "loop.i" => Some(&mut of.i),
        "loop.d" => Some(&mut of.d),
        "loop.integral_limit" => Some(&mut of.integral_limit),
        _ => None,
    }
}

impl RegisterTable for SuprMotrProposal {
    fn fields() -> Vec<&'static RegisterField> {
        FIELDS.iter().collect()
    }

    fn raw(&self, key: &str) -> Option<i64> {
        place(&mut self.suprmotr?, key).map(|byte| i64::from(*byte))
    }

    fn set_raw(&mut self, key: &str, raw: i64) {
        if let Some(byte) = self.suprmotr.as_mut().and_then(|registers| place(registers, key)) {
            // Held to the width of the register.
            *byte = raw.clamp(0, 0xFF) as u8;
        }
    }

    fn blank(_with_position: bool) -> Self {
        Self { suprmotr: Some(SuprMotrRegisters::default()) }
    }

    fn has_a_loop(&self) -> bool {
        self.suprmotr.is_some_and(|registers| registers.p > 0)
    }

    fn is_one_set(&self) -> bool {
        true
    }
}

/// The registers for people: name, held, proposed, and what is on the wire.
pub(super) fn rows(held: &SuprMotrHeld, proposed: &SuprMotrProposal) -> Vec<[String; 4]> {
    let (Some(held), Some(new)) = (held.suprmotr, proposed.suprmotr) else { return Vec::new() };
    let old = SuprMotrProposal { suprmotr: Some(held.registers) };
    let new = SuprMotrProposal { suprmotr: Some(new) };
    let text = |of: &SuprMotrProposal, key: &str| of.raw(key).unwrap_or_default().to_string();
    let row = |field: &RegisterField| {
        [field.label.to_owned(), text(&old, field.key), text(&new, field.key), text(&new, field.key)]
    };
    FIELDS.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_that_are_told_by_key_come_back_and_one_that_is_not_known_leaves_none() {
        let registers = SuprMotrRegisters { p: 75, i: 3, d: 255, integral_limit: 100 };
        let full = SuprMotrProposal { suprmotr: Some(registers) };
        assert_eq!(full.raw("velocity.p"), None);
        assert_eq!(SuprMotrProposal::of_values(&|field| full.raw(field.key), true), Some(full));
        let but_one = |field: &RegisterField| full.raw(field.key).filter(|_| field.key != "loop.d");
        assert_eq!(SuprMotrProposal::of_values(&but_one, true), None);
        let mut held = full;
        held.set_raw("loop.p", 300);
        assert_eq!(held.raw("loop.p"), Some(255), "eight bits");
    }
}
