//! The text of a program on the screen: only the lines in view are laid out.

use std::ops::Range;

use brushwork_script::diagnostic::Severity;
use egui::containers::scroll_area::{DragScroll, ScrollSource};
use egui::output::IMEOutput;
use egui::{
    Align2, Color32, CursorIcon, IMEPurpose, Id, Painter, Pos2, Rect, Response, ScrollArea, Sense, Stroke,
    Ui, UiBuilder, Vec2, pos2, vec2,
};

use super::document::Reveal;
use super::editor::Options;
use super::moves::word_at;
use super::paint::Line;
use super::{Buffer, Caret, Document, Editor, MclAction, Metrics, access, gutter, input, popup, squiggle};
use crate::theme::Palette;
use crate::widgets::text_field;

/// Space left of the text.
const MARGIN: f32 = 6.0;

/// Draws the program in front and takes what is done to it. `value_of` tells what a name holds in a running script.
pub fn view_ui(
    ui: &mut Ui,
    editor: &mut Editor,
    value_of: &dyn Fn(&str) -> Option<String>,
    actions: &mut Vec<MclAction>,
) {
    let options = editor.options;
    let wants_focus = std::mem::take(&mut editor.wants_focus);
    let mut list = editor.completion.take();
    let document = &mut editor.documents[editor.front];
    let metrics = Metrics::of(ui, options.zoom_percent);
    let rect = ui.available_rect_before_wrap();
    ui.painter().rect_filled(rect, 0.0, Palette::of(ui).ground);
    let gutter = Rect { max: pos2(rect.left() + gutter::width(document, &metrics), rect.max.y), ..rect };
    let text = Rect { min: pos2(gutter.right(), rect.min.y), ..rect };
    let id = id_of(document);
    if wants_focus && editor.sheet.is_none() {
        ui.memory_mut(|memory| memory.request_focus(id));
    }
    if ui.memory(|memory| memory.has_focus(id)) {
        text_field::keep_space(ui, id);
        text_field::take_many_lines(ui, id);
        let page = (document.view.size.y / metrics.row) as usize;
        input::take(ui, id, document, &mut list, page.saturating_sub(1).max(1));
        let filter = input::filter(list.is_some());
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
    } else {
        list = None;
    }
    editor.find.look(document);
    let looks = Looks { options, matches: editor.find.matches(), value_of };
    let anchor = text_ui(ui, text, id, document, &looks, &metrics, actions);
    gutter::gutter_ui(ui, gutter, document, &options, &metrics, actions);
    if let (Some(open), Some(at)) = (&list, anchor)
        && let Some(index) = popup::completion_ui(ui.ctx(), open, at)
        && let Some(open) = list.take()
    {
        open.accept(document, index);
        editor.wants_focus = true;
    }
    editor.completion = list;
    ui.advance_cursor_after_rect(rect);
}

/// What the text is drawn with besides its letters.
struct Looks<'a> {
    options: Options,
    matches: &'a [Range<usize>],
    value_of: &'a dyn Fn(&str) -> Option<String>,
}

/// Whether what is typed goes into the program in front.
pub fn has_keyboard(ctx: &egui::Context, editor: &Editor) -> bool {
    ctx.memory(|memory| memory.has_focus(id_of(editor.front())))
}

/// The widget that has the keyboard while a program is edited.
pub fn id_of(document: &Document) -> Id {
    Id::unique(("mcl text", document.id()))
}

/// Draws the text; where the caret is on the screen, if it is in view.
fn text_ui(
    ui: &mut Ui,
    rect: Rect,
    id: Id,
    document: &mut Document,
    looks: &Looks<'_>,
    metrics: &Metrics,
    actions: &mut Vec<MclAction>,
) -> Option<Rect> {
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
        let mut page = Page { document, looks, metrics, origin: content.min + vec2(MARGIN, 0.0), visible };
        page.pointer(ui, &response, actions);
        let anchor = page.paint(ui, &response);
        page.hover(ui, &response);
        let (rows, origin) = (page.rows(), page.origin);
        access::describe(ui, &response, page.document, metrics, rows, origin);
        anchor
    });
    document.view.offset = shown.state.clamped_offset();
    document.view.size = shown.inner_rect.size();
    shown.inner
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
    let x = Line::of(ui, &document.text.line(line), metrics, false, document.language())
        .x_of(document.caret.head - start);
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
    looks: &'a Looks<'a>,
    metrics: &'a Metrics,
    /// Where the first line begins, in view or not.
    origin: Pos2,
    visible: Rect,
}

