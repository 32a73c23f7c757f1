//! A picture of the graph as plain shapes, so that the window, a PNG and an SVG show the same.
//!
//! What is drawn is decided in [`draw`]; in the window a plot of the toolkit draws the grid and the lines and [`paint`] what
//! lies over them; [`svg`] writes all of it as text, [`png`] draws it on the CPU.

use egui::{Align2, Color32, Context, FontFamily, FontId, Mesh, Painter, Pos2, Rect, Shape, Stroke, vec2};

pub mod axes;
pub mod draw;
pub mod frame;
pub mod legend;
pub mod png;
pub mod svg;

/// One shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    Box {
        rect: Rect,
        color: Color32,
    },
    Line {
        points: Vec<Pos2>,
        color: Color32,
        width: f32,
    },
    /// Upright bars side by side: what lies between the least and the greatest of many samples. Cheap, since it is not
    /// smoothed.
    Bars {
        bars: Vec<[Pos2; 2]>,
        color: Color32,
        width: f32,
    },
    Dashes {
        points: [Pos2; 2],
        color: Color32,
        width: f32,
    },
    /// Convex.
    Polygon {
        points: Vec<Pos2>,
        color: Color32,
    },
    Text {
        at: Pos2,
        anchor: Align2,
        text: String,
        size: f32,
        color: Color32,
        figures: bool,
    },
}

/// Shapes that are cut off at a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    pub clip: Rect,
    pub elements: Vec<Element>,
}

/// Layers, the lowest first.
pub type Picture = Vec<Layer>;

const DASH: f32 = 5.0;
const DASH_GAP: f32 = 4.0;

/// The font that a text of a picture has.
pub fn font(size: f32, figures: bool) -> FontId {
    FontId::new(size, if figures { FontFamily::Monospace } else { FontFamily::Proportional })
}

/// Hands a picture to egui.
pub fn paint(painter: &Painter, picture: Picture) {
    for layer in picture {
        let painter = painter.with_clip_rect(layer.clip.intersect(painter.clip_rect()));
        for element in layer.elements {
            paint_element(&painter, element);
        }
    }
}

fn paint_element(painter: &Painter, element: Element) {
    painter.add(shape(painter.ctx(), element));
}

/// An element as the toolkit draws it.
pub fn shape(ctx: &Context, element: Element) -> Shape {
    match element {
        Element::Box { rect, color } => Shape::rect_filled(rect, 0.0, color),
        Element::Line { points, color, width } => Shape::line(points, Stroke::new(width, color)),
        Element::Bars { bars, color, width } => Shape::mesh(bars_mesh(&bars, color, width)),
        Element::Dashes { points, color, width } => {
            Shape::Vec(Shape::dashed_line(&points, Stroke::new(width, color), DASH, DASH_GAP))
        }
        Element::Polygon { points, color } => Shape::convex_polygon(points, color, Stroke::NONE),
        Element::Text { at, anchor, text, size, color, figures } => {
            ctx.fonts_mut(|fonts| Shape::text(fonts, at, anchor, text, font(size, figures), color))
        }
    }
}

/// Two triangles for each bar.
fn bars_mesh(bars: &[[Pos2; 2]], color: Color32, width: f32) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.reserve_vertices(bars.len() * 4);
    mesh.reserve_triangles(bars.len() * 2);
    let half = vec2(width * 0.5, width * 0.5);
    for [a, b] in bars {
        mesh.add_colored_rect(Rect::from_two_pos(*a, *b).expand2(half), color);
    }
    mesh
}

/// A line as what is cheapest to draw: bars where it goes up and down in one place again and again, lines elsewhere.
pub fn line_of(points: Vec<Pos2>, color: Color32, width: f32) -> Vec<Element> {
    /// Bars further apart than this would leave holes.
    const NEXT: f32 = 1.1;
    /// Fewer are not worth it.
    const LEAST: usize = 16;
    let is_bar = |at: usize| at + 1 < points.len() && points[at].x == points[at + 1].x;
    let follows = |at: usize| is_bar(at) && points[at].x - points[at - 1].x <= NEXT;
    let mut elements = Vec::new();
    let mut drawn = 0;
    let mut at = 0;
    while at < points.len() {
        let first = at;
        while if at == first { is_bar(at) } else { follows(at) } {
            at += 2;
        }
        if at - first >= 2 * LEAST {
            if first > drawn {
                elements.push(Element::Line { points: points[drawn..=first].to_vec(), color, width });
            }
            let bars = points[first..at].chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
            elements.push(Element::Bars { bars, color, width });
            drawn = at - 1;
        }
        at = at.max(first + 1);
    }
    if drawn + 1 < points.len() || drawn == 0 {
        let points = if drawn == 0 { points } else { points[drawn..].to_vec() };
        elements.push(Element::Line { points, color, width });
    }
    elements
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn a_dense_stretch_becomes_bars_and_the_rest_stays_a_line_that_meets_them() {
        let mut points = vec![pos2(0.0, 5.0), pos2(7.0, 6.0)];
        for x in 10..60 {
            points.extend([pos2(x as f32, 1.0), pos2(x as f32, 9.0)]);
        }
        points.extend([pos2(70.0, 4.0), pos2(80.0, 4.0)]);
        let elements = line_of(points.clone(), Color32::WHITE, 1.2);
        let [
            Element::Line { points: before, .. },
            Element::Bars { bars, .. },
            Element::Line { points: after, .. },
        ] = elements.as_slice()
        else {
            panic!("{elements:?}");
        };
        assert_eq!((before.len(), bars.len(), after.len()), (3, 50, 3));
        assert_eq!((before[2], after[0]), (bars[0][0], bars[49][1]));
    }

    #[test]
    fn a_sparse_line_stays_as_it_is() {
        let points: Vec<Pos2> = (0..200).map(|x| pos2(x as f32 * 3.0, (x % 7) as f32)).collect();
        let whole = vec![Element::Line { points: points.clone(), color: Color32::WHITE, width: 1.0 }];
        assert_eq!(line_of(points, Color32::WHITE, 1.0), whole);
        assert_eq!(line_of(vec![pos2(1.0, 1.0)], Color32::WHITE, 1.0).len(), 1);
    }
}
