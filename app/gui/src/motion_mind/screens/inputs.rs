//! The inputs as the unit measures them, what each pin means in the present mode, and the R/C calibration assistant
//! (Motion Mind manual 4.3).

use brushwork_motion_mind_wire::{register_named, status};
use egui::{Button, Frame, Label, Margin, ProgressBar, RichText, Role, Stroke, Ui, WidgetInfo, vec2};

use crate::command::{Command, Commands};
use crate::model::{Connection, IndicatorState, Model};
use crate::motion_mind::MindAction;
use crate::motion_mind::messages::MindMessage;
use crate::motion_mind::model::radio::{STEP_MS, Stage, WIDE};
use crate::motion_mind::model::registers::in_unit;
use crate::screens::title_ui;
use crate::theme::{self, Palette};
use crate::widgets::label::fixed_label_ui;

const NAME_WIDTH: f32 = 150.0;
const BAR_WIDTH: f32 = 150.0;
const ROW_HEIGHT: f32 = 26.0;

pub fn inputs_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    title_ui(ui, "Inputs and R/C", "What the unit measures at its pins, and ends of the stick for mode 0.");
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let columns = if ui.available_width() < 700.0 { 1 } else { 2 };
        ui.columns(columns, |ui| {
            measured_ui(&mut ui[0], &model.front);
            radio_ui(&mut ui[columns - 1], model, commands);
        });
    });
}

/// One measured input: name, what it means in this mode, and how far it is in its range.
fn measured_ui(ui: &mut Ui, connection: &Connection) {
    let mode = connection.mode();
    ui.strong("Measured");
    for (register, pin, range) in
        [("ANALOGCON", "J4 P4", 1023.0), ("ANALOGFBCK", "J4 P3", 1023.0), ("RCCOUNT", "J6 P2", 1440.0)]
    {
        let raw = connection.register(register);
        let text = raw.zip(register_named(register)).and_then(|(raw, row)| in_unit(row, raw));
        let text = text.unwrap_or_else(|| "–".to_owned());
        ui.horizontal(|ui| {
            fixed_label_ui(ui, &format!("{register} ({pin})"), NAME_WIDTH);
            let share = raw.map_or(0.0, |raw| raw as f32 / range);
            let bar = ProgressBar::new(share).desired_width(BAR_WIDTH).text("");
            let response = ui.add(bar);
            let spoken = format!("{register}: {text}");
            response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &spoken));
            ui.label(RichText::new(&text).text_style(theme::figures()));
        });
        ui.label(RichText::new(meaning(mode, register)).small().weak());
    }
    ui.add_space(8.0);
    ui.strong("Switches");
    for (bit, name, means) in [
        (status::POSLIMIT, "POS_LIM, J4 P17", switch_meaning(mode, true)),
        (status::NEGLIMIT, "NEG_LIM, J4 P16", switch_meaning(mode, false)),
        (status::BRAKE, "_BRAKE, J4 P12", "at ground the bridge is off"),
        (status::INDEX, "Index, J6 P2", "the index channel of an encoder"),
    ] {
        switch_ui(ui, connection, bit, name, means);
    }
}

fn switch_ui(ui: &mut Ui, connection: &Connection, bit: u16, name: &str, means: &str) {
    let low = connection.link.status.as_ref().map(|report| report.word & u32::from(bit) != 0);
    let (state, word) = match low {
        None => (IndicatorState::Unknown, "not known"),
        Some(true) => (IndicatorState::Active, "at ground"),
        Some(false) => (IndicatorState::Ok, "open"),
    };
    ui.horizontal(|ui| {
        ui.set_min_height(ROW_HEIGHT);
        let response = state.ui(ui, vec2(18.0, ROW_HEIGHT), 6.0);
        response.widget_info(|| WidgetInfo::labeled(Role::Status, true, format!("{name}: {word}")));
        ui.add(Label::new(format!("{name}: {word}")).selectable(false));
        ui.add(Label::new(RichText::new(means).small().weak()).truncate());
    });
}

/// What an input is for in a mode (Motion Mind manual 3.5 and chapter 4).
fn meaning(mode: Option<u8>, register: &str) -> &'static str {
    match (register, mode) {
        ("ANALOGCON", Some(1)) => "ANA_SPEED: the speed that is asked for",
        ("ANALOGCON", Some(2)) => "BTN_MODE: 5 V for both directions, 0 V for one",
        ("ANALOGCON", Some(5)) => "ANA_CON: the position that is asked for, unless ADSERIAL is set",
        ("ANALOGCON", _) => "not used in this mode",
        ("ANALOGFBCK", Some(0..=2)) => "the step limit, unless ADSTEP is set: 5 V is no limit",
        ("ANALOGFBCK", Some(5)) => "ANA_FBCK: where the motor is",
        ("ANALOGFBCK", _) => "not used in this mode",
        ("RCCOUNT", Some(0)) => "the stick: RCMIN is full reverse, 1.500 ms stops, RCMAX is full forward",
        _ => "used in mode 0, and as pulse feedback in mode 4",
    }
}

