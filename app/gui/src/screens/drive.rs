//! What the screens that drive motors share: the arm switch, a motor's row, sync and on release, and the live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Align, Frame, Label, Layout, Margin, RichText, ScrollArea, Stroke, Ui, UiBuilder, vec2};

use super::drawer::{drawer_ui, is_tuning};
use super::stream::stream_ui;
use super::title_ui;
use crate::command::{Command, Commands};
use crate::family::{Ability, Family};
use crate::graph::panel;
use crate::keys::stop_words;
use crate::model::{Arming, Direction, IndicatorState, LinkView, Model, Setpoints};
use crate::theme::Palette;
use crate::tune::guide::guide_ui;
use crate::widgets::jog::{self, jog_ui};
use crate::widgets::{Numeric, Readout, arm_switch_ui};

/// Height of a motor's row.
const ROW_HEIGHT: f32 = 34.0;

/// In a small window the screen scrolls rather than give the graph less.
const LEAST_GRAPH_HEIGHT: f32 = 176.0;
const LEAST_GUIDE_HEIGHT: f32 = 320.0;
/// Height of a screen that has room for the drawer and a graph.
const ROOM_FOR_DRAWER: f32 = 520.0;
const BAR_WIDTH: f32 = 10.0;

const RISK: &str = "While armed, a slider moves its motor at once. Keep clear.";
const RISK_OF_ONE: &str = "While armed, the slider moves the motor at once. Keep clear.";
/// The same where a run is started instead.
const RISK_OF_RUN: &str =
    "While armed, starting the test turns the motor at up to full speed. Keep hands and cables clear.";

/// What a screen that drives is made of: its head, its arm switch, its sliders in `controls_ui`, the drawer and the graph.
pub fn drive_ui(
    ui: &mut Ui,
    model: &mut Model,
    (title, note, scope): (&str, &str, ArmScope),
    commands: &mut Commands,
    controls_ui: impl FnOnce(&mut Ui, &mut Model),
) {
    let room = ui.available_rect_before_wrap();
    model.front.drawers.has_room = room.height() >= ROOM_FOR_DRAWER;
    // The scroll bar stands in the margin of the window, beside everything.
    let with_bar = room.with_max_x(room.right() + BAR_WIDTH);
    ui.scope_builder(UiBuilder::new().max_rect(with_bar), |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_max_width(room.width());
            let top = ui.cursor().top();
            title_ui(ui, title, note);
            arm_ui(ui, scope, &model.front.link, model.front.family(), commands);
            // A large graph takes the room of the sliders. What they asked for goes on; nobody can hold a jog button.
            if is_tuning(model) {
                model.front.release_jogs();
                ui.add_space(2.0);
                drawer_ui(ui, model, commands);
            } else if model.front.graph.large {
                model.front.release_jogs();
            } else {
                ui.add_space(2.0);
                controls_ui(ui, model);
                ui.add_space(2.0);
                drawer_ui(ui, model, commands);
            }
            ui.add_space(4.0);
            let least = if is_tuning(model) { LEAST_GUIDE_HEIGHT } else { LEAST_GRAPH_HEIGHT };
            let height = (room.height() - (ui.cursor().top() - top)).max(least);
            // A place of exact size: what does not fit into it cannot make the screen scroll.
            let (place, _) = ui.allocate_exact_size(vec2(room.width(), height), egui::Sense::hover());
            let layout = Layout::top_down(Align::Min);
            let mut inside = ui.new_child(UiBuilder::new().max_rect(place).layout(layout));
            if is_tuning(model) {
                guide_ui(&mut inside, model, commands);
            } else {
                graph_ui(&mut inside, model, commands);
            }
        });
    });
}

/// The switch, the risk, and what stands in the way.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn arm_ui(ui: &mut Ui, scope: ArmScope, link: &LinkView, family: &dyn Family, commands: &mut Commands) {
    let palette = Palette::of(ui);
    let armed = link.arming.is_armed_for(scope);
    // As thick armed as disarmed, so that nothing moves.
    let outline = Stroke::new(1.5, if armed { palette.warning } else { palette.line });
    Frame::new().stroke(outline).corner_radius(4.0).inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal(|ui| {
            let waiting = matches!(link.arming, Arming::Asked(_));
            if arm_switch_ui(ui, armed, waiting).clicked() {
                commands.push(if armed { Command::Disarm } else { Command::Arm(scope) });
            }
            ui.vertical(|ui| {
                let (risk, what) = match scope {
                    ArmScope::ClampTest => (RISK_OF_RUN, "both motors"),
                    _ if family.motors(link.identity()).len() == 1 => (RISK_OF_ONE, "it"),
                    _ => (RISK, "both"),
                };
                ui.label(format!("{risk} {} stops {what}.", stop_words(ui.ctx())));
                let color = palette.weak_text;
                ui.label(RichText::new(fallback_text(link.arming)).small().color(color));
            });
        });
        if link.stream.is_none() && family.lacks(Ability::Streams).is_none() {
            stream_ui(ui, "port: its time-out is what stops the motors if this program dies.", commands);
        }
        for refusal in &link.refusals {
            IndicatorState::Error.line_ui(ui, &refusal.to_string());
        }
        for warning in &link.warnings {
            IndicatorState::Warning.line_ui(ui, warning);
        }
    });
}

