//! Calibrating an input on the controller: its range there is opened wide, so that its bare readings can be seen, and put
//! back on every way out. While it is open the input commands nothing.

use brushwork_link::Message;
use brushwork_link::settings::{Keeper, SettingsImage};

use super::calibration::{Calibrated, Calibration};
use crate::family::Family;
use crate::messages::CalibrationMessage;
use crate::model::message::Gravity;
use crate::model::settings::{Before, SettingsAction, Summary, UnitKey, UnitSettings};
use brushwork_core::keep::TrialKeeper;

mod acts;

/// A calibration of one input.
#[derive(Debug)]
pub struct Run {
    pub(super) unit: UnitKey,
    family: &'static dyn Family,
    pub pin: usize,
    phase: Phase,
    /// Why the last step was not taken, for the user.
    pub reported: Option<CalibrationMessage>,
    /// What the pin had before.
    before: SettingsImage,
    kept: Before,
    /// From the write that opens the input to the one that closes it.
    keeper: Option<TrialKeeper>,
    found: Option<Calibrated>,
}

#[derive(Debug)]
enum Phase {
    Opening,
    Moving(Calibration),
    Closing,
}

impl Run {
    /// The calibration, while readings come.
    pub fn moving(&self) -> Option<&Calibration> {
        match &self.phase {
            Phase::Moving(calibration) => Some(calibration),
            Phase::Opening | Phase::Closing => None,
        }
    }

    /// Whether the input is to be put back.
    pub fn is_closing(&self) -> bool {
        matches!(self.phase, Phase::Closing)
    }

    /// What to write for an action of a calibration.
    pub(super) fn image(&self, action: SettingsAction) -> SettingsImage {
        if action == SettingsAction::CloseInput { self.before.clone() } else { self.opened() }
    }

    /// What keeps the journal of the whole calibration; `make` makes one at its beginning.
    pub(super) fn keeper(&mut self, make: impl FnOnce() -> Option<Box<dyn Keeper>>) -> Option<TrialKeeper> {
        if self.keeper.is_none() {
            self.keeper = make().map(TrialKeeper::new);
        }
        self.keeper.clone()
    }

    fn opened(&self) -> SettingsImage {
        let opened = self.family.opened_input(&|key| self.before.get(key), self.pin);
        opened.unwrap_or_default()
    }
}

/// The input is as it was. What was found is wanted.
fn closed(unit: &mut UnitSettings, run: &Run, pin: String) -> CalibrationMessage {
    unit.put_back(run.kept.clone());
    let Some(found) = run.found else {
        return CalibrationMessage::PutBack { pin };
    };
    for (field, value) in [("min", found.min), ("center", found.center), ("max", found.max)] {
        unit.set_number(&format!("pin.{}.{field}", run.pin), value);
    }
    let Calibrated { min, center, max, noise } = found;
    match noise > 0.0 {
        true => CalibrationMessage::RunsWithNoise { pin, min, center, max, noise },
        false => CalibrationMessage::Runs { pin, min, center, max },
    }
}

fn left_open(unit: &mut UnitSettings, run: &Run, pin: String, sentences: Vec<Message>) -> Summary {
    want_back(unit, run);
    Summary {
        gravity: Gravity::Error,
        summary: CalibrationMessage::LeftOpen { pin }.into(),
        sentences,
        address: None,
    }
}

fn want_back(unit: &mut UnitSettings, run: &Run) {
    unit.put_back(run.kept.clone());
    for (key, value) in run.before.iter() {
        unit.take(key, value);
    }
}
