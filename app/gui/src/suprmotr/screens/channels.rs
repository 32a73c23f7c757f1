//! Inputs and outputs: the 16 channels with their directions, the limit switches, the brake, and the analog lines (SuprMotr manual, J1 to J4).

use brushwork_suprmotr_wire::{CHANNELS, Status, inputs};
use egui::{Button, Grid, Label, ProgressBar, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};

use crate::command::Commands;
use crate::model::{IndicatorState, Model};
use crate::screens::{not_connected_text, nothing_ui, title_ui};
use crate::suprmotr::messages::LinesMessage;
use crate::suprmotr::model::channels::{
    Act, Channels, Direction, STEP_VOLTS, holds_lines, status_in, steps_of,
};
use crate::theme;
use crate::widgets::{Numeric, fixed_label_ui, heading_ui};

/// What a channel shares its pin with, by channel, and the pin of J3 (SuprMotr manual, J3).
const PINS: [(u8, &str); CHANNELS as usize] = [
    (12, ""),
    (9, ""),
    (3, ""),
    (10, ""),
    (7, ""),
    (6, ""),
    (8, ""),
    (5, ""),
    (2, ""),
    (17, "or the analog output"),
    (18, "or analog input 3"),
    (15, "or analog input 4"),
    (16, "or analog input 5"),
    (13, "or analog input 6"),
    (14, "or analog input 7"),
    (11, "or analog input 8"),
];

const NAME_WIDTH: f32 = 150.0;
const MARK: egui::Vec2 = vec2(18.0, 20.0);
/// A window that is narrower has the analog lines below the channels.
const WIDE: f32 = 760.0;

pub fn channels_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note = "Channels are read by # while this screen is open, which no macro minds. No command tells a direction: it is known once it was set here.";
    title_ui(ui, "Inputs and Outputs", note);
    let status = model.front.link.status.as_ref().map(status_in);
    let is_held = status.is_some_and(holds_lines);
    if is_held {
        IndicatorState::Warning.line_ui(
            ui,
            "A macro or a wait is in process, which a line would end: the analog lines are not read meanwhile, and nothing is switched. Stop ends it.",
        );
    }
    let channels = &mut model.front.suprmotr_mut().channels;
    if let Some(trouble) = &channels.trouble {
        IndicatorState::Error.line_ui(ui, trouble);
    }
    let takes_lines = status.is_some() && !is_held;
    let mut acts = Vec::new();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let columns = if ui.available_width() < WIDE { 1 } else { 2 };
        ui.columns(columns, |ui| {
            table_ui(&mut ui[0], channels, takes_lines, &mut acts);
            pattern_ui(&mut ui[0], channels, takes_lines, &mut acts);
            let ui = &mut ui[columns - 1];
            switches_ui(ui, status);
            analog_ui(ui, channels, takes_lines, &mut acts);
        });
    });
    commands.extend(acts.into_iter().map(|act| channels.act(act)));
}

fn table_ui(ui: &mut Ui, channels: &Channels, takes_lines: bool, acts: &mut Vec<Act>) {
    heading_ui(ui, "Digital channels (J3)");
    Grid::new("channels").num_columns(5).spacing(vec2(10.0, 3.0)).striped(true).show(ui, |ui| {
        for title in ["Channel", "Reads", "Direction", "Output", ""] {
            ui.label(RichText::new(title).small().weak());
        }
        ui.end_row();
        for channel in 1..=CHANNELS {
            channel_ui(ui, channels, channel, takes_lines, acts);
            ui.end_row();
        }
    });
}

/// All channels at once, by their number as the wire has it (CP).
fn pattern_ui(ui: &mut Ui, channels: &mut Channels, takes_lines: bool, acts: &mut Vec<Act>) {
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        ui.label("Pattern");
        let field = Numeric::new("Channel pattern", "", 0.0..=65_535.0, (0, 1.0, 84.0));
        field.ui(ui, &mut channels.wanted_pattern);
        let hint = "CP makes an output of every channel, also of those that something else drives: two drivers on one line may damage both";
        ui.checkbox(&mut channels.accepts_outputs, "All are outputs").on_hover_text(hint);
        // Whole, and within the field's range.
        let word = channels.wanted_pattern as u16;
        let can = takes_lines && channels.accepts_outputs;
        let response = ui.add_enabled(can, Button::new("Set"));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, can, "Set the channel pattern"));
        let hint = LinesMessage::Pattern { word, bits: binary(word) }.to_string();
        if response.on_hover_text(&hint).on_disabled_hover_text(hint).clicked() {
            acts.push(Act::Pattern(word));
        }
    });
}

/// Channel 16 first.
fn binary(word: u16) -> String {
    format!("{word:016b}")
}

fn channel_ui(ui: &mut Ui, channels: &Channels, channel: u8, takes_lines: bool, acts: &mut Vec<Act>) {
    let (pin, shared) = PINS[usize::from(channel) - 1];
    ui.label(channel.to_string()).on_hover_text(LinesMessage::Pin { pin }.to_string());
    let input = on_off(channels.input(channel));
    mark_ui(ui, channels.input(channel), &LinesMessage::Input { channel, state: input }.to_string(), input);
    let direction = channels.direction(channel);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (wanted, text) in [(Direction::Input, "In"), (Direction::Output, "Out")] {
            let name = match wanted {
                Direction::Input => LinesMessage::MakeInput { channel },
                Direction::Output => LinesMessage::MakeOutput { channel },
            };
            let hint = match wanted {
                Direction::Input => "CI: what is connected drives the line",
                Direction::Output => {
                    "CT: the controller drives the line. See first that nothing else does: two drivers on one line may damage both"
                }
            };
            if choice_ui(ui, text, (&name.to_string(), hint), direction == Some(wanted), takes_lines) {
                acts.push(Act::Turn(channel, wanted));
            }
        }
    });
    let is_output = direction == Some(Direction::Output);
    let level = channels.output(channel).filter(|_| is_output);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (wanted, text) in [(false, "Off"), (true, "On")] {
            let name =
                if wanted { LinesMessage::SwitchOn { channel } } else { LinesMessage::SwitchOff { channel } };
            let hint = if is_output { "CN and CF" } else { "It is no output, as far as is known" };
            let can = takes_lines && is_output;
            if choice_ui(ui, text, (&name.to_string(), hint), level == Some(wanted), can) {
                acts.push(Act::Switch(channel, wanted));
            }
        }
    });
    ui.label(RichText::new(shared).small().weak());
}

