//! The picture being drawn, what may be touched of it, and how a colour comes onto another.

use egui::{Color32, Rect};

/// The picture being drawn.
pub struct Canvas {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Color32>,
}

impl Canvas {
    pub fn row(&mut self, y: usize) -> &mut [Color32] {
        let start = y * self.width;
        &mut self.pixels[start..start + self.width]
    }
}

/// The pixels a primitive may touch: `left..right`, `top..bottom`.
pub struct Clip {
    pub left: i64,
    pub right: i64,
    pub top: i64,
    pub bottom: i64,
}

impl Clip {
    pub fn new(rect: Rect, canvas: &Canvas) -> Self {
        let inside = |value: f32, end: usize| (value.round().max(0.0) as i64).min(end as i64);
        Self {
            left: inside(rect.min.x, canvas.width),
            right: inside(rect.max.x, canvas.width),
            top: inside(rect.min.y, canvas.height),
            bottom: inside(rect.max.y, canvas.height),
        }
    }
}

/// `over` on top of `under`, both premultiplied.
pub fn blend(under: Color32, over: Color32) -> Color32 {
    let keep = 255 - u32::from(over.a());
    let channel =
        |under: u8, over: u8| (u32::from(over) + (u32::from(under) * keep + 127) / 255).min(255) as u8;
    Color32::from_rgba_premultiplied(
        channel(under.r(), over.r()),
        channel(under.g(), over.g()),
        channel(under.b(), over.b()),
        channel(under.a(), over.a()),
    )
}
