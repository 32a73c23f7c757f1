//! What a stop came to, as a person has to know it.

use brushwork_link::device::StopReport;
use brushwork_link::{Identity, Message};

use crate::messages::StopMessage;

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
    let identity = units.iter().find(|identity| identity.address == address);
    identity.map_or_else(|| format!("0x{address:02X}"), Identity::place)
}
