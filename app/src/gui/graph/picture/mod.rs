//! A picture of the graph as plain shapes, so that the window, a PNG and an SVG show the very same.
//!
//! What is drawn is decided in [`draw`]; [`paint`] hands it to egui, [`svg`] writes it as text, [`png`] draws it on the
//! CPU.

use egui::{Align2, Color32, FontFamily, FontId, Painter, Pos2, Rect, Shape, Stroke};

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
    match element {
        Element::Box { rect, color } => {
            painter.rect_filled(rect, 0.0, color);
        }
        Element::Line { points, color, width } => {
            painter.add(Shape::line(points, Stroke::new(width, color)));
        }
        Element::Dashes { points, color, width } => {
            painter.extend(Shape::dashed_line(&points, Stroke::new(width, color), DASH, DASH_GAP));
        }
        Element::Polygon { points, color } => {
            painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
        }
        Element::Text { at, anchor, text, size, color, figures } => {
            painter.text(at, anchor, text, font(size, figures), color);
        }
    }
}
