//! The signal graph of a pin (MCP manual 1.9.10): what its settings make of its reading, where the live signal stands on
//! it, and handles that bend it.

use brushwork_link::device::PinSignal;
use brushwork_mcp_client::settings::{Behind, SignalShape};
use brushwork_mcp_wire::packet_serial::scale;
use egui::accesskit::Action;
use egui::{
    Align2, Id, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, TextStyle, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};

use crate::mcp::messages::SignalMessage;
use crate::model::settings::UnitSettings;
use crate::theme::Palette;
use crate::widgets::steps::{Steps, set_by_reader};

/// Room around the plot for its handles and figures.
const MARGIN: Vec2 = vec2(34.0, 24.0);
/// Points that the curve is drawn with.
const POINTS: u16 = 160;
/// The share of the range that is shown beyond each end.
const BEYOND: f64 = 0.04;
const HANDLE_RADIUS: f32 = 7.0;
/// Steps of the power exponent: of its row, and of a key.
const EXPONENT_STEP: f64 = 0.01;
const EXPONENT_KEY_STEP: f64 = 0.05;

/// Where readings and shares of the range lie on the screen.
#[derive(Clone, Copy)]
struct Frame {
    plot: Rect,
    low: f64,
    high: f64,
}

impl Frame {
    fn new(rect: Rect, shape: &SignalShape) -> Self {
        let (low, high) = (shape.min.min(shape.max), shape.min.max(shape.max));
        let beyond = ((high - low) * BEYOND).max(0.5);
        Self { plot: rect.shrink2(MARGIN), low: low - beyond, high: high + beyond }
    }

    fn x(&self, reading: f64) -> f32 {
        let share = ((reading - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.plot.left() + share as f32 * self.plot.width()
    }

    fn reading(&self, x: f32) -> f64 {
        self.low + f64::from((x - self.plot.left()) / self.plot.width()) * (self.high - self.low)
    }

    fn y(&self, share: f64) -> f32 {
        self.plot.center().y - share.clamp(-1.0, 1.0) as f32 * self.plot.height() / 2.0
    }

    fn share(&self, y: f32) -> f64 {
        f64::from((self.plot.center().y - y) / (self.plot.height() / 2.0))
    }

    fn at(&self, reading: f64, share: f64) -> Pos2 {
        pos2(self.x(reading), self.y(share))
    }
}

/// What a handle changes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bend {
    Deadband,
    Exponent,
    Minimum,
}

impl Bend {
    const ALL: [Self; 3] = [Self::Deadband, Self::Exponent, Self::Minimum];

    fn field(self) -> &'static str {
        match self {
            Self::Deadband => "deadband",
            Self::Exponent => "power_exp",
            Self::Minimum => "power_min",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Deadband => "Deadband handle",
            Self::Exponent => "Power exponent handle",
            Self::Minimum => "Power minimum handle",
        }
    }

    fn value(self, shape: &SignalShape) -> f64 {
        match self {
            Self::Deadband => shape.deadband,
            Self::Exponent => shape.power_exponent,
            Self::Minimum => shape.power_min,
        }
    }

    /// The least and the greatest value that the handle can be moved to.
    fn range(self, shape: &SignalShape) -> (f64, f64) {
        match self {
            Self::Exponent => (-8.0, 8.0),
            Self::Deadband | Self::Minimum => (0.0, shape.span(1.0)),
        }
    }

    fn steps(self, shape: &SignalShape) -> Steps {
        match self {
            Self::Exponent => Steps { step: EXPONENT_KEY_STEP, page: 1.0 },
            Self::Deadband | Self::Minimum => Steps { step: 1.0, page: (shape.span(1.0) / 20.0).round() },
        }
    }

    /// Where it lies: the deadband below the plot, the minimum right of it, the exponent on the curve.
    fn place(self, frame: &Frame, shape: &SignalShape) -> Pos2 {
        let edge = shape.center + shape.deadband;
        match self {
            Self::Deadband => pos2(frame.x(edge), frame.plot.bottom() + HANDLE_RADIUS + 2.0),
            Self::Exponent => {
                let middle = middle(shape);
                frame.at(middle, shape.share(shape.position(middle)))
            }
            Self::Minimum => {
                let share = shape.power_min / shape.span(1.0).max(1.0);
                pos2(frame.plot.right() + HANDLE_RADIUS + 2.0, frame.y(share))
            }
        }
    }

    /// The value at which the handle would lie at `pointer`.
    fn value_at(self, pointer: Pos2, frame: &Frame, shape: &SignalShape) -> f64 {
        let span = shape.span(1.0).max(1.0);
        match self {
            Self::Deadband => (frame.reading(pointer.x) - shape.center).round(),
            Self::Minimum => (frame.share(pointer.y) * span).round(),
            Self::Exponent => exponent_through(frame.share(pointer.y) - shape.power_min / span),
        }
    }
}

/// The reading half way between the edge of the deadband and the high end, where the exponent's handle lies.
fn middle(shape: &SignalShape) -> f64 {
    let edge = shape.center + shape.deadband;
    edge + (shape.max - edge) / 2.0
}

