//! What is always in view: devices and screens at the left, monitored parameters at the top, indicators at the bottom.

use egui::{CentralPanel, Frame, Margin, Panel, ScrollArea, Ui};

use super::command::Commands;
use super::focus::{Region, region_ui};
use super::model::{Layout, Model};
use super::theme::Palette;
use super::{help, screens, traffic, world};

mod bottom;
mod devices;
mod drop;
mod left;
mod marks;
mod menu;
mod message;
pub mod messages;
mod palette;
mod top;

const TRAFFIC_HEIGHT: f32 = 230.0;
const TRAFFIC_RANGE: std::ops::RangeInclusive<f32> = 140.0..=600.0;

/// The whole window.
pub fn shell_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let palette = Palette::of(ui);
    let panel = Frame::new().fill(palette.panel).inner_margin(Margin::symmetric(10, 8));
    let bar = Frame::new().fill(palette.panel).inner_margin(Margin::symmetric(6, 2));
    Panel::top("menus").resizable(false).frame(bar).show(ui, |ui| menu::menu_ui(ui, model, commands));
    let left = Panel::left("left").resizable(true).default_size(model.layout.left_width);
    let left = left.size_range(Layout::LEFT_RANGE).frame(panel);
    let left = left.show(ui, |ui| left::left_ui(ui, model, commands)).response.rect;
    model.layout.left_width = left.width();
    Panel::top("parameters").resizable(false).frame(panel).show(ui, |ui| {
        top::top_ui(ui, model, commands);
    });
    Panel::bottom("indicators").resizable(false).frame(panel).show(ui, |ui| bottom::bottom_ui(ui, model));
    Panel::bottom("message").resizable(false).frame(panel).show(ui, |ui| {
        message::message_ui(ui, model, commands);
    });
    if model.front.worlds.is_some() && model.front.world.open {
        let world = Panel::right("world").resizable(true).default_size(model.layout.world_width);
        let world = world.size_range(Layout::WORLD_RANGE).frame(panel);
        let world = world.show(ui, |ui| {
            region_ui(ui, Region::World);
            ScrollArea::vertical().show(ui, |ui| world::world_ui(ui, model, commands));
        });
        model.layout.world_width = world.response.rect.width();
    }
    if model.front.traffic.open {
        let traffic = Panel::bottom("traffic").resizable(true).default_size(TRAFFIC_HEIGHT);
        traffic.size_range(TRAFFIC_RANGE).frame(panel).show(ui, |ui| {
            region_ui(ui, Region::Traffic);
            traffic::traffic_ui(ui, model, commands);
        });
    }
    let central = Frame::new().fill(palette.panel).inner_margin(Margin::symmetric(12, 10));
    CentralPanel::no_frame().frame(central).show(ui, |ui| screens::screen_ui(ui, model, commands));
    let room = ui.ctx().content_rect().with_min_x(left.right());
    help::help_ui(ui.ctx(), model, room);
    screens::face::all().for_each(|face| face.windows_ui(ui.ctx(), model, commands, room));
    screens::canopen::canopen_ui(ui.ctx(), model, commands, room);
    screens::examination::examination_ui(ui.ctx(), model, commands, room);
    screens::addressing::addressing_ui(ui.ctx(), model, commands, room);
    screens::to_all::to_all_ui(ui.ctx(), model, commands, room);
    screens::raw::raw_ui(ui.ctx(), model, commands, room);
    screens::graph_place::detached_ui(ui.ctx(), model, commands);
    palette::palette_ui(ui.ctx(), model, commands);
    drop::drop_ui(ui.ctx());
}
