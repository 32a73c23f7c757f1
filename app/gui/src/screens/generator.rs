//! The profile generator: what to play, how far it is, and the figures of the last steps.

use std::ops::RangeInclusive;

use egui::{Button, ComboBox, Grid, Label, RichText, Ui, vec2};

use super::progress::progress_ui;
use crate::command::{Command, Commands, GuidedAction};
use crate::messages::NameMessage;
use crate::model::generator::{duration_text, mode_of};
use crate::model::{IndicatorState, Model};
use crate::screens::messages::ScreenMessage;
use crate::theme::{self, Palette};
use crate::widgets::{Numeric, choice_ui};
use brushwork_core::motion::player::JudgedStep;
use brushwork_core::motion::profile::{COUNT_RANGE, DWELL_RANGE_S, Mode, Profile, Shape};

/// Any count of a 32 bit encoder.
const COUNTS: RangeInclusive<f64> = i32::MIN as f64..=i32::MAX as f64;
const FIELD_WIDTH: f32 = 104.0;
/// Standard deviations that are told as the uncertainty of a figure.
const SPREADS: f64 = 2.0;

pub fn generator_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let Some(scope) = model.screen.arm_scope() else { return };
    let Some(mode) = mode_of(scope) else { return };
    let is_running = model.front.is_guided();
    ui.add_enabled_ui(!is_running, |ui| {
        ui.horizontal_wrapped(|ui| profile_ui(ui, model, mode));
    });
    ui.horizontal(|ui| {
        if is_running {
            return progress_ui(ui, model.front.generator.job.progress(), commands);
        }
        let is_armed = model.front.link.arming.is_armed_for(scope);
        let plan = model.front.plan(mode);
        let run = ui.add_enabled(is_armed && plan.is_ok(), Button::new("Run profile"));
        let run = run.on_disabled_hover_text("Arm this screen first").on_hover_text(
            "Plays it once, stops the motors and disarms. Any stop, and a window that hangs, ends it.",
        );
        if run.clicked() {
            commands.push(Command::Guided(GuidedAction::Play));
        }
        let palette = Palette::of(ui);
        let (text, color) = match plan {
            Ok(legs) if is_armed => (duration_text(&legs), palette.weak_text),
            Ok(legs) => {
                (ScreenMessage::ArmToRun { duration: duration_text(&legs) }.to_string(), palette.weak_text)
            }
            Err(why) => (why.to_string(), palette.warning),
        };
        ui.add(Label::new(RichText::new(text).small().color(color)).truncate());
    });
    figures_ui(ui, &model.front.generator.last_steps(mode), mode);
}

fn profile_ui(ui: &mut Ui, model: &mut Model, mode: Mode) {
    let motors = model.front.motors();
    let generator = &mut model.front.generator;
    for motor in motors {
        let hint = "Whether this motor plays the profile";
        ui.checkbox(&mut generator.motors[motor.index()], motor.to_string()).on_hover_text(hint);
    }
    let profile = generator.profile_mut(mode);
    shape_ui(ui, &mut profile.shape);
    let by_points = profile.shape == Shape::Jog && mode != Mode::Position;
    let unit = if by_points { Mode::Position.unit() } else { mode.unit() };
    let (range, decimals) = match mode {
        Mode::Duty if !by_points => (-100.0..=100.0, 1),
        Mode::Duty | Mode::Speed | Mode::Position => (COUNTS, 0),
    };
    let step = 10f64.powi(-decimals) * 10.0;
    let setpoint = |name| field(name, unit, range.clone(), decimals as usize, step);
    labelled_ui(ui, "From", &setpoint("Profile from"), &mut profile.from);
    labelled_ui(ui, "To", &setpoint("Profile to"), &mut profile.to);
    if by_points {
        let (most, decimals) = if mode == Mode::Duty { (100.0, 1) } else { (f64::from(i32::MAX), 0) };
        let rate = field("Profile rate", mode.unit(), 0.0..=most, decimals, 1.0);
        labelled_ui(ui, "at", &rate, &mut profile.rate);
    }
    labelled_ui(ui, "Dwell", &field("Profile dwell", "s", DWELL_RANGE_S, 2, 0.05), &mut profile.dwell_s);
    count_ui(ui, profile);
}

