//! Where things lie: the place of the plot, and which time and height is which pixel.

use egui::{Pos2, Rect, pos2};
use egui_plot::PlotTransform;

/// Width kept for the figures of the vertical axis, so that the grid never moves.
pub const AXIS_WIDTH: f32 = 68.0;
/// Width of the strip with the zero marks.
pub const GUTTER: f32 = 16.0;
/// Height of the strip with the flags of marks and, at the left, the unit above the topmost figure.
pub const FLAGS: f32 = 18.0;
/// Height of the strip with the figures of the time axis.
pub const TIMES: f32 = 17.0;
/// Room at the right, for the handle of the trigger's level and the last time's figure.
pub const RIGHT: f32 = 16.0;

/// How far outside the plot lines are still drawn.
const OUTSIDE: f32 = 64.0;

/// The plot's place on the screen and in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub outer: Rect,
    pub plot: Rect,
    pub start_s: f64,
    pub end_s: f64,
}

impl Frame {
    pub fn new(outer: Rect, (start_s, end_s): (f64, f64)) -> Self {
        let left = outer.left() + AXIS_WIDTH + GUTTER;
        let (right, bottom) = ((outer.right() - RIGHT).max(left + 8.0), outer.bottom() - TIMES);
        let top = outer.top() + FLAGS;
        let plot = Rect::from_min_max(pos2(left, top), pos2(right, bottom.max(top + 8.0)));
        Self { outer, plot, start_s, end_s }
    }

    /// Of a plot that the toolkit has laid out.
    pub fn of(outer: Rect, transform: &PlotTransform) -> Self {
        let ([start_s, _], [end_s, _]) = (transform.bounds().min(), transform.bounds().max());
        Self { outer, plot: *transform.frame(), start_s, end_s }
    }

    pub fn x(&self, time_s: f64) -> f32 {
        let part = (time_s - self.start_s) / (self.end_s - self.start_s);
        self.plot.left() + (part * f64::from(self.plot.width())) as f32
    }

    pub fn time_s(&self, x: f32) -> f64 {
        self.start_s + f64::from((x - self.plot.left()) / self.plot.width()) * (self.end_s - self.start_s)
    }

    /// The height of a part: 0 at the bottom, 1 at the top.
    pub fn y(&self, part: f64) -> f32 {
        self.plot.bottom() - (part * f64::from(self.plot.height())) as f32
    }

    pub fn part(&self, y: f32) -> f64 {
        f64::from((self.plot.bottom() - y) / self.plot.height())
    }

    /// A line's points on the screen. Its ends are cut a little outside the plot, however far away their times are.
    pub fn place(&self, line: &[[f64; 2]], part: impl Fn(f64) -> f64) -> Vec<Pos2> {
        let margin_s = f64::from(OUTSIDE / self.plot.width()) * (self.end_s - self.start_s);
        let (from_s, to_s) = (self.start_s - margin_s, self.end_s + margin_s);
        let height = |value: f64| self.y(part(value).clamp(-20.0, 21.0));
        let pixels_per_s = f64::from(self.plot.width()) / (self.end_s - self.start_s);
        let across = |time_s: f64| self.plot.left() + ((time_s - self.start_s) * pixels_per_s) as f32;
        let mut points: Vec<Pos2> =
            line.iter().map(|[time_s, value]| pos2(across(*time_s), height(*value))).collect();
        if let [first, second, ..] = line
            && first[0] < from_s
        {
            points[0] = pos2(self.x(from_s), height(between(*first, *second, from_s)));
        }
        if let [.., before, last] = line
            && last[0] > to_s
        {
            let end = points.len() - 1;
            points[end] = pos2(self.x(to_s), height(between(*before, *last, to_s)));
        }
        points
    }
}

/// The value at a time on the straight line through two points.
fn between(a: [f64; 2], b: [f64; 2], time_s: f64) -> f64 {
    let part = (time_s - a[0]) / (b[0] - a[0]);
    if part.is_finite() { a[1] + part.clamp(0.0, 1.0) * (b[1] - a[1]) } else { b[1] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lead_back_to_times_and_heights() {
        let frame = Frame::new(Rect::from_min_max(pos2(0.0, 0.0), pos2(500.0, 300.0)), (100.0, 110.0));
        assert_eq!(frame.x(100.0), frame.plot.left());
        assert!((frame.time_s(frame.x(103.5)) - 103.5).abs() < 1e-4);
        assert!((frame.part(frame.y(0.25)) - 0.25).abs() < 1e-6);
    }

    #[test]
    fn a_point_far_outside_does_not_bend_the_line_that_leads_to_it() {
        let frame = Frame::new(Rect::from_min_max(pos2(0.0, 0.0), pos2(500.0, 300.0)), (100.0, 100.01));
        let points = frame.place(&[[0.0, 0.0], [200.0, 1.0]], |value| value);
        assert_eq!(points.len(), 2);
        assert!(points.iter().all(|point| point.x > -100.0 && point.x < 700.0), "{points:?}");
        assert!((points[0].y - frame.y(0.5)).abs() < 0.5);
    }
}
