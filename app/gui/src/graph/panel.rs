//! The whole graph: buttons above, the plot, measures under it, and the list of channels at the right.

use brushwork_link::device::PollRate;
use egui::{Align, Layout, Rect, Ui, UiBuilder};

use super::{LiveGraph, list, measure, plot, toolbar};
use crate::command::Commands;

/// Width of the list of channels.
const LIST_WIDTH: f32 = 258.0;

/// Fills what is left of `ui`.
pub fn graph_ui(ui: &mut Ui, graph: &mut LiveGraph, poll: PollRate, commands: &mut Commands) {
    // Places of exact size: none can push another out of the window.
    let (place, _) = ui.allocate_exact_size(ui.available_size(), egui::Sense::hover());
    part_ui(ui, place, |ui| {
        ui.horizontal_wrapped(|ui| toolbar::toolbar_ui(ui, graph, poll, commands));
        ui.spacing_mut().item_spacing.y = 2.0;
        let below = ui.available_rect_before_wrap();
        if graph.legend.is_some() {
            return part_ui(ui, below, |ui| picture_ui(ui, graph, poll));
        }
        let (left, right) = below.split_left_right_at_x(below.right() - LIST_WIDTH);
        let left = left.with_max_x(left.right() - 8.0);
        part_ui(ui, left, |ui| picture_ui(ui, graph, poll));
        part_ui(ui, right, |ui| list::channels_ui(ui, graph));
    });
}

fn picture_ui(ui: &mut Ui, graph: &mut LiveGraph, poll: PollRate) {
    toolbar::status_ui(ui, graph, poll);
    let rest = ui.available_rect_before_wrap();
    let table = measure::height(graph.sheet(), rest.height());
    let (upper, lower) = rest.split_top_bottom_at_y(rest.bottom() - table);
    part_ui(ui, upper, |ui| {
        plot::plot_ui(ui, graph);
    });
    if table > 0.0 {
        part_ui(ui, lower, |ui| measure::measure_ui(ui, graph));
    }
}

fn part_ui(ui: &mut Ui, place: Rect, contents: impl FnOnce(&mut Ui)) {
    ui.scope_builder(UiBuilder::new().max_rect(place).layout(Layout::top_down(Align::Min)), contents);
}
