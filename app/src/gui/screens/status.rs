//! Device Status (MCP manual 1.2.3 to 1.2.5): thirteen lamps in full, what they mean for the motors, and who the unit is.

use brushwork_link::device::{Identity, StatusReport};
use brushwork_protocol::packet_serial::status::Lamp;
use egui::{Grid, RichText, ScrollArea, Ui};

use super::{not_connected_text, nothing_ui, title_ui};
use crate::gui::command::{Command, Commands};
use crate::gui::model::{Model, lamps};
use crate::gui::shell::heading_ui;
use crate::gui::theme::Palette;
use crate::gui::widgets::{LampState, lamp};

/// Lamps in the first of the two columns.
const FIRST_COLUMN: usize = 7;

/// Width from which two columns fit.
const TWO_COLUMNS_FROM: f32 = 600.0;

pub fn status_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let Some(identity) = model.front.link.identity() else {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    };
    title_ui(ui, "Device Status", &headline(model));
    // Side by side where there is room, else below each other.
    let columns = if ui.available_width() < TWO_COLUMNS_FROM { 1 } else { 2 };
    ScrollArea::vertical().show(ui, |ui| {
        lamps_ui(ui, model, columns);
        ui.add_space(10.0);
        ui.columns(columns, |ui| {
            conditions_ui(&mut ui[0], model, commands);
            unit_ui(&mut ui[columns - 1], model, identity);
        });
    });
}

fn headline(model: &Model) -> String {
    match model.front.link.lamps.worst() {
        LampState::Error => "At least one error: the controller has stopped a motor or both.".to_owned(),
        LampState::Warning => "At least one warning: a limit is close.".to_owned(),
        LampState::Active => "No warning and no error; a signal is active.".to_owned(),
        LampState::Ok => "No warning and no error.".to_owned(),
        LampState::Unknown | LampState::NotApplicable => "The status has not been read yet.".to_owned(),
    }
}

fn lamps_ui(ui: &mut Ui, model: &Model, columns: usize) {
    ui.columns(columns, |ui| {
        for (index, lamp) in Lamp::ALL.into_iter().enumerate() {
            let column = &mut ui[usize::from(index >= FIRST_COLUMN).min(columns - 1)];
            column.spacing_mut().item_spacing.y = 4.0;
            lamp::full_ui(column, lamp.abbreviation(), lamps::title(lamp), model.front.link.lamps.get(lamp));
        }
    });
}

/// What the status word says, in words.
fn conditions_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    heading_ui(ui, "What the controller reports");
    let reported = model.front.link.status.map(|report| report.conditions).unwrap_or_default();
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
    if model.front.link.lamps.get(Lamp::EStop) == LampState::Error {
        let reset = ui.horizontal(|ui| ui.button("Reset emergency stop")).inner;
        let note = "Works only where the controller lets software reset it, and not while it is pressed";
        if reset.on_hover_text(note).clicked() {
            commands.push(Command::ResetEmergencyStop);
        }
    }
}

fn unit_ui(ui: &mut Ui, model: &Model, identity: &Identity) {
    heading_ui(ui, "Unit and link");
    let addresses = |addresses: &[u8]| {
        let each: Vec<_> = addresses.iter().map(|address| format!("0x{address:02X}")).collect();
        if each.is_empty() { String::new() } else { format!(", also answers {}", each.join(" ")) }
    };
    let stream = model.front.link.stream.map_or("not known".to_owned(), |stream| stream.to_string());
    let figures = &model.front.link.statistics;
    let rows = [
        ("Says of itself", identity.version_text.trim().to_owned()),
        ("Firmware", format!("{}, {}", or_not_told(&identity.firmware), identity.generation)),
        ("Address", format!("0x{:02X}{}", identity.address, addresses(&identity.also_answers))),
        ("Port", format!("{} ({stream})", identity.port)),
        ("Status word", model.front.link.status.as_ref().map_or(String::new(), word_text)),
        (
            "Traffic",
            format!("{:.1} kbit/s, {:.0} requests/s", figures.kbit_per_s, figures.transactions_per_s),
        ),
        (
            "Round trip",
            format!(
                "{:.2} ms median, {:.2} ms for 99 %",
                figures.round_trip_median_s * 1000.0,
                figures.round_trip_p99_s * 1000.0
            ),
        ),
        (
            "Link errors",
            format!(
                "{} time-outs, {} bad CRC, {} retries",
                figures.timeouts, figures.crc_errors, figures.retries
            ),
        ),
    ];
    let weak = Palette::of(ui).weak_text;
    Grid::new("unit").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
        for (label, value) in rows {
            ui.label(RichText::new(label).color(weak));
            ui.add(egui::Label::new(value).truncate());
            ui.end_row();
        }
    });
}

fn or_not_told(text: &str) -> &str {
    if text.is_empty() { "not told" } else { text }
}

fn word_text(report: &StatusReport) -> String {
    format!("0x{:04X}", report.word)
}
