//! What the screens that drive motors share: the arm switch, a motor's row, sync and on release, and the live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Align, Frame, Label, Layout, Margin, RichText, ScrollArea, Stroke, Ui, UiBuilder, vec2};

use super::drawer::{drawer_ui, is_tuning, tabs_ui};
use super::graph_place::graph_place_ui;
use super::split::{GRAPH_PART, Split};
use super::stream::stream_ui;
use crate::command::{Command, Commands};
use crate::family::{Ability, Family};
use crate::focus::{self, Region, region_ui};
use crate::keys::stop_words;
use crate::messages::{MotorFieldMessage, NameMessage};
use crate::model::{Arming, Direction, IndicatorState, LinkView, Model, Setpoints};
use crate::screens::messages::ScreenMessage;
use crate::theme::Palette;
use crate::tune::guide::guide_ui;
use crate::widgets::jog::{self, jog_ui};
use crate::widgets::{Numeric, Readout, arm_switch_ui};

/// Height of a motor's row.
const ROW_HEIGHT: f32 = 32.0;

/// In a small window the screen scrolls rather than give guided tuning less.
const LEAST_GUIDE_HEIGHT: f32 = 320.0;
/// Height of head, arm switch and sliders, and of a drawer below them: where both leave the graph its part, the drawer is open at first.
const ROOM_FOR_CONTROLS: f32 = 194.0;
const ROOM_FOR_DRAWER: f32 = 130.0;
const BAR_WIDTH: f32 = 10.0;

const RISK: &str = "While armed, a slider moves its motor at once. Keep clear.";
const RISK_OF_ONE: &str = "While armed, the slider moves the motor at once. Keep clear.";
/// The same where a run is started instead.
const RISK_OF_RUN: &str =
    "While armed, starting the test turns the motor at up to full speed. Keep hands and cables clear.";

/// What a screen that drives is made of: its head, its arm switch, its sliders in `controls_ui`, the drawer, what the arming says, and the
/// graph.
pub fn drive_ui(
    ui: &mut Ui,
    model: &mut Model,
    (title, note, scope): (&str, &str, ArmScope),
    commands: &mut Commands,
    controls_ui: impl FnOnce(&mut Ui, &mut Model),
) {
    let room = ui.available_rect_before_wrap();
    let wanted = GRAPH_PART * ui.ctx().content_rect().height();
    model.front.drawers.has_room = room.height() - ROOM_FOR_CONTROLS - ROOM_FOR_DRAWER >= wanted;
    // The scroll bar stands in the margin of the window, beside everything.
    let with_bar = room.with_max_x(room.right() + BAR_WIDTH);
    ui.scope_builder(UiBuilder::new().max_rect(with_bar), |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_max_width(room.width());
            ui.spacing_mut().item_spacing.y = 4.0;
            let bottom = ui.cursor().top() + room.height();
            head_ui(ui, model, title, note);
            arm_ui(ui, scope, &model.front.link, model.front.family(), commands);
            // Guided tuning and a large graph take the room of the sliders. What they asked for goes on; nobody can hold a jog button.
            if is_tuning(model) {
                model.front.release_jogs();
                notices_ui(ui, &model.front.link);
                return tuning_ui(ui, model, bottom, commands);
            }
            let split = Split::of(ui, model.screen, bottom);
            split.above_ui(ui, model, |ui, model| {
                ui.add_space(2.0);
                region_ui(ui, Region::Controls);
                controls_ui(ui, model);
                drawer_ui(ui, model, commands);
            });
            notices_ui(ui, &model.front.link);
            split.graph_ui(ui, model, commands);
        });
    });
}

/// Guided tuning in what is left.
fn tuning_ui(ui: &mut Ui, model: &mut Model, bottom: f32, commands: &mut Commands) {
    ui.add_space(4.0);
    let height = (bottom - ui.cursor().top()).max(LEAST_GUIDE_HEIGHT);
    // A place of exact size: what does not fit into it cannot make the screen scroll.
    let (place, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), egui::Sense::hover());
    let layout = Layout::top_down(Align::Min);
    guide_ui(&mut ui.new_child(UiBuilder::new().max_rect(place).layout(layout)), model, commands);
}

