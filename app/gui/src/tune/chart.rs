//! A small chart: lines over a grid with figures, a legend, and the values under the pointer.

use egui::{
    Align2, Color32, FontFamily, FontId, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, Ui,
    WidgetInfo, pos2, vec2,
};

use crate::theme::Palette;

/// Room for the figures at the left and below.
const LEFT: f32 = 62.0;
const BELOW: f32 = 18.0;
const ABOVE: f32 = 16.0;
const FIGURE: f32 = 10.5;

/// How a line is drawn: not by its colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    Solid,
    Dashed,
    Dots,
    /// Wide and pale, to lie under another.
    Under,
}

/// A line.
#[derive(Clone, Debug)]
pub struct Line {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    pub color: Color32,
    pub look: Look,
}

/// One axis of a chart.
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

    fn part(&self, value: f64) -> f32 {
        let part = if self.is_log {
            (value.max(1e-12).ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        };
        // Far outside is as good as outside, and a shape of the painter's must stay finite.
        part.clamp(-4.0, 5.0) as f32
    }

    fn value(&self, part: f64) -> f64 {
        if self.is_log {
            (self.low.ln() + part * (self.high.ln() - self.low.ln())).exp()
        } else {
            self.low + part * (self.high - self.low)
        }
    }

    fn ticks(&self, most: usize) -> Vec<f64> {
        if self.is_log {
            let first = self.low.log10().ceil() as i32;
            let last = self.high.log10().floor() as i32;
            return (first..=last).map(|power| 10_f64.powi(power)).collect();
        }
        let step = tick_step(self.high - self.low, most);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        (first..=last.min(first + 40)).map(|n| n as f64 * step).collect()
    }
}

/// The step of 1, 2 or 5 times a power of ten that gives at most so many parts.
fn tick_step(span: f64, most: usize) -> f64 {
    let raw = (span / most.max(1) as f64).max(1e-12);
    let power = 10_f64.powf(raw.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|times| times * power)
        .into_iter()
        .find(|step| *step >= raw * 0.999)
        .unwrap_or(10.0 * power)
}

/// As many digits as the step needs.
fn figure(value: f64, step: f64) -> String {
    let decimals = (-step.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    let value = if value.abs() < step * 1e-6 { 0.0 } else { value };
    format!("{value:.decimals$}")
}

/// What is drawn.
pub struct Chart<'a> {
    /// What a screen reader says of it.
    pub name: &'a str,
    pub x: Axis,
    pub y: Axis,
    pub lines: &'a [Line],
    /// Lines across: (value, word).
    pub levels: &'a [(f64, &'a str)],
    /// Circles: (center, radius), in the units of the axes.
    pub circles: &'a [([f64; 2], f64, &'a str)],
    /// The same length means the same on both axes.
    pub is_square: bool,
    /// What stands in it while there is nothing.
    pub empty: &'a str,
}

