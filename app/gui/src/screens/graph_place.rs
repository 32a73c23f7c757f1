//! Where a screen has its graph: there, or a line that says that it stands in a window of its own.

use egui::{Context, Label, RichText, Ui, Vec2, ViewportBuilder, ViewportId, vec2};

use crate::command::{Command, Commands};
use crate::focus::{Region, region_ui};
use crate::graph::{GraphAction, panel};
use crate::keys;
use crate::model::{Connection, Model};
use crate::screens::messages::ScreenMessage;
use crate::theme::Palette;
use crate::widgets::stop;

/// Size of the graph's own window at first.
const WINDOW_SIZE: Vec2 = vec2(960.0, 540.0);
const LEAST_WINDOW_SIZE: Vec2 = vec2(640.0, 320.0);

/// Fills what is left of `ui`.
pub fn graph_place_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    region_ui(ui, Region::Graph);
    if !model.front.graph.detached {
        return panel::graph_ui(ui, &mut model.front.graph, model.front.poll, commands);
    }
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        ui.add(Label::new(RichText::new("The graph stands in a window of its own.").weak()));
        if ui.button("Put it back here").clicked() {
            commands.push(Command::Graph(GraphAction::ToggleDetached));
        }
    });
}

/// The graph in a window of its own, while it is asked for. Closing that puts the graph back.
pub fn detached_ui(ctx: &Context, model: &mut Model, commands: &mut Commands) {
    if !model.front.graph.detached {
        return;
    }
    let title = match &model.front.target {
        Some(target) => ScreenMessage::GraphOf { target: target.clone() }.to_string(),
        None => "Brushwork graph".to_owned(),
    };
    let builder = ViewportBuilder::default()
        .with_title(title)
        .with_app_id("brushwork")
        .with_inner_size(WINDOW_SIZE)
        .with_min_inner_size(LEAST_WINDOW_SIZE);
    let is_any_connected = model.connections().any(Connection::is_connected);
    let id = ViewportId::from_hash_of("graph");
    ctx.show_viewport_immediate(id, builder, |ui, _class| {
        // A window has keys of its own: these stop from there as they do from here.
        if ui.ctx().viewport_id() == id && keys::take_stop_key(ui.ctx()).is_some() {
            commands.push(Command::Stop);
        }
        let fill = Palette::of(ui).panel;
        egui::Frame::new().fill(fill).inner_margin(10.0).show(ui, |ui| {
            ui.horizontal(|ui| {
                let response = stop::small_stop_ui(ui, is_any_connected);
                if stop::pressed(&response) {
                    commands.push(Command::Stop);
                }
                if ui.button("Put it back").on_hover_text("The graph goes back to its screen").clicked() {
                    commands.push(Command::Graph(GraphAction::ToggleDetached));
                }
            });
            panel::graph_ui(ui, &mut model.front.graph, model.front.poll, commands);
        });
        if ui.input(|input| input.viewport().close_requested()) {
            commands.push(Command::Graph(GraphAction::ToggleDetached));
        }
    });
}