/// The screen's title, the tabs of its drawer, and a line of explanation.
fn head_ui(ui: &mut Ui, model: &mut Model, title: &str, note: &str) {
    ui.horizontal(|ui| {
        focus::heading_ui(ui, title).on_hover_text(note);
        ui.add_space(6.0);
        tabs_ui(ui, model);
        ui.add_space(6.0);
        ui.add(Label::new(RichText::new(note).weak()).truncate());
    });
}

/// The switch and the risk. What stands in the way of arming is in [`notices_ui`], so that nothing here moves when it is pressed.
pub fn arm_ui(ui: &mut Ui, scope: ArmScope, link: &LinkView, family: &dyn Family, commands: &mut Commands) {
    let palette = Palette::of(ui);
    let armed = link.arming.is_armed_for(scope);
    // As thick armed as disarmed, so that nothing moves.
    let outline = Stroke::new(1.5, if armed { palette.warning } else { palette.line });
    Frame::new().stroke(outline).corner_radius(4.0).inner_margin(Margin::symmetric(10, 4)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal(|ui| {
            let waiting = matches!(link.arming, Arming::Asked(_));
            if arm_switch_ui(ui, armed, waiting).clicked() {
                commands.push(if armed { Command::Disarm } else { Command::Arm(scope) });
            }
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                let (risk, what) = risk(scope, family.motors(link.identity()).len());
                ui.label(ScreenMessage::Stops { risk, keys: stop_words(ui.ctx()), what }.to_string());
                let text = RichText::new(fallback_text(link.arming)).small().color(palette.weak_text);
                ui.add(Label::new(text).truncate());
            });
        });
        if link.stream.is_none() && family.lacks(Ability::Streams).is_none() {
            stream_ui(ui, "port: its time-out is what stops the motors if this program dies.", commands);
        }
    });
}

/// What arming risks, and what Stop stops.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn risk(scope: ArmScope, motors: usize) -> (&'static str, &'static str) {
    match scope {
        ArmScope::ClampTest => (RISK_OF_RUN, "both motors"),
        _ if motors == 1 => (RISK_OF_ONE, "it"),
        _ => (RISK, "both"),
    }
}

/// Why arming was refused, and what an armed screen has to be warned of. It takes its room from what stands below the controls.
pub fn notices_ui(ui: &mut Ui, link: &LinkView) {
    for refusal in &link.refusals {
        IndicatorState::Error.line_ui(ui, &refusal.to_string());
    }
    for warning in &link.warnings {
        IndicatorState::Warning.line_ui(ui, warning);
    }
}

/// What happens if this program dies.
fn fallback_text(arming: Arming) -> String {
    match arming {
        Arming::Armed { controller_timeout: Some(timeout), .. } => {
            ScreenMessage::FallsSilent { seconds: timeout.as_secs_f64() }.to_string()
        }
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
        let name = if is_only {
            "Motor".to_owned()
        } else {
            NameMessage::Motor { number: motor.index() + 1 }.to_string()
        };
        let label = Label::new(name.as_str()).selectable(false);
        ui.add_sized(vec2(62.0, ROW_HEIGHT), label);
        let slider_width = ui.available_width() - output.width;
        let armed = model.front.link.arming.is_armed_for(output.scope);
        ui.add_enabled_ui(armed && !model.front.is_guided(), |ui| {
            let jog = |ui: &mut Ui, direction: Direction| {
                let name = match (direction, is_only) {
                    (Direction::Backward, true) => MotorFieldMessage::JogOnlyBackward,
                    (Direction::Backward, false) => MotorFieldMessage::JogBackward { motor },
                    (Direction::Forward, true) => MotorFieldMessage::JogOnlyForward,
                    (Direction::Forward, false) => MotorFieldMessage::JogForward { motor },
                }
                .to_string();
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

/// The graph instead of the rest of a screen that drives. The arm switch stays, and so does what it says.
pub fn large_graph_ui(ui: &mut Ui, scope: ArmScope, model: &mut Model, commands: &mut Commands) {
    model.front.release_jogs();
    arm_ui(ui, scope, &model.front.link, model.front.family(), commands);
    notices_ui(ui, &model.front.link);
    ui.add_space(6.0);
    graph_place_ui(ui, model, commands);
}
