//! What is drawn under and around the letters: waves under problems, boxes around matches, and signs for characters that nobody sees.

use std::ops::Range;

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};

use super::paint::{Line, Metrics};
use crate::theme::Palette;

/// A wave under a stretch of a line.
pub fn wave(painter: &Painter, from: f32, to: f32, bottom: f32, color: Color32) {
    let to = to.max(from + 6.0);
    let points: Vec<Pos2> = (0..)
        .map(|step: u16| (from + f32::from(step) * 2.5, step))
        .take_while(|(x, _)| *x <= to)
        .map(|(x, step)| pos2(x, bottom - if step % 2 == 0 { 0.5 } else { 2.5 }))
        .collect();
    painter.add(Shape::line(points, Stroke::new(1.2, color)));
}

/// The part of a range of the text that lies in a line from `start` to `end`, as points from the line's left.
pub fn stretch(line: &Line, range: &Range<usize>, start: usize, end: usize) -> Option<(f32, f32)> {
    if range.end < start || range.start > end {
        return None;
    }
    let from = line.x_of(range.start.saturating_sub(start));
    Some((from, line.x_of(range.end.min(end) - start)))
}

/// A thin box around a stretch.
pub fn boxed(painter: &Painter, at: Rect, fill: Color32, stroke: Stroke) {
    painter.rect(at, 2.0, fill, stroke, StrokeKind::Inside);
}

/// Dots for spaces, arrows for tabs, a hook for the end of a line, and a code for what has no letter.
pub fn hidden(
    painter: &Painter,
    line: &Line,
    text: &str,
    origin: Pos2,
    metrics: &Metrics,
    palette: &Palette,
) {
    let middle = origin.y + metrics.row / 2.0;
    let color = palette.weak_text.gamma_multiply(0.75);
    for (byte, letter) in text.char_indices().take(2000) {
        let (from, to) = (line.x_of(byte), line.x_of(byte + letter.len_utf8()));
        let at = pos2(origin.x + (from + to) / 2.0, middle);
        match letter {
            ' ' => {
                painter.circle_filled(at, 1.1, color);
            }
            '\t' => {
                let (left, right) = (origin.x + from + 2.0, origin.x + to - 2.0);
                painter.arrow(pos2(left, middle), vec2(right - left, 0.0), Stroke::new(1.0, color));
            }
            letter if is_unseen(letter) => {
                let code = format!("{:X}", u32::from(letter));
                let font = FontId::monospace(metrics.font.size * 0.62);
                let galley = painter.layout_no_wrap(code, font.clone(), palette.error);
                let size = galley.size() + vec2(4.0, 2.0);
                let place = Rect::from_center_size(pos2(origin.x + from + size.x / 2.0, middle), size);
                boxed(painter, place, palette.ground, Stroke::new(1.0, palette.error));
                painter.galley(place.min + vec2(2.0, 1.0), galley, palette.error);
            }
            _ => {}
        }
    }
    let end = pos2(origin.x + line.width() + 2.0, middle);
    painter.text(end, Align2::LEFT_CENTER, "¶", FontId::monospace(metrics.font.size * 0.8), color);
}

/// Characters that a copy brings along and that nobody sees: controls, blanks of no or odd width, marks of direction.
pub fn is_unseen(letter: char) -> bool {
    let code = u32::from(letter);
    letter.is_control() && letter != '\t'
        || matches!(code, 0xA0 | 0xAD | 0x1680 | 0x2000..=0x200F | 0x2028..=0x202F | 0x205F..=0x2064 | 0x3000 | 0xFEFF)
}
