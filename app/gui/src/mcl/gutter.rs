//! The strip left of the text: line numbers, and marks that are set by a click.

use egui::{Align2, FontId, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::editor::Options;
use super::{Document, MclAction, Metrics};
use crate::theme::Palette;

/// Room for a breakpoint or bookmark.
const MARKS: f32 = 18.0;
/// Room for the sign of a fold.
const FOLDS: f32 = 14.0;

/// How wide the strip is: it grows with the number of lines and with counts.
pub fn width(document: &Document, metrics: &Metrics) -> f32 {
    let digits = document.text.line_count().to_string().len().max(3);
    let counts = if document.run.counts.is_empty() { 0 } else { COUNT_CELLS };
    MARKS + (digits + counts) as f32 * metrics.cell + FOLDS
}

/// Letters of a count: "999k" and a space.
const COUNT_CELLS: usize = 6;

pub fn gutter_ui(
    ui: &mut Ui,
    rect: Rect,
    document: &Document,
    options: &Options,
    metrics: &Metrics,
    actions: &mut Vec<MclAction>,
) {
    let palette = Palette::of(ui);
    let response = ui.interact(rect, ui.scope_id().with("mcl gutter"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Pane, true, "Lines and breakpoints"));
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    painter.rect_filled(rect, 0.0, palette.panel);
    let count = document.folds.rows(document.text.line_count());
    let first = (document.view.offset.y / metrics.row).max(0.0) as usize;
    let caret_line = document.caret_line();
    for row in first..count {
        let top = rect.top() + row as f32 * metrics.row - document.view.offset.y;
        if top > rect.bottom() {
            break;
        }
        let line = document.folds.line_at(row);
        let at = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), metrics.row));
        marks_ui(ui, &painter, at, document, line);
        if options.folding {
            fold_ui(ui, &painter, at, document, line);
        }
        let color = if line == caret_line && options.current_line { palette.text } else { palette.weak_text };
        let right = at.right() - FOLDS;
        let font = FontId::monospace(metrics.font.size * 0.9);
        painter.text(pos2(right, at.center().y), Align2::RIGHT_CENTER, line + 1, font, color);
    }
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked()) {
        let row = ((at.y - rect.top() + document.view.offset.y) / metrics.row).max(0.0) as usize;
        if row < count {
            let line = document.folds.line_at(row);
            let folds =
                options.folding && at.x > rect.right() - FOLDS && document.findings.last_of(line).is_some();
            actions.push(if folds { MclAction::ToggleFold(line) } else { MclAction::ToggleBreakpoint(line) });
        }
    }
    let hint = "Click a line to set a breakpoint; click the sign at its right to fold a block away";
    response.on_hover_text(hint);
}

/// A sign where a block can be folded away, and a line beside what belongs to it.
fn fold_ui(ui: &Ui, painter: &egui::Painter, at: Rect, document: &Document, line: usize) {
    let palette = Palette::of(ui);
    let center = pos2(at.right() - FOLDS / 2.0, at.center().y);
    let stroke = Stroke::new(1.0, palette.weak_text);
    if document.findings.last_of(line).is_none() {
        let inside = document.findings.folds.iter().any(|(first, last)| *first < line && line <= *last);
        if inside {
            painter.vline(center.x, at.y_range(), Stroke::new(1.0, palette.line));
        }
        return;
    }
    let sign = Rect::from_center_size(center, vec2(9.0, 9.0));
    painter.rect_stroke(sign, 1.0, stroke, egui::StrokeKind::Inside);
    painter.hline(sign.x_range().shrink(2.0), center.y, stroke);
    if document.folds.is_closed(line) {
        painter.vline(center.x, sign.y_range().shrink(2.0), stroke);
    }
}

/// A breakpoint is a disc, a bookmark a flag, the line of a halt an arrow.
fn marks_ui(ui: &Ui, painter: &egui::Painter, at: Rect, document: &Document, line: usize) {
    let palette = Palette::of(ui);
    let center = pos2(at.left() + MARKS / 2.0, at.center().y);
    if document.bookmarks.contains(line) {
        let flag = Rect::from_center_size(center, vec2(11.0, 12.0));
        painter.rect_filled(flag, 2.0, palette.accent);
    }
    if document.breakpoints.contains(line) {
        painter.circle_filled(center, 5.0, palette.error);
    }
    if document.run.halted_at == Some(line) {
        let arrow = vec![center + vec2(-5.0, -5.0), center + vec2(6.0, 0.0), center + vec2(-5.0, 5.0)];
        painter.add(egui::Shape::convex_polygon(arrow, palette.warning, Stroke::new(1.0, palette.text)));
    }
    let Some(times) = document.run.counts.get(line).filter(|times| **times > 0) else { return };
    let font = FontId::monospace(10.0);
    painter.text(
        pos2(at.left() + MARKS, at.center().y),
        Align2::LEFT_CENTER,
        short(*times),
        font,
        palette.weak_text,
    );
}

/// A count in four letters.
fn short(times: u64) -> String {
    match times {
        0..=9_999 => times.to_string(),
        10_000..=999_999 => format!("{}k", times / 1000),
        1_000_000..=999_999_999 => format!("{}M", times / 1_000_000),
        _ => format!("{}G", times / 1_000_000_000),
    }
}
