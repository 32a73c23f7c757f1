//! The guide: buttons and levels at the top, what is found at the left, its picture at the right.

use egui::{
    Align, Button, Frame, Id, Label, Layout, Margin, ProgressBar, Rect, RichText, ScrollArea, Stroke, Ui,
    UiBuilder, vec2,
};

use super::{Loop, TuneAction, Tuning, plots, result, setup};
use crate::command::{Command, Commands};
use crate::family::Ability;
use crate::focus::{self, Region, region_ui};
use crate::model::{Connection, Model};
use crate::theme::Palette;
use crate::tune::messages::RunMessage;

/// Width of the figures; the picture has the rest.
const LEFT_WIDTH: f32 = 412.0;
/// Below this width the picture stands under the figures.
const SIDE_BY_SIDE: f32 = 720.0;
/// Height of the picture where it stands below.
const PICTURE_HEIGHT: f32 = 300.0;
/// Frames after which the tables of a result have their sizes.
const SETTLED: u8 = 3;

/// Fills what is left of `ui`.
pub fn guide_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let Some(which) = Loop::of(model.screen) else { return };
    if let Some(why) = model.front.cannot_tune() {
        region_ui(ui, Region::Controls);
        ui.add(Label::new(why).wrap());
        return;
    }
    go_to_result(ui, &model.front, which);
    let outline = Stroke::new(1.0, Palette::of(ui).line);
    Frame::new().stroke(outline).corner_radius(4.0).inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        if model.front.tune.is_running() {
            region_ui(ui, Region::Controls);
            progress_ui(ui, &model.front.tune, which, commands);
        } else {
            setup::setup_ui(ui, model, which, commands);
        }
    });
    ui.add_space(4.0);
    if model.front.tune.is_running() {
        let room = ui.available_rect_before_wrap();
        return part_ui(ui, room, |ui| {
            if let Some(sequence) = model.front.tune.running() {
                plots::live_ui(ui, &sequence.live.look(), which, has_duty(&model.front));
            }
        });
    }
    found_ui(ui, model, which, commands);
}

/// When a run has ended and its gains can be applied, the keyboard goes to what came of it; a hand at the pointer is not led about.
fn go_to_result(ui: &Ui, front: &Connection, which: Loop) {
    // How many frames what came of a run has been there; none while it goes on, and nothing where it has been gone to.
    let id = Id::unique("what came of a tuning run is there");
    let frames: Option<u8> = ui.data(|data| data.get_temp(id)).flatten();
    let is_shown = front.tune.front(which).run().is_none_or(|run| run.shown.is_some());
    let is_there = !front.is_guided() && !front.settings.is_busy() && is_shown;
    let frames = match (front.tune.is_running(), frames) {
        (true, _) => Some(0),
        (false, Some(frames)) if is_there => Some(frames + 1),
        (false, frames) => frames,
    };
    // A frame that shows a table for the first time is laid out twice, between which the keyboard would get lost.
    let is_settled = frames == Some(SETTLED);
    ui.data_mut(|data| data.insert_temp(id, frames.filter(|_| !is_settled)));
    if is_settled && focus::shows_ring(ui.ctx()) {
        focus::want(ui.ctx(), Region::Result);
    }
}

/// What the runs have found, with its picture: it needs no controller.
pub fn found_ui(ui: &mut Ui, model: &mut Model, which: Loop, commands: &mut Commands) {
    region_ui(ui, Region::Result);
    let room = ui.available_rect_before_wrap();
    // Each run has a place of its own to be scrolled to, so that a new one is seen from its verdict on.
    let place = ("tune", model.front.tune.front(which).run().map(|run| run.number));
    if room.width() < SIDE_BY_SIDE {
        ScrollArea::vertical().id_salt(place).auto_shrink(false).show(ui, |ui| {
            result::result_ui(ui, model, which, commands);
            let (place, _) =
                ui.allocate_exact_size(vec2(ui.available_width(), PICTURE_HEIGHT), egui::Sense::hover());
            part_ui(ui, place, |ui| picture_ui(ui, &mut model.front, which));
        });
        return;
    }
    let (left, right) = room.split_left_right_at_x(room.left() + LEFT_WIDTH);
    part_ui(ui, left, |ui| {
        ScrollArea::vertical().id_salt(place).auto_shrink(false).show(ui, |ui| {
            ui.set_max_width(LEFT_WIDTH - 14.0);
            result::result_ui(ui, model, which, commands);
        });
    });
    part_ui(ui, right.with_min_x(right.left() + 6.0), |ui| picture_ui(ui, &mut model.front, which));
}

fn picture_ui(ui: &mut Ui, front: &mut Connection, which: Loop) {
    let mut view = front.tune.view;
    plots::result_ui(ui, front.tune.front(which), &mut view, which, has_duty(front));
    front.tune.view = view;
}

/// Whether the controller's duty is known: what is not told has no picture.
fn has_duty(front: &Connection) -> bool {
    front.family().lacks(Ability::Duty).is_none()
}

fn part_ui(ui: &mut Ui, place: Rect, contents: impl FnOnce(&mut Ui)) {
    ui.scope_builder(UiBuilder::new().max_rect(place).layout(Layout::top_down(Align::Min)), contents);
}

/// Whole seconds, so that the figure does not flicker.
fn time_left(seconds: f64) -> String {
    if seconds < 1.5 { "a moment left".to_owned() } else { RunMessage::SecondsLeft { seconds }.to_string() }
}

/// What goes on, how long it will take, and the button that ends it.
fn progress_ui(ui: &mut Ui, tuning: &Tuning, which: Loop, commands: &mut Commands) {
    let Some(sequence) = tuning.running() else { return };
    let _palette = Palette::of(ui);
    let left = super::remaining::remaining(sequence);
    ui.horizontal(|ui| {
        ui.heading(RunMessage::Tuning { motor: tuning.motor(which) }.to_string());
        let stop = Button::new(RichText::new("Stop the run").strong());
        let hint = "Stops at once and puts the old gains back. Esc does the same.";
        if ui.add(stop).on_hover_text(hint).clicked() {
            commands.push(Command::Tune(TuneAction::Cancel));
        }
        let bar = ProgressBar::new(left.fraction).desired_width(220.0);
        ui.add(bar);
        let text = left.seconds.map_or_else(String::new, time_left);
        ui.add(Label::new(RichText::new(text).monospace()).selectable(false));
    });
    ui.horizontal(|ui| {
        ui.label(sequence.text());
        let note = "The gains are tried in RAM only; the old ones are put back at the end, whatever happens.";
        ui.label(RichText::new(note).small().weak());
    });
}
