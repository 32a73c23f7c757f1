//! A button that runs a motor while it is held, by mouse or by Enter, and lets go when the window is left.

use egui::{Event, Key, Response, Role, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, vec2};

use crate::theme::Palette;

/// Width and height.
pub const SIZE: egui::Vec2 = vec2(30.0, 26.0);

/// Draws the button, pointing left or right, and tells whether it is held. A hold begins with a press on it; a button that
/// comes to be enabled under a finger, or a key that repeats, begins none.
pub fn jog_ui(ui: &mut Ui, name: &str, points_right: bool, hint: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(SIZE, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    let held = is_held(ui, &response);
    paint(ui, rect, &response, points_right, held);
    response.on_hover_text(hint);
    held
}

fn is_held(ui: &Ui, response: &Response) -> bool {
    let key = response.id.with("held");
    let was_held = ui.data(|data| data.get_temp::<bool>(key)).unwrap_or(false);
    let has_focus = response.has_focus();
    let (pressed, key_down, window_has_focus) = ui.input(|input| {
        let enter =
            |event: &Event| matches!(event, Event::Key { key: Key::Enter, pressed: true, repeat: false, .. });
        let pressed = input.pointer.primary_pressed() || has_focus && input.events.iter().any(enter);
        (pressed, input.key_down(Key::Enter), input.focused)
    });
    let is_down = response.is_pointer_button_down_on() || has_focus && key_down;
    let held = ui.is_enabled() && window_has_focus && is_down && (was_held || pressed);
    ui.data_mut(|data| data.insert_temp(key, held));
    held
}

fn paint(ui: &Ui, rect: egui::Rect, response: &Response, points_right: bool, held: bool) {
    let palette = Palette::of(ui);
    let fill = if held { palette.warning } else { palette.raised };
    let ring = match response.has_focus() {
        true => Stroke::new(2.0, palette.accent),
        false => Stroke::new(1.0, if response.hovered() { palette.text } else { palette.line }),
    };
    ui.painter().rect(rect, 4.0, fill, ring, StrokeKind::Inside);
    let arrow = match (held, ui.is_enabled()) {
        (true, _) => palette.ground,
        (false, true) => palette.text,
        (false, false) => palette.weak_text,
    };
    let side = if points_right { 1.0 } else { -1.0 };
    let at = |x: f32, y: f32| rect.center() + vec2(x * side, y);
    let corners = vec![at(5.0, 0.0), at(-4.0, -6.0), at(-4.0, 6.0)];
    ui.painter().add(Shape::convex_polygon(corners, arrow, Stroke::NONE));
}
