//! The family's indicators in full, and what the status word says in words.

use egui::{RichText, Ui};

use crate::model::{Connection, IndicatorState, clock_text};
use crate::screens::messages::StatusMessage;
use crate::widgets::{heading_ui, indicator};

pub fn indicators_ui(ui: &mut Ui, connection: &Connection, columns: usize) {
    if let Some(sentence) = connection.link.without_status() {
        return IndicatorState::Unknown.line_ui(ui, sentence);
    }
    ui.columns(columns, |ui| {
        let indicators = connection.family().indicators();
        for (index, info) in indicators.iter().enumerate() {
            let column = &mut ui[usize::from(index >= indicators.len().div_ceil(2)).min(columns - 1)];
            column.spacing_mut().item_spacing.y = 4.0;
            let state = connection.link.indicators.named(info.short);
            let since =
                connection.indicator_since(info.short).filter(|_| state >= IndicatorState::Ok).map(|since| {
                    let clock = clock_text(since);
                    StatusMessage::Since { time: clock.split('.').next().unwrap_or_default().to_string() }
                        .to_string()
                });
            indicator::full_ui(column, info.short, info.title, state, since.as_deref());
        }
    });
    if let Some(note) = note(connection) {
        ui.label(RichText::new(note).small().weak());
    }
}

/// What some indicators go by.
fn note(connection: &Connection) -> Option<&'static str> {
    connection.family().indicators_note(connection.link.identity()?, connection.homed())
}

/// What the status word says, in words.
pub fn active_ui(ui: &mut Ui, connection: &Connection) {
    ui.add_space(6.0);
    heading_ui(ui, "What the controller reports");
    let report = connection.link.status.as_ref();
    let Some(report) = report else {
        ui.weak("Not known: no status has come from this controller.");
        return;
    };
    let active = connection.family().active(report, connection.link.identity());
    if active.is_empty() {
        ui.weak("Nothing: neither warning nor error.");
    }
    for indicator in active {
        ui.horizontal(|ui| {
            indicator.state.ui(ui, egui::vec2(18.0, 18.0), 6.0);
            ui.label(format!("{} ({})", indicator.title, indicator.state.word()));
        });
    }
}
