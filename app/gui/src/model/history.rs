//! What happened to a controller: every indicator that came or went, armings, disarmings, stops and losses, with times and
//! counts.
//!
//! Times are counted from the connection. The list survives the end of a link, so that one can read why it ended; it is
//! bounded and can be cleared.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::time::Duration;

use brushwork_link::device::{DisarmReason, Event, Identity, StatusReport, StopReport};

use crate::family::{self, ActiveIndicator, Family};
use crate::messages::NameMessage;
use crate::model::indicator::IndicatorState;
use crate::model::messages::HistoryMessage;

/// Entries kept; the oldest go first.
pub const KEPT: usize = 2000;

/// The history of one link.
#[derive(Debug, Default)]
pub struct History {
    entries: VecDeque<Entry>,
    /// Entries that had to go.
    pub dropped: u64,
    next_number: u64,
    counts: BTreeMap<Kind, u32>,
    units: BTreeMap<u8, UnitState>,
    connected_at: Option<Duration>,
    /// By the link's clock, as last looked at.
    now: Duration,
    /// Between connecting and the end of the link.
    is_open: bool,
}

/// One thing that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Counts up over the whole history.
    pub number: u64,
    /// Time since the connection.
    pub at: Duration,
    /// Where the unit is, where it is about one: "0x80"; else empty.
    pub place: String,
    pub kind: Kind,
    pub text: String,
}

/// What kind of thing happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    Came(ActiveIndicator),
    Went(ActiveIndicator),
    Connected,
    Armed,
    Disarmed { by_fault: bool },
    ArmRefused,
    Stopped { confirmed: bool },
    Failed,
    Lost,
    Closed,
}

impl Kind {
    /// How it is marked.
    pub fn state(self) -> IndicatorState {
        match self {
            Self::Came(indicator) => indicator.state,
            Self::Disarmed { by_fault: true } | Self::Stopped { confirmed: false } | Self::Lost => {
                IndicatorState::Error
            }
            Self::Armed | Self::ArmRefused | Self::Failed => IndicatorState::Warning,
            Self::Went(_) | Self::Connected => IndicatorState::Ok,
            Self::Disarmed { by_fault: false } | Self::Stopped { confirmed: true } | Self::Closed => {
                IndicatorState::Active
            }
        }
    }

    /// What is counted under this name; none for what is not worth counting.
    fn counted_as(self) -> Option<String> {
        Some(match self {
            Self::Came(indicator) => indicator.title.to_owned(),
            Self::Disarmed { by_fault: true } => "Disarmed by a fault".to_owned(),
            Self::Disarmed { by_fault: false } => "Disarmed".to_owned(),
            Self::ArmRefused => "Arming refused".to_owned(),
            Self::Stopped { confirmed: true } => "Stopped".to_owned(),
            Self::Stopped { confirmed: false } => "Stop not confirmed".to_owned(),
            Self::Failed => "Something failed".to_owned(),
            Self::Lost => "Link lost".to_owned(),
            Self::Went(_) | Self::Connected | Self::Armed | Self::Closed => return None,
        })
    }
}

/// What is so with one unit, and since when.
#[derive(Debug, Default)]
struct UnitState {
    identity: Option<Identity>,
    /// What its status word said last.
    active: BTreeSet<ActiveIndicator>,
    report: Option<StatusReport>,
    /// Homed or at a limit by its pins, where the status word has no bit for it.
    homed: Option<[bool; 2]>,
    indicators: BTreeMap<&'static str, (IndicatorState, Duration)>,
}

impl UnitState {
    fn family(&self) -> &'static dyn Family {
        self.identity.as_ref().map_or_else(family::first, |identity| family::of(identity.family))
    }
}

impl History {
    /// The newest first.
    pub fn entries(&self) -> impl ExactSizeIterator<Item = &Entry> {
        self.entries.iter().rev()
    }

    /// The entry so many places from the newest.
    pub fn from_newest(&self, index: usize) -> Option<&Entry> {
        self.entries.get(self.entries.len().checked_sub(index + 1)?)
    }

    pub fn len(&self) -> usize {
        self.entries.len()
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// How often each kind of thing happened since the history was cleared: its state, its name, its count.
    pub fn counts(&self) -> impl Iterator<Item = (IndicatorState, String, u32)> {
        let named = |(kind, count): (&Kind, &u32)| Some((kind.state(), kind.counted_as()?, *count));
        self.counts.iter().filter_map(named)
    }

    /// Time since the connection, while there is one.
    pub fn connected_for(&self) -> Option<Duration> {
        self.connected_at.filter(|_| self.is_open).map(|at| self.now.saturating_sub(at))
    }

    /// Since when a unit's indicator is as it is, as time since the connection.
    pub fn indicator_since(&self, address: u8, short: &str) -> Option<Duration> {
        let unit = self.units.get(&address).filter(|_| self.is_open)?;
        Some(unit.indicators.get(short)?.1)
    }

    /// Forgets what happened; what is so now stays known.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.counts.clear();
        self.dropped = 0;
    }

