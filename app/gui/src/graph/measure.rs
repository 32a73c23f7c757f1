//! The table under the plot while the cursors are on: where they stand, and what each shown channel does there and
//! between them.

use egui::{Grid, RichText, ScrollArea, Ui};

use super::cursors::{Cursors, Measure};
use super::live::LiveGraph;
use super::picture::{axes, draw};
use super::sheet::{ChannelView, Sheet};
use crate::graph::messages::GraphBarMessage;
use crate::theme::Palette;

const ROW: f32 = 17.0;

/// The table takes no more of the graph's height than this.
const MOST_PART: f32 = 0.42;

const HEADS: [&str; 9] = ["Channel", "A", "B", "B − A", "Mean", "Min", "Max", "Std dev", "Slope /s"];

/// How high the table wants to be, in a graph of that height.
pub fn height(sheet: &Sheet, available: f32) -> f32 {
    if !sheet.cursors.on {
        return 0.0;
    }
    let rows = sheet.shown().len() as f32 + 2.0;
    (rows * ROW + 14.0).min(available * MOST_PART)
}

/// Draws the table.
pub fn measure_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    ui.spacing_mut().item_spacing = egui::vec2(10.0, 1.0);
    ui.spacing_mut().interact_size.y = ROW - 1.0;
    times_ui(ui, graph);
    let sheet = graph.sheet();
    let mut shown = sheet.shown();
    shown.sort_unstable();
    ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
        Grid::new("measures").num_columns(HEADS.len()).min_row_height(ROW - 1.0).striped(true).show(
            ui,
            |ui| {
                let _palette = Palette::of(ui);
                for head in HEADS {
                    ui.label(RichText::new(head).small().weak());
                }
                ui.end_row();
                for channel in shown {
                    row_ui(ui, sheet, channel);
                }
            },
        );
    });
}

/// Where the cursors stand; each can be taken for the arrow keys.
fn times_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let is_recording = graph.opened.is_some();
    let sheet = graph.sheet_mut();
    let zero_s = draw::zero_s(sheet, is_recording);
    let zero = draw::zero_of(sheet, is_recording);
    let step_s = (sheet.span_s() / 1000.0).min(0.1);
    let at_s = [sheet.cursor_s(0), sheet.cursor_s(1)];
    ui.horizontal(|ui| {
        for (which, name) in Cursors::NAMES.into_iter().enumerate() {
            let text = format!("{name}  {}", axes::label(at_s[which] - zero_s, step_s, zero));
            let active = sheet.cursors.active == which;
            let response = ui.selectable_label(active, RichText::new(text).small());
            if response
                .on_hover_text(
                    "Takes this cursor; with the plot selected the arrow keys move it, with Shift further",
                )
                .clicked()
            {
                sheet.cursors.active = which;
            }
        }
        let delta_s = at_s[1] - at_s[0];
        let sign = if delta_s < 0.0 { "−" } else { "" };
        let mut text = format!("B − A  {sign}{}", axes::duration_text(delta_s.abs(), step_s));
        if delta_s != 0.0 {
            text += &format!("   1/(B − A)  {} Hz", figure(1.0 / delta_s.abs(), 3));
        }
        ui.small(text);
    });
}

fn row_ui(ui: &mut Ui, sheet: &Sheet, channel: usize) {
    let view = &sheet.channels[channel];
    let measure = sheet.measure(channel);
    let color = draw::color_of(sheet, Palette::of(ui), channel);
    let label = ui.label(RichText::new(format!("{} {}", channel + 1, view.info.label)).small().color(color));
    let unit = view.info.unit.as_str();
    label.on_hover_text(match measure.count {
        1 => GraphBarMessage::OneReading.to_string(),
        count => GraphBarMessage::Readings { count }.to_string(),
    });
    for (head, text) in HEADS[1..].iter().zip(texts(view, &measure)) {
        let response = ui.label(RichText::new(&text).small().monospace());
        let spoken = format!("{} {head}: {text} {unit}", view.info.label);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_value(spoken.trim_end()));
    }
    ui.end_row();
}

/// The figures of a row; computed ones have a digit more than what was read.
fn texts(view: &ChannelView, measure: &Measure) -> [String; 8] {
    let decimals = view.info.decimals;
    let read = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| figure(value, decimals));
    let computed =
        |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| figure(value, decimals + 1));
    [
        read(measure.a),
        read(measure.b),
        read(measure.delta),
        computed(measure.mean),
        read(measure.min),
        read(measure.max),
        computed(measure.deviation),
        computed(measure.slope_per_s),
    ]
}

/// A number with so many digits after the point, and never minus zero.
fn figure(value: f64, decimals: usize) -> String {
    let factor = 10f64.powi(decimals as i32);
    let rounded = (value * factor).round() / factor + 0.0;
    format!("{rounded:.decimals$}")
}