/// What happens if this program dies.
fn fallback_text(arming: Arming) -> String {
    match arming {
        Arming::Armed { controller_timeout: Some(timeout), .. } => format!(
            "If this program falls silent, the controller stops the motors by itself after {:.1} s. \
             Leaving this screen disarms.",
            timeout.as_secs_f64()
        ),
        Arming::Armed { .. } => "Leaving this screen disarms.".to_owned(),
        Arming::Asked(_) => "Asking the controller …".to_owned(),
        Arming::Disarmed => "Disarmed: nothing on this screen moves a motor.".to_owned(),
    }
}

/// One motor's row: its slider in `slider_ui` between two jog buttons, and what a channel reads. Tells which jog button is
/// held.
pub fn motor_ui(
    ui: &mut Ui,
    model: &mut Model,
    motor: Motor,
    output: &Output,
    slider_ui: impl FnOnce(&mut Ui, &mut Model),
) -> Option<Direction> {
    let mut held = None;
    let size = vec2(ui.available_width(), ROW_HEIGHT);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        let is_only = model.front.motors().len() == 1;
        let name = if is_only { "Motor".to_owned() } else { format!("Motor {}", motor.index() + 1) };
        let label = Label::new(name.as_str()).selectable(false);
        ui.add_sized(vec2(62.0, ROW_HEIGHT), label);
        let slider_width = ui.available_width() - output.width;
        let armed = model.front.link.arming.is_armed_for(output.scope);
        ui.add_enabled_ui(armed && !model.front.is_guided(), |ui| {
            let jog = |ui: &mut Ui, direction: Direction| {
                let name = format!(
                    "{} jog {}",
                    if is_only { "Motor".to_owned() } else { motor.to_string() },
                    direction.word()
                );
                let hint = "Runs the motor while it is held: by mouse, or by Enter while it has the focus";
                jog_ui(ui, &name, direction == Direction::Forward, hint).then_some(direction)
            };
            held = jog(ui, Direction::Backward);
            let size = vec2(slider_width - 2.0 * (jog::SIZE.x + ui.spacing().item_spacing.x), ROW_HEIGHT);
            ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
                ui.set_width(size.x);
                slider_ui(ui, model);
            });
            held = held.or(jog(ui, Direction::Forward));
        });
        ui.label(RichText::new(output.word).small().weak());
        let channel = output.channels[motor.index()];
        let text = model.front.link.readings.text(channel);
        let label = format!("{motor} {}", output.word);
        let (digits, unit_letters) = (output.digits, output.unit_letters);
        Readout { label: &label, unit: output.unit, digits, unit_letters }.ui(ui, text.as_deref());
    });
    held
}

/// The row of what the sliders keep to.
pub fn options_ui(ui: &mut Ui, options: impl FnOnce(&mut Ui)) {
    ui.horizontal_wrapped(options);
}

/// A field of that row with its label, which stay on one line.
pub fn pace_ui(ui: &mut Ui, label: &str, hint: &str, field: &Numeric<'_>, value: &mut f64) {
    ui.horizontal(|ui| {
        ui.label(label);
        field.ui(ui, value).on_hover_text(hint);
    });
}

/// What stands at the right of the sliders.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    pub scope: ArmScope,
    pub word: &'static str,
    pub channels: [Channel; 2],
    pub unit: &'static str,
    pub digits: usize,
    pub unit_letters: usize,
    /// Room for word, figure and unit.
    pub width: f32,
}

/// The box that couples both sliders, where there are two.
pub fn sync_ui(ui: &mut Ui, motors: &[Motor], setpoints: &mut Setpoints) {
    if motors.len() < 2 {
        return;
    }
    let mut sync = setpoints.sync;
    if ui.checkbox(&mut sync, "Sync motors").on_hover_text("Both sliders move together").changed() {
        setpoints.set_sync(sync);
    }
}

/// The box that keeps a setpoint back while its slider is held.
pub fn on_release_ui(ui: &mut Ui, setpoints: &mut Setpoints) {
    let hint = "The motor gets a new setpoint only when the slider is let go";
    ui.checkbox(&mut setpoints.on_release, "On release").on_hover_text(hint);
}

/// The live graph and its list of channels, in what is left of the screen.
fn graph_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    panel::graph_ui(ui, &mut model.front.graph, model.front.poll, commands);
}

/// The graph instead of the rest of a screen that drives. The arm switch stays, and so does what it says.
pub fn large_graph_ui(ui: &mut Ui, scope: ArmScope, model: &mut Model, commands: &mut Commands) {
    arm_ui(ui, scope, &model.front.link, model.front.family(), commands);
    ui.add_space(6.0);
    graph_ui(ui, model, commands);
}
