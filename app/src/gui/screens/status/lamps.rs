//! The thirteen lamps in full, and what the status word says in words.

use brushwork_link::device::Lamp;
use egui::{RichText, Ui};

use crate::gui::model::desk::Desk;
use crate::gui::model::history::clock_text;
use crate::gui::model::lamps;
use crate::gui::shell::heading_ui;
use crate::gui::theme::Palette;
use crate::gui::widgets::{LampState, lamp};

/// Lamps in the first of the two columns.
const FIRST_COLUMN: usize = 7;

pub fn lamps_ui(ui: &mut Ui, desk: &Desk, columns: usize) {
    ui.columns(columns, |ui| {
        for (index, lamp) in Lamp::ALL.into_iter().enumerate() {
            let column = &mut ui[usize::from(index >= FIRST_COLUMN).min(columns - 1)];
            column.spacing_mut().item_spacing.y = 4.0;
            let state = desk.link.lamps.get(lamp);
            let since = desk.lamp_since(lamp).filter(|_| state >= LampState::Ok).map(|since| {
                let clock = clock_text(since);
                format!("since {}", clock.split('.').next().unwrap_or_default())
            });
            lamp::full_ui(column, lamp.abbreviation(), lamps::title(lamp), state, since.as_deref());
        }
    });
    if let Some(note) = note(desk) {
        ui.label(RichText::new(note).small().color(Palette::of(ui).weak_text));
    }
}

/// What the home lamps go by.
fn note(desk: &Desk) -> Option<&'static str> {
    let identity = desk.link.identity()?;
    if !identity.is_mcp() {
        return None;
    }
    Some(match desk.watch.homed() {
        Some(_) => {
            "M1HM and M2HM follow the actions of the input pins: this controller's status word has no bits for them. \
             Times are counted from the connection."
        }
        None => {
            "M1HM and M2HM follow the actions of the input pins, which have not been read yet: this controller's status \
             word has no bits for them. Times are counted from the connection."
        }
    })
}

/// What the status word says, in words.
pub fn conditions_ui(ui: &mut Ui, desk: &Desk) {
    ui.add_space(6.0);
    heading_ui(ui, "What the controller reports");
    let reported = desk.link.status.map(|report| report.conditions).unwrap_or_default();
    if reported.is_empty() {
        let color = Palette::of(ui).weak_text;
        ui.label(RichText::new("Nothing: neither warning nor error.").color(color));
    }
    for condition in reported.iter() {
        let state = lamps::state_of(condition.severity());
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(egui::vec2(18.0, 18.0), egui::Sense::hover());
            state.paint(ui, rect.center(), 6.0);
            ui.label(format!("{} ({})", condition.title(), state.word()));
        });
    }
}
