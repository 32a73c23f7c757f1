//! The message line: always there and always as high, so that a message moves nothing.

use egui::accesskit::Live;
use egui::{Align, Label, Layout, RichText, Role, Ui, WidgetInfo, vec2};

use super::marks;
use crate::command::{Command, Commands};
use crate::focus::{Region, region_ui};
use crate::language::{is_translated, said_message, word};
use crate::model::message::Message;
use crate::model::{Gravity, IndicatorState, Model};

const HEIGHT: f32 = 36.0;
const BUTTON_WIDTH: f32 = 76.0;

pub fn message_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    region_ui(ui, Region::Message);
    ui.allocate_ui_with_layout(
        vec2(ui.available_width(), HEIGHT),
        Layout::left_to_right(Align::Center),
        |ui| {
            ui.set_min_height(HEIGHT);
            let width = ui.available_width() - marks::WIDTH - ui.spacing().item_spacing.x;
            ui.allocate_ui_with_layout(vec2(width, HEIGHT), Layout::left_to_right(Align::Center), |ui| {
                ui.set_min_size(vec2(width, HEIGHT));
                match &model.messages.shown {
                    Some(message) => shown_ui(ui, message, commands),
                    None => quiet_ui(ui, model),
                }
            });
            marks::marks_ui(ui, model, commands);
        },
    );
}

fn shown_ui(ui: &mut Ui, message: &Message, commands: &mut Commands) {
    let state = match message.gravity {
        Gravity::Note => IndicatorState::Ok,
        Gravity::Warning => IndicatorState::Warning,
        Gravity::Error => IndicatorState::Error,
    };
    state.ui(ui, vec2(20.0, HEIGHT), 7.0);
    let text_width = (ui.available_width() - BUTTON_WIDTH - 8.0).max(60.0);
    ui.allocate_ui_with_layout(vec2(text_width, HEIGHT), Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(vec2(text_width, HEIGHT));
        // Two lines fit; what is longer is shown in full by a pointer over it.
        let words = said_message(&message.text);
        let text = ui.add(Label::new(&words).wrap()).on_hover_text(&words);
        let gravity = gravity_word(message.gravity, is_translated(&message.text));
        let spoken = format!("{gravity}: {words}");
        text.widget_info(|| WidgetInfo::labeled(Role::Alert, true, &spoken));
        let live = match message.gravity {
            Gravity::Note => Live::Polite,
            Gravity::Warning | Gravity::Error => Live::Assertive,
        };
        ui.ctx().accesskit_node_builder(text.id, |node| node.set_live(live));
    });
    if ui.button(word("bar", "Dismiss")).clicked() {
        commands.push(Command::DismissMessage);
    }
}

fn quiet_ui(ui: &mut Ui, model: &Model) {
    let text = match model.is_connected() {
        true => word("bar", "Nothing to report."),
        false => word(
            "bar",
            "No controller is connected. Choose one at the left and press Connect; the simulated one is always there.",
        ),
    };
    ui.add(Label::new(RichText::new(text).weak()).wrap());
}

/// Before a message that has no translation it is English too.
fn gravity_word(gravity: Gravity, is_translated: bool) -> String {
    let (english, said) = match gravity {
        Gravity::Note => ("Note", word("gravity", "Note")),
        Gravity::Warning => ("Warning", word("gravity", "Warning")),
        Gravity::Error => ("Error", word("gravity", "Error")),
    };
    if is_translated { said } else { english.to_owned() }
}
