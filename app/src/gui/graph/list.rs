//! The list of channels beside the graph: which are shown, their newest values, and the selected one's scale.

use egui::{
    Align2, Response, Role, ScrollArea, Sense, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

use super::live::{LiveGraph, SPANS_S};
use super::plot::trace_color;
use crate::gui::theme::{self, Palette};
use crate::gui::widgets::readout::NO_VALUE;

const ROW_HEIGHT: f32 = 22.0;
const SWATCH: f32 = 14.0;

/// The channels, one per row.
pub fn channels_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let footer = 66.0;
    ScrollArea::vertical().max_height((ui.available_height() - footer).max(ROW_HEIGHT)).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for index in 0..graph.channels.len() {
            row_ui(ui, graph, index);
        }
    });
    ui.separator();
    selected_ui(ui, graph);
}

/// What is shown of time, above the graph; `ui` lays its buttons out side by side.
pub fn time_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.spacing_mut().button_padding.x = 7.0;
    for span_s in SPANS_S {
        let text = span_text(span_s);
        if ui.selectable_label(graph.span_s == span_s, &text).clicked() {
            graph.span_s = span_s;
        }
    }
    ui.separator();
    let held = graph.is_held();
    let hold = ui.selectable_label(held, "Hold").on_hover_text("Holds the picture; recording goes on");
    if hold.clicked() {
        graph.hold(!held);
    }
    if ui
        .button("Fit all")
        .on_hover_text("Fits the scale of every shown channel to what is in view")
        .clicked()
    {
        graph.fit_shown();
    }
    if ui.button("Clear all").on_hover_text("Clears the lines of all channels").clicked() {
        graph.clear_all();
    }
}

fn span_text(span_s: f64) -> String {
    match span_s {
        s if s < 60.0 => format!("{s:.0} s"),
        s if s < 3600.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}

fn row_ui(ui: &mut Ui, graph: &mut LiveGraph, index: usize) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if swatch_ui(ui, graph, index).clicked() {
            let channel = &mut graph.channels[index];
            channel.shown = !channel.shown;
            if channel.shown {
                graph.selected = index;
            }
        }
        if name_ui(ui, graph, index).clicked() {
            graph.selected = index;
        }
    });
}

/// A box in the channel's colour: filled when it is shown.
fn swatch_ui(ui: &mut Ui, graph: &LiveGraph, index: usize) -> Response {
    let palette = Palette::of(ui);
    let channel = &graph.channels[index];
    let (rect, response) = ui.allocate_exact_size(vec2(SWATCH + 8.0, ROW_HEIGHT), Sense::click());
    let label = format!("Show {}", channel.info.label);
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, channel.shown, &label));
    let square = egui::Rect::from_center_size(rect.center(), vec2(SWATCH, SWATCH));
    let color = trace_color(palette, index);
    let fill = if channel.shown { color } else { palette.panel };
    ui.painter().rect(square, 3.0, fill, Stroke::new(1.0, color), StrokeKind::Inside);
    if channel.shown {
        let mark = Stroke::new(2.0, palette.ground);
        let (middle, left) = (square.center() + vec2(-1.0, 3.0), square.left_center() + vec2(3.0, 0.5));
        ui.painter().line_segment([left, middle], mark);
        ui.painter().line_segment([middle, square.right_top() + vec2(-3.0, 4.0)], mark);
    }
    if response.has_focus() || response.hovered() {
        let ring = Stroke::new(2.0, if response.has_focus() { palette.accent } else { palette.weak_text });
        ui.painter().rect_stroke(square.expand(2.0), 4.0, ring, StrokeKind::Inside);
    }
    response
}

/// Name and newest value; a click selects the channel.
fn name_ui(ui: &mut Ui, graph: &LiveGraph, index: usize) -> Response {
    let palette = Palette::of(ui);
    let channel = &graph.channels[index];
    let selected = graph.selected == index;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::click());
    let value = channel.latest.map(|value| format!("{value:.0$}", channel.info.decimals));
    let spoken =
        format!("{}: {} {}", channel.info.label, value.as_deref().unwrap_or("no value"), channel.info.unit);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, spoken.trim_end()));
    if selected || response.hovered() || response.has_focus() {
        let fill = if selected { palette.raised } else { palette.panel };
        let ring = Stroke::new(1.0, if response.has_focus() { palette.accent } else { palette.line });
        ui.painter().rect(rect.shrink(1.0), 3.0, fill, ring, StrokeKind::Inside);
    }
    let y = rect.center().y;
    let (body, small) = (TextStyle::Body.resolve(ui.style()), TextStyle::Small.resolve(ui.style()));
    let figures = egui::FontId::new(12.5, theme::figures().resolve(ui.style()).family);
    let color = if channel.shown { palette.text } else { palette.weak_text };
    let painter = ui.painter().with_clip_rect(rect);
    painter.text(pos2(rect.left() + 6.0, y), Align2::LEFT_CENTER, channel.info.label, body, color);
    let unit_left = rect.right() - 46.0;
    let value = value.as_deref().unwrap_or(NO_VALUE);
    painter.text(pos2(unit_left - 3.0, y), Align2::RIGHT_CENTER, value, figures, color);
    painter.text(pos2(unit_left, y + 1.0), Align2::LEFT_CENTER, channel.info.unit, small, palette.weak_text);
    response.on_hover_text("Click to write this channel's scale at the side of the graph")
}

fn selected_ui(ui: &mut Ui, graph: &mut LiveGraph) {
    let selected = graph.selected;
    let channel = &graph.channels[selected];
    let decimals = channel.scale.decimals();
    let (low, high) = (channel.scale.low, channel.scale.high);
    ui.horizontal(|ui| {
        let text =
            format!("{} {low:.decimals$} to {high:.decimals$} {}", channel.info.label, channel.info.unit);
        ui.add(egui::Label::new(egui::RichText::new(text).small()).truncate());
    });
    let (mut fit, mut clear) = (false, false);
    ui.horizontal(|ui| {
        fit = ui.button("Fit scale").on_hover_text("Fits this channel's scale to what is in view").clicked();
        clear = ui.button("Clear").on_hover_text("Clears this channel's line").clicked();
    });
    if fit {
        graph.fit(selected);
    }
    if clear {
        graph.clear(selected);
    }
}