impl Chart<'_> {
    /// Takes `size` and draws.
    pub fn ui(&self, ui: &mut Ui, size: egui::Vec2) -> Response {
        let (outer, response) = ui.allocate_exact_size(size.max(vec2(80.0, 40.0)), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, self.spoken()));
        if !ui.is_rect_visible(outer) {
            return response;
        }
        let mut plot = Rect::from_min_max(outer.min + vec2(LEFT, ABOVE), outer.max - vec2(8.0, BELOW));
        let (mut x, mut y) = (self.x, self.y);
        if self.is_square {
            (x, y) = squared(x, y, plot.size());
        }
        plot.max = plot.max.max(plot.min + vec2(20.0, 20.0));
        let frame = Frame { plot, x, y };
        self.paint_grid(ui, &frame);
        let painter = ui.painter().with_clip_rect(plot);
        for (center, radius, word) in self.circles {
            let color = Palette::of(ui).warning;
            painter.extend(circle(&frame, *center, *radius, color));
            let below = frame.at(center[0], center[1] - radius) + vec2(0.0, 2.0);
            painter.text(below, Align2::CENTER_TOP, *word, FontId::proportional(FIGURE), color);
        }
        for line in self.lines {
            painter.extend(shapes(line, &frame));
        }
        self.paint_legend(ui, &frame);
        if self.lines.iter().all(|line| line.points.is_empty()) {
            let font = FontId::proportional(13.0);
            let color = Palette::of(ui).weak_text;
            let text = ui.painter().layout(self.empty.to_owned(), font, color, plot.width() - 24.0);
            let at = plot.center() - text.size() / 2.0;
            ui.painter().galley(at, text, color);
        }
        self.pointer_ui(ui, &frame, &response);
        response
    }

    fn spoken(&self) -> String {
        let names: Vec<&str> =
            self.lines.iter().filter(|l| !l.points.is_empty()).map(|l| l.name.as_str()).collect();
        if names.is_empty() { self.name.to_owned() } else { format!("{}: {}", self.name, names.join(", ")) }
    }

    fn paint_grid(&self, ui: &Ui, frame: &Frame) {
        let palette = Palette::of(ui);
        let painter = ui.painter();
        let font = FontId::new(FIGURE, FontFamily::Monospace);
        painter.rect_filled(frame.plot, 0.0, palette.ground);
        let thin = Stroke::new(1.0, palette.line.gamma_multiply(0.6));
        let most_x = (frame.plot.width() / 70.0) as usize;
        let x_step = tick_step(frame.x.high - frame.x.low, most_x);
        let ticks = frame.x.ticks(most_x);
        for (index, value) in ticks.iter().enumerate() {
            let x = frame.at(*value, frame.y.low).x;
            painter.vline(x, frame.plot.y_range(), thin);
            let mut text = figure(*value, if frame.x.is_log { *value } else { x_step });
            if index + 1 == ticks.len() {
                // The last one tells what it is.
                text = format!("{text} {}", if self.x.unit.is_empty() { self.x.name } else { self.x.unit });
            }
            let text = painter.layout_no_wrap(text, font.clone(), palette.weak_text);
            let left = (x - text.size().x / 2.0).min(frame.plot.right() - text.size().x + 6.0);
            painter.galley(pos2(left, frame.plot.bottom() + 3.0), text, palette.weak_text);
        }
        let most_y = ((frame.plot.height() / 28.0) as usize).clamp(2, 8);
        let y_step = tick_step(frame.y.high - frame.y.low, most_y);
        for value in frame.y.ticks(most_y) {
            let y = frame.at(frame.x.low, value).y;
            painter.hline(frame.plot.x_range(), y, thin);
            let step = if frame.y.is_log { value } else { y_step };
            painter.text(
                pos2(frame.plot.left() - 5.0, y),
                Align2::RIGHT_CENTER,
                figure(value, step),
                font.clone(),
                palette.weak_text,
            );
        }
        for (value, word) in self.levels {
            let y = frame.at(frame.x.low, *value).y;
            if frame.plot.y_range().contains(y) {
                painter.extend(Shape::dashed_line(
                    &[pos2(frame.plot.left(), y), pos2(frame.plot.right(), y)],
                    Stroke::new(1.2, palette.warning),
                    6.0,
                    4.0,
                ));
                painter.text(
                    pos2(frame.plot.left() + 5.0, y - 2.0),
                    Align2::LEFT_BOTTOM,
                    *word,
                    FontId::proportional(FIGURE),
                    palette.warning,
                );
            }
        }
        painter.rect_stroke(frame.plot, 0.0, Stroke::new(1.0, palette.line), StrokeKind::Inside);
        let small = FontId::proportional(FIGURE + 0.5);
        let y_name = [self.y.name, self.y.unit].join(" ");
        painter.text(
            pos2(frame.plot.left(), frame.plot.top() - 2.0),
            Align2::LEFT_BOTTOM,
            y_name.trim(),
            small,
            palette.text,
        );
    }

    /// Names with samples of their lines, right above the plot.
    fn paint_legend(&self, ui: &Ui, frame: &Frame) {
        let palette = Palette::of(ui);
        let painter = ui.painter();
        let font = FontId::proportional(FIGURE + 0.5);
        let mut right = frame.plot.right();
        for line in self.lines.iter().rev().filter(|line| !line.points.is_empty() && !line.name.is_empty()) {
            let text = painter.layout_no_wrap(line.name.clone(), font.clone(), palette.text);
            let width = text.size().x;
            if right - width - 34.0 < frame.plot.left() + 90.0 {
                break;
            }
            let y = frame.plot.top() - ABOVE / 2.0 - 1.0;
            painter.galley(pos2(right - width, y - text.size().y / 2.0), text, palette.text);
            right -= width + 5.0;
            painter.extend(sample_of(line, pos2(right - 20.0, y), pos2(right, y)));
            right -= 32.0;
        }
    }

    fn pointer_ui(&self, ui: &Ui, frame: &Frame, response: &Response) {
        let Some(at) = response.hover_pos().filter(|at| frame.plot.contains(*at)) else { return };
        let palette = Palette::of(ui);
        ui.painter().vline(at.x, frame.plot.y_range(), Stroke::new(1.0, palette.weak_text));
        let x = frame.x.value(f64::from((at.x - frame.plot.left()) / frame.plot.width()));
        let mut text = format!("{} {} {}", self.x.name, short(x), self.x.unit);
        for line in self.lines.iter().filter(|line| line.look != Look::Dots && !line.name.is_empty()) {
            let index = line.points.partition_point(|point| point[0] < x);
            if let Some(point) = line.points.get(index).filter(|_| index > 0 && !self.is_square) {
                text += &format!("\n{}: {} {}", line.name, short(point[1]), self.y.unit);
            }
        }
        let font = FontId::new(FIGURE + 0.5, FontFamily::Monospace);
        let galley = ui.painter().layout_no_wrap(text, font, palette.text);
        let beside =
            if at.x + galley.size().x + 16.0 > frame.plot.right() { -galley.size().x - 10.0 } else { 10.0 };
        let place = Rect::from_min_size(pos2(at.x + beside, frame.plot.top() + 6.0), galley.size());
        ui.painter().rect_filled(place.expand(4.0), 3.0, palette.raised);
        ui.painter().galley(place.min, galley, palette.text);
    }
}

