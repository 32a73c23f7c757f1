//! What is known of every unit of a link, the one that is looked at and the others: for the row that each has in the list.

use std::collections::BTreeMap;
use std::time::Duration;

use brushwork_link::device::{Channel, Event, Newest, StatusReport};

use super::indicator::{IndicatorState, state_of};

/// A unit of which nothing came for so long while others answered is said to be silent. With many units each has its turn later.
const SILENT_AFTER: Duration = Duration::from_secs(5);
const TURN_OF_EACH: Duration = Duration::from_secs(1);

/// What a row shows, in the order in which it does.
const FIGURES: [(&str, Channel); 5] = [
    ("", Channel::MAIN_BATTERY),
    ("M1 ", Channel::M1_CURRENT),
    ("M2 ", Channel::M2_CURRENT),
    ("", Channel::TEMPERATURE_1),
    ("logic ", Channel::LOGIC_BATTERY),
];

/// The units by their addresses.
#[derive(Debug, Default)]
pub struct Boards(BTreeMap<u8, Board>);

#[derive(Debug, Default)]
struct Board {
    newest: Newest,
    status: Option<StatusReport>,
    heard_at: Duration,
}

impl Boards {
    /// Takes over what an event tells of any unit.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn note(&mut self, event: &Event) {
        match event {
            Event::Sample(sample) => {
                let board = self.0.entry(sample.address).or_default();
                board.newest.update(sample);
                board.heard_at = board.heard_at.max(sample.replied_at);
            }
            Event::Status(status) => {
                let board = self.0.entry(status.address).or_default();
                board.status = Some(*status);
                board.heard_at = board.heard_at.max(status.at);
            }
            Event::Moved { from } => {
                self.0.remove(from);
            }
            _ => {}
        }
    }

    /// Battery, currents and temperature of a unit, as far as they were read: "24.0 V  M1 0.10 A".
    pub fn figures(&self, address: u8) -> String {
        let Some(board) = self.0.get(&address) else { return String::new() };
        let figure = |(name, channel): (&str, Channel)| {
            let digits = if channel.unit == "A" { 2 } else { 1 };
            Some(format!("{name}{:.digits$} {}", board.newest.get(channel)?, channel.unit))
        };
        FIGURES.into_iter().filter_map(figure).collect::<Vec<_>>().join("  ")
    }

    /// How a unit is: what it reports, or that nothing is heard of it.
    pub fn state(&self, address: u8) -> (IndicatorState, String) {
        let Some(board) = self.0.get(&address) else {
            return (IndicatorState::Unknown, "not heard yet".to_owned());
        };
        let newest = self.0.values().map(|board| board.heard_at).max().unwrap_or_default();
        let turns = u32::try_from(self.0.len()).unwrap_or(u32::MAX);
        if newest > board.heard_at + SILENT_AFTER + TURN_OF_EACH * turns {
            return (IndicatorState::Error, "does not answer".to_owned());
        }
        let Some(status) = &board.status else {
            return (IndicatorState::Unknown, "tells no status".to_owned());
        };
        let worst = status.active().map(|indicator| state_of(indicator.severity)).max();
        let titles: Vec<&str> = status.active().map(|indicator| indicator.title).collect();
        match worst {
            None => (IndicatorState::Ok, "OK".to_owned()),
            Some(worst) => (worst, titles.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use brushwork_link::device::Sample;

    use super::*;

    fn heard(boards: &mut Boards, address: u8, at_s: u64) {
        let at = Duration::from_secs(at_s);
        let mut sample = Sample::new(address);
        sample.set(Channel::MAIN_BATTERY, 24.0, at, at);
        boards.note(&Event::Sample(Box::new(sample)));
    }

    #[test]
    fn a_unit_is_silent_when_others_are_heard_long_after_it() {
        let mut boards = Boards::default();
        assert_eq!(boards.state(0x80).0, IndicatorState::Unknown);
        heard(&mut boards, 0x80, 1);
        heard(&mut boards, 0x81, 1);
        heard(&mut boards, 0x81, 8);
        assert_ne!(boards.state(0x80).1, "does not answer", "two units have 7 s");
        heard(&mut boards, 0x81, 9);
        assert_eq!(boards.state(0x80), (IndicatorState::Error, "does not answer".to_owned()));
        assert_eq!(boards.figures(0x80), "24.0 V", "what was read last stays");
        boards.note(&Event::Moved { from: 0x80 });
        assert_eq!(boards.figures(0x80), "");
    }
}
