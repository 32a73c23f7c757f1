//! Draws the graph: the grid, a line per shown channel, the selected channel's scale at the side.

use egui::{Color32, Response, Role, Sense, Stroke, Ui, Vec2b, WidgetInfo};
use egui_plot::{AxisHints, GridMark, HLine, Line, Plot, PlotPoint, PlotPoints};

use super::live::LiveGraph;
use super::scale::DIVISIONS;
use super::trace::Columns;
use crate::gui::theme::Palette;

/// Width kept for the figures of the vertical axis, so that the grid never moves.
const AXIS_WIDTH: f32 = 76.0;

/// Room for one figure of the horizontal axis.
const LABEL_WIDTH: f32 = 56.0;

/// Room for one figure of the vertical axis.
const LABEL_HEIGHT: f32 = 20.0;

/// Fills what is left of `ui`.
pub fn plot_ui(ui: &mut Ui, graph: &LiveGraph) -> Response {
    let palette = Palette::of(ui);
    let width = (ui.available_width() - AXIS_WIDTH).max(16.0);
    let labels = (width / LABEL_WIDTH) as usize;
    let every = (DIVISIONS as f32 * LABEL_HEIGHT / ui.available_height().max(1.0)).ceil().max(1.0) as usize;
    let columns = (width * ui.pixels_per_point()).clamp(16.0, 8192.0) as usize;
    let columns = Columns::new(graph.history(), &graph.view(columns));
    let lines = shown_lines(graph, &columns, palette);
    let selected = &graph.channels[graph.selected];
    let (scale, unit, span_s) = (selected.scale, selected.info.unit, graph.span_s);
    let decimals = scale.decimals();
    let division_s = division_s(span_s);
    let response = Plot::new("live graph")
        .default_x_bounds(-span_s, 0.0)
        .default_y_bounds(0.0, 1.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_axis_zoom_drag(false)
        .set_margin_fraction(egui::Vec2::ZERO)
        .sense(Sense::hover())
        .show_crosshair(false)
        .show_axes(Vec2b::TRUE)
        .grid_color(palette.line)
        .grid_fade(0.0)
        .grid_spacing(2.0..=4.0)
        .x_grid_spacer(move |_| x_marks(span_s, division_s))
        .y_grid_spacer(move |_| y_marks(every))
        .custom_x_axes(vec![
            AxisHints::new_x()
                .label_spacing(1.0..=2.0)
                .tick_label_color(palette.weak_text)
                .formatter(move |mark, _| time_label(mark.value, span_s, division_s, labels)),
        ])
        .custom_y_axes(vec![
            AxisHints::new_y()
                .label_spacing(1.0..=2.0)
                .min_thickness(AXIS_WIDTH)
                .tick_label_color(palette.text)
                .formatter(move |mark, _| {
                    let division = (mark.value * DIVISIONS as f64).round() as usize;
                    let value = scale.value(mark.value) + 0.0;
                    if division.is_multiple_of(every) {
                        format!("{value:.decimals$} {unit}")
                    } else {
                        String::new()
                    }
                }),
        ])
        .label_formatter(|_| None)
        .show(ui, |plot| {
            // Room for the label of the newest second, and for lines at the very top and bottom.
            plot.set_plot_bounds_x(-span_s..=span_s * 0.025);
            plot.set_plot_bounds_y(-0.015..=1.015);
            let zero = scale.part(0.0);
            plot.hline(
                HLine::new("zero", zero).stroke(Stroke::new(1.0, palette.weak_text)).allow_hover(false),
            );
            for line in lines {
                plot.line(line);
            }
        })
        .response;
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, spoken(graph)));
    response
}

fn shown_lines<'a>(graph: &LiveGraph, columns: &Columns, palette: &Palette) -> Vec<Line<'a>> {
    // The selected channel is drawn last, on top, and thicker.
    let shown = |index: &usize| graph.channels[*index].shown;
    let others = (0..graph.channels.len()).filter(|index| *index != graph.selected);
    let order = others.chain([graph.selected]).filter(shown);
    let mut lines = Vec::new();
    for index in order {
        let color = trace_color(palette, index);
        let width = if index == graph.selected { 2.0 } else { 1.2 };
        for points in graph.lines(index, columns) {
            let points = points.into_iter().map(|[x, y]| PlotPoint::new(x, y)).collect();
            let line = Line::new(graph.channels[index].info.label, PlotPoints::Owned(points));
            lines.push(line.color(color).width(width).allow_hover(false));
        }
    }
    lines
}

pub fn trace_color(palette: &Palette, index: usize) -> Color32 {
    palette.traces[index % palette.traces.len()]
}

/// Seconds per vertical division: one, as long as that can be seen.
fn division_s(span_s: f64) -> f64 {
    match span_s {
        s if s <= 60.0 => 1.0,
        s if s <= 600.0 => 30.0,
        _ => 300.0,
    }
}

fn x_marks(span_s: f64, division_s: f64) -> Vec<GridMark> {
    let count = (span_s / division_s).round() as usize;
    (0..=count).map(|i| GridMark { value: -(i as f64) * division_s, step_size: division_s }).collect()
}

/// Marks that carry a figure say that there is room for it.
fn y_marks(every: usize) -> Vec<GridMark> {
    let part = 1.0 / DIVISIONS as f64;
    let room = |i: usize| if i.is_multiple_of(every) { part * every as f64 } else { part };
    (0..=DIVISIONS).map(|i| GridMark { value: i as f64 * part, step_size: room(i) }).collect()
}

/// At most about `labels` labels, the newest called "now".
fn time_label(seconds: f64, span_s: f64, division_s: f64, labels: usize) -> String {
    let index = (-seconds / division_s).round() as usize;
    let every = ((span_s / division_s) / labels.max(1) as f64).ceil() as usize;
    let every = [1, 2, 5, 10, 20].into_iter().find(|step| *step >= every).unwrap_or(60);
    match index {
        0 => "now".to_owned(),
        index if !index.is_multiple_of(every) => String::new(),
        index if span_s > 60.0 => format!("−{:.0} min", index as f64 * division_s / 60.0),
        index => format!("−{:.0} s", index as f64 * division_s),
    }
}

fn spoken(graph: &LiveGraph) -> String {
    let shown: Vec<_> =
        graph.channels.iter().filter(|channel| channel.shown).map(|channel| channel.info.label).collect();
    let shown = if shown.is_empty() { "no channel".to_owned() } else { shown.join(", ") };
    format!("Live graph of the last {:.0} s: {shown}", graph.span_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisions_are_one_second_up_to_a_minute() {
        assert_eq!(x_marks(10.0, division_s(10.0)).len(), 11);
        assert_eq!(division_s(60.0), 1.0);
    }

    #[test]
    fn there_are_never_more_labels_than_can_be_read() {
        for span_s in crate::gui::graph::live::SPANS_S {
            let division_s = division_s(span_s);
            let labels = x_marks(span_s, division_s)
                .iter()
                .map(|mark| time_label(mark.value, span_s, division_s, 12))
                .filter(|label| !label.is_empty())
                .count();
            assert!((6..=13).contains(&labels), "{labels} labels for {span_s} s");
        }
    }
}
