//! Small pictures on the graph's buttons. They are drawn, since the window's fonts have no such letters.

use egui::{Atom, Button, Color32, IdSalt, Painter, Pos2, Rect, Response, Stroke, Ui, pos2, vec2};

/// One picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    Pause,
    Play,
    Record,
    Stop,
    Cursors,
    Trigger,
    Menu,
    /// Four corners: the whole screen.
    Large,
    /// The same, pointing inwards.
    Small,
    /// A window in front of another.
    Window,
}

const SIZE: f32 = 11.0;

/// Keeps the place of the picture at the left of a button's words.
pub const ROOM: &str = "      ";

/// A button with a picture before its words; `label` is what it is called.
pub fn icon_button_ui(
    ui: &mut Ui,
    icon: Icon,
    text: &str,
    label: &str,
    chosen: bool,
    least_width: f32,
) -> Response {
    let id = IdSalt::new("icon");
    let button = Button::new((Atom::custom(id, vec2(SIZE, SIZE)), text)).selected(chosen);
    let drawn = button.min_size(vec2(least_width, 0.0)).atom_ui(ui);
    if let Some(place) = drawn.rect(id) {
        icon.paint(ui.painter(), place, color_of(ui, &drawn.response, icon));
    }
    ui.ctx().accesskit_node_builder(drawn.response.id, |node| node.set_label(label));
    drawn.response
}

/// Draws the picture into the room that was kept.
pub fn put_icon(ui: &Ui, response: &Response, icon: Icon) {
    let left = response.rect.left() + ui.spacing().button_padding.x + 1.0;
    let center = pos2(left + SIZE * 0.5, response.rect.center().y);
    let color = color_of(ui, response, icon);
    icon.paint(ui.painter(), Rect::from_center_size(center, vec2(SIZE, SIZE)), color);
}

fn color_of(ui: &Ui, response: &Response, icon: Icon) -> Color32 {
    if icon == Icon::Record {
        ui.visuals().error_fg_color
    } else {
        ui.style().interact(response).text_color()
    }
}

impl Icon {
    fn paint(self, painter: &Painter, place: Rect, color: Color32) {
        let at = |x: f32, y: f32| -> Pos2 { place.lerp_inside(vec2(x, y)) };
        let bar = |from: Pos2, to: Pos2| painter.rect_filled(Rect::from_min_max(from, to), 0.0, color);
        let fill = |points: Vec<Pos2>| painter.add(egui::Shape::convex_polygon(points, color, Stroke::NONE));
        match self {
            Self::Pause => {
                bar(at(0.15, 0.05), at(0.4, 0.95));
                bar(at(0.6, 0.05), at(0.85, 0.95));
            }
            Self::Play => {
                fill(vec![at(0.15, 0.0), at(0.95, 0.5), at(0.15, 1.0)]);
            }
            Self::Record => {
                painter.circle_filled(place.center(), SIZE * 0.45, color);
            }
            Self::Stop => {
                bar(at(0.08, 0.08), at(0.92, 0.92));
            }
            Self::Cursors => {
                bar(at(0.1, 0.0), at(0.24, 1.0));
                bar(at(0.76, 0.0), at(0.9, 1.0));
                bar(at(0.3, 0.46), at(0.7, 0.56));
            }
            Self::Trigger => {
                let stroke = Stroke::new(1.6, color);
                let line = [at(0.0, 0.95), at(0.45, 0.95), at(0.55, 0.05), at(1.0, 0.05)];
                painter.add(egui::Shape::line(line.to_vec(), stroke));
                fill(vec![at(0.5, 0.25), at(0.8, 0.6), at(0.2, 0.6)]);
            }
            Self::Large | Self::Small => {
                let stroke = Stroke::new(1.6, color);
                // An angle at each corner, or turned towards the middle.
                let turned = if self == Self::Small { 0.36 } else { 0.0 };
                for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                    let inwards = |from: f32, by: f32| if from < 0.5 { from + by } else { from - by };
                    let (cx, cy) = (inwards(x, turned), inwards(y, turned));
                    let arm = if self == Self::Small { -0.36 } else { 0.36 };
                    let points = [at(inwards(cx, arm), cy), at(cx, cy), at(cx, inwards(cy, arm))];
                    painter.add(egui::Shape::line(points.to_vec(), stroke));
                }
            }
            Self::Window => {
                let stroke = Stroke::new(1.4, color);
                let back = [at(0.35, 0.28), at(0.35, 0.0), at(1.0, 0.0), at(1.0, 0.65), at(0.72, 0.65)];
                painter.add(egui::Shape::line(back.to_vec(), stroke));
                let front = Rect::from_min_max(at(0.0, 0.35), at(0.65, 1.0));
                painter.rect_stroke(front, 0.0, stroke, egui::StrokeKind::Middle);
            }
            Self::Menu => {
                for y in [0.1, 0.45, 0.8] {
                    bar(at(0.0, y), at(1.0, y + 0.14));
                }
            }
        }
    }
}
