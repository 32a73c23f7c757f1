//! What the keyboard and a screen reader ask of something that can be slid.

use egui::accesskit::{Action, ActionData};
use egui::{EventFilter, Key, Modifiers, Response, Ui};

/// How far one key goes.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    /// An arrow key; with Shift ten times as far.
    pub step: f64,
    /// Page Up and Page Down.
    pub page: f64,
}

impl Steps {
    /// The change asked for in this frame. Arrows in both directions count; Home goes to zero.
    pub fn asked(self, ui: &Ui, response: &Response, value: f64) -> f64 {
        let (up, down) = ui.input(|input| {
            let asked = |action| input.num_accesskit_action_requests(response.id, action) as f64;
            (asked(Action::Increment), asked(Action::Decrement))
        });
        let mut change = (up - down) * self.step;
        if !response.has_focus() {
            return change;
        }
        let keep = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, keep));
        let keys = [
            (Key::ArrowRight, self.step),
            (Key::ArrowUp, self.step),
            (Key::ArrowLeft, -self.step),
            (Key::ArrowDown, -self.step),
        ];
        ui.input_mut(|input| {
            for (key, by) in keys {
                change += input.count_and_consume_key(Modifiers::SHIFT, key) as f64 * 10.0 * by;
                change += input.count_and_consume_key(Modifiers::NONE, key) as f64 * by;
            }
            for (key, by) in [(Key::PageUp, self.page), (Key::PageDown, -self.page)] {
                change += input.count_and_consume_key(Modifiers::NONE, key) as f64 * by;
            }
            if input.consume_key(Modifiers::NONE, Key::Home) { -value } else { change }
        })
    }
}

/// The value that a screen reader has set.
pub fn set_by_reader(ui: &Ui, response: &Response) -> Option<f64> {
    ui.input(|input| {
        let requests = input.accesskit_action_requests(response.id, Action::SetValue);
        requests
            .filter_map(|request| match request.data {
                Some(ActionData::NumericValue(value)) => Some(value),
                _ => None,
            })
            .last()
    })
}