/// The power exponent whose curve goes through `share` at half the way.
fn exponent_through(share: f64) -> f64 {
    let power = share.clamp(0.001, 0.999).ln() / 0.5_f64.ln();
    let exponent = if power < 1.0 { 1.0 / power - 1.0 } else { 1.0 - power };
    (exponent / EXPONENT_STEP).round() * EXPONENT_STEP
}

/// Draws the graph of a pin in `size`; `signal` is what the controller makes of it now.
pub fn signal_graph_ui(
    ui: &mut Ui,
    unit: &mut UnitSettings,
    pin: usize,
    signal: Option<PinSignal>,
    size: Vec2,
) {
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let Some(shape) = unit.shape(pin) else { return };
    let frame = Frame::new(rect, &shape);
    let live = live_point(unit, pin, signal);
    let spoken = spoken(&unit.table().subject().pin_name(pin - 1), &shape, live);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
    paint_ground(ui, &frame, &shape);
    let present = SignalShape::of(&|key| unit.on_controller(key), pin);
    if let Some(present) = present.filter(|present| *present != shape) {
        paint_curve(ui, &frame, &present, Stroke::new(1.0, Palette::of(ui).weak_text));
    }
    let color = if ui.is_enabled() { Palette::of(ui).accent } else { Palette::of(ui).weak_text };
    paint_curve(ui, &frame, &shape, Stroke::new(2.0, color));
    for bend in Bend::ALL {
        let key = format!("pin.{pin}.{}", bend.field());
        if let Some(value) = handle_ui(ui, &frame, &shape, bend, pin) {
            unit.set_number(&key, value);
        }
    }
    if let Some((reading, share)) = live {
        paint_live(ui, &frame, &shape, reading, share);
    }
}

/// The reading behind the signal, and the share of the range that the controller makes of it.
fn live_point(unit: &UnitSettings, pin: usize, signal: Option<PinSignal>) -> Option<(f64, f64)> {
    let signal = signal?;
    let shape = SignalShape::of(&|key| unit.on_controller(key), pin)?;
    let reading = match unit.reading(pin, signal)? {
        Behind::Reading(reading) => reading,
        Behind::Deadband => shape.center,
        Behind::LowEnd => shape.min,
        Behind::HighEnd => shape.max,
    };
    Some((reading, f64::from(signal.percent) / scale::FULL_DUTY_RAW as f64))
}

fn spoken(name: &str, shape: &SignalShape, live: Option<(f64, f64)>) -> String {
    let live = live.map_or_else(
        || "no live signal".to_owned(),
        |(reading, share)| SignalMessage::At { reading, percent: share * 100.0 }.to_string(),
    );
    SignalMessage::Graph {
        name: name.to_string(),
        min: shape.min,
        max: shape.max,
        center: shape.center,
        deadband: shape.deadband,
        exponent: shape.power_exponent,
        least: shape.power_min,
        live,
    }
    .to_string()
}

fn paint_ground(ui: &Ui, frame: &Frame, shape: &SignalShape) {
    let palette = Palette::of(ui);
    let painter = ui.painter();
    let plot = frame.plot;
    painter.rect(plot, 2.0, palette.ground, Stroke::new(1.0, palette.line), StrokeKind::Outside);
    let band = Rect::from_x_y_ranges(
        frame.x(shape.center - shape.deadband)..=frame.x(shape.center + shape.deadband),
        plot.y_range(),
    );
    painter.rect_filled(band, 0.0, palette.raised);
    let line = Stroke::new(1.0, palette.line);
    for share in [-0.5, 0.0, 0.5] {
        painter.hline(plot.x_range(), frame.y(share), line);
    }
    painter.vline(frame.x(shape.center), plot.y_range(), line);
    let font = TextStyle::Small.resolve(ui.style());
    for (share, text) in [(1.0, "100 %"), (0.0, "0"), (-1.0, "-100")] {
        let at = pos2(plot.left() - 4.0, frame.y(share));
        painter.text(at, Align2::RIGHT_CENTER, text, font.clone(), palette.weak_text);
    }
    let ends = [
        (shape.min, Align2::LEFT_TOP),
        (shape.center, Align2::CENTER_BOTTOM),
        (shape.max, Align2::RIGHT_TOP),
    ];
    for (reading, align) in ends {
        let y = if align == Align2::CENTER_BOTTOM { plot.top() - 4.0 } else { plot.bottom() + 5.0 };
        painter.text(pos2(frame.x(reading), y), align, reading.to_string(), font.clone(), palette.weak_text);
    }
}

fn paint_curve(ui: &Ui, frame: &Frame, shape: &SignalShape, stroke: Stroke) {
    let step = (frame.high - frame.low) / f64::from(POINTS);
    let mut readings: Vec<f64> = (0..=POINTS).map(|index| frame.low + f64::from(index) * step).collect();
    // The edges of the deadband are where the curve has its jumps.
    let edge = step / 100.0;
    for side in [shape.center - shape.deadband, shape.center + shape.deadband] {
        readings.extend([side - edge, side, side + edge]);
    }
    readings.sort_by(f64::total_cmp);
    let points = readings.iter().map(|reading| frame.at(*reading, shape.share(shape.position(*reading))));
    ui.painter().with_clip_rect(frame.plot.expand(2.0)).add(Shape::line(points.collect(), stroke));
}

