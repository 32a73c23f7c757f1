//! What General Settings does while an input is calibrated.

use brushwork_link::Message;
use brushwork_link::device::PinSignal;
use brushwork_link::settings::{SettingsImage, WriteReport};

use super::{Phase, Run, closed, left_open, want_back};
use crate::family;
use crate::messages::CalibrationMessage;
use crate::model::general::calibration::{Calibration, CalibrationStage};
use crate::model::{General, GeneralView, Gravity, SettingsAction, Summary};

impl General {
    /// Whether a calibration or a test needs the settings to be left as they are.
    pub fn holds_settings(&self) -> bool {
        self.calibration.is_some() || self.clamp.job.is_running()
    }

    /// Takes in the readings of a sweep.
    pub fn take_signals(&mut self, signals: &[PinSignal]) {
        let Some(run) = &mut self.calibration else { return };
        if let (Phase::Moving(calibration), Some(signal)) = (&mut run.phase, signals.get(run.pin - 1)) {
            calibration.read(f64::from(signal.position));
        }
    }

    /// Takes the ends, or the center, which ends it.
    pub fn take_calibrated(&mut self) {
        let Some(run) = &mut self.calibration else { return };
        let Phase::Moving(calibration) = &mut run.phase else { return };
        let refused = match calibration.stage {
            CalibrationStage::Ends => calibration.take_ends().err(),
            CalibrationStage::Center => match calibration.take_center() {
                Ok(found) => {
                    run.found = Some(found);
                    run.phase = Phase::Closing;
                    None
                }
                Err(refused) => Some(refused),
            },
        };
        run.reported = refused;
    }

    /// Ends a calibration without a result: the pin is put back as it was.
    pub fn cancel_calibration(&mut self) {
        if let Some(run) = &mut self.calibration
            && !run.is_closing()
        {
            run.phase = Phase::Closing;
            run.found = None;
        }
    }

    /// A request of the calibration was not taken.
    pub(in crate::model::general) fn calibration_not_begun(&mut self) {
        if self.calibration.as_ref().is_some_and(|run| matches!(run.phase, Phase::Opening)) {
            self.calibration = None;
        }
    }
}

impl GeneralView<'_> {
    /// Begins to calibrate a pin; what to ask for next.
    pub fn calibrate(&mut self, pin: usize) -> Option<SettingsAction> {
        if self.is_busy() {
            return None;
        }
        let unit_key = self.settings.current()?.clone();
        let unit = self.unit()?;
        let own = format!("pin.{pin}.");
        let family = family::of(unit.table().subject().family());
        let opened = family.opened_input(&|key| unit.on_controller(key), pin)?;
        let known = |key: &str| Some((key.to_owned(), unit.on_controller(key)?));
        let keys = opened.iter().map(|(key, _)| key.to_owned());
        let all: Option<SettingsImage> = keys.map(|key| known(&key)).collect();
        let mut before = all?;
        // The mode itself is not written; it says how far the range is opened.
        for field in ["type", "digital"] {
            let key = format!("{own}{field}");
            if let Some(value) = unit.on_controller(&key) {
                before.set(&key, value);
            }
        }
        let run = Run {
            unit: unit_key,
            family,
            pin,
            phase: Phase::Opening,
            reported: None,
            before,
            kept: unit.keep(),
            keeper: None,
            found: None,
        };
        self.calibration = Some(run);
        Some(SettingsAction::OpenInput)
    }

    /// The write that opens or closes the input has ended, with its report if it got that far.
    pub(in crate::model::general) fn calibration_step_ended(
        &mut self,
        report: Option<WriteReport>,
    ) -> Summary {
        let Some(mut run) = self.calibration.take() else { return Summary::note(Message::default()) };
        let Some(unit) = self.settings.unit_at(&run.unit) else { return Summary::note(Message::default()) };
        let sentences = report.as_ref().map(|report| report.sentences(unit.table()));
        let has_taken = sentences.as_ref().is_some_and(Vec::is_empty)
            && report.is_some_and(|report| report.ended_early.is_none());
        let name = unit.table().subject().pin_name(run.pin - 1);
        match run.phase {
            Phase::Opening if has_taken => {
                run.phase = Phase::Moving(Calibration::default());
                self.calibration = Some(run);
                Summary::note(CalibrationMessage::Open { pin: name })
            }
            Phase::Closing if has_taken => Summary::note(closed(unit, &run, name)),
            Phase::Closing => left_open(unit, &run, name, sentences.unwrap_or_default()),
            Phase::Opening | Phase::Moving(_) => {
                run.phase = Phase::Closing;
                self.calibration = Some(run);
                Summary {
                    gravity: Gravity::Error,
                    summary: CalibrationMessage::NotOpened { pin: name }.into(),
                    sentences: sentences.unwrap_or_default(),
                    address: None,
                }
            }
        }
    }

    /// The link is gone in the middle of a calibration: what the pin had is wanted again.
    pub(in crate::model::general) fn calibration_lost(&mut self) {
        if let Some(run) = self.calibration.take()
            && let Some(unit) = self.settings.unit_at(&run.unit)
        {
            want_back(unit, &run);
        }
    }
}
