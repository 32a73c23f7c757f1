//! A slider for a motor's setpoint: zero in the middle, exact entry beside it, steps by key.
//!
//! Arrow keys move one step, with Shift ten; Page Up and Page Down a tenth of the range; Home goes to zero. The
//! handle catches at zero, which is the value most often wanted.

use std::ops::RangeInclusive;

use egui::accesskit::Action;
use egui::{
    Align, Button, EventFilter, Key, Layout, Modifiers, Pos2, Rect, Response, Role, Sense, Stroke,
    StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use super::numeric::Numeric;
use super::steps::set_by_reader;
use crate::messages::ButtonMessage;
use crate::theme::Palette;

/// How near zero, in points, the handle must come to catch.
const CATCH_POINTS: f32 = 6.0;
const HANDLE_RADIUS: f32 = 9.0;
const HEIGHT: f32 = 34.0;
const ENTRY_WIDTH: f32 = 92.0;

/// What the slider sets.
#[derive(Clone, Debug)]
pub struct Setpoint<'a> {
    /// The accessible name, for example "M1 duty".
    pub name: &'a str,
    pub unit: &'a str,
    /// Runs from below zero to above it, or a travel that need not have a zero in it.
    pub range: RangeInclusive<f64>,
    pub decimals: usize,
    pub step: f64,
}

/// What was done with a slider in this frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moved {
    /// The value is another.
    pub changed: bool,
    /// The pointer holds the handle.
    pub held: bool,
}

impl Setpoint<'_> {
    /// Changes `value` in place.
    pub fn ui(&self, ui: &mut Ui, value: &mut f64) -> Moved {
        let before = *value;
        let size = vec2(ui.available_width(), HEIGHT);
        let mut held = false;
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            let width = (ui.available_width() - ENTRY_WIDTH - 56.0).max(120.0);
            held = self.rail_ui(ui, width, value).is_pointer_button_down_on();
            Numeric::new(
                &ButtonMessage::Exact { name: self.name.to_string() }.to_string(),
                self.unit,
                self.range.clone(),
                (self.decimals, self.step, ENTRY_WIDTH),
            )
            .ui(ui, value);
            let zero = ui.add_enabled(self.has_zero(), Button::new("0")).on_hover_text("Back to zero (Home)");
            zero.widget_info(|| {
                WidgetInfo::labeled(
                    Role::Button,
                    ui.is_enabled(),
                    ButtonMessage::ToZero { name: self.name.to_string() }.to_string(),
                )
            });
            if zero.clicked() {
                *value = 0.0;
            }
        });
        *value = self.rounded(*value);
        Moved { changed: *value != before, held }
    }

    fn rail_ui(&self, ui: &mut Ui, width: f32, value: &mut f64) -> Response {
        let (rect, response) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::click_and_drag());
        let rail = Rect::from_center_size(rect.center(), vec2(rect.width() - 2.0 * HANDLE_RADIUS, 6.0));
        if let Some(pointer) = response.interact_pointer_pos() {
            response.request_focus();
            *value = self.value_at(pointer.x, &rail);
        }
        *value = self.rounded(*value + self.steps_by_key(ui, &response, *value));
        if let Some(asked) = set_by_reader(ui, &response) {
            *value = self.rounded(asked);
        }
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), *value, self.name));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_min_numeric_value(*self.range.start());
            node.set_max_numeric_value(*self.range.end());
            node.set_numeric_value_step(self.step);
            for action in [Action::SetValue, Action::Increment, Action::Decrement] {
                node.add_action(action);
            }
        });
        self.paint(ui, &response, &rail, *value);
        response
    }

    /// The change asked for by the keyboard or a screen reader.
    fn steps_by_key(&self, ui: &Ui, response: &Response, value: f64) -> f64 {
        let (up, down) = ui.input(|input| {
            let asked = |action| input.num_accesskit_action_requests(response.id, action) as f64;
            (asked(Action::Increment), asked(Action::Decrement))
        });
        let mut change = (up - down) * self.step;
        if !response.has_focus() {
            return change;
        }
        let keep = EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, keep));
        let tenth = (self.range.end() - self.range.start()) / 20.0;
        let keys = [
            (Modifiers::SHIFT, Key::ArrowRight, 10.0 * self.step),
            (Modifiers::SHIFT, Key::ArrowLeft, -10.0 * self.step),
            (Modifiers::NONE, Key::ArrowRight, self.step),
            (Modifiers::NONE, Key::ArrowLeft, -self.step),
            (Modifiers::NONE, Key::PageUp, tenth),
            (Modifiers::NONE, Key::PageDown, -tenth),
        ];
        ui.input_mut(|input| {
            for (modifiers, key, by) in keys {
                change += input.count_and_consume_key(modifiers, key) as f64 * by;
            }
            let home = input.consume_key(Modifiers::NONE, Key::Home);
            if home && self.has_zero() { -value } else { change }
        })
    }

    /// A travel may lie on one side of zero.
    fn has_zero(&self) -> bool {
        self.range.contains(&0.0)
    }

    fn value_at(&self, x: f32, rail: &Rect) -> f64 {
        if self.has_zero() && (x - self.x_of(0.0, rail)).abs() <= CATCH_POINTS {
            return 0.0;
        }
        let part = f64::from((x - rail.left()) / rail.width()).clamp(0.0, 1.0);
        self.rounded(self.range.start() + part * (self.range.end() - self.range.start()))
    }

    fn x_of(&self, value: f64, rail: &Rect) -> f32 {
        let part = (value - self.range.start()) / (self.range.end() - self.range.start());
        rail.left() + part.clamp(0.0, 1.0) as f32 * rail.width()
    }

    fn rounded(&self, value: f64) -> f64 {
        let steps = (value / self.step).round();
        // Adding zero turns -0.0 into 0.0.
        (steps * self.step).clamp(*self.range.start(), *self.range.end()) + 0.0
    }

    fn paint(&self, ui: &Ui, response: &Response, rail: &Rect, value: f64) {
        let palette = Palette::of(ui);
        let painter = ui.painter();
        let middle = rail.center().y;
        let zero = self.x_of(0.0, rail);
        painter.rect(*rail, 3.0, palette.raised, Stroke::new(1.0, palette.line), StrokeKind::Inside);
        let tick = |x: f32, length: f32| {
            painter.vline(x, middle - length..=middle + length, Stroke::new(1.0, palette.line));
        };
        (0..=8).for_each(|eighth| tick(rail.left() + rail.width() / 8.0 * eighth as f32, 7.0));
        tick(zero, 12.0);
        let handle = pos2(self.x_of(value, rail), middle);
        let color = if ui.is_enabled() { palette.accent } else { palette.weak_text };
        painter.rect_filled(
            Rect::from_two_pos(pos2(zero, rail.top()), pos2(handle.x, rail.bottom())),
            2.0,
            color,
        );
        paint_handle(ui, response, handle, color);
    }
}

