//! What a stop came to, as a person has to know it; and how one program has another stop the line that it holds.

mod door;
mod note;
pub mod outside;

use std::time::Duration;

use brushwork_link::device::{StopReport, UnitStop};
use brushwork_link::family::FamilyRef;
use brushwork_link::{Identity, Message, families};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::messages::StopMessage;

/// How long the controllers may take to confirm: late replies at 2400 bit/s take 6 s.
pub const STOP_LIMIT: Duration = Duration::from_secs(10);

/// What of a stop is not plain, the gravest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Matter {
    /// A unit did not confirm it: the power has to be cut.
    NotConfirmed,
    /// Something went wrong.
    Failed,
    /// Something else can drive a motor now.
    StillDriven,
}

/// All that is not plainly stopped, a sentence each, unit by unit.
#[must_use]
pub fn matters(report: &StopReport, units: &[Identity]) -> Vec<(Matter, Message)> {
    let mut matters = Vec::new();
    for unit in &report.units {
        let place = place(units, unit.address);
        if !unit.confirmed {
            let text = StopMessage::NotConfirmed { unit: place.clone() };
            matters.push((Matter::NotConfirmed, text.into()));
        }
        let several = report.units.len() > 1;
        let text = |text: &Message| match several {
            true => StopMessage::Of { unit: place.clone(), text: text.clone() }.into(),
            false => text.clone(),
        };
        matters.extend(unit.still_driven_by.iter().map(|driver| (Matter::StillDriven, text(driver))));
        matters.extend(unit.failures.iter().map(|failure| (Matter::Failed, failure.message())));
    }
    matters
}

/// Where a unit is on its bus, as its family says it.
#[must_use]
pub fn place(units: &[Identity], address: u8) -> String {
    place_of(units.iter().find(|identity| identity.address == address), address)
}

fn place_of(identity: Option<&Identity>, address: u8) -> String {
    identity.map_or_else(|| format!("0x{address:02X}"), Identity::place)
}

/// A stop of a line as one program tells it to another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineStop {
    /// The units that are known on it.
    pub units: Vec<StoppedUnit>,
    /// What is not plainly stopped, the words of [`matters`].
    matters: Vec<String>,
    /// From the request to the last byte handed to the port.
    pub latency: Duration,
}

/// What one unit made of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoppedUnit {
    /// Its address.
    pub address: u8,
    /// Further addresses at which it answers.
    pub also_answers: Vec<u8>,
    /// Where it is, as its family says it.
    pub place: String,
    /// What it calls itself; none where it is not known.
    pub model: Option<String>,
    /// Key of its family.
    family: String,
    /// Whether it is a node of a CAN bus.
    pub is_node: bool,
    /// Whether it has one motor.
    pub has_one_motor: bool,
    /// Whether it confirmed duty 0 on its motors.
    pub confirmed: bool,
    /// Whether its motion buffers are empty by its own account; `None` if it does not tell.
    pub buffers_empty: Option<bool>,
    /// What can still drive a motor now, a sentence each, as JSON has them.
    pub still_driven_by: Value,
    /// What went wrong, as JSON has it.
    pub failures: Value,
}

/// A sentence as the program said it that has stopped the line.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Told(String);

impl LineStop {
    /// What `units` made of a stop.
    #[must_use]
    pub fn of(units: &[Identity], report: &StopReport) -> Self {
        let identity = |stop: &UnitStop| units.iter().find(|unit| unit.address == stop.address);
        Self {
            units: report.units.iter().map(|stop| StoppedUnit::of(stop, identity(stop))).collect(),
            matters: matters(report, units).into_iter().map(|(_, text)| text.to_string()).collect(),
            latency: report.latency(),
        }
    }

    /// What is not plainly stopped, a sentence each.
    #[must_use]
    pub fn matters(&self) -> Vec<Message> {
        self.matters.iter().map(|sentence| Message::error(Told(sentence.clone()))).collect()
    }

    /// Whether every unit confirmed.
    #[must_use]
    pub fn is_confirmed(&self) -> bool {
        self.units.iter().all(|unit| unit.confirmed)
    }
}

impl StoppedUnit {
    fn of(stop: &UnitStop, identity: Option<&Identity>) -> Self {
        Self {
            address: stop.address,
            also_answers: identity.map_or_else(Vec::new, |unit| unit.also_answers.clone()),
            place: place_of(identity, stop.address),
            model: identity.map(|unit| unit.title().to_owned()),
            family: identity.map(|unit| unit.family.key().to_owned()).unwrap_or_default(),
            is_node: identity.is_some_and(Identity::is_node),
            has_one_motor: identity.is_some_and(|unit| unit.capabilities().motors == 1),
            confirmed: stop.confirmed,
            buffers_empty: stop.buffers_empty,
            still_driven_by: json!(stop.still_driven_by),
            failures: json!(stop.failures),
        }
    }

    /// Its family, where this program has it.
    #[must_use]
    pub fn family(&self) -> Option<FamilyRef> {
        families().iter().find(|family| family.key() == self.family).copied()
    }
}
