//! The board as it is seen: the two characters of its display, and its on/off inputs.

use brushwork_link::StatusReport;
use brushwork_motorvator_client::indicators;
use brushwork_motorvator_wire::host::characters_text;
use egui::{Align2, FontId, RichText, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

use crate::model::Connection;
use crate::motorvator::messages::BoardMessage;
use crate::theme::Palette;
use crate::widgets::heading::heading_ui;

/// Of one character.
const SIZE: egui::Vec2 = vec2(34.0, 48.0);

/// What the library has heard of an on/off input.
pub fn changed_text(status: Option<StatusReport>, number: u8) -> &'static str {
    let key = ["input_1", "input_2", "input_3", "input_4"][usize::from(number) - 1];
    match status {
        None => "?",
        Some(status) if status.is_active(key) => "changed",
        Some(_) => "as at the start",
    }
}

/// The two characters and the inputs, as the library tells them.
pub fn display_and_inputs_ui(ui: &mut Ui, connection: &Connection) {
    heading_ui(ui, "Display and inputs");
    let status = connection.link.status;
    let is_told = status.is_some_and(|status| indicators::display_of(status.word).is_some());
    ui.horizontal(|ui| {
        characters_ui(ui, connection);
        ui.add_space(12.0);
        for number in 1..=4_u8 {
            let word = changed_text(status.filter(|_| is_told), number);
            ui.vertical(|ui| {
                ui.label(BoardMessage::Input { number }.to_string());
                ui.label(RichText::new(word).small().weak());
            });
        }
    });
    source_ui(ui, is_told);
}

/// The two characters alone, where the inputs stand elsewhere.
pub fn display_ui(ui: &mut Ui, connection: &Connection) {
    heading_ui(ui, "Display");
    characters_ui(ui, connection);
    if connection.link.status.is_none_or(|status| indicators::display_of(status.word).is_none()) {
        source_ui(ui, false);
    }
}

fn characters_ui(ui: &mut Ui, connection: &Connection) {
    let palette = Palette::of(ui);
    let shown = connection.link.status.and_then(|status| indicators::display_of(status.word));
    let (place, response) = ui.allocate_exact_size(vec2(2.0 * SIZE.x, SIZE.y), Sense::hover());
    let text = shown.map_or_else(|| "  ".to_owned(), characters_text);
    let label = BoardMessage::Display { text: text.clone() }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &label));
    ui.painter().rect_stroke(place, 3.0, Stroke::new(1.0, palette.line), egui::StrokeKind::Inside);
    for (index, letter) in text.chars().enumerate() {
        let middle = place.left_center() + vec2((index as f32 + 0.5) * SIZE.x, 0.0);
        let font = FontId::monospace(34.0);
        ui.painter().text(middle, Align2::CENTER_CENTER, letter, font, palette.text);
    }
}

fn source_ui(ui: &mut Ui, is_told: bool) {
    let source = if is_told {
        "As the host library tells them: it hears when an input changes, not how it stands."
    } else {
        "The host library does not answer: what another program shows is not known."
    };
    ui.label(RichText::new(source).small().weak());
}