fn count_ui(ui: &mut Ui, profile: &mut Profile) {
    let range = f64::from(*COUNT_RANGE.start())..=f64::from(*COUNT_RANGE.end());
    let mut count = f64::from(profile.count);
    // A single step has no count, but its place stays.
    ui.add_enabled_ui(profile.shape != Shape::Step, |ui| {
        let numeric = Numeric { width: 48.0, ..field("Profile count", "", range, 0, 1.0) };
        labelled_ui(ui, "Count", &numeric, &mut count);
    });
    profile.count = count as u32;
}

fn field(
    name: &'static str,
    unit: &'static str,
    range: RangeInclusive<f64>,
    decimals: usize,
    step: f64,
) -> Numeric<'static> {
    let width = if unit == "s" { 64.0 } else { FIELD_WIDTH };
    Numeric { name, unit, range, decimals, step, width }
}

fn labelled_ui(ui: &mut Ui, label: &str, field: &Numeric<'_>, value: &mut f64) {
    // Label and field stay on one line.
    ui.horizontal(|ui| {
        ui.weak(label);
        field.ui(ui, value);
    });
}

fn shape_ui(ui: &mut Ui, shape: &mut Shape) {
    let list = ComboBox::from_id_salt("shape").width(156.0);
    let response = choice_ui(ui, list, "Shape", shape, Shape::ALL, Shape::title);
    let hint =
        "A step and a square wave change at once; a trapezoid and a jog keep to Accel, Decel and Speed";
    response.on_hover_text(hint);
}

/// Rise time, overshoot, settling and ITAE of the last steps, and how sure they are.
fn figures_ui(ui: &mut Ui, steps: &[&JudgedStep], mode: Mode) {
    let _palette = Palette::of(ui);
    if steps.is_empty() {
        let hint = "After a step its rise time, overshoot, settling time and ITAE stand here.";
        ui.label(RichText::new(hint).small().weak());
        return;
    }
    Grid::new("figures").spacing(vec2(18.0, 2.0)).show(ui, |ui| {
        for heading in ["Step", "Response", "Rise", "Overshoot", "Settling", "ITAE", "Final error"] {
            let hint = "Of a response that is fitted to the counts with the times at which they were read; ± two standard deviations";
            ui.label(RichText::new(heading).small().weak()).on_hover_text(hint);
        }
        ui.end_row();
        for step in steps {
            step_ui(ui, step, mode);
            ui.end_row();
        }
    });
    for step in steps {
        let Some(late_s) = step.late_s else { continue };
        let late = ScreenMessage::LateStep {
            motor: step.motor,
            text: step.text.clone(),
            milliseconds: late_s * 1e3,
        };
        IndicatorState::Warning.line_ui(ui, &late.to_string());
    }
}

/// A time with twice its standard deviation; one that is no longer than that was not seen.
fn time_text(time_s: Option<f64>, spread_s: Option<f64>, without: &str) -> String {
    match (time_s, spread_s.map(|spread_s| SPREADS * spread_s)) {
        (None, _) => without.to_owned(),
        (Some(time_s), Some(spread_s)) if spread_s < time_s => format!("{time_s:.3} ± {spread_s:.3} s"),
        (Some(_), _) => "not seen".to_owned(),
    }
}

fn step_ui(ui: &mut Ui, step: &JudgedStep, mode: Mode) {
    let (unit, itae_unit) = match mode {
        Mode::Position => ("counts", "counts·s²"),
        Mode::Duty | Mode::Speed => ("counts/s", "counts·s"),
    };
    let mut cells = vec![
        NameMessage::To { from: step.motor.to_string(), to: step.text.clone() }.to_string(),
        format!("{:.0} → {:.0} {unit}", step.start + 0.0, step.end + 0.0),
    ];
    match &step.figures {
        Some(figures) => cells.extend([
            time_text(figures.rise_time_s, step.spread.rise_s, "not reached"),
            format!("{:.1} ± {:.1} %", figures.overshoot * 100.0, SPREADS * step.spread.overshoot * 100.0),
            time_text(figures.settling_time_s, step.spread.settling_s, "not settled"),
            format!("{:.1} {itae_unit}", figures.itae),
            format!("{:.0} {unit}", figures.final_error + 0.0),
        ]),
        None => cells.push("the readings tell none".to_owned()),
    }
    for cell in cells {
        ui.label(RichText::new(cell).text_style(theme::figures()));
    }
}
