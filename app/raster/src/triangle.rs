//! One triangle: which pixels it covers and in what colour.
//!
//! Corners are snapped to 1/256 pixel and edges are exact integers, with the top-left rule for pixels that lie on
//! an edge, so that neighbours neither overlap nor leave a seam.

use egui::epaint::Vertex;
use egui::{Color32, Pos2, pos2};

use crate::canvas::{Canvas, Clip, blend};
use crate::texture::Texture;

/// Steps per pixel that corners are snapped to.
const STEPS: i64 = 256;

/// Farthest corner taken, in pixels: edge products then fit an `i64` with room to spare.
const FAR_PIXELS: f32 = 1e6;

#[derive(Clone, Copy)]
struct Corner {
    x: i64,
    y: i64,
    uv: Pos2,
    color: Color32,
}

/// Three corners, turning so that the inside is where all edges are positive.
pub struct Triangle {
    corners: [Corner; 3],
    /// Twice the area, in steps squared; positive.
    area: i64,
}

impl Triangle {
    /// None if the triangle has no area.
    pub fn new(vertices: &[Vertex; 3], pixels_per_point: f32) -> Option<Self> {
        let snap = |value: f32| {
            ((value * pixels_per_point).clamp(-FAR_PIXELS, FAR_PIXELS) * STEPS as f32).round() as i64
        };
        let mut corners =
            vertices.map(|v| Corner { x: snap(v.pos.x), y: snap(v.pos.y), uv: v.uv, color: v.color });
        let area = edge(&corners[0], &corners[1], corners[2].x, corners[2].y);
        if area < 0 {
            corners.swap(1, 2);
        }
        (area != 0).then_some(Self { corners, area: area.abs() })
    }

    pub fn draw(&self, texture: &Texture, clip: &Clip, canvas: &mut Canvas) {
        let [a, b, c] = &self.corners;
        let first_pixel = |steps: i64| (steps - STEPS / 2).div_euclid(STEPS);
        let left = first_pixel(a.x.min(b.x).min(c.x)).max(clip.left);
        let right = (first_pixel(a.x.max(b.x).max(c.x)) + 1).min(clip.right);
        let top = first_pixel(a.y.min(b.y).min(c.y)).max(clip.top);
        let bottom = (first_pixel(a.y.max(b.y).max(c.y)) + 1).min(clip.bottom);
        let shade = Shade::new(self, texture);
        for y in top..bottom {
            let row = canvas.row(y as usize);
            let mut inside = false;
            for x in left..right {
                let Some(weights) = self.weights_at(x, y) else {
                    if inside {
                        break;
                    }
                    continue;
                };
                inside = true;
                let pixel = &mut row[x as usize];
                *pixel = match &shade {
                    Shade::Flat(color) => blend(*pixel, *color),
                    Shade::Varying => blend(*pixel, self.color(texture, weights)),
                };
            }
        }
    }

    /// The weights of the three corners at a pixel's centre, in units of [`Triangle::area`]; none outside.
    fn weights_at(&self, x: i64, y: i64) -> Option<[i64; 3]> {
        let (x, y) = (x * STEPS + STEPS / 2, y * STEPS + STEPS / 2);
        let [a, b, c] = &self.corners;
        let weights = [edge(b, c, x, y), edge(c, a, x, y), edge(a, b, x, y)];
        let covers =
            |weight: i64, from: &Corner, to: &Corner| weight > 0 || (weight == 0 && is_top_left(from, to));
        (covers(weights[0], b, c) && covers(weights[1], c, a) && covers(weights[2], a, b)).then_some(weights)
    }

    fn color(&self, texture: &Texture, weights: [i64; 3]) -> Color32 {
        let part = weights.map(|weight| weight as f32 / self.area as f32);
        let [a, b, c] = &self.corners;
        let mix = |value: fn(&Corner) -> f32| part[0] * value(a) + part[1] * value(b) + part[2] * value(c);
        let uv = pos2(mix(|corner| corner.uv.x), mix(|corner| corner.uv.y));
        let tint = [
            mix(|corner| f32::from(corner.color.r())),
            mix(|corner| f32::from(corner.color.g())),
            mix(|corner| f32::from(corner.color.b())),
            mix(|corner| f32::from(corner.color.a())),
        ];
        tinted(texture.sample(uv), tint)
    }
}

/// Whether every pixel of a triangle has the same colour, as most have.
enum Shade {
    Flat(Color32),
    Varying,
}

impl Shade {
    fn new(triangle: &Triangle, texture: &Texture) -> Self {
        let [a, b, c] = &triangle.corners;
        let flat = a.uv == b.uv && b.uv == c.uv && a.color == b.color && b.color == c.color;
        if !flat {
            return Self::Varying;
        }
        Self::Flat(tinted(texture.sample(a.uv), a.color.to_array().map(f32::from)))
    }
}

/// Twice the area of the triangle from `from` over `to` to the point, positive when it turns clockwise on screen.
fn edge(from: &Corner, to: &Corner, x: i64, y: i64) -> i64 {
    (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)
}

/// Whether the inside lies to the right of the edge or just below it.
fn is_top_left(from: &Corner, to: &Corner) -> bool {
    to.y < from.y || (to.y == from.y && to.x > from.x)
}

fn tinted(texel: [f32; 4], tint: [f32; 4]) -> Color32 {
    let [r, g, b, a] = std::array::from_fn(|i| (texel[i] * tint[i] / 255.0).round().clamp(0.0, 255.0) as u8);
    Color32::from_rgba_premultiplied(r, g, b, a)
}
