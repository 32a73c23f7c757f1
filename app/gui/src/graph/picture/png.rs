//! A picture as PNG, drawn on the CPU with the window's own fonts: no display and no GPU is needed.

use brushwork_raster::Painter;
use egui::{Color32, Context, RawInput, Rect};
use image::{ExtendedColorType, ImageEncoder as _, ImageError};

use super::{Picture, paint};
use crate::theme;

/// Pixels per point: fine enough for a page.
const PIXELS_PER_POINT: f32 = 2.0;

/// The whole file. `size` begins at 0, 0.
///
/// # Errors
/// The picture is too large to be encoded.
pub fn png(picture: &Picture, size: Rect, background: Color32) -> Result<Vec<u8>, ImageError> {
    let ([width, height], rgba) = pixels(picture, size, background);
    let mut file = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut file);
    encoder.write_image(&rgba, width as u32, height as u32, ExtendedColorType::Rgba8)?;
    Ok(file)
}

/// Width and height, and each pixel's red, green, blue and opacity. `size` begins at 0, 0.
pub fn pixels(picture: &Picture, size: Rect, background: Color32) -> ([usize; 2], Vec<u8>) {
    let ctx = Context::default();
    theme::install(&ctx);
    ctx.set_pixels_per_point(PIXELS_PER_POINT);
    let mut painter = Painter::default();
    // The first frame takes over the pixels per point; the second is drawn with them.
    let mut shapes = Vec::new();
    for _ in 0..2 {
        let input = RawInput { screen_rect: Some(size), ..RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| {
            let all = ui.ctx().layer_painter(egui::LayerId::background());
            paint(&all, picture.clone());
        });
        painter.apply(&mut output.textures_delta);
        shapes = std::mem::take(&mut output.shapes);
    }
    let primitives = ctx.tessellate(shapes, PIXELS_PER_POINT);
    let pixels =
        [size.width(), size.height()].map(|points| (points * PIXELS_PER_POINT).round().max(1.0) as usize);
    let rgba = painter.paint(pixels, PIXELS_PER_POINT, background, &primitives);
    (pixels, rgba)
}

#[cfg(test)]
mod tests {
    use egui::{Align2, pos2};

    use super::super::{Element, Layer};
    use super::*;

    #[test]
    fn a_picture_becomes_a_png_of_twice_its_size_with_its_shapes_and_words() {
        let size = Rect::from_min_max(pos2(0.0, 0.0), pos2(80.0, 40.0));
        let half = Rect::from_min_max(pos2(0.0, 0.0), pos2(40.0, 40.0));
        let text = Element::Text {
            at: pos2(60.0, 20.0),
            anchor: Align2::CENTER_CENTER,
            text: "M1".to_owned(),
            size: 14.0,
            color: Color32::WHITE,
            figures: false,
        };
        let elements = vec![Element::Box { rect: half, color: Color32::RED }, text];
        let file = png(&vec![Layer { clip: size, elements }], size, Color32::BLACK).unwrap();
        let seen = image::load_from_memory(&file).unwrap().to_rgba8();
        assert_eq!(seen.dimensions(), (160, 80));
        assert_eq!(seen.get_pixel(20, 40).0, [255, 0, 0, 255]);
        let white = seen.pixels().filter(|pixel| pixel.0[0] > 200 && pixel.0[1] > 200).count();
        assert!(white > 20, "{white} pixels of the words");
    }
}
