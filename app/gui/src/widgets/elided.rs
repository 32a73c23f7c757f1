//! A painted text that ends in an ellipsis where its room does.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, FontId, Painter, Pos2};

/// Paints a line of text within a width; tells whether all of it had room.
pub fn elided(
    painter: &Painter,
    (at, align): (Pos2, Align2),
    (text, font, color): (&str, FontId, Color32),
    width: f32,
) -> bool {
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = TextWrapping::truncate_at_width(width.max(0.0));
    let galley = painter.layout_job(job);
    let is_whole = !galley.elided;
    painter.galley(align.anchor_size(at, galley.size()).min, galley, color);
    is_whole
}
