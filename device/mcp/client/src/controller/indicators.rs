//! The conditions of a status word as indicators, by generation, and the places of the status row that combine them.

use brushwork_link::device::{Indicator, PlaceState, StatusPlace, StatusReport};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_mcp_wire::packet_serial::status::{CONDITIONS, Conditions, StatusIndicator};
use brushwork_values::Severity;

static BY_GENERATION: [[Indicator; CONDITIONS.len()]; 4] =
    [of(Generation::Gen1), of(Generation::Gen2), of(Generation::Gen3), of(Generation::Gen4)];

const fn of(generation: Generation) -> [Indicator; CONDITIONS.len()] {
    let none = Indicator { key: "", short: "", title: "", severity: Severity::Signal, mask: 0 };
    let mut indicators = [none; CONDITIONS.len()];
    let mut index = 0;
    while index < indicators.len() {
        let row = &CONDITIONS[index];
        let short = match row.indicator {
            Some(place) => place.abbreviation(),
            None => "",
        };
        indicators[index] = Indicator {
            key: row.key,
            short,
            title: row.title,
            severity: row.severity,
            mask: row.mask(generation),
        };
        index += 1;
    }
    indicators
}

/// What the bits of a status word mean in a generation, in the order of the table of conditions.
#[must_use]
pub fn indicators(generation: Generation) -> &'static [Indicator] {
    &BY_GENERATION[usize::from(generation.number()) - 1]
}

/// The conditions that a report tells.
#[must_use]
pub fn conditions(report: &StatusReport) -> Conditions {
    let rows = CONDITIONS.iter().filter(|row| report.is_active(row.key));
    rows.map(|row| row.condition).collect()
}

/// The thirteen places of the status row. Where the word has no bits for home and limit switches, their places go by what the
/// pins say, if that is known.
#[must_use]
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn status_row(
    report: Option<&StatusReport>,
    generation: Generation,
    is_mcp: bool,
    homed: Option<[bool; 2]>,
) -> Vec<StatusPlace> {
    let by_pins = |place: StatusIndicator| match place {
        StatusIndicator::M1Home => homed.map(|homed| homed[0]),
        StatusIndicator::M2Home => homed.map(|homed| homed[1]),
        _ => None,
    };
    let state = |place: StatusIndicator| {
        let Some(report) = report else { return PlaceState::Unknown };
        match (place.lit_by(conditions(report)), by_pins(place)) {
            (Some(severity), _) => PlaceState::Active(severity),
            (None, Some(true)) => PlaceState::Active(Severity::Signal),
            (None, Some(false)) => PlaceState::Clear,
            (None, None) if place.is_reported(generation, is_mcp) => PlaceState::Clear,
            (None, None) => PlaceState::NotReported,
        }
    };
    let place = |place: StatusIndicator| StatusPlace {
        short: place.abbreviation(),
        title: place.title(),
        state: state(place),
    };
    StatusIndicator::ALL.into_iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::packet_serial::status::{decode, unknown_bits};
    use std::time::Duration;

    #[test]
    fn every_word_is_active_as_the_table_of_conditions_decodes_it() {
        for generation in Generation::ALL {
            for word in (0..32).map(|bit| 1 << bit).chain([0, u32::MAX, 0x1004]) {
                let report = StatusReport::new(0x80, Duration::ZERO, word, indicators(generation));
                assert_eq!(conditions(&report), decode(word, generation));
                let known = report.active().fold(0, |known, indicator| known | indicator.mask);
                assert_eq!(word & !known, unknown_bits(word, generation));
            }
        }
    }
}
