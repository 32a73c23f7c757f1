//! The arm switch: a sliding switch with the word beside it.

use egui::{Align2, FontId, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use crate::theme::Palette;

/// Draws the switch; what a click means is the caller's business. `waiting` is between asking and being armed.
pub fn arm_switch_ui(ui: &mut Ui, armed: bool, waiting: bool) -> Response {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(136.0, 32.0), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Switch, ui.is_enabled(), armed, "Arm"));
    let track = egui::Rect::from_min_size(rect.left_center() - vec2(0.0, 11.0), vec2(44.0, 22.0));
    let fill = if armed { palette.warning } else { palette.raised };
    let ring = match response.has_focus() {
        true => Stroke::new(2.0, palette.accent),
        false => Stroke::new(1.0, if response.hovered() { palette.text } else { palette.weak_text }),
    };
    ui.painter().rect(track, 11.0, fill, ring, StrokeKind::Inside);
    let knob_x = match (armed, waiting) {
        (true, _) => track.right() - 11.0,
        (false, true) => track.center().x,
        (false, false) => track.left() + 11.0,
    };
    let knob = if armed { palette.ground } else { palette.text };
    ui.painter().circle_filled(pos2(knob_x, track.center().y), 7.0, knob);
    let word = match (armed, waiting) {
        (true, _) => "ARMED",
        (false, true) => "asking …",
        (false, false) => "Disarmed",
    };
    let color = if armed { palette.warning } else { palette.text };
    let at = pos2(track.right() + 8.0, rect.center().y);
    ui.painter().text(at, Align2::LEFT_CENTER, word, FontId::proportional(15.0), color);
    response
}