fn switch_meaning(mode: Option<u8>, is_positive: bool) -> &'static str {
    match (mode, is_positive) {
        (Some(1), true) => "ANA_DIR: open is forward",
        (Some(1), false) => "ANA_MODE: at ground both directions",
        (Some(2), true) => "BTN_UP",
        (Some(2), false) => "BTN_DN",
        (_, true) => "at ground the motor does not move forward",
        (_, false) => "at ground the motor does not move backward",
    }
}

fn radio_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let palette = Palette::of(ui);
    let frame = Frame::new().stroke(Stroke::new(1.0, palette.line)).corner_radius(4.0);
    frame.inner_margin(Margin::symmetric(10, 8)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.strong("R/C calibration");
        if model.front.mode() != Some(0) {
            let text = "R/C moves the motor in mode 0 alone. Set SW1 to mode 0 (MODE2, MODE1 and MODE0 on) and switch the power off \
                        and on; then the ends of the stick are found here.";
            ui.add(Label::new(text).wrap());
            return;
        }
        let is_position = model.front.has_bit("FUNCTION", "RCPOS-ENCFDBCK");
        let count = model.front.register("RCCOUNT");
        pulse_ui(ui, &model.front, count);
        stage_ui(ui, model, count, is_position, commands);
    });
}

fn pulse_ui(ui: &mut Ui, connection: &Connection, count: Option<i64>) {
    let bad =
        connection.link.status.as_ref().is_some_and(|report| report.word & u32::from(status::BADRC) != 0);
    let text = match count {
        Some(count) => MindMessage::PulseNow { milliseconds: count as f64 * STEP_MS, count }.to_string(),
        None => "Pulse not read yet".to_owned(),
    };
    ui.horizontal(|ui| {
        let state = if bad { IndicatorState::Warning } else { IndicatorState::Ok };
        state.ui(ui, vec2(18.0, ROW_HEIGHT), 6.0);
        ui.label(RichText::new(text).text_style(theme::figures()));
        if bad {
            ui.label("bad or missing");
        }
    });
}

fn stage_ui(ui: &mut Ui, model: &mut Model, count: Option<i64>, is_position: bool, commands: &mut Commands) {
    let stage = model.front.mind().radio.stage;
    ui.add(Label::new(stage_text(stage)).wrap());
    if is_position && stage == Stage::Idle {
        let text = "R/C position control is on (RCPOS): the pulse is cut at RCMIN and RCMAX while it is measured. Widen them first; \
                    the motor may move.";
        ui.add(Label::new(RichText::new(text).color(Palette::of(ui).warning)).wrap());
        if ui.button("Widen to 0.75 and 2.25 ms").clicked() {
            commands.push(Command::own(MindAction::Radio(WIDE.1, WIDE.0)));
        }
    }
    if let Some(end) = model.front.mind().radio.reached() {
        ui.label(MindMessage::Farthest { milliseconds: end as f64 * STEP_MS, count: end }.to_string());
    }
    if let Some([max, min, band]) = model.front.mind().radio.result(is_position) {
        for (name, value) in [("RCMAX", max), ("RCMIN", min), ("RCBAND", band)] {
            let text = format!("{name} {value} ({:.3} ms)", value as f64 * STEP_MS);
            ui.strong(&text);
        }
    }
    let mut reported = None;
    ui.horizontal_wrapped(|ui| match stage {
        Stage::Idle => {
            if ui.button("Start the calibration").clicked() {
                model.front.mind_mut().radio.start();
            }
        }
        Stage::Done => {
            let hint = "Puts them into the Wanted column of the registers and shows what will be written";
            if ui.button("Use these values…").on_hover_text(hint).clicked() {
                commands.push(Command::own(MindAction::UseRadio));
            }
            if ui.button("Start again").clicked() {
                model.front.mind_mut().radio.start();
            }
        }
        Stage::Middle | Stage::Forward | Stage::Backward => {
            if ui.add(Button::new(button_text(stage))).clicked() {
                reported = model.front.mind_mut().radio.go_on(count).err();
            }
            if ui.button("Cancel").clicked() {
                model.front.mind_mut().radio.give_up();
            }
        }
    });
    if let Some(why) = reported {
        model.messages.warn(why);
    }
}

const fn stage_text(stage: Stage) -> &'static str {
    match stage {
        Stage::Idle => {
            "Finds RCMAX, RCMIN and RCBAND for your transmitter in three steps. The motor follows the stick meanwhile: lift the \
             wheels or take the load off. Nothing is written before you have seen it."
        }
        Stage::Middle => "1. Leave the stick in the middle and trim it until the pulse is 1.500 ms.",
        Stage::Forward => "2. Push the stick fully forward, and hold it there for a second.",
        Stage::Backward => "3. Pull the stick fully back, and hold it there for a second.",
        Stage::Done => "Measured. Let the stick go.",
    }
}

const fn button_text(stage: Stage) -> &'static str {
    match stage {
        Stage::Middle => "The stick is in the middle",
        Stage::Forward => "It was fully forward",
        Stage::Idle | Stage::Backward | Stage::Done => "It was fully back",
    }
}
