//! A small chart: lines over a grid with figures, a legend, and the values under the pointer.

use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{
    Align2, Color32, FontId, Rangef, Rect, Role, Sense, TextStyle, Ui, UiBuilder, Vec2, WidgetInfo, vec2,
};
use egui_plot::{
    AxisHints, CoordinatesFormatter, Corner, GridInput, GridMark, LineStyle, Plot, PlotPoint, PlotUi, Text,
};

use crate::theme::Palette;

/// Room for the figures at the left and below, for the names above, and for half of the last figure.
const LEFT: f32 = 62.0;
const BELOW: f32 = 18.0;
const ABOVE: f32 = 16.0;
const RIGHT: f32 = 14.0;
const FIGURE: f32 = 10.5;
/// Least distances of the grid's lines on the screen.
const APART: [f64; 2] = [70.0, 28.0];

/// How a line is drawn: not by its colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    Solid,
    Dashed,
    Dots,
    /// Wide and pale, to lie under another.
    Under,
    /// What others are measured by: its name stands at its first point and not in the legend.
    Mark,
}

impl Look {
    /// Width, style, opacity, and what stands for it in the legend.
    fn drawn(self) -> (f32, LineStyle, f32, &'static str) {
        match self {
            Self::Solid => (1.8, LineStyle::Solid, 1.0, "━━━"),
            Self::Dashed => (1.5, LineStyle::Dashed { length: 6.0 }, 1.0, "╍╍╍"),
            Self::Dots => (1.7, LineStyle::Dotted { spacing: 6.0 }, 1.0, "•••"),
            Self::Under => (4.5, LineStyle::Solid, 0.55, "▬▬▬"),
            Self::Mark => (1.3, LineStyle::Dashed { length: 5.0 }, 1.0, ""),
        }
    }
}

/// A line.
#[derive(Clone, Debug)]
pub struct Line {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    pub color: Color32,
    pub look: Look,
}

impl Line {
    fn is_in_legend(&self) -> bool {
        self.look != Look::Mark && !self.points.is_empty() && !self.name.is_empty()
    }
}

/// One axis of a chart. Two of the same unit have the same scale.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    pub name: &'static str,
    pub unit: &'static str,
    pub low: f64,
    pub high: f64,
    pub is_log: bool,
}

impl Axis {
    pub fn new(name: &'static str, unit: &'static str, low: f64, high: f64) -> Self {
        Self { name, unit, low, high, is_log: false }
    }

    pub fn log(self) -> Self {
        Self { is_log: true, ..self }
    }

    /// Wide enough for the lines' values on it, with some room.
    pub fn around(name: &'static str, unit: &'static str, values: impl Iterator<Item = f64>) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Self::new(name, unit, 0.0, 1.0);
        }
        let room = (0.06 * (high - low)).max(1e-9 * high.abs()).max(0.5);
        let step = tick_step(high - low + 2.0 * room, 4);
        Self::new(name, unit, ((low - room) / step).floor() * step, ((high + room) / step).ceil() * step)
    }

    /// Where a value lies in the plot, which knows no logarithms.
    fn place(&self, value: f64) -> f64 {
        if self.is_log { value.max(1e-12).log10() } else { value }
    }

    fn value(&self, place: f64) -> f64 {
        if self.is_log { 10_f64.powf(place) } else { place }
    }

    fn ticks(&self, (low, high): (f64, f64), most: usize) -> Vec<GridMark> {
        let step = if self.is_log { 1.0 } else { tick_step(high - low, most) };
        let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        (first..=last.min(first + 40)).map(|n| GridMark { value: n as f64 * step, step_size: step }).collect()
    }

    fn grid(&self, input: &GridInput, apart: f64) -> Vec<GridMark> {
        let most = (input.bounds.1 - input.bounds.0) / (input.base_step_size * apart);
        self.ticks(input.bounds, most.clamp(2.0, 10.0) as usize)
    }

    /// A tick's figure, with as many digits as the step needs.
    fn figure(&self, tick: GridMark) -> String {
        let value = self.value(if tick.value.abs() < tick.step_size * 1e-6 { 0.0 } else { tick.value });
        let step = if self.is_log { value } else { tick.step_size };
        let decimals = (-step.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
        format!("{value:.decimals$}")
    }
}

/// The step of 1, 2 or 5 times a power of ten that gives at most so many parts.
fn tick_step(span: f64, most: usize) -> f64 {
    let raw = (span / most.max(1) as f64).max(1e-12);
    let power = 10_f64.powf(raw.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|times| times * power);
    steps.into_iter().find(|step| *step >= raw * 0.999).unwrap_or(10.0 * power)
}

