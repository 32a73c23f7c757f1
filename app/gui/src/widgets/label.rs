//! A label of fixed width, so that what stands right of it never moves and rows line up.

use egui::{Align2, Role, Sense, TextStyle, Ui, WidgetInfo, vec2};

use crate::theme::Palette;

/// Draws `text` in the weak colour in a place of its own; what does not fit is cut off.
pub fn fixed_label_ui(ui: &mut Ui, text: &str, width: f32) {
    let size = vec2(width, ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
    let mut font = TextStyle::Body.resolve(ui.style());
    font.size -= 1.0;
    let color = Palette::of(ui).weak_text;
    ui.painter().with_clip_rect(rect).text(rect.left_center(), Align2::LEFT_CENTER, text, font, color);
}
