//! A small drawing of how a part is wired to the controller, from its description in a recipe.

use egui::{
    Align2, FontId, Painter, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use crate::family::recipe::{Part, Wiring};
use crate::messages::{NameMessage, SpokenMessage};
use crate::theme::Palette;

/// Size of the drawing, points.
pub const SIZE: Vec2 = vec2(330.0, 132.0);
/// The part at the left, the controller at the right.
const PART: Rect = Rect { min: pos2(8.0, 22.0), max: pos2(128.0, 124.0) };
const UNIT: Rect = Rect { min: pos2(232.0, 22.0), max: pos2(322.0, 124.0) };
const FONT: f32 = 11.5;

/// Draws it; `name` gives the names of the controller's terminals.
pub fn wiring_ui(ui: &mut Ui, wiring: &Wiring, name: &dyn Fn(&str) -> String) {
    let (place, response) = ui.allocate_exact_size(SIZE, Sense::hover());
    let wires: Vec<String> = wiring
        .wires
        .iter()
        .map(|(from, to)| NameMessage::To { from: (*from).to_owned(), to: name(to) }.to_string())
        .collect();
    let spoken = SpokenMessage::Wiring { part: wiring.part.name(), wires: wires.join(", ") }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
    let palette = Palette::of(ui);
    let drawing =
        Drawing { painter: ui.painter().with_clip_rect(place), origin: place.min, palette: *palette };
    drawing.boxed(PART, wiring.part.name());
    drawing.boxed(UNIT, "Controller");
    let count = wiring.wires.len() as f32;
    for (index, (from, to)) in wiring.wires.iter().enumerate() {
        let y = PART.top() + (index as f32 + 0.5) * PART.height() / count;
        drawing.line(pos2(PART.right(), y), pos2(UNIT.left(), y));
        drawing.dot(pos2(PART.right(), y));
        drawing.dot(pos2(UNIT.left(), y));
        drawing.word(pos2(PART.right() - 7.0, y), Align2::RIGHT_CENTER, from);
        drawing.word(pos2(UNIT.left() + 7.0, y), Align2::LEFT_CENTER, &name(to));
    }
    drawing.symbol(wiring.part);
}

struct Drawing {
    painter: Painter,
    origin: Pos2,
    palette: Palette,
}

impl Drawing {
    fn at(&self, point: Pos2) -> Pos2 {
        self.origin + point.to_vec2()
    }

    fn boxed(&self, place: Rect, title: &str) {
        let rect = place.translate(self.origin.to_vec2());
        let outline = Stroke::new(1.0, self.palette.weak_text);
        self.painter.rect(rect, 4.0, self.palette.raised, outline, StrokeKind::Inside);
        let font = FontId::proportional(FONT);
        self.painter.text(
            self.at(pos2(place.center().x, place.top() - 11.0)),
            Align2::CENTER_CENTER,
            title,
            font,
            self.palette.weak_text,
        );
    }

    fn line(&self, from: Pos2, to: Pos2) {
        self.painter.line_segment([self.at(from), self.at(to)], Stroke::new(1.6, self.palette.accent));
    }

    fn dot(&self, at: Pos2) {
        self.painter.circle_filled(self.at(at), 3.0, self.palette.accent);
    }

    fn word(&self, at: Pos2, align: Align2, text: &str) {
        self.painter.text(self.at(at), align, text, FontId::proportional(FONT), self.palette.text);
    }

    fn path(&self, points: &[(f32, f32)]) {
        let middle = vec2(PART.left() + 30.0, PART.center().y);
        let points =
            points.iter().map(|(x, y)| self.at(pos2(middle.x + x, middle.y + y))).collect::<Vec<_>>();
        self.painter.line(points, Stroke::new(1.6, self.palette.text));
    }

    fn ring(&self, (x, y): (f32, f32), radius: f32) {
        let at = self.at(pos2(PART.left() + 30.0 + x, PART.center().y + y));
        self.painter.circle_stroke(at, radius, Stroke::new(1.6, self.palette.text));
    }

    /// What the part looks like in a circuit, at the left of its box.
    fn symbol(&self, part: Part) {
        match part {
            Part::Switch => {
                self.path(&[(0.0, -24.0), (0.0, -10.0)]);
                self.path(&[(0.0, 10.0), (0.0, 24.0)]);
                self.path(&[(0.0, 10.0), (-12.0, -10.0)]);
            }
            Part::Receiver => {
                self.path(&[(0.0, 22.0), (0.0, -22.0)]);
                self.path(&[(-9.0, -22.0), (0.0, -10.0), (9.0, -22.0)]);
            }
            Part::Potentiometer => {
                self.path(&[(0.0, -26.0), (0.0, -16.0), (-6.0, -12.0), (6.0, -6.0), (-6.0, 0.0)]);
                self.path(&[(-6.0, 0.0), (6.0, 6.0), (-6.0, 12.0), (0.0, 16.0), (0.0, 26.0)]);
                self.path(&[(18.0, 0.0), (7.0, 0.0), (11.0, -4.0)]);
                self.path(&[(7.0, 0.0), (11.0, 4.0)]);
            }
            Part::Encoder => {
                self.ring((0.0, 0.0), 18.0);
                self.ring((0.0, 0.0), 3.0);
                for (x, y) in [
                    (0.0, -1.0),
                    (0.71, -0.71),
                    (1.0, 0.0),
                    (0.71, 0.71),
                    (0.0, 1.0),
                    (-0.71, 0.71),
                    (-1.0, 0.0),
                    (-0.71, -0.71),
                ] {
                    self.path(&[(11.0 * x, 11.0 * y), (16.0 * x, 16.0 * y)]);
                }
            }
            Part::Brake => {
                self.path(&[(-12.0, -14.0), (12.0, -14.0), (12.0, 0.0), (-12.0, 0.0), (-12.0, -14.0)]);
                self.path(&[(-12.0, 0.0), (12.0, -14.0)]);
                self.path(&[(-10.0, 20.0), (10.0, 20.0), (0.0, 8.0), (-10.0, 20.0)]);
                self.path(&[(-10.0, 8.0), (10.0, 8.0)]);
            }
            Part::Motor => {
                self.ring((0.0, 0.0), 18.0);
                self.path(&[(-7.0, 8.0), (-7.0, -8.0), (0.0, 2.0), (7.0, -8.0), (7.0, 8.0)]);
            }
            Part::Load => {
                self.path(&[(0.0, -26.0), (0.0, -16.0), (-6.0, -16.0), (-6.0, 16.0), (0.0, 16.0)]);
                self.path(&[(0.0, -16.0), (6.0, -16.0), (6.0, 16.0), (0.0, 16.0), (0.0, 26.0)]);
            }
            Part::Battery => {
                for (index, half) in [12.0, 6.0, 12.0, 6.0].into_iter().enumerate() {
                    let y = 8.0 * index as f32 - 12.0;
                    self.path(&[(-half, y), (half, y)]);
                }
                self.path(&[(0.0, -24.0), (0.0, -12.0)]);
                self.path(&[(0.0, 12.0), (0.0, 24.0)]);
            }
            Part::Computer => {
                self.path(&[(-16.0, -14.0), (16.0, -14.0), (16.0, 8.0), (-16.0, 8.0), (-16.0, -14.0)]);
                self.path(&[(-20.0, 16.0), (20.0, 16.0)]);
            }
        }
    }
}
