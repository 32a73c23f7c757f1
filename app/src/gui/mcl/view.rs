//! The text of a program on the screen: only the lines in view are laid out.

use egui::containers::scroll_area::{DragScroll, ScrollSource};
use egui::{
    CursorIcon, IMEPurpose, Id, Pos2, Rect, Response, ScrollArea, Sense, Stroke, Ui, UiBuilder, Vec2, pos2,
    vec2,
};

use super::access;
use super::buffer::Buffer;
use super::caret::{Caret, word_at};
use super::document::{Document, Reveal};
use super::editor::{Editor, Options};
use super::gutter;
use super::input;
use super::paint::{Line, Metrics};
use super::wish::MclWish;
use crate::gui::theme::Palette;
use crate::gui::widgets::text_field;

/// Space left of the text.
const MARGIN: f32 = 6.0;

/// Draws the program in front and takes what is done to it.
pub fn view_ui(ui: &mut Ui, editor: &mut Editor, wishes: &mut Vec<MclWish>) {
    let options = editor.options;
    let wants_focus = std::mem::take(&mut editor.wants_focus);
    let document = editor.front_mut();
    let metrics = Metrics::of(ui, options.zoom_percent);
    let rect = ui.available_rect_before_wrap();
    ui.painter().rect_filled(rect, 0.0, Palette::of(ui).ground);
    let gutter = Rect { max: pos2(rect.left() + gutter::width(document, &metrics), rect.max.y), ..rect };
    let text = Rect { min: pos2(gutter.right(), rect.min.y), ..rect };
    let id = id_of(document);
    if wants_focus {
        ui.memory_mut(|memory| memory.request_focus(id));
    }
    if ui.memory(|memory| memory.has_focus(id)) {
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, input::FILTER));
        text_field::keep_space(ui, id);
        let page = (document.view.size.y / metrics.row) as usize;
        input::take(ui, id, document, page.saturating_sub(1).max(1));
    }
    text_ui(ui, text, id, document, &options, &metrics);
    gutter::gutter_ui(ui, gutter, document, &options, &metrics, wishes);
    ui.advance_cursor_after_rect(rect);
}

/// The widget that has the keyboard while a program is edited.
pub fn id_of(document: &Document) -> Id {
    Id::unique(("mcl text", document.id()))
}

fn text_ui(ui: &mut Ui, rect: Rect, id: Id, document: &mut Document, options: &Options, metrics: &Metrics) {
    let mut child = ui.new_child(UiBuilder::new().max_rect(rect));
    child.shrink_clip_rect(rect);
    let source = ScrollSource { drag: DragScroll::Never, ..ScrollSource::default() };
    let mut area = ScrollArea::both().id_salt(("mcl scroll", document.id())).auto_shrink(false);
    area = area.scroll_source(source);
    if let Some(offset) = reveal(ui, document, metrics) {
        area = area.scroll_offset(offset);
    }
    let shown = area.show_viewport(&mut child, |ui, viewport| {
        // The last line can be scrolled up to the middle.
        let rows = document.folds.rows(document.text.line_count()) as f32;
        let height = rows * metrics.row + viewport.height() / 2.0;
        let size = vec2(document.view.widest + 8.0 * metrics.cell, height).max(viewport.size());
        let (content, _) = ui.allocate_exact_size(size, Sense::hover());
        let visible = Rect::from_min_size(content.min + viewport.min.to_vec2(), viewport.size());
        let response = ui.interact(visible, id, Sense::click_and_drag() | Sense::focusable_noninteractive());
        let mut page = Page { document, options, metrics, origin: content.min + vec2(MARGIN, 0.0), visible };
        page.pointer(ui, &response);
        page.paint(ui, &response);
        let (rows, origin) = (page.rows(), page.origin);
        access::describe(ui, &response, page.document, metrics, rows, origin);
    });
    document.view.offset = shown.state.clamped_offset();
    document.view.size = shown.inner_rect.size();
}

/// How far to scroll so that the caret is in view, when it has to be.
fn reveal(ui: &Ui, document: &mut Document, metrics: &Metrics) -> Option<Vec2> {
    let way = std::mem::take(&mut document.view.reveal);
    let view = document.view;
    if way == Reveal::No || view.size.y <= 0.0 {
        return None;
    }
    let line = document.caret_line();
    let top = document.folds.row_of(line) as f32 * metrics.row;
    let start = document.text.line_start(line);
    let x = Line::of(ui, &document.text.line(line), metrics, false).x_of(document.caret.head - start);
    let room = metrics.row * 1.5;
    let (low, high) = (top + metrics.row + room - view.size.y, top - room);
    let nearest = view.offset.y.max(low).min(high.max(0.0)).max(0.0);
    let is_far = (nearest - view.offset.y).abs() > view.size.y / 3.0;
    let y = if way == Reveal::Middle && is_far { (top - view.size.y / 2.0).max(0.0) } else { nearest };
    let right = x + 4.0 * metrics.cell - view.size.x;
    let x = view.offset.x.max(right).min((x - 4.0 * metrics.cell).max(0.0)).max(0.0);
    document.view.widest = document.view.widest.max(x + view.size.x - 8.0 * metrics.cell);
    Some(vec2(x, y))
}