/// Draws `lines` in `size`, or says `empty` while there are none. A screen reader says `name`.
pub fn chart_ui(ui: &mut Ui, name: &str, axes: (Axis, Axis), lines: &[Line], empty: &str, size: Vec2) {
    if size.y < 1.0 {
        return;
    }
    let palette = Palette::of(ui);
    let (outer, response) = ui.allocate_exact_size(size.max(vec2(80.0, 40.0)), Sense::hover());
    let names: Vec<&str> = lines.iter().filter(|l| l.is_in_legend()).map(|l| l.name.as_str()).collect();
    let spoken = if names.is_empty() { name.to_owned() } else { format!("{name}: {}", names.join(", ")) };
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
    let frame = Rect::from_min_max(outer.min + vec2(0.0, ABOVE), outer.max - vec2(RIGHT, 0.0));
    let mut inside = ui.new_child(UiBuilder::new().max_rect(frame));
    inside.style_mut().text_styles.insert(TextStyle::Monospace, FontId::monospace(FIGURE + 0.5));
    // The values stand where the pointer is not.
    let is_right = response.hover_pos().is_some_and(|at| at.x > frame.center().x);
    let corner = if is_right { Corner::LeftTop } else { Corner::RightTop };
    let plot = plot(name, axes, palette)
        .coordinates_formatter(corner, CoordinatesFormatter::new(|at, _| read_out(axes, lines, at)));
    let shown = plot.show(&mut inside, |plot| {
        plot.set_plot_bounds_x(axes.0.place(axes.0.low)..=axes.0.place(axes.0.high));
        plot.set_plot_bounds_y(axes.1.place(axes.1.low)..=axes.1.place(axes.1.high));
        for line in lines {
            add(plot, axes, line);
        }
    });
    names_ui(ui, shown.response.rect, axes.1, lines);
    if lines.iter().all(|line| line.points.is_empty() || line.look == Look::Mark) {
        let (place, font) = (shown.response.rect, FontId::proportional(13.0));
        let text = ui.painter().layout(empty.to_owned(), font, palette.weak_text, place.width() - 24.0);
        ui.painter().galley(place.center() - text.size() / 2.0, text, palette.weak_text);
    }
}

/// An empty plot that stays where it is, whatever the pointer does on it.
fn plot<'a>(name: &str, (x, y): (Axis, Axis), palette: &Palette) -> Plot<'a> {
    let hints = |hints: AxisHints<'a>| {
        let font = FontId::monospace(FIGURE);
        hints.tick_label_font(font).tick_label_color(palette.weak_text).label_spacing(Rangef::new(0.0, 1.0))
    };
    let with_unit = move |tick: GridMark, shown: &std::ops::RangeInclusive<f64>| {
        // The last one tells what it is.
        let is_last = tick.value + 0.999 * tick.step_size > *shown.end();
        let unit = if x.unit.is_empty() { x.name } else { x.unit };
        let figure = x.figure(tick);
        if is_last {
            format!("{figure} {unit}")
        } else if tick.value < *shown.start() + 0.001 * tick.step_size {
            // In the corner it stands to the right of the axis, since the lowest figure of the other axis is at its left.
            format!("{figure:>width$}", width = 2 * figure.len() + 1)
        } else {
            figure
        }
    };
    let plot = Plot::new(name)
        .sense(Sense::hover())
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_axis_zoom_drag(false)
        .show_y(false)
        .cursor_color(palette.weak_text)
        .min_size(vec2(20.0, 20.0))
        .grid_spacing(Rangef::new(1.0, 2.0))
        .grid_color(palette.line.gamma_multiply(0.6))
        .x_grid_spacer(move |input| x.grid(&input, APART[0]))
        .y_grid_spacer(move |input| y.grid(&input, APART[1]))
        .custom_x_axes(vec![hints(AxisHints::new_x().min_thickness(BELOW).formatter(with_unit))])
        .custom_y_axes(vec![hints(
            AxisHints::new_y().min_thickness(LEFT).formatter(move |tick, _| y.figure(tick) + " "),
        )]);
    if x.unit == y.unit { plot.data_aspect(1.0) } else { plot }
}

/// What the plot shows upwards, and the lines' names with samples, the topmost line first.
fn names_ui(ui: &Ui, plot: Rect, y: Axis, lines: &[Line]) {
    let (palette, painter) = (Palette::of(ui), ui.painter());
    let font = FontId::proportional(FIGURE + 0.5);
    let y_name = [y.name, y.unit].join(" ");
    let above = vec2(0.0, 2.0);
    let used =
        painter.text(plot.left_top() - above, Align2::LEFT_BOTTOM, y_name.trim(), font.clone(), palette.text);
    let mut legend = LayoutJob::default();
    for line in lines.iter().rev().filter(|line| line.is_in_legend()) {
        let (_, _, opacity, sample) = line.look.drawn();
        let color = line.color.gamma_multiply(opacity);
        legend.append(sample, 12.0, TextFormat::simple(FontId::monospace(FIGURE), color));
        legend.append(&line.name, 4.0, TextFormat::simple(font.clone(), palette.text));
    }
    legend.wrap = TextWrapping::truncate_at_width((plot.right() - used.right()).max(0.0));
    let legend = painter.layout_job(legend);
    painter.galley(plot.right_top() - legend.size() - above, legend, palette.text);
}