fn short(value: f64) -> String {
    match value.abs() {
        big if big >= 1000.0 => format!("{value:.0}"),
        middle if middle >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.3}"),
    }
}

struct Frame {
    plot: Rect,
    x: Axis,
    y: Axis,
}

impl Frame {
    fn at(&self, x: f64, y: f64) -> Pos2 {
        pos2(
            self.plot.left() + self.x.part(x) * self.plot.width(),
            self.plot.bottom() - self.y.part(y) * self.plot.height(),
        )
    }
}

/// Both axes with the same scale, about their middles.
fn squared(x: Axis, y: Axis, size: egui::Vec2) -> (Axis, Axis) {
    let per_point =
        ((x.high - x.low) / f64::from(size.x.max(1.0))).max((y.high - y.low) / f64::from(size.y.max(1.0)));
    let widen = |axis: Axis, points: f32| {
        let (middle, half) = (0.5 * (axis.low + axis.high), 0.5 * per_point * f64::from(points));
        Axis { low: middle - half, high: middle + half, ..axis }
    };
    (widen(x, size.x), widen(y, size.y))
}

fn shapes(line: &Line, frame: &Frame) -> Vec<Shape> {
    // What is no number leaves a gap.
    let is_gap = |point: &[f64; 2]| !(point[0].is_finite() && point[1].is_finite());
    let parts = line.points.split(is_gap).filter(|part| !part.is_empty());
    let of_part = |part: &[[f64; 2]]| part.iter().map(|point| frame.at(point[0], point[1])).collect();
    parts.flat_map(|part| drawn(of_part(part), line.look, line.color)).collect()
}

fn sample_of(line: &Line, from: Pos2, to: Pos2) -> Vec<Shape> {
    let middle = from + (to - from) / 2.0;
    let points = if line.look == Look::Dots { vec![from, middle, to] } else { vec![from, to] };
    drawn(points, line.look, line.color)
}

fn drawn(points: Vec<Pos2>, look: Look, color: Color32) -> Vec<Shape> {
    match look {
        Look::Solid => vec![Shape::line(points, Stroke::new(1.8, color))],
        Look::Under => vec![Shape::line(points, Stroke::new(4.5, color.gamma_multiply(0.55)))],
        Look::Dashed => Shape::dashed_line(&points, Stroke::new(1.5, color), 6.0, 4.0),
        Look::Dots => points.into_iter().map(|at| Shape::circle_filled(at, 1.7, color)).collect(),
    }
}

fn circle(frame: &Frame, center: [f64; 2], radius: f64, color: Color32) -> Vec<Shape> {
    let around = (0..=72).map(|n| {
        let angle = f64::from(n) * std::f64::consts::TAU / 72.0;
        frame.at(center[0] + radius * angle.cos(), center[1] + radius * angle.sin())
    });
    Shape::dashed_line(&around.collect::<Vec<_>>(), Stroke::new(1.4, color), 5.0, 4.0)
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
        let ticks: Vec<i64> = axis.ticks(9).iter().map(|tick| (tick * 100.0).round() as i64).collect();
        assert_eq!(ticks, [10, 100, 1000, 10_000]);
        assert!((axis.value(f64::from(axis.part(3.0))) - 3.0).abs() < 1e-4);
    }
}
