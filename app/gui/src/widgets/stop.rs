//! The Stop All button.

use egui::{Align2, FontId, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, vec2};

use crate::keys::said_stop_words;
use crate::language::{said, word};
use crate::messages::ButtonMessage;
use crate::theme::Palette;

/// Height in points: big enough to hit in a hurry.
const HEIGHT: f32 = 64.0;

/// Height where it stands in a row with others.
const SMALL_HEIGHT: f32 = 28.0;
const SMALL_FONT: FontId = FontId::proportional(13.5);
/// Room beside its words.
const SMALL_MARGIN: f32 = 20.0;

/// Fills the width. `connected` only changes how it looks: pressing it is never refused. It names the keys that stop at this moment.
pub fn stop_ui(ui: &mut Ui, connected: bool) -> Response {
    sized_ui(ui, connected, vec2(ui.available_width(), HEIGHT))
}

/// The same as high as other buttons, and as wide as its longest words.
pub fn small_stop_ui(ui: &mut Ui, connected: bool) -> Response {
    let keys = word("bar", "Space or Esc");
    let words = said(&ButtonMessage::StopAll { keys });
    let words = ui.painter().layout_no_wrap(words, SMALL_FONT, Palette::of(ui).text);
    sized_ui(ui, connected, vec2(words.size().x + SMALL_MARGIN, SMALL_HEIGHT))
}

fn sized_ui(ui: &mut Ui, connected: bool, size: Vec2) -> Response {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, word("bar", "Stop All")));
    let keys = said_stop_words(ui.ctx());
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_keyboard_shortcut(keys.clone()));
    let (fill, text) =
        if connected { (palette.stop, palette.on_stop) } else { (palette.raised, palette.weak_text) };
    let fill = if response.is_pointer_button_down_on() { fill.gamma_multiply(0.8) } else { fill };
    let ring = if response.has_focus() {
        Stroke::new(3.0, palette.accent)
    } else if response.hovered() {
        Stroke::new(2.0, palette.text)
    } else {
        Stroke::new(1.0, palette.line)
    };
    let painter = ui.painter();
    painter.rect(rect, 6.0, fill, ring, StrokeKind::Inside);
    if size.y < HEIGHT {
        let words = said(&ButtonMessage::StopAll { keys: keys.to_string() });
        painter.text(rect.center(), Align2::CENTER_CENTER, words, SMALL_FONT, text);
        return response;
    }
    painter.text(
        rect.center() - vec2(0.0, 8.0),
        Align2::CENTER_CENTER,
        word("bar", "Stop All").to_uppercase(),
        FontId::proportional(22.0),
        text,
    );
    painter.text(
        rect.center() + vec2(0.0, 16.0),
        Align2::CENTER_CENTER,
        keys,
        FontId::proportional(11.5),
        text,
    );
    response
}

/// Whether it was pressed: the pointer going down is enough, so that a hand that slips off still stops.
pub fn pressed(response: &Response) -> bool {
    let (down_now, up_now) =
        response.ctx.input(|input| (input.pointer.any_pressed(), input.pointer.any_released()));
    let by_pointer = down_now && response.is_pointer_button_down_on();
    let by_key_or_reader = response.clicked() && !up_now;
    by_pointer || by_key_or_reader
}
