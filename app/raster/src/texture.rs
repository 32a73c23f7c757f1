//! One texture: its texels, its filter, and how a point of it is read.

use egui::epaint::{ImageData, ImageDelta};
use egui::{Color32, Pos2, TextureFilter};

/// Texels, premultiplied, row by row.
#[derive(Default)]
pub struct Texture {
    width: usize,
    height: usize,
    texels: Vec<Color32>,
    nearest: bool,
}

impl Texture {
    /// Replaces the whole texture, or a patch of it that lies inside.
    pub fn apply(&mut self, delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        self.nearest = delta.options.magnification == TextureFilter::Nearest;
        let [width, height] = image.size;
        let Some([left, top]) = delta.pos else {
            *self = Self { width, height, texels: image.pixels.clone(), nearest: self.nearest };
            return;
        };
        for y in 0..height {
            let from = &image.pixels[y * width..(y + 1) * width];
            let start = (top + y) * self.width + left;
            if let Some(row) = self.texels.get_mut(start..start + width) {
                row.copy_from_slice(from);
            }
        }
    }

    /// The colour at `uv`, each part 0 to 255.
    pub fn sample(&self, uv: Pos2) -> [f32; 4] {
        let (x, y) = (uv.x * self.width as f32, uv.y * self.height as f32);
        if self.nearest {
            return self.texel(x.floor() as isize, y.floor() as isize);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (dx, dy) = (x - left, y - top);
        let (left, top) = (left as isize, top as isize);
        let upper = mix(self.texel(left, top), self.texel(left + 1, top), dx);
        let lower = mix(self.texel(left, top + 1), self.texel(left + 1, top + 1), dx);
        mix(upper, lower, dy)
    }

    fn texel(&self, x: isize, y: isize) -> [f32; 4] {
        if self.texels.is_empty() {
            return [0.0; 4];
        }
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.texels[y * self.width + x].to_array().map(f32::from)
    }
}

fn mix(a: [f32; 4], b: [f32; 4], part: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * part)
}

#[cfg(test)]
mod tests {
    use egui::epaint::ColorImage;
    use egui::{TextureOptions, pos2};

    use super::*;

    fn two_by_one() -> Texture {
        let mut texture = Texture::default();
        let image = ColorImage::new([2, 1], vec![Color32::BLACK, Color32::WHITE]);
        texture.apply(&ImageDelta::full(image, TextureOptions::LINEAR));
        texture
    }

    #[test]
    fn four_taps_mix_between_texel_centres_and_hold_at_the_edge() {
        let texture = two_by_one();
        assert_eq!(texture.sample(pos2(0.25, 0.5))[0], 0.0);
        assert_eq!(texture.sample(pos2(0.5, 0.5))[0], 127.5);
        assert_eq!(texture.sample(pos2(0.0, 0.0))[0], 0.0);
        assert_eq!(texture.sample(pos2(1.0, 1.0))[0], 255.0);
    }

    #[test]
    fn a_patch_changes_only_its_texels() {
        let mut texture = two_by_one();
        let patch = ColorImage::filled([1, 1], Color32::RED);
        texture.apply(&ImageDelta::partial([1, 0], patch, TextureOptions::LINEAR));
        assert_eq!(texture.texels, [Color32::BLACK, Color32::RED]);
    }
}
