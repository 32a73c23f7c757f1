//! Draws egui's triangles on the CPU, so that a picture of the window needs no GPU, no display and no driver.
//!
//! [`Painter`] keeps egui's textures and turns tessellated shapes into RGBA pixels. It follows the glow renderer:
//! colours are multiplied and blended, premultiplied, in gamma space; textures are sampled at pixel centres with
//! four taps. It leaves out paint callbacks (custom GL) and texture wrapping, which the window does not use.
//!
//! It is a crate of its own so that it can be optimised in debug builds, where tests take their pictures.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod canvas;
mod texture;
mod triangle;

use std::collections::HashMap;

use egui::epaint::{ClippedPrimitive, Primitive};
use egui::{Color32, TextureId, TexturesDelta};

use canvas::{Canvas, Clip};
use texture::Texture;
use triangle::Triangle;

/// Egui's textures, and the means to draw with them.
#[derive(Default)]
pub struct Painter {
    textures: HashMap<TextureId, Texture>,
    /// Textures the last frame no longer needs. They are dropped with the next delta, after that frame was drawn.
    free_next: Vec<TextureId>,
}

impl Painter {
    /// Takes all texture changes out of `delta`.
    pub fn apply(&mut self, delta: &mut TexturesDelta) {
        for id in self.free_next.drain(..) {
            self.textures.remove(&id);
        }
        for (id, changes) in delta.set.drain() {
            for change in &changes {
                self.textures.entry(id).or_default().apply(change);
            }
        }
        self.free_next.extend(delta.free.drain());
    }

    /// Draws over `background` and returns `width * height` RGBA pixels, row by row, premultiplied.
    pub fn paint(
        &self,
        [width, height]: [usize; 2],
        pixels_per_point: f32,
        background: Color32,
        primitives: &[ClippedPrimitive],
    ) -> Vec<u8> {
        let mut canvas = Canvas { width, height, pixels: vec![background; width * height] };
        for ClippedPrimitive { clip_rect, primitive } in primitives {
            let Primitive::Mesh(mesh) = primitive else { continue };
            let Some(texture) = self.textures.get(&mesh.texture_id) else { continue };
            let clip = Clip::new(*clip_rect * pixels_per_point, &canvas);
            for corners in mesh.indices.chunks_exact(3) {
                let vertices = [0, 1, 2].map(|i| mesh.vertices[corners[i] as usize]);
                if let Some(triangle) = Triangle::new(&vertices, pixels_per_point) {
                    triangle.draw(texture, &clip, &mut canvas);
                }
            }
        }
        canvas.pixels.iter().flat_map(Color32::to_array).collect()
    }
}

#[cfg(test)]
mod tests {
    use egui::epaint::{ColorImage, ImageDelta, Mesh, Vertex};
    use egui::{Rect, TextureOptions, pos2};

    use super::*;

    const WHITE: Color32 = Color32::WHITE;

    fn painter() -> Painter {
        let mut painter = Painter::default();
        let mut delta = TexturesDelta::default();
        let image = ColorImage::filled([2, 2], WHITE);
        delta.push(TextureId::default(), ImageDelta::full(image, TextureOptions::LINEAR));
        painter.apply(&mut delta);
        assert!(delta.is_empty());
        painter
    }

    fn drawn(mesh: Mesh, clip: Rect, size: [usize; 2]) -> Vec<[u8; 4]> {
        let primitives = [ClippedPrimitive { clip_rect: clip, primitive: Primitive::Mesh(mesh) }];
        let pixels = painter().paint(size, 1.0, Color32::BLACK, &primitives);
        pixels.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]).collect()
    }

    fn rect(left: f32, top: f32, right: f32, bottom: f32) -> Rect {
        Rect::from_min_max(pos2(left, top), pos2(right, bottom))
    }

    #[test]
    fn a_rectangle_fills_exactly_its_pixels() {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(rect(1.0, 1.0, 3.0, 2.0), Color32::RED);
        let pixels = drawn(mesh, Rect::EVERYTHING, [4, 3]);
        let red: Vec<usize> = (0..12).filter(|i| pixels[*i] == [255, 0, 0, 255]).collect();
        assert_eq!(red, [5, 6]);
    }

    #[test]
    fn two_triangles_that_share_an_edge_never_draw_a_pixel_twice() {
        // Half transparent: a pixel drawn twice would be brighter than its neighbours.
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(rect(0.0, 0.0, 16.0, 16.0), Color32::from_rgba_premultiplied(100, 0, 0, 128));
        let pixels = drawn(mesh, Rect::EVERYTHING, [16, 16]);
        assert!(pixels.iter().all(|pixel| *pixel == pixels[0]), "{pixels:?}");
        assert_eq!(pixels[0], [100, 0, 0, 255]);
    }

    #[test]
    fn nothing_is_drawn_outside_the_clip_rectangle() {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(rect(-100.0, -100.0, 100.0, 100.0), WHITE);
        let pixels = drawn(mesh, rect(1.0, 0.0, 2.0, 1.0), [3, 1]);
        assert_eq!(pixels, [[0, 0, 0, 255], [255; 4], [0, 0, 0, 255]]);
    }

    #[test]
    fn colours_run_evenly_between_corners() {
        let mut mesh = Mesh::default();
        for (x, y, grey) in [(0.0, 0.0, 0), (4.0, 0.0, 200), (4.0, 4.0, 200), (0.0, 4.0, 0)] {
            mesh.vertices.push(Vertex::untextured(pos2(x, y), Color32::from_gray(grey)));
        }
        mesh.add_triangle(0, 1, 2);
        mesh.add_triangle(0, 2, 3);
        let pixels = drawn(mesh, Rect::EVERYTHING, [4, 4]);
        assert_eq!([pixels[0][0], pixels[1][0], pixels[2][0], pixels[3][0]], [25, 75, 125, 175]);
        assert_eq!(pixels[12], pixels[0]);
    }

    #[test]
    fn a_degenerate_triangle_and_a_missing_texture_draw_nothing() {
        let mut mesh = Mesh::default();
        for x in [0.0, 2.0, 4.0] {
            mesh.vertices.push(Vertex::untextured(pos2(x, x), WHITE));
        }
        mesh.add_triangle(0, 1, 2);
        assert!(drawn(mesh.clone(), Rect::EVERYTHING, [4, 4]).iter().all(|pixel| *pixel == [0, 0, 0, 255]));
        mesh.texture_id = TextureId::User(9);
        assert!(drawn(mesh, Rect::EVERYTHING, [4, 4]).iter().all(|pixel| *pixel == [0, 0, 0, 255]));
    }
}
