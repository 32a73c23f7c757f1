//! The inputs: four on/off inputs and six analog ones, with the display. On a simulated board they can be switched here.

use brushwork_motorvator_client::channels::ANALOG;
use brushwork_motorvator_client::indicators;
use brushwork_plant::world::{PinSignal, WorldAction};
use egui::{Button, Label, ProgressBar, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};

use super::display::{changed_text, display_ui};
use crate::command::{Command, Commands};
use crate::model::{Connection, IndicatorState, Model};
use crate::motorvator::messages::BoardMessage;
use crate::screens::{not_connected_text, nothing_ui, title_ui};
use crate::theme;
use crate::widgets::{fixed_label_ui, heading_ui};

const NAME_WIDTH: f32 = 84.0;
const MARK: egui::Vec2 = vec2(18.0, 20.0);
/// What a switch to ground puts on an input.
const ON: PinSignal = PinSignal::Volts { volts: 0.0 };

pub fn inputs_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note = "Once for both halves. The host library tells which on/off inputs have changed, and what the analog ones read.";
    title_ui(ui, "Inputs", note);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        display_ui(ui, &model.front);
        ui.add_space(8.0);
        heading_ui(ui, "On/off inputs");
        for number in 1..=4 {
            on_off_ui(ui, &model.front, number, commands);
        }
        if model.front.worlds.is_some() {
            let source = "The states are those of the simulated board; nothing on the wire tells them.";
            ui.add(Label::new(RichText::new(source).small().weak()).wrap());
        }
        ui.add_space(8.0);
        heading_ui(ui, "Analog inputs, 0 to 255");
        for (index, channel) in ANALOG.into_iter().enumerate() {
            let readings = &model.front.link.readings;
            analog_ui(ui, index + 1, readings.text(channel), readings.get(channel));
        }
        let source =
            "Of how many volts no page says. The voltage of a simulated input is set under Simulated World.";
        ui.add(Label::new(RichText::new(source).small().weak()).wrap());
    });
}

fn on_off_ui(ui: &mut Ui, connection: &Connection, number: u8, commands: &mut Commands) {
    let pin = usize::from(number) - 1;
    let worlds = connection.worlds.as_ref();
    let is_on = worlds.and_then(|worlds| Some(is_on(*worlds.first()?.pins.get(pin)?)));
    ui.horizontal(|ui| {
        fixed_label_ui(ui, &BoardMessage::Input { number }.to_string(), NAME_WIDTH);
        let (state, word) = match is_on {
            Some(true) => (IndicatorState::Active, "on"),
            Some(false) => (IndicatorState::NotApplicable, "off"),
            None => (IndicatorState::Unknown, "not told"),
        };
        let response = state.ui(ui, MARK, 6.0);
        let spoken = BoardMessage::OnOff { number, state: word }.to_string();
        response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &spoken));
        ui.add(Label::new(word).selectable(false));
        if let Some(is_on) = is_on {
            let (text, signal) = if is_on { ("off", PinSignal::Open) } else { ("on", ON) };
            let name = BoardMessage::SwitchInput { number, state: text }.to_string();
            let response = ui.add(Button::new(if is_on { "Switch off" } else { "Switch on" }));
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            if response.clicked() {
                commands.push(Command::World(WorldAction::SetPin { pin, signal }));
            }
        }
        let status = connection.link.status;
        let is_told = status.is_some_and(|status| indicators::display_of(status.word).is_some());
        ui.weak(changed_text(status.filter(|_| is_told), number));
    });
}

/// Whether what is on a pin is a switch that is closed: it leads to ground.
fn is_on(signal: PinSignal) -> bool {
    matches!(signal, PinSignal::Volts { volts } if volts < 0.8)
}

fn analog_ui(ui: &mut Ui, number: usize, text: Option<String>, reads: Option<f64>) {
    ui.horizontal(|ui| {
        fixed_label_ui(ui, &BoardMessage::AnalogName { number }.to_string(), NAME_WIDTH);
        let value = text.unwrap_or_else(|| "not read".to_owned());
        let share = reads.unwrap_or(0.0) / 255.0;
        // Rounded ends would make a dot of nothing.
        let bar = ProgressBar::new(share as f32).desired_width(160.0).corner_radius(2.0).text("");
        let response = ui.add(bar);
        let spoken = BoardMessage::AnalogInput { number, value: value.clone() }.to_string();
        response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &spoken));
        ui.label(RichText::new(value).text_style(theme::figures()));
    });
}
