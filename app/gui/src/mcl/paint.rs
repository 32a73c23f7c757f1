//! One line of a program as it is drawn: its letters in their colours, and which byte stands at which point.

use std::sync::Arc;

use brushwork_script::language::Language;
use brushwork_script::mcl::index::Class;
use egui::text::{CCursor, LayoutJob, TextFormat};
use egui::{FontId, Galley, Ui, Vec2};

use super::moves::TAB_CELLS;
use crate::theme::{Palette, Syntax};

/// What is drawn of a line at most, in characters: nobody reads on, and laying it out takes time.
const LONGEST: usize = 4000;

/// How the text is drawn.
#[derive(Clone, Debug)]
pub struct Metrics {
    pub font: FontId,
    /// Height of a row.
    pub row: f32,
    /// Width of a figure.
    pub cell: f32,
}

impl Metrics {
    pub fn of(ui: &Ui, zoom_percent: u16) -> Self {
        let size = (13.5 * f32::from(zoom_percent) / 100.0 * 2.0).round() / 2.0;
        let font = FontId::monospace(size);
        let (row, cell) = ui.fonts_mut(|fonts| (fonts.row_height(&font), fonts.glyph_width(&font, '0')));
        Self { font, row: (row * 1.12).ceil(), cell }
    }
}

/// A line with its letters laid out. Tabs are spaces up to the next stop.
pub struct Line {
    pub galley: Arc<Galley>,
    /// The byte of the line at which each drawn character stands, and at last its end.
    bytes: Vec<usize>,
}

impl Line {
    pub fn of(ui: &Ui, text: &str, metrics: &Metrics, is_left_out: bool, language: Language) -> Self {
        let palette = Palette::of(ui);
        let (mut shown, mut bytes) = (String::new(), Vec::new());
        let mut starts = Vec::new();
        for (at, letter) in text.char_indices().take(LONGEST) {
            starts.push((at, shown.len()));
            if letter == '\t' {
                let cells = TAB_CELLS - bytes.len() % TAB_CELLS;
                shown.extend(std::iter::repeat_n(' ', cells));
                bytes.extend(std::iter::repeat_n(at, cells));
            } else {
                shown.push(if letter.is_control() { ' ' } else { letter });
                bytes.push(at);
            }
        }
        let end = text.char_indices().nth(LONGEST).map_or(text.len(), |(at, _)| at);
        bytes.push(end);
        let shown_at = |byte: usize| {
            let index = starts.partition_point(|(at, _)| *at < byte);
            starts.get(index).map_or(shown.len(), |(_, shown)| *shown)
        };
        let mut job = LayoutJob { break_on_newline: false, ..LayoutJob::default() };
        job.wrap.max_width = f32::INFINITY;
        let mut drawn = 0;
        let mut append = |job: &mut LayoutJob, to: usize, color| {
            if to > drawn {
                job.append(&shown[drawn..to], 0.0, TextFormat::simple(metrics.font.clone(), color));
                drawn = to;
            }
        };
        for (range, class) in language.classes(&text[..end]) {
            append(&mut job, shown_at(range.start), palette.text);
            let color =
                if is_left_out { palette.weak_text } else { color_of(&palette.syntax, class, palette) };
            append(&mut job, shown_at(range.end), color);
        }
        append(&mut job, shown.len(), palette.text);
        Self { galley: ui.fonts_mut(|fonts| fonts.layout_job(job)), bytes }
    }

    /// Where a byte of the line stands, from its left.
    pub fn x_of(&self, byte: usize) -> f32 {
        let index = self.bytes.partition_point(|at| *at < byte);
        self.galley.pos_from_cursor(CCursor::new(index)).min.x
    }

    /// The byte nearest to a point, from its left.
    pub fn byte_at(&self, x: f32) -> usize {
        let cursor = self.galley.cursor_from_pos(Vec2::new(x, 1.0));
        let index = cursor.index.0.min(self.bytes.len() - 1);
        self.bytes[index]
    }

    pub fn width(&self) -> f32 {
        self.galley.size().x
    }
}

pub fn color_of(syntax: &Syntax, class: Class, palette: &Palette) -> egui::Color32 {
    match class {
        Class::Command => syntax.command,
        Class::Operator | Class::Format => syntax.operator,
        Class::Type | Class::Modifier => syntax.kind,
        Class::Register => syntax.register,
        Class::Directive => syntax.directive,
        Class::Number => syntax.number,
        Class::Text => syntax.text,
        Class::Comment => syntax.comment,
        Class::Label => syntax.label,
        Class::Wrong => palette.error,
        Class::Name | Class::Punctuation => palette.text,
    }
}