/// One of two buttons; true when it was pressed.
fn choice_ui(ui: &mut Ui, text: &str, (name, hint): (&str, &str), is_on: bool, can: bool) -> bool {
    let response = ui.add_enabled(can, Button::selectable(is_on, text).min_size(vec2(34.0, 0.0)));
    response.widget_info(|| WidgetInfo::selected(Role::Button, can, is_on, name));
    response.on_hover_text(hint).on_disabled_hover_text(hint).clicked()
}

const fn on_off(is_on: Option<bool>) -> &'static str {
    match is_on {
        None => "not read",
        Some(true) => "on",
        Some(false) => "off",
    }
}

/// A mark and a word; the name says what it is of.
fn mark_ui(ui: &mut Ui, is_on: Option<bool>, name: &str, word: &str) {
    let state = match is_on {
        None => IndicatorState::Unknown,
        Some(true) => IndicatorState::Active,
        Some(false) => IndicatorState::NotApplicable,
    };
    ui.horizontal(|ui| {
        let response = state.ui(ui, MARK, 6.0);
        response.widget_info(|| WidgetInfo::labeled(Role::Status, true, name));
        ui.add(Label::new(word).selectable(false));
    });
}

fn switches_ui(ui: &mut Ui, status: Option<Status>) {
    heading_ui(ui, "Switches and brake");
    for (bit, name) in [
        (inputs::NEGATIVE, "Negative limit switch"),
        (inputs::REFERENCE, "Reference switch"),
        (inputs::POSITIVE, "Positive limit switch"),
    ] {
        let is_on = status.map(|status| status.inputs & bit != 0);
        let state = on_off(is_on);
        ui.horizontal(|ui| {
            fixed_label_ui(ui, name, NAME_WIDTH);
            mark_ui(ui, is_on, &LinesMessage::Line { name, state }.to_string(), state);
        });
    }
    let is_released = status.map(Status::is_motor_on);
    let state = match is_released {
        None => "not known",
        Some(true) => "released",
        Some(false) => "holds",
    };
    ui.horizontal(|ui| {
        let name = "Brake output (J3 pin 4)";
        fixed_label_ui(ui, name, NAME_WIDTH);
        mark_ui(ui, is_released, &LinesMessage::Line { name, state }.to_string(), state);
    });
    let source = "The brake is told by nothing. Assumed: it is released while the motor is on (MN), and holds while it is off (MF).";
    ui.add(Label::new(RichText::new(source).small().weak()).wrap());
    ui.add_space(10.0);
}

fn analog_ui(ui: &mut Ui, channels: &mut Channels, takes_lines: bool, acts: &mut Vec<Act>) {
    heading_ui(ui, "Analog lines, 5 V at 255");
    for (number, name) in [(1, "Input 1 (J1 pin 3)"), (2, "Input 2 (J2 pin 1)")] {
        analog_line_ui(ui, name, channels.analog(number), takes_lines);
    }
    analog_line_ui(ui, "Output (J3 pin 17)", channels.analog_output(), takes_lines);
    ui.horizontal(|ui| {
        ui.add_space(NAME_WIDTH + ui.spacing().item_spacing.x);
        let field = Numeric::new("Analog output", "V", 0.0..=5.0, (2, 0.02, 84.0));
        field.ui(ui, &mut channels.wanted_volts);
        let steps = steps_of(channels.wanted_volts);
        let name = "Set the analog output";
        let response = ui.add_enabled(takes_lines, Button::new("Set"));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, takes_lines, name));
        if response.on_hover_text(LinesMessage::Sets { steps }.to_string()).clicked() {
            acts.push(Act::Analog(steps));
        }
    });
    let source =
        "Two inputs are told (TA); those on channels 11 to 16 are told by no command. A step is 19.6 mV.";
    ui.add(Label::new(RichText::new(source).small().weak()).wrap());
}

/// One line with its volts, which are old while lines are not taken.
fn analog_line_ui(ui: &mut Ui, name: &'static str, steps: Option<u8>, is_live: bool) {
    let reads = steps.map_or_else(
        || "not read".to_owned(),
        |steps| {
            let volts = f64::from(steps) * STEP_VOLTS;
            LinesMessage::Volts { volts, steps }.to_string()
        },
    );
    let reads = match (steps, is_live) {
        (Some(_), false) => LinesMessage::NotLive { reads }.to_string(),
        (Some(_), true) | (None, _) => reads,
    };
    ui.horizontal(|ui| {
        fixed_label_ui(ui, name, NAME_WIDTH);
        let share = steps.map_or(0.0, |steps| f32::from(steps) / 255.0);
        let response = ui.add(ProgressBar::new(share).desired_width(110.0).text(""));
        let spoken = LinesMessage::Analog { name, reads: reads.clone() }.to_string();
        response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &spoken));
        ui.label(RichText::new(reads).text_style(theme::figures()));
    });
}