fn paint_handle(ui: &Ui, response: &Response, at: Pos2, color: egui::Color32) {
    let palette = Palette::of(ui);
    ui.painter().circle(at, HANDLE_RADIUS, color, Stroke::new(1.0, palette.ground));
    let ring = if response.has_focus() {
        Some(palette.text)
    } else {
        response.hovered().then_some(palette.weak_text)
    };
    if let Some(ring) = ring {
        ui.painter().circle_stroke(at, HANDLE_RADIUS, Stroke::new(2.0, ring));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DUTY: Setpoint<'_> =
        Setpoint { name: "M1 duty", unit: "%", range: -100.0..=100.0, decimals: 1, step: 0.1 };

    fn rail() -> Rect {
        Rect::from_min_size(pos2(100.0, 0.0), vec2(400.0, 6.0))
    }

    #[test]
    fn the_ends_and_the_middle_of_the_rail_are_exact() {
        assert_eq!(DUTY.value_at(100.0, &rail()), -100.0);
        assert_eq!(DUTY.value_at(300.0, &rail()), 0.0);
        assert_eq!(DUTY.value_at(500.0, &rail()), 100.0);
        assert_eq!(DUTY.value_at(9999.0, &rail()), 100.0);
    }

    #[test]
    fn the_handle_catches_at_zero_but_keys_can_go_past_it() {
        assert_eq!(DUTY.value_at(305.0, &rail()), 0.0);
        assert!(DUTY.value_at(307.0, &rail()) > 3.0);
        assert!((DUTY.rounded(0.1) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn a_travel_beside_zero_never_leads_to_zero() {
        let travel = Setpoint { name: "M1 position", unit: "", range: 500.0..=900.0, decimals: 0, step: 1.0 };
        assert_eq!(travel.value_at(100.0, &rail()), 500.0);
        assert_eq!(travel.rounded(0.0), 500.0);
    }

    #[test]
    fn values_are_whole_steps() {
        assert!((DUTY.rounded(12.34) - 12.3).abs() < 1e-9);
        assert_eq!(DUTY.rounded(-0.04).to_bits(), 0.0f64.to_bits());
    }
}