fn add(plot: &mut PlotUi<'_>, (x, y): (Axis, Axis), line: &Line) {
    let (width, style, opacity, _) = line.look.drawn();
    let color = line.color.gamma_multiply(opacity);
    // Far outside is as good as outside, and not as long to dash.
    let far = 4.0 * (y.high - y.low);
    let place = |[at, value]: &[f64; 2]| [x.place(*at), y.place(*value).clamp(y.low - far, y.high + far)];
    // What is no number leaves a gap.
    for part in line.points.split(|point| !(point[0].is_finite() && point[1].is_finite())) {
        let points: Vec<[f64; 2]> = part.iter().map(place).collect();
        if let Some([x, y]) = points.first().filter(|_| line.look == Look::Mark) {
            let in_size = |size| TextFormat::simple(FontId::proportional(size), color);
            let mut word = LayoutJob::default();
            word.append(&line.name, 4.0, in_size(FIGURE));
            // A low row below lifts the word off its line.
            word.append("\n ", 0.0, in_size(2.0));
            plot.text(Text::new("", PlotPoint::new(*x, *y), word).anchor(Align2::LEFT_BOTTOM).color(color));
        }
        // A band instead of a line would fill the steps of a staircase.
        let drawn = egui_plot::Line::new("", points).allow_band(false).allow_hover(false);
        plot.line(drawn.width(width).style(style).color(color));
    }
}

/// The lines' values where the pointer is; where both axes have the same unit, that place.
fn read_out((x, y): (Axis, Axis), lines: &[Line], at: &PlotPoint) -> String {
    let here = x.value(at.x);
    let mut text = format!("{} {} {}", x.name, short(here), x.unit);
    if x.unit == y.unit {
        return text + &format!("\n{} {} {}", y.name, short(at.y), y.unit);
    }
    for line in lines.iter().filter(|line| line.is_in_legend() && line.look != Look::Dots) {
        let index = line.points.partition_point(|point| point[0] < here);
        if let Some(point) = line.points.get(index).filter(|point| index > 0 && point[1].is_finite()) {
            text += &format!("\n{}: {} {}", line.name, short(point[1]), y.unit);
        }
    }
    text
}

fn short(value: f64) -> String {
    match value.abs() {
        big if big >= 1000.0 => format!("{value:.0}"),
        middle if middle >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_a_grid_are_one_two_or_five() {
        for (span, most, step) in [(1.0, 5, 0.2), (10.0, 4, 5.0), (44_000.0, 8, 10_000.0), (0.35, 6, 0.1)] {
            assert!((tick_step(span, most) - step).abs() < 1e-9, "{span} {most}: {}", tick_step(span, most));
        }
    }

    #[test]
    fn an_axis_holds_all_values_and_its_ends_are_round() {
        let axis = Axis::around("speed", "counts/s", [120.0, 9_870.0, f64::NAN].into_iter());
        assert!(axis.low <= 120.0 && axis.high >= 9_870.0 && axis.high % 1000.0 == 0.0, "{axis:?}");
        let flat = Axis::around("speed", "counts/s", [5.0, 5.0].into_iter());
        assert!(flat.low < 5.0 && flat.high > 5.0);
        let empty = Axis::around("speed", "counts/s", std::iter::empty());
        assert_eq!((empty.low, empty.high), (0.0, 1.0));
    }

    #[test]
    fn a_logarithmic_axis_has_its_decades_as_ticks() {
        let axis = Axis::new("frequency", "Hz", 0.02, 150.0).log();
        let ticks = axis.ticks((axis.place(axis.low), axis.place(axis.high)), 9);
        let figures: Vec<String> = ticks.into_iter().map(|tick| axis.figure(tick)).collect();
        assert_eq!(figures, ["0.1", "1", "10", "100"]);
        assert!((axis.value(axis.place(3.0)) - 3.0).abs() < 1e-9);
    }

    #[test]
    fn the_values_under_the_pointer_are_those_of_the_lines_there() {
        let line = |name: &str, points: &[[f64; 2]], look| Line {
            name: name.to_owned(),
            points: points.to_vec(),
            color: Color32::WHITE,
            look,
        };
        let axes = (Axis::new("time", "s", 0.0, 2.0), Axis::new("speed", "counts/s", 0.0, 2000.0));
        let lines = [
            line("level", &[[0.0, 7.0], [2.0, 7.0]], Look::Mark),
            line("ended", &[[0.0, 5.0], [0.5, 5.0]], Look::Solid),
            line("gap", &[[0.0, 5.0], [2.0, f64::NAN]], Look::Dashed),
            line("measured", &[[0.0, 5.0], [1.0, 1234.5], [2.0, 0.0]], Look::Solid),
        ];
        let text = read_out(axes, &lines, &PlotPoint::new(0.75, 0.0));
        assert_eq!(text, "time 0.750 s\nmeasured: 1234 counts/s");
        let place = (Axis::new("real", "", -1.0, 1.0), Axis::new("imaginary", "", -1.0, 1.0));
        let text = read_out(place, &lines, &PlotPoint::new(0.75, -12.34));
        assert_eq!(text, "real 0.750 \nimaginary -12.3 ");
    }
}
