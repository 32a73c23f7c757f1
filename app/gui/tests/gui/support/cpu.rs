//! Pictures of the window without a GPU: kittest's renderer over our own painter.

use brushwork_raster::Painter;
use egui::{Color32, Context, FullOutput, TexturesDelta};
use egui_kittest::TestRenderer;
use image::RgbaImage;

/// Draws what a test sees.
#[derive(Default)]
pub struct Cpu(Painter);

impl TestRenderer for Cpu {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        self.0.apply(delta);
    }

    fn render(&mut self, ctx: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let pixels_per_point = ctx.pixels_per_point();
        let size = ctx.content_rect().size() * pixels_per_point;
        let (width, height) = (size.x.round() as u32, size.y.round() as u32);
        let primitives = ctx.tessellate(output.shapes.clone(), pixels_per_point);
        let pixels = [width as usize, height as usize];
        let picture = self.0.paint(pixels, pixels_per_point, Color32::TRANSPARENT, &primitives);
        RgbaImage::from_raw(width, height, picture).ok_or_else(|| "picture of another size".to_owned())
    }
}
