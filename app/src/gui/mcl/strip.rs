//! The line below the text: where the caret is. It is always as high, so that nothing jumps.

use egui::{Align2, Role, Sense, TextStyle, Ui, WidgetInfo, vec2};

use super::document::Document;
use crate::gui::theme::{self, Palette};

pub const HEIGHT: f32 = 24.0;

pub fn strip_ui(ui: &mut Ui, document: &Document) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    ui.painter().rect_filled(rect, 0.0, palette.raised);
    let place = place_text(document);
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &place));
    let font = egui::FontId::new(12.0, theme::figures().resolve(ui.style()).family);
    let inner = rect.shrink2(vec2(8.0, 0.0));
    ui.painter().text(inner.right_center(), Align2::RIGHT_CENTER, place, font, palette.weak_text);
    let _ = TextStyle::Small;
}

/// "Line 3, column 5"; how much is selected.
fn place_text(document: &Document) -> String {
    let (line, column) = (document.caret_line() + 1, document.text.column(document.caret.head) + 1);
    match document.text.slice(document.caret.range()).chars().count() {
        0 => format!("Line {line}, column {column}"),
        count => format!("{count} selected · Line {line}, column {column}"),
    }
}