    /// The link's clock goes on.
    pub fn tick(&mut self, now: Duration) {
        self.now = now;
    }

    /// Takes note of an event of the link.
    pub fn note(&mut self, event: &Event) {
        match event {
            Event::Connected(identity) => {
                if !self.is_open {
                    self.is_open = true;
                    self.connected_at = Some(self.now);
                    self.units.clear();
                }
                let unit = self.units.entry(identity.address).or_default();
                unit.identity = Some(identity.clone());
                let text = HistoryMessage::Connected {
                    unit: identity.title().to_string(),
                    port: identity.port.clone(),
                }
                .to_string();
                self.push(self.now, Some(identity.address), Kind::Connected, text);
            }
            Event::Status(report) => self.note_status(report),
            Event::Armed { address, scope, .. } => {
                let identity = self.units.get(address).and_then(|unit| unit.identity.as_ref());
                let scope = identity.map_or_else(
                    || scope.to_string(),
                    |identity| family::armed_text(family::of(identity.family), *scope),
                );
                let text = NameMessage::ArmedFor { scope }.to_string();
                self.push(self.now, Some(*address), Kind::Armed, text);
            }
            Event::Disarmed(reason) => {
                let by_fault = matches!(
                    reason,
                    DisarmReason::Fault(_)
                        | DisarmReason::Restarted
                        | DisarmReason::NoAnswer
                        | DisarmReason::NotTogether
                        | DisarmReason::LinkLost
                        | DisarmReason::DeadMan
                );
                self.push(self.now, None, Kind::Disarmed { by_fault }, reason.to_string());
            }
            Event::ArmRefused { reasons, .. } => {
                let text = reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
                self.push(self.now, None, Kind::ArmRefused, text);
            }
            Event::Stopped(report) => self.note_stop(report),
            Event::Failure(failure) => self.push(self.now, None, Kind::Failed, failure.to_string()),
            Event::Lost(failure) => {
                self.push(self.now, None, Kind::Lost, failure.to_string());
                self.is_open = false;
            }
            Event::Closed => {
                self.push(self.now, None, Kind::Closed, "Disconnected".to_owned());
                self.is_open = false;
            }
            // What is asked, measured and answered all the time is no moment to remember.
            Event::Searching { .. }
            | Event::Moved { .. }
            | Event::Selected { .. }
            | Event::Sample(_)
            | Event::Driven { .. }
            | Event::Transacted { .. }
            | Event::RawReply { .. }
            | Event::ProgramStarted { .. }
            | Event::LoaderEntered
            | Event::JobStarted { .. }
            | Event::JobProgress { .. }
            | Event::JobEnded(_)
            | Event::Capabilities { .. }
            | Event::Link(_)
            | Event::Traffic { .. } => {}
        }
    }

    /// What a unit's pins say of its home and limit switches, where the status word has no bit for them.
    pub fn note_homed(&mut self, address: u8, homed: [bool; 2]) {
        let unit = self.units.entry(address).or_default();
        let before = unit.homed.replace(homed).unwrap_or_default();
        let indicators = unit.family().home_indicators().into_iter().flatten();
        for (index, indicator) in indicators.enumerate() {
            if before[index] != homed[index] {
                self.changed(address, indicator, homed[index], self.now);
            }
        }
        self.update_indicators(address, self.now);
    }

    fn note_status(&mut self, report: &StatusReport) {
        let unit = self.units.entry(report.address).or_default();
        let active: BTreeSet<_> = unit.family().active(report, unit.identity.as_ref()).into_iter().collect();
        let before = std::mem::replace(&mut unit.active, active.clone());
        unit.report = Some(*report);
        for indicator in before.symmetric_difference(&active) {
            self.changed(report.address, *indicator, active.contains(indicator), report.at);
        }
        self.update_indicators(report.address, report.at);
    }

    fn changed(&mut self, address: u8, indicator: ActiveIndicator, came: bool, at: Duration) {
        let (kind, word) =
            if came { (Kind::Came(indicator), "came") } else { (Kind::Went(indicator), "went") };
        self.push(at, Some(address), kind, format!("{} {word}", indicator.title));
    }

    fn update_indicators(&mut self, address: u8, at: Duration) {
        let since = self.since_connect(at);
        let Some(unit) = self.units.get_mut(&address) else { return };
        let Some(report) = &unit.report else { return };
        let family = unit.family();
        let states = family.lit_since(report, unit.identity.as_ref(), unit.homed);
        for (info, state) in family.indicators().iter().zip(states) {
            let known = unit.indicators.entry(info.short).or_insert((state, since));
            if known.0 != state {
                *known = (state, since);
            }
        }
    }

    fn note_stop(&mut self, report: &StopReport) {
        let confirmed = report.confirmed();
        let latency_ms = report.latency().as_secs_f64() * 1000.0;
        let mut text = HistoryMessage::Stopped { latency_ms }.to_string();
        text += if confirmed { "confirmed" } else { "NOT confirmed" };
        for unit in &report.units {
            for driver in &unit.still_driven_by {
                text += &format!(". {}: {driver}", self.place(unit.address));
            }
        }
        self.push(report.requested_at, None, Kind::Stopped { confirmed }, text);
    }