/// The live signal as the controller shapes it, and where the wanted settings would put it.
fn paint_live(ui: &Ui, frame: &Frame, shape: &SignalShape, reading: f64, share: f64) {
    let palette = Palette::of(ui);
    let painter = ui.painter();
    let at = frame.at(reading, share);
    let guide = Stroke::new(1.0, palette.ok);
    painter.extend(Shape::dashed_line(&[pos2(at.x, frame.plot.bottom()), at], guide, 3.0, 3.0));
    painter.extend(Shape::dashed_line(&[pos2(frame.plot.left(), at.y), at], guide, 3.0, 3.0));
    let wanted = frame.at(reading, shape.share(shape.position(reading)));
    if wanted.distance(at) > 1.0 {
        painter.circle_stroke(wanted, 5.0, Stroke::new(1.5, palette.ok));
    }
    painter.circle(at, 5.0, palette.ok, Stroke::new(1.0, palette.ground));
}

/// Draws a handle; the value that it is moved to, if it is.
fn handle_ui(ui: &mut Ui, frame: &Frame, shape: &SignalShape, bend: Bend, pin: usize) -> Option<f64> {
    let place = bend.place(frame, shape);
    let around = Rect::from_center_size(place, Vec2::splat(2.0 * HANDLE_RADIUS + 4.0));
    let id = Id::unique((bend.name(), pin));
    let response = ui.interact(around, id, Sense::click_and_drag());
    let value = bend.value(shape);
    let (low, high) = bend.range(shape);
    let mut wanted = value + bend.steps(shape).asked(ui, &response, value);
    if response.dragged()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        response.request_focus();
        wanted = bend.value_at(pointer, frame, shape);
    }
    wanted = set_by_reader(ui, &response).unwrap_or(wanted).clamp(low, high.max(low));
    describe(ui, &response, bend, value, (low, high));
    paint_handle(ui, &response, place);
    let note = SignalMessage::Handle { name: bend.name(), value }.to_string();
    response.on_hover_text(note);
    (wanted != value && ui.is_enabled()).then_some(wanted)
}

fn describe(ui: &Ui, response: &Response, bend: Bend, value: f64, (low, high): (f64, f64)) {
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value, bend.name()));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(low);
        node.set_max_numeric_value(high);
        for action in [Action::SetValue, Action::Increment, Action::Decrement] {
            node.add_action(action);
        }
    });
}

fn paint_handle(ui: &Ui, response: &Response, at: Pos2) {
    let palette = Palette::of(ui);
    let fill = if ui.is_enabled() { palette.accent } else { palette.weak_text };
    let ring = if response.has_focus() {
        Stroke::new(2.0, palette.text)
    } else if response.hovered() {
        Stroke::new(2.0, palette.weak_text)
    } else {
        Stroke::new(1.0, palette.ground)
    };
    ui.painter().circle(at, HANDLE_RADIUS, fill, ring);
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: SignalShape = SignalShape {
        min: 0.0,
        center: 2048.0,
        max: 4095.0,
        deadband: 0.0,
        power_exponent: 0.0,
        power_min: 0.0,
        min_output: -32_767.0,
        max_output: 32_767.0,
    };

    fn frame(shape: &SignalShape) -> Frame {
        Frame::new(Rect::from_min_size(pos2(10.0, 20.0), vec2(300.0, 200.0)), shape)
    }

    #[test]
    fn a_handle_lies_where_its_value_is_and_a_value_where_its_handle_lies() {
        let shape = SignalShape { deadband: 300.0, power_min: 400.0, power_exponent: -0.5, ..SHAPE };
        let frame = frame(&shape);
        for bend in Bend::ALL {
            let found = bend.value_at(bend.place(&frame, &shape), &frame, &shape);
            let off = (found - bend.value(&shape)).abs();
            assert!(off <= if bend == Bend::Exponent { 0.02 } else { 1.0 }, "{}: {found}", bend.name());
        }
    }

    #[test]
    fn the_exponent_is_found_from_the_height_of_its_curve() {
        assert_eq!(exponent_through(0.5), 0.0);
        assert_eq!(exponent_through(0.25), -1.0);
        assert!((exponent_through(0.5_f64.sqrt()) - 1.0).abs() < 1e-9);
        assert!(exponent_through(2.0).is_finite() && exponent_through(-1.0).is_finite());
    }

    #[test]
    fn a_range_without_extent_is_drawn_all_the_same() {
        let shape = SignalShape { min: 7.0, center: 7.0, max: 7.0, ..SHAPE };
        let frame = frame(&shape);
        for bend in Bend::ALL {
            let place = bend.place(&frame, &shape);
            assert!(place.x.is_finite() && place.y.is_finite());
            assert!(bend.value_at(place, &frame, &shape).is_finite());
        }
    }
}
