//! The one sentence that says why the motors do not run and what to do, and the reasons behind it.

use brushwork_core::words::capital;
use brushwork_mcp_client::diagnosis::{Finding, Hindrance, diagnose};
use egui::{Frame, Label, Margin, RichText, Role, Stroke, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands};
use crate::model::{Connection, IndicatorState};
use crate::theme::Palette;

pub fn reasons_ui(ui: &mut Ui, connection: &Connection, commands: &mut Commands) {
    let pins = connection.pin_ends();
    let Some(evidence) = connection.evidence(pins.as_deref()) else { return };
    let diagnosis = diagnose(&evidence);
    let state = diagnosis.findings.first().map_or(IndicatorState::Ok, |first| state_of(first.hindrance));
    let palette = Palette::of(ui);
    let outline = if state == IndicatorState::Ok { palette.line } else { state.color(palette) };
    let frame = Frame::new()
        .fill(palette.raised)
        .stroke(Stroke::new(1.0, outline))
        .corner_radius(4.0)
        .inner_margin(Margin::symmetric(10, 8));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        row_ui(ui, state, RichText::new(diagnosis.sentence().to_string()).strong(), "Diagnosis");
        for finding in diagnosis.findings.iter().skip(1) {
            row_ui(ui, state_of(finding.hindrance), RichText::new(in_full(finding)), "Another reason");
        }
        if evidence.settings.is_none() {
            let color = palette.weak_text;
            ui.label(
                RichText::new("The settings have not been read yet: they may hold more reasons.")
                    .color(color),
            );
        }
        if connection.link.status.is_some_and(|report| report.is_active("e_stop")) {
            let note = "Works only where the controller lets software reset it, and not while it is pressed";
            if ui.button("Reset emergency stop").on_hover_text(note).clicked() {
                commands.push(Command::ResetEmergencyStop);
            }
        }
    });
}

fn row_ui(ui: &mut Ui, state: IndicatorState, text: RichText, name: &str) {
    ui.horizontal(|ui| {
        state.ui(ui, vec2(20.0, 18.0), 6.0);
        let spoken = format!("{name}: {}", text.text());
        let response = ui.add(Label::new(text).wrap());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    });
}

fn in_full(finding: &Finding) -> String {
    format!("{}. {}.", capital(&finding.what.to_string()), finding.cure)
}

const fn state_of(hindrance: Hindrance) -> IndicatorState {
    match hindrance {
        Hindrance::BlocksAll => IndicatorState::Error,
        Hindrance::BlocksSome => IndicatorState::Warning,
        Hindrance::Limits => IndicatorState::Active,
    }
}