    fn push(&mut self, at: Duration, address: Option<u8>, kind: Kind, text: String) {
        if self.entries.len() == KEPT {
            self.entries.pop_front();
            self.dropped += 1;
        }
        *self.counts.entry(kind).or_default() += 1;
        let place = address.map_or_else(String::new, |address| self.place(address));
        let entry = Entry { number: self.next_number, at: self.since_connect(at), place, kind, text };
        self.next_number += 1;
        self.entries.push_back(entry);
    }

    /// Where a unit is, as its family writes it.
    fn place(&self, address: u8) -> String {
        let known = self.units.get(&address).and_then(|unit| unit.identity.as_ref());
        known.map_or_else(|| format!("0x{address:02X}"), Identity::place)
    }

    fn since_connect(&self, at: Duration) -> Duration {
        self.connected_at.map_or(Duration::ZERO, |connected_at| at.saturating_sub(connected_at))
    }
}

/// A time as hours, minutes and seconds with tenths: "0:01:23.4".
pub fn clock_text(time: Duration) -> String {
    let tenths = time.as_millis() / 100;
    let (seconds, tenth) = (tenths / 10, tenths % 10);
    format!("{}:{:02}:{:02}.{tenth}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::Failure;
    use brushwork_link::Message;
    use brushwork_link::messages::{ActMessage, CauseMessage};
    use brushwork_mcp_client::indicators::indicators;
    use brushwork_mcp_wire::packet_serial::Generation;
    use brushwork_mcp_wire::packet_serial::status::{Condition, encode};

    fn report(at_s: u64, conditions: &[Condition]) -> Event {
        let word = encode(conditions.iter().copied().collect(), Generation::Gen1);
        Event::Status(StatusReport::new(0x80, Duration::from_secs(at_s), word, indicators(Generation::Gen1)))
    }

    fn texts(history: &History) -> Vec<&str> {
        history.entries().map(|entry| entry.text.as_str()).collect()
    }

    #[test]
    fn conditions_come_and_go_with_their_times_and_are_counted() {
        let mut history =
            History { is_open: true, connected_at: Some(Duration::from_secs(100)), ..History::default() };
        history.note(&report(101, &[]));
        history.note(&report(110, &[Condition::EStop]));
        history.note(&report(111, &[Condition::EStop, Condition::Temperature1Warning]));
        history.note(&report(130, &[Condition::Temperature1Warning]));
        history.note(&report(140, &[Condition::EStop]));
        assert_eq!(
            texts(&history),
            [
                "Temperature warning went",
                "E-Stop came",
                "E-Stop went",
                "Temperature warning came",
                "E-Stop came"
            ]
        );
        assert_eq!(history.from_newest(2).unwrap().at, Duration::from_secs(30));
        let counts: Vec<(String, u32)> = history.counts().map(|(_, name, count)| (name, count)).collect();
        assert_eq!(counts, [("E-Stop".to_owned(), 2), ("Temperature warning".to_owned(), 1)]);
        assert_eq!(history.indicator_since(0x80, "ESTP"), Some(Duration::from_secs(40)));
        assert_eq!(history.indicator_since(0x80, "TMP2"), Some(Duration::from_secs(1)));
        history.clear();
        assert!(history.is_empty() && history.counts().next().is_none());
        assert_eq!(history.indicator_since(0x80, "ESTP"), Some(Duration::from_secs(40)));
    }

    #[test]
    fn a_home_switch_that_only_the_pins_know_comes_and_goes_too() {
        let mut history = History { is_open: true, connected_at: Some(Duration::ZERO), ..History::default() };
        history.note(&report(1, &[]));
        history.tick(Duration::from_secs(5));
        history.note_homed(0x80, [false, true]);
        history.note_homed(0x80, [false, true]);
        assert_eq!(texts(&history), ["M2 home came"]);
        assert_eq!(history.indicator_since(0x80, "M2HM"), Some(Duration::from_secs(5)));
    }

    #[test]
    fn the_history_is_bounded_and_says_how_much_is_gone() {
        let mut history = History::default();
        for number in 0..KEPT + 50 {
            let came_back = CauseMessage::StopUnconfirmed { seconds: number as u64 };
            history.note(&Event::Failure(Failure::new(
                ActMessage::Move,
                "0x80",
                came_back,
                Message::default(),
            )));
        }
        assert_eq!((history.len(), history.dropped), (KEPT, 50));
        assert_eq!(history.counts().next().map(|(.., count)| count), Some(KEPT as u32 + 50));
    }

    #[test]
    fn times_read_as_clocks_do() {
        assert_eq!(clock_text(Duration::from_millis(83_456)), "0:01:23.4");
        assert_eq!(clock_text(Duration::from_secs(36_000)), "10:00:00.0");
    }
}
