//! The link as the window sees it: closed, opening, open, closing, and what is known of the controller.
//!
//! Everything here follows from the device thread's events. What an event means for the rest of the window (a
//! sentence to say, a slider to put back to zero) is handed back as [`Effect`]s.

use crate::messages::{LinkStatusMessage, WindowStatusMessage};
use brushwork_core::messages::CoreStatusMessage;
use brushwork_link::capability::CapabilityMap;
use brushwork_link::device::{DisarmReason, StopReport};
use brushwork_link::{
    ArmScope, Channel, Event, Failure, Identity, LinkStatistics, Message, Sample, StatusReport, Stream,
};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::time::Duration;

use super::boards::Boards;
use super::indicators::Indicators;
use super::message::Gravity;
use super::readings::Readings;
use crate::family::{self, Family};
use brushwork_core::motion::check::MotionCheck;
use brushwork_core::stop::{Matter, matters};

/// Whether motors may be moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arming {
    #[default]
    Disarmed,
    /// Asked for; the device thread checks.
    Asked(ArmScope),
    Armed {
        scope: ArmScope,
        /// After how much silence the controller stops by itself.
        controller_timeout: Option<Duration>,
    },
}

impl Arming {
    pub fn is_armed_for(self, wanted: ArmScope) -> bool {
        matches!(self, Self::Armed { scope, .. } if scope == wanted)
    }
}

/// What an event means beyond this module.
#[derive(Debug)]
pub enum Effect {
    Say(Gravity, Message),
    /// Sliders go to zero: nothing may move any more.
    AtRest,
    /// A new sample of the selected unit.
    Sample(Box<Sample>),
    /// Another unit's samples follow.
    OtherUnit,
    /// The link has ended.
    Ended,
}

impl Effect {
    /// Something for the message line.
    pub fn say(gravity: Gravity, text: impl Into<Message>) -> Self {
        Self::Say(gravity, text.into())
    }
}

/// What is known of an open link.
#[derive(Debug, Default)]
pub struct LinkView {
    /// Every unit that answered.
    pub units: Vec<Identity>,
    pub selected: Option<u8>,
    /// Which of the controller's ports this is, where it is known.
    pub stream: Option<Stream>,
    pub readings: Readings,
    pub indicators: Indicators,
    /// Whether the pins hold a motor at a home or limit switch, where they are known.
    homed: Option<[bool; 2]>,
    pub status: Option<StatusReport>,
    /// What is known of each unit, for their list.
    pub boards: Boards,
    pub statistics: LinkStatistics,
    /// How far the search for units is, while there is one.
    pub searching: Option<Search>,
    pub arming: Arming,
    /// Whether motors do what they are told.
    motion: MotionCheck,
    /// Set when the link was lost while armed: after how much silence the controller stops by itself.
    lost_while_armed: Option<Option<Duration>>,
    /// What was said when the link was lost.
    pub(super) lost_because: Option<Message>,
    /// Why arming was refused the last time.
    pub refusals: Vec<Failure>,
    /// What else can drive a motor while something is armed: input pins and scripts, each as a sentence.
    pub warnings: Vec<Message>,
    /// What is known of this place, should nobody answer: an update that did not end.
    pub waiting: Option<Message>,
    /// The address that the selected unit is about to leave for another.
    moved_from: Option<u8>,
    /// The commands that each unit is known to lack, by its address.
    absent: BTreeMap<u8, Vec<u8>>,
}

/// How far the search for units is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Search {
    pub done: usize,
    pub of: usize,
    /// What is asked now.
    pub what: String,
}

/// What is said of a unit that tells no status.
const WITHOUT_STATUS: &str =
    "This controller tells no status: nothing here says whether a fault or a limit holds its motors.";

impl LinkView {
    /// The unit that is looked at.
    pub fn identity(&self) -> Option<&Identity> {
        self.units.iter().find(|unit| Some(unit.address) == self.selected)
    }

