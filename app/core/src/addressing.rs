//! Giving controllers their addresses, one after the other, so that several can share a line: who is meant, and whether he can have it.
//!
//! Two units with one address answer at once and take a new one at once, so that they could never be told apart again by their line. So
//! nothing is written before one unit alone was found, its replies were sound, and nobody else was at the new address.

use std::time::Duration;

use brushwork_link::settings::plan;
use brushwork_link::{Identity, LinkStatistics, ReadReport, SettingsImage, WriteOptions, families};

/// How long replies are looked at before an address is written.
pub const LOOK: Duration = Duration::from_millis(1200);
/// Of so many replies one may be wrong, or bring a byte too many; with two units that answer together most do.
const WRONG_OF: u64 = 50;

/// Who of a line is to have an address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meant {
    /// This one.
    This(Box<Identity>),
    /// Nobody waits for one.
    Nobody,
    /// More than one waits, at these addresses.
    Several(Vec<u8>),
    /// Somebody else has it already.
    Taken,
}

/// The factory's address last: a new unit has it, and must be alone there, while those before it may stay on the line.
#[must_use]
pub fn in_order(numbers: &[u8]) -> Vec<u8> {
    let (last, mut first): (Vec<u8>, Vec<u8>) = numbers.iter().partition(|number| is_factory(**number));
    first.extend(last);
    first
}

/// Whether units come from the factory with this address.
#[must_use]
pub fn is_factory(number: u8) -> bool {
    families().iter().any(|family| family.factory_address() == number)
}

/// The one unit that is to have the address: the one that is named, or else the only one that has none of those that were given.
#[must_use]
pub fn meant(units: &[Identity], number: u8, named: Option<u8>, given: &[u8]) -> Meant {
    let is_meant = |unit: &&Identity| match named {
        Some(named) => answers_at(unit, named),
        None => !given.contains(&unit.address),
    };
    let meant: Vec<&Identity> = units.iter().filter(is_meant).collect();
    // Over USB one unit answers at every address, and nobody else can be there.
    let is_taken = units.len() > 1 && units.iter().any(|unit| unit.address == number);
    match meant[..] {
        // The last one may wait where it is to stay.
        [unit] if unit.address == number => Meant::This(Box::new(unit.clone())),
        _ if is_taken => Meant::Taken,
        [] => Meant::Nobody,
        [unit] => Meant::This(Box::new(unit.clone())),
        _ => Meant::Several(meant.into_iter().map(|unit| unit.address).collect()),
    }
}

/// Whether a unit answers at an address.
#[must_use]
pub fn answers_at(unit: &Identity, number: u8) -> bool {
    unit.address == number || unit.also_answers.contains(&number)
}

/// Whether the replies of a line are those of one unit: two spoil each other's bytes, or one of them speaks when the other has ended. Replies that
/// came late, over a slow line or on a busy computer, are no sign of a second unit.
#[must_use]
pub fn is_sound(statistics: &LinkStatistics) -> bool {
    let unasked = statistics.stray_bytes.saturating_sub(statistics.late_bytes);
    (statistics.crc_errors + unasked) * WRONG_OF <= statistics.transactions
}

/// The setting that gives a unit the address, by whichever of its family's settings the unit has. `None` where it cannot have it.
#[must_use]
pub fn address_of(ram: &ReadReport, options: WriteOptions, number: u8) -> Option<SettingsImage> {
    let family = ram.table.subject().family();
    let moves = |wanted: &SettingsImage| {
        let plan = plan(&ram.table, &ram.image, wanted, options).ok()?;
        plan.steps.iter().find_map(|step| family.settings().new_address(step)).or(Some(number))
    };
    let rows = family.settings().address_keys().iter().filter_map(|key| ram.table.row(key));
    let values = rows.filter_map(|row| {
        let texts = [family.address_text(number), number.to_string()];
        let value = texts.iter().find_map(|text| row.parse(text).ok())?;
        Some(SettingsImage::from_iter([(row.key.clone(), value)]))
    });
    let mut found = values.into_iter();
    found.find(|wanted| moves(wanted) == Some(number))
}

/// Which of these addresses a unit has by its own settings, wherever it answers besides.
#[must_use]
pub fn held_of(ram: &ReadReport, options: WriteOptions, numbers: &[u8]) -> Option<u8> {
    let holds = |number: &u8| {
        let wanted = address_of(ram, options, *number).unwrap_or_default();
        !wanted.is_empty() && wanted.iter().all(|(key, value)| ram.image.get(key) == Some(value))
    };
    numbers.iter().copied().find(holds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_nobody_asked_for_are_of_a_second_unit_and_late_ones_are_not() {
        let figures = |stray_bytes, late_bytes, crc_errors| LinkStatistics {
            transactions: 100,
            stray_bytes,
            late_bytes,
            crc_errors,
            ..LinkStatistics::default()
        };
        assert!(is_sound(&figures(0, 0, 0)) && is_sound(&figures(40, 40, 0)));
        assert!(!is_sound(&figures(40, 0, 0)) && !is_sound(&figures(40, 20, 0)));
        assert!(!is_sound(&figures(40, 40, 3)), "a checksum is no matter of time");
    }
}