/// The lines in view and where they stand.
struct Page<'a> {
    document: &'a mut Document,
    options: &'a Options,
    metrics: &'a Metrics,
    /// Where the first line begins, in view or not.
    origin: Pos2,
    visible: Rect,
}

impl Page<'_> {
    /// The rows in view.
    fn rows(&self) -> std::ops::Range<usize> {
        let row = |y: f32| ((y - self.origin.y) / self.metrics.row).max(0.0) as usize;
        let count = self.document.folds.rows(self.document.text.line_count());
        row(self.visible.top()).min(count)..(row(self.visible.bottom()) + 1).min(count)
    }

    fn line(&self, ui: &Ui, line: usize) -> Line {
        Line::of(ui, &self.document.text.line(line), self.metrics, false)
    }

    /// The byte of the text nearest to a point.
    fn place_at(&self, ui: &Ui, at: Pos2) -> usize {
        let text = &self.document.text;
        let count = self.document.folds.rows(text.line_count());
        let row = ((at.y - self.origin.y) / self.metrics.row).max(0.0) as usize;
        let line = self.document.folds.line_at(row.min(count - 1));
        text.line_start(line) + self.line(ui, line).byte_at(at.x - self.origin.x)
    }

    fn pointer(&mut self, ui: &Ui, response: &Response) {
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Text);
        }
        let Some(at) = response.interact_pointer_pos() else { return };
        let (pressed, shift) = ui.input(|input| (input.pointer.primary_pressed(), input.modifiers.shift));
        let place = self.place_at(ui, at);
        let document = &mut *self.document;
        if pressed {
            response.request_focus();
            document.text.close_group();
            document.caret = document.caret.to(place, shift);
            document.composing = None;
        }
        if response.triple_clicked() {
            document.caret = line_around(&document.text, place);
        } else if response.double_clicked() {
            let word = word_at(&document.text, place);
            document.caret = Caret::selecting(word.start, word.end);
        } else if response.dragged_by(egui::PointerButton::Primary) && !pressed {
            document.caret = document.caret.to(place, true);
            document.view.reveal = Reveal::Nearest;
        }
    }

    fn paint(&mut self, ui: &Ui, response: &Response) {
        let palette = Palette::of(ui);
        let painter = ui.painter().with_clip_rect(self.visible.intersect(ui.clip_rect()));
        let caret = self.document.caret;
        let caret_line = self.document.caret_line();
        for row in self.rows() {
            let index = self.document.folds.line_at(row);
            let line = self.line(ui, index);
            let (start, end) = (self.document.text.line_start(index), self.document.text.line_end(index));
            let top = self.origin.y + row as f32 * self.metrics.row;
            let band = Rect::from_x_y_ranges(self.visible.x_range(), top..=top + self.metrics.row);
            if self.document.run.halted_at == Some(index) {
                painter.rect_filled(band, 0.0, palette.warning.gamma_multiply(0.25));
            } else if self.options.current_line && index == caret_line && caret.is_empty() {
                painter.rect_filled(band, 0.0, palette.panel);
            }
            let selected = caret.range();
            if !caret.is_empty() && selected.start <= end && selected.end > start {
                let from = line.x_of(selected.start.saturating_sub(start));
                let past = if selected.end > end { self.metrics.cell } else { 0.0 };
                let to = line.x_of(selected.end.min(end) - start) + past;
                let chosen = Rect::from_x_y_ranges(
                    self.origin.x + from..=self.origin.x + to,
                    top..=top + self.metrics.row,
                );
                painter.rect_filled(chosen, 0.0, palette.chosen);
            }
            let text_top = top + (self.metrics.row - line.galley.size().y) / 2.0;
            painter.galley(pos2(self.origin.x, text_top), line.galley.clone(), palette.text);
            self.document.view.widest = self.document.view.widest.max(line.width());
            if index == caret_line {
                self.caret_ui(ui, &painter, response, &line, top);
            }
        }
    }

    fn caret_ui(&self, ui: &Ui, painter: &egui::Painter, response: &Response, line: &Line, top: f32) {
        if !response.has_focus() {
            return;
        }
        let start = self.document.text.line_start(self.document.caret_line());
        let x = self.origin.x + line.x_of(self.document.caret.head - start);
        let stroke = Stroke::new(2.0, Palette::of(ui).accent);
        painter.vline(x, top..=top + self.metrics.row, stroke);
        let cursor_rect = Rect::from_min_size(pos2(x, top), vec2(1.0, self.metrics.row));
        if ui.memory(|memory| memory.owns_ime_events(response.id)) {
            ui.output_mut(|output| {
                output.ime = Some(egui::output::IMEOutput {
                    purpose: IMEPurpose::Normal,
                    rect: self.visible,
                    cursor_rect,
                    should_interrupt_composition: false,
                });
            });
        }
    }
}

/// A whole line with its end.
fn line_around(text: &Buffer, at: usize) -> Caret {
    let line = text.line_of(at);
    Caret::selecting(text.line_start(line), text.line_start(line + 1))
}