    /// The family of the unit that is looked at.
    fn family(&self) -> &'static dyn Family {
        self.identity().map_or_else(family::first, |identity| family::of(identity.family))
    }

    /// Takes over what the pins say of home and limit switches.
    pub fn set_homed(&mut self, homed: Option<[bool; 2]>) {
        if homed == self.homed {
            return;
        }
        self.homed = homed;
        if let Some(report) = &self.status {
            self.indicators = Indicators::of(self.family(), report, self.identity(), homed);
        }
    }

    /// Takes over an event.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let finding = self.motion.take(&event);
        self.boards.note(&event);
        let mut effects = self.heard(event);
        effects.extend(finding.map(|finding| {
            let gravity = if finding.is_fault() { Gravity::Error } else { Gravity::Warning };
            Effect::say(gravity, finding.sentence)
        }));
        effects
    }

    fn heard(&mut self, event: Event) -> Vec<Effect> {
        match event {
            Event::Searching { done, of, what } => {
                self.searching = Some(Search { done, of, what });
                Vec::new()
            }
            Event::Connected(identity) => self.connected(identity),
            Event::Moved { from } => {
                self.moved_from = Some(from);
                Vec::new()
            }
            Event::Selected { address, stream } => {
                self.searching = None;
                self.select(address, stream)
            }
            Event::Sample(mut sample) if Some(sample.address) == self.selected => {
                self.leave_out_missing_sensor(&mut sample);
                self.readings.update(&sample);
                vec![Effect::Sample(sample)]
            }
            Event::Sample(_) => Vec::new(),
            Event::Status(report) => self.status(report),
            Event::Armed { scope, controller_timeout, warnings, .. } => {
                self.arming = Arming::Armed { scope, controller_timeout };
                self.warnings = warnings;
                self.refusals.clear();
                vec![
                    Effect::AtRest,
                    Effect::say(
                        Gravity::Warning,
                        WindowStatusMessage::Armed { scope: self.armed_text(scope) },
                    ),
                ]
            }
            Event::Disarmed(reason) => self.disarmed(&reason),
            Event::ArmRefused { reasons, .. } => self.refused(reasons),
            Event::Stopped(report) => self.stopped(&report),
            Event::Link(statistics) => {
                self.statistics = statistics;
                Vec::new()
            }
            Event::Capabilities { address, map } => self.lacks(address, &map),
            Event::Failure(failure) => vec![Effect::say(Gravity::Error, failure.message())],
            Event::Lost(failure) => self.lost(&failure),
            Event::LoaderEntered => Vec::new(),
            Event::Closed => {
                vec![Effect::say(Gravity::Note, WindowStatusMessage::Disconnected), Effect::Ended]
            }
            Event::Driven { .. }
            | Event::RawReply { .. }
            | Event::ProgramStarted { .. }
            | Event::Transacted { .. }
            | Event::JobStarted { .. }
            | Event::JobProgress { .. }
            | Event::JobEnded(_)
            | Event::Traffic { .. } => Vec::new(),
        }
    }

    /// What is armed, as the screens of the unit are called.
    fn armed_text(&self, scope: ArmScope) -> String {
        let family = self.identity().map(|identity| family::of(identity.family));
        family.map_or_else(|| scope.to_string(), |family| family::armed_text(family, scope))
    }

    fn connected(&mut self, identity: Identity) -> Vec<Effect> {
        let (unit, port, place) =
            (identity.title().to_owned(), identity.port.clone(), identity.named_place());
        let (generation, firmware) = (identity.generation.to_string(), identity.firmware.clone());
        let said = match firmware.as_str() {
            _ if family::of(identity.family).generation_number(&identity).is_none() => {
                LinkStatusMessage::ConnectedOf { unit, port, place, generation }
            }
            "" => LinkStatusMessage::ConnectedBare { unit, port, place, generation },
            _ => LinkStatusMessage::Connected { unit, port, place, firmware, generation },
        };
        let mut effects = vec![Effect::say(Gravity::Note, said)];
        // A node's notes are its CANopen identity, which is nothing odd.
        let gravity = if identity.is_node() { Gravity::Note } else { Gravity::Warning };
        let notes = identity.notes.iter().map(|note| Effect::say(gravity, note.clone()));
        effects.extend(notes);
        self.units.retain(|unit| unit.address != identity.address);
        self.units.push(identity);
        effects
    }

    fn select(&mut self, address: u8, stream: Option<Stream>) -> Vec<Effect> {
        let changed = self.selected.replace(address) != Some(address);
        if let Some(from) = self.moved_from.take() {
            self.units.retain(|unit| unit.address != from || from == address);
        }
        self.stream = stream.or(if changed { None } else { self.stream });
        if !changed {
            return Vec::new();
        }
        self.readings = Readings::default();
        self.indicators = Indicators::default();
        self.status = None;
        vec![Effect::OtherUnit]
    }

    /// Boards without a second temperature sensor report 0 for it: what is not there was not read.
    fn leave_out_missing_sensor(&self, sample: &mut Sample) {
        let second = Channel::TEMPERATURE_2;
        let is_made_up = |identity: &Identity| self.family().makes_up(identity, second);
        if sample.get(second) == Some(0.0) && self.identity().is_some_and(is_made_up) {
            sample.remove(second);
        }
    }

    fn status(&mut self, report: StatusReport) -> Vec<Effect> {
        if Some(report.address) != self.selected {
            return Vec::new();
        }
        self.indicators = Indicators::of(self.family(), &report, self.identity(), self.homed);
        self.status = Some(report);
        Vec::new()
    }

    /// The commands that the selected unit's firmware is known to lack, in words, where it lacks some.
    pub fn lacking(&self) -> Option<String> {
        let unit = self.identity()?;
        let absent = self.absent.get(&unit.address).filter(|absent| !absent.is_empty())?;
        Some(titles(unit, absent))
    }

    /// What stands in place of indicators that nothing will ever light, where the selected unit tells no status.
    pub fn without_status(&self) -> Option<&'static str> {
        (self.status.is_none() && self.lacking().is_some()).then_some(WITHOUT_STATUS)
    }

    /// Says which commands a firmware is newly known to lack.
    fn lacks(&mut self, address: u8, map: &CapabilityMap) -> Vec<Effect> {
        let absent: Vec<u8> = map.absent().collect();
        let known = self.absent.insert(address, absent.clone()).unwrap_or_default();
        let new: Vec<u8> = absent.into_iter().filter(|command| !known.contains(command)).collect();
        let Some(unit) = self.units.iter().find(|unit| unit.address == address && !new.is_empty()) else {
            return Vec::new();
        };
        let sentence = LinkStatusMessage::Lacks { unit: unit.place(), commands: titles(unit, &new) };
        vec![Effect::say(Gravity::Note, sentence)]
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn disarmed(&mut self, reason: &DisarmReason) -> Vec<Effect> {
        if let (DisarmReason::LinkLost, Arming::Armed { controller_timeout, .. }) = (reason, self.arming) {
            self.lost_while_armed = Some(controller_timeout);
        }
        self.arming = Arming::Disarmed;
        self.warnings.clear();
        let gravity = match reason {
            DisarmReason::Fault(_)
            | DisarmReason::Restarted
            | DisarmReason::NoAnswer
            | DisarmReason::NotTogether
            | DisarmReason::LinkLost => Gravity::Error,
            DisarmReason::DeadMan => Gravity::Warning,
            _ => Gravity::Note,
        };
        vec![Effect::AtRest, Effect::say(gravity, CoreStatusMessage::Stopping { reason: reason.clone() })]
    }

    fn refused(&mut self, reasons: Vec<Failure>) -> Vec<Effect> {
        self.arming = Arming::Disarmed;
        let first = reasons.first().map(Failure::message).unwrap_or_default();
        self.refusals = reasons;
        vec![Effect::AtRest, Effect::say(Gravity::Error, first)]
    }

    fn lost(&mut self, failure: &Failure) -> Vec<Effect> {
        let mut text = failure.message();
        if let Arming::Armed { controller_timeout, .. } = self.arming {
            self.lost_while_armed = Some(controller_timeout);
        }
        match self.lost_while_armed {
            Some(Some(timeout)) => {
                let seconds = timeout.as_secs_f64();
                text = LinkStatusMessage::LostArmed { what: text, seconds }.into();
            }
            Some(None) => text = LinkStatusMessage::LostArmedForever { what: text }.into(),
            None => {}
        }
        if let Some(waiting) = self.waiting.as_ref().filter(|_| self.units.is_empty()) {
            text = LinkStatusMessage::LostWaiting { what: text, waiting: waiting.clone() }.into();
        }
        self.arming = Arming::Disarmed;
        self.lost_because = Some(text.clone());
        vec![Effect::AtRest, Effect::say(Gravity::Error, text), Effect::Ended]
    }
}

