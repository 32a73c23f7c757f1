//! The level slider: from soft to stiff, with exact entry beside it.

use egui::accesskit::Action;
use egui::{Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use crate::messages::ButtonMessage;
use crate::theme::Palette;
use crate::widgets::numeric::Numeric;
use crate::widgets::steps::{Steps, set_by_reader};

const HEIGHT: f32 = 24.0;
const RADIUS: f32 = 7.0;
const TOP: f64 = 100.0;

/// Changes `level` in place; tells whether it did.
pub fn level_ui(ui: &mut Ui, name: &str, hint: &str, width: f32, level: &mut f64) -> bool {
    let before = *level;
    rail_ui(ui, name, width, level).on_hover_text(hint);
    let exact = ButtonMessage::Exact { name: name.to_string() }.to_string();
    let entry = Numeric { name: &exact, unit: "", range: 0.0..=TOP, decimals: 0, step: 1.0, width: 44.0 };
    entry.ui(ui, level).on_hover_text(hint);
    *level = level.round().clamp(0.0, TOP);
    *level != before
}

fn rail_ui(ui: &mut Ui, name: &str, width: f32, level: &mut f64) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::click_and_drag());
    let (left, right) = (rect.left() + RADIUS, rect.right() - RADIUS);
    if let Some(pointer) = response.interact_pointer_pos() {
        response.request_focus();
        *level = TOP * f64::from((pointer.x - left) / (right - left));
    }
    let steps = Steps { step: 1.0, page: 10.0 };
    *level += steps.asked(ui, &response, *level);
    if let Some(asked) = set_by_reader(ui, &response) {
        *level = asked;
    }
    *level = level.round().clamp(0.0, TOP);
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), *level, name));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(0.0);
        node.set_max_numeric_value(TOP);
        node.set_numeric_value_step(1.0);
        for action in [Action::SetValue, Action::Increment, Action::Decrement] {
            node.add_action(action);
        }
    });
    paint(ui, &response, left, right, *level);
    response
}

fn paint(ui: &Ui, response: &Response, left: f32, right: f32, level: f64) {
    let palette = Palette::of(ui);
    let painter = ui.painter();
    let middle = response.rect.center().y;
    let x = left + (right - left) * (level / TOP) as f32;
    let rail = egui::Rect::from_min_max(pos2(left, middle - 3.0), pos2(right, middle + 3.0));
    painter.rect(rail, 3.0, palette.raised, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    for quarter in 0..=4 {
        let at = left + (right - left) * quarter as f32 / 4.0;
        painter.vline(at, middle - 6.0..=middle + 6.0, Stroke::new(1.0, palette.line));
    }
    painter.rect_filled(rail.with_max_x(x), 2.0, palette.accent);
    painter.circle(pos2(x, middle), RADIUS, palette.accent, Stroke::new(1.0, palette.ground));
    let ring = if response.has_focus() {
        Some(palette.text)
    } else {
        response.hovered().then_some(palette.weak_text)
    };
    if let Some(ring) = ring {
        painter.circle_stroke(pos2(x, middle), RADIUS, Stroke::new(2.0, ring));
    }
}
