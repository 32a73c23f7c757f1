//! Which way a motor turns, and which way its encoder counts: two arrows for each, and what to do where they disagree.

use brushwork_link::device::Channel;
use brushwork_link::settings::{SettingValue, SettingsImage};
use brushwork_values::Motor;
use egui::{Button, Grid, Label, Pos2, RichText, Role, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands};
use crate::messages::MotorFieldMessage;
use crate::model::{Arming, IndicatorState, Model};
use crate::screens::messages::SettingMessage;
use crate::theme::{self, Palette};

const DUTIES: [Channel; 2] = [Channel::M1_PWM, Channel::M2_PWM];
const SPEEDS: [Channel; 2] = [Channel::M1_VELOCITY, Channel::M2_VELOCITY];
/// Less of either is at rest.
const LEAST_DUTY_PERCENT: f64 = 1.0;
const LEAST_SPEED: f64 = 5.0;
const ARROW: f32 = 16.0;

pub fn direction_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let hint = "Arm, then hold the forward jog button of a motor: both arrows have to point the same way, and the shaft has to turn the way that you call forward.";
    ui.add(Label::new(RichText::new(hint).weak()).wrap());
    Grid::new("direction").num_columns(5).spacing([14.0, 4.0]).show(ui, |ui| {
        for motor in model.front.motors() {
            row_ui(ui, model, *motor, commands);
            ui.end_row();
        }
    });
}

fn row_ui(ui: &mut Ui, model: &Model, motor: Motor, commands: &mut Commands) {
    let front = &model.front;
    let read = |channel: Channel| front.link.readings.get(channel);
    ui.label(motor.to_string());
    let duty = read(DUTIES[motor.index()]);
    let speed = read(SPEEDS[motor.index()]);
    turning_ui(ui, &MotorFieldMessage::Duty { motor }.to_string(), duty, (LEAST_DUTY_PERCENT, 1, "%"));
    turning_ui(ui, &MotorFieldMessage::Encoder { motor }.to_string(), speed, (LEAST_SPEED, 0, "counts/s"));
    let (state, text) = match front.path.turning.agrees(motor) {
        Some(true) => (IndicatorState::Ok, "They agree."),
        Some(false) => {
            let cure = "They disagree: swap the encoder's lines A and B, or the motor's two leads.";
            (IndicatorState::Error, cure)
        }
        None => (IndicatorState::Unknown, "Not seen yet."),
    };
    ui.horizontal(|ui| {
        state.ui(ui, vec2(18.0, 18.0), 6.0);
        let label = ui.label(text);
        label.widget_info(|| WidgetInfo::labeled(Role::Status, true, format!("{motor}: {text}")));
    });
    ui.horizontal(|ui| {
        let [encoder, of_motor] = front.family().direction_keys().unwrap_or_default();
        reverse_ui(ui, model, (motor, encoder), "Reverse encoder", commands);
        reverse_ui(ui, model, (motor, of_motor), "Reverse motor", commands);
    });
}

/// An arrow with the figure that it is of.
fn turning_ui(ui: &mut Ui, name: &str, value: Option<f64>, (least, decimals, unit): (f64, usize, &str)) {
    let palette = Palette::of(ui);
    let way = value.filter(|value| value.abs() >= least).map(f64::signum);
    let word = match way {
        Some(way) if way > 0.0 => "forward",
        Some(_) => "backward",
        None => "at rest",
    };
    ui.horizontal(|ui| {
        let (place, response) = ui.allocate_exact_size(vec2(ARROW * 1.5, ARROW), Sense::hover());
        let figure = value.map_or_else(|| "–".to_owned(), |value| format!("{:+.decimals$}", value + 0.0));
        let spoken = format!("{name}: {word}, {figure} {unit}");
        response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &spoken));
        match way {
            Some(way) => {
                let at = |x: f32, y: f32| -> Pos2 { place.center() + vec2(x * way as f32, y) * ARROW };
                let head = vec![at(0.7, 0.0), at(-0.1, -0.45), at(-0.1, 0.45)];
                ui.painter().add(Shape::convex_polygon(head, palette.accent, Stroke::NONE));
                let shaft = [at(-0.7, 0.0), at(0.0, 0.0)];
                ui.painter().line_segment(shaft, Stroke::new(4.0, palette.accent));
            }
            None => {
                ui.painter().circle_stroke(place.center(), 3.5, Stroke::new(1.5, palette.weak_text));
            }
        }
        let text = format!("{figure:>9} {unit}");
        ui.add(Label::new(RichText::new(text).text_style(theme::figures())).selectable(false));
        ui.add(Label::new(RichText::new(word).small().weak()).selectable(false));
    });
}

/// A button that reverses one of them in the controller's RAM, where it has such a setting.
fn reverse_ui(
    ui: &mut Ui,
    model: &Model,
    (motor, pattern): (Motor, &str),
    text: &str,
    commands: &mut Commands,
) {
    let key = pattern.replace("{n}", &(motor.index() + 1).to_string());
    let Some(unit) = model.front.settings.unit() else { return };
    let Some(row) = unit.table().row(&key).filter(|row| unit.is_writable(row)) else { return };
    let held = unit.on_controller(&key);
    let is_free = model.front.link.arming == Arming::Disarmed && !model.front.settings.is_busy();
    let is_reversed = held == Some(SettingValue::Bool(true));
    let label = SettingMessage::OfMotor { what: text.to_owned(), motor }.to_string();
    let button = ui.add_enabled(is_free && held.is_some(), Button::new(text).selected(is_reversed));
    button.widget_info(|| WidgetInfo::selected(Role::Button, is_free, is_reversed, &label));
    let hint = SettingMessage::WrittenAtOnce { help: row.help.to_string() }.to_string();
    let button = button
        .on_hover_text(hint)
        .on_disabled_hover_text("Disarm first: a loop may not be turned round while it runs");
    if button.clicked() {
        let mut image = SettingsImage::default();
        image.set(&key, SettingValue::Bool(!is_reversed));
        commands.push(Command::Reverse(image));
    }
}