impl LinkView {
    /// What became of a stop, in one sentence per thing the user has to know.
    fn stopped(&self, report: &StopReport) -> Vec<Effect> {
        let mut matters = matters(report, &self.units);
        let reason = DisarmReason::StopFromOutside;
        if matters.is_empty() {
            let milliseconds = report.latency().as_secs_f64() * 1000.0;
            let text = match report.from_outside {
                true => LinkStatusMessage::StoppedFromOutside { reason: reason.clone(), milliseconds }.into(),
                false => LinkStatusMessage::Stopped { milliseconds }.into(),
            };
            return vec![Effect::AtRest, Effect::Say(Gravity::Note, text)];
        }
        // The message line shows what was said last: the gravest.
        matters.sort_by_key(|(matter, _)| Reverse(*matter));
        let said = matters.into_iter().map(|(matter, text)| match matter {
            Matter::NotConfirmed | Matter::Failed => Effect::say(Gravity::Error, text),
            Matter::StillDriven => Effect::say(Gravity::Warning, text),
        });
        let by = report
            .from_outside
            .then(|| Effect::say(Gravity::Note, CoreStatusMessage::Stopped { reason: reason.clone() }));
        std::iter::once(Effect::AtRest).chain(by).chain(said).collect()
    }
}

fn titles(unit: &Identity, commands: &[u8]) -> String {
    let titles: Vec<_> =
        commands.iter().map(|command| unit.family.settings().learned_phrase(*command)).collect();
    titles.join(", ")
}