impl Page<'_> {
    /// The rows in view.
    fn rows(&self) -> Range<usize> {
        let row = |y: f32| ((y - self.origin.y) / self.metrics.row).max(0.0) as usize;
        let count = self.document.folds.rows(self.document.text.line_count());
        row(self.visible.top()).min(count)..(row(self.visible.bottom()) + 1).min(count)
    }

    fn line(&self, ui: &Ui, line: usize) -> Line {
        let text = &self.document.text;
        let start = text.line_start(line);
        let is_left_out = self.document.findings.left_out.iter().any(|range| range.contains(&start));
        Line::of(ui, &text.line(line), self.metrics, is_left_out, self.document.language())
    }

    /// The byte of the text nearest to a point.
    fn place_at(&self, ui: &Ui, at: Pos2) -> usize {
        let text = &self.document.text;
        let count = self.document.folds.rows(text.line_count());
        let row = ((at.y - self.origin.y) / self.metrics.row).max(0.0) as usize;
        let line = self.document.folds.line_at(row.min(count - 1));
        text.line_start(line) + self.line(ui, line).byte_at(at.x - self.origin.x)
    }

    fn pointer(&mut self, ui: &Ui, response: &Response, actions: &mut Vec<MclAction>) {
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Text);
            let zoom = ui.input(egui::InputState::zoom_delta);
            if zoom != 1.0 {
                let step = if zoom > 1.0 { 10 } else { -10 };
                actions.push(MclAction::Zoom(self.looks.options.zoom_percent.saturating_add_signed(step)));
            }
        }
        let Some(at) = response.interact_pointer_pos() else { return };
        let (pressed, modifiers) = ui.input(|input| (input.pointer.primary_pressed(), input.modifiers));
        let place = self.place_at(ui, at);
        let document = &mut *self.document;
        if pressed {
            response.request_focus();
            document.text.close_group();
            document.caret = document.caret.to(place, modifiers.shift);
            document.composing = None;
            if modifiers.command {
                actions.push(MclAction::Definition);
            }
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

    /// What the word under a resting pointer means.
    fn hover(&self, ui: &Ui, response: &Response) {
        let Some(at) = response.hover_pos().filter(|_| !response.is_pointer_button_down_on()) else { return };
        let text = &self.document.text;
        let row = ((at.y - self.origin.y) / self.metrics.row).max(0.0) as usize;
        if row >= self.document.folds.rows(text.line_count()) {
            return;
        }
        let line = self.document.folds.line_at(row);
        let shown = self.line(ui, line);
        if at.x > self.origin.x + shown.width() + self.metrics.cell {
            return;
        }
        let place = text.line_start(line) + shown.byte_at(at.x - self.origin.x);
        let Some(hover) = self.document.hover(place) else { return };
        let value = (self.looks.value_of)(&text.slice(self.document.word(place)));
        response.clone().on_hover_ui_at_pointer(|ui| popup::hover_ui(ui, &hover, value.as_deref()));
    }

    /// Draws the lines in view; where the caret is, if it is among them.
    fn paint(&mut self, ui: &Ui, response: &Response) -> Option<Rect> {
        let painter = ui.painter().with_clip_rect(self.visible.intersect(ui.clip_rect()));
        let caret_line = self.document.caret_line();
        let matching = self.document.matching();
        let mut anchor = None;
        for row in self.rows() {
            let index = self.document.folds.line_at(row);
            let line = self.line(ui, index);
            let top = self.origin.y + row as f32 * self.metrics.row;
            self.behind(ui, &painter, &line, index, top, &matching);
            let palette = Palette::of(ui);
            let text_top = top + (self.metrics.row - line.galley.size().y) / 2.0;
            painter.galley(pos2(self.origin.x, text_top), line.galley.clone(), palette.text);
            if self.looks.options.hidden {
                let text = self.document.text.line(index);
                squiggle::hidden(&painter, &line, &text, pos2(self.origin.x, top), self.metrics, palette);
            }
            if self.document.folds.is_closed(index) {
                let at = pos2(self.origin.x + line.width() + 8.0, top + self.metrics.row / 2.0);
                painter.text(at, Align2::LEFT_CENTER, "…", self.metrics.font.clone(), palette.accent);
            }
            self.problems(ui, &painter, &line, index, top);
            self.document.view.widest = self.document.view.widest.max(line.width());
            if index == caret_line {
                anchor = Some(self.caret_ui(ui, &painter, response, &line, top));
            }
        }
        anchor
    }

    /// Bands and boxes behind a line's letters.
    fn behind(
        &self,
        ui: &Ui,
        painter: &Painter,
        line: &Line,
        index: usize,
        top: f32,
        matching: &[Range<usize>],
    ) {
        let palette = Palette::of(ui);
        let document = &*self.document;
        let (start, end) = (document.text.line_start(index), document.text.line_end(index));
        let band = Rect::from_x_y_ranges(self.visible.x_range(), top..=top + self.metrics.row);
        if document.run.halted_at == Some(index) {
            painter.rect_filled(band, 0.0, palette.warning.gamma_multiply(0.25));
        } else if self.looks.options.current_line
            && index == document.caret_line()
            && document.caret.is_empty()
        {
            painter.rect_filled(band, 0.0, palette.panel);
        }
        let place = |from: f32, to: f32| {
            Rect::from_x_y_ranges(self.origin.x + from..=self.origin.x + to, top..=top + self.metrics.row)
        };
        let first = self.looks.matches.partition_point(|range| range.end < start);
        for range in self.looks.matches[first..].iter().take_while(|range| range.start <= end) {
            if let Some((from, to)) = squiggle::stretch(line, range, start, end) {
                let fill = palette.warning.gamma_multiply(0.22);
                squiggle::boxed(painter, place(from, to), fill, Stroke::new(1.0, palette.warning));
            }
        }
        let selected = document.caret.range();
        if !document.caret.is_empty() && selected.start <= end && selected.end > start {
            let from = line.x_of(selected.start.saturating_sub(start));
            let past = if selected.end > end { self.metrics.cell } else { 0.0 };
            let to = line.x_of(selected.end.min(end) - start) + past;
            painter.rect_filled(place(from, to), 0.0, palette.chosen);
        }
        for range in matching.iter().filter(|range| range.start >= start && range.end <= end) {
            if let Some((from, to)) = squiggle::stretch(line, range, start, end) {
                squiggle::boxed(
                    painter,
                    place(from, to),
                    Color32::TRANSPARENT,
                    Stroke::new(1.0, palette.accent),
                );
            }
        }
    }

    /// Waves under what is wrong in a line.
    fn problems(&self, ui: &Ui, painter: &Painter, line: &Line, index: usize, top: f32) {
        let palette = Palette::of(ui);
        let text = &self.document.text;
        let (start, end) = (text.line_start(index), text.line_end(index));
        let problems = &self.document.findings.problems;
        let first = problems.partition_point(|problem| problem.range.start < start);
        // A problem of several lines is marked where it begins.
        for problem in problems[first..].iter().take_while(|problem| problem.range.start <= end) {
            let Some((from, to)) = squiggle::stretch(line, &problem.range, start, end) else { continue };
            let color = match problem.severity {
                Severity::Error => palette.error,
                Severity::Warning => palette.warning,
            };
            let x = self.origin.x;
            squiggle::wave(painter, x + from, x + to, top + self.metrics.row - 0.5, color);
        }
    }

    fn caret_ui(&self, ui: &Ui, painter: &Painter, response: &Response, line: &Line, top: f32) -> Rect {
        let start = self.document.text.line_start(self.document.caret_line());
        let x = self.origin.x + line.x_of(self.document.caret.head - start);
        let at = popup::anchor(pos2(x, top), self.metrics.row);
        if !response.has_focus() {
            return at;
        }
        painter.vline(x, at.y_range(), Stroke::new(2.0, Palette::of(ui).accent));
        if ui.memory(|memory| memory.owns_ime_events(response.id)) {
            ui.output_mut(|output| {
                output.ime = Some(IMEOutput {
                    purpose: IMEPurpose::Normal,
                    rect: self.visible,
                    cursor_rect: at,
                    should_interrupt_composition: false,
                });
            });
        }
        at
    }
}

/// A whole line with its end.
fn line_around(text: &Buffer, at: usize) -> Caret {
    let line = text.line_of(at);
    Caret::selecting(text.line_start(line), text.line_start(line + 1))
}
