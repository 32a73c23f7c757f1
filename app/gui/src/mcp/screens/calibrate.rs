//! The guide through the calibration of an input, in place of its settings.

use crate::mcp::messages::SignalMessage;
use crate::model::general::{CalibrationStage, GeneralView};
use egui::{Button, ProgressBar, RichText, Role, Ui, WidgetInfo, vec2};

use crate::model::indicator::IndicatorState;
use crate::screens::general::sheet_parts::{indicator_ui, text_ui};
use crate::widgets::readout::Readout;

pub fn calibrate_ui(ui: &mut Ui, general: &mut GeneralView<'_>) {
    let Some(run) = &general.calibration else { return };
    ui.label(RichText::new("Calibration").size(16.0).strong());
    let Some(calibration) = run.moving() else {
        let text = if run.is_closing() {
            "Putting the input back as it was…"
        } else {
            "Opening the range of the input…"
        };
        ui.add(ProgressBar::new(0.0).text(text).desired_width(ui.available_width().min(420.0)));
        return;
    };
    text_ui(ui, "The input commands nothing and triggers no action until this has ended.");
    let (step, text, button) = match calibration.stage {
        CalibrationStage::Ends => (
            "Step 1 of 2",
            "Move the input slowly to one end, hold it there a moment, then to the other. Readings that jump are not \
             counted.",
            "Take ends",
        ),
        CalibrationStage::Center => (
            "Step 2 of 2",
            "Let the input rest at its center, or hold it in the middle, for a second.",
            "Take center",
        ),
    };
    ui.strong(step);
    text_ui(ui, text);
    let now = calibration.lasting().map(|reading| reading.to_string());
    let seen = calibration.seen();
    let lines = [
        ("Now", now),
        ("Lowest", seen.map(|(lowest, _)| lowest.to_string())),
        ("Highest", seen.map(|(_, highest)| highest.to_string())),
    ];
    for (label, value) in lines {
        ui.horizontal(|ui| {
            crate::widgets::label::fixed_label_ui(ui, label, 80.0);
            let spoken = SignalMessage::Calibration { what: label.to_lowercase() }.to_string();
            Readout { label: &spoken, unit: "", digits: 10, unit_letters: 0 }.ui(ui, value.as_deref());
        });
    }
    if let Some(reported) = &run.reported {
        indicator_ui(ui, IndicatorState::Warning, reported);
    }
    let (mut take, mut cancel) = (false, false);
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        take = ui.add(Button::new(button).min_size(vec2(120.0, 28.0))).clicked();
        let response = ui.add(Button::new("Cancel calibration").min_size(vec2(120.0, 28.0)));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Cancel calibration"));
        cancel = response.clicked();
    });
    if take {
        general.take_calibrated();
    } else if cancel {
        general.cancel_calibration();
    }
}
