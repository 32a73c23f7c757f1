//! The text as a screen reader has it: a field of several lines, the lines in view as runs of text, and the selection in them.

use crate::mcl::messages::PanelMessage;
use std::ops::Range;

use egui::emath::TSTransform;
use egui::text::{CCursor, CCursorRange, LayoutJob, TextFormat};
use egui::text_selection::accesskit_text::update_accesskit_for_text_widget;
use egui::{Color32, Pos2, Response, Role, Ui, WidgetInfo};

use super::{Document, Metrics};

/// Tells what the field is, what its caret stands in, and what of it is in view. `origin` is where row 0 begins.
pub fn describe(
    ui: &Ui,
    response: &Response,
    document: &Document,
    metrics: &Metrics,
    rows: Range<usize>,
    origin: Pos2,
) {
    let label = PanelMessage::Program { title: document.title().to_string() }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::MultilineTextInput, true, &label));
    let line = document.caret_line();
    let reported = ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_label(label.as_str());
        node.set_value(document.text.line(line).into_owned());
        node.set_description(
            PanelMessage::LineOf { line: line + 1, lines: document.text.line_count() }.to_string(),
        );
    });
    // Nobody listens: the lines need not be laid out once more.
    if reported.is_none() {
        return;
    }
    let lines: Vec<usize> = rows.clone().map(|row| document.folds.line_at(row)).collect();
    let text: Vec<String> = lines.iter().map(|line| document.text.line(*line).replace('\t', " ")).collect();
    let mut format = TextFormat::simple(metrics.font.clone(), Color32::WHITE);
    format.line_height = Some(metrics.row);
    let mut job = LayoutJob::single_section(text.join("\n"), format);
    job.wrap.max_width = f32::INFINITY;
    let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
    let top = origin.to_vec2() + egui::vec2(0.0, rows.start as f32 * metrics.row);
    let selection = selection(document, &lines, &text);
    update_accesskit_for_text_widget(
        ui.ctx(),
        response.id,
        selection,
        TSTransform::from_translation(top),
        &galley,
    );
}

/// The selection within the lines in view, if both its ends are there.
fn selection(document: &Document, lines: &[usize], text: &[String]) -> Option<CCursorRange> {
    let place = |at: usize| {
        let index = lines.iter().position(|line| *line == document.text.line_of(at))?;
        let before: usize = text[..index].iter().map(|line| line.chars().count() + 1).sum();
        Some(CCursor::new(before + document.text.column(at)))
    };
    Some(CCursorRange::two(place(document.caret.anchor)?, place(document.caret.head)?))
}
