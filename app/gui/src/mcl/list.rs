//! The list of errors and warnings: a row leads to its place.

use egui::{Align2, FontId, Role, ScrollArea, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2};

use brushwork_script::diagnostic::Severity;

use super::problems::Problem;
use super::{Document, MclAction};
use crate::mcl::messages::PanelMessage;
use crate::model::indicator::IndicatorState;
use crate::theme::Palette;

const ROW: f32 = 22.0;

pub fn list_ui(ui: &mut Ui, document: &Document, actions: &mut Vec<MclAction>) {
    let problems = &document.findings.problems;
    if problems.is_empty() {
        let text = match (document.findings.checked.is_some(), document.text.is_empty()) {
            (_, true) => {
                "Type a program, or open one of the examples in the File menu. It is checked while you type."
            }
            (true, _) => "No problems.",
            (false, _) => "Not checked yet.",
        };
        ui.add_space(4.0);
        ui.weak(text);
        return;
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, problems.len(), |ui, rows| {
        for problem in &problems[rows] {
            row_ui(ui, document, problem, actions);
        }
    });
}

fn row_ui(ui: &mut Ui, document: &Document, problem: &Problem, actions: &mut Vec<MclAction>) {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    let line = document.text.line_of(problem.range.start) + 1;
    let spoken = PanelMessage::Problem {
        word: problem.word(),
        code: problem.code.to_string(),
        line,
        message: problem.message.to_string(),
    }
    .to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &spoken));
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 2.0, palette.raised);
    }
    if response.has_focus() {
        let ring = Stroke::new(1.5, palette.accent);
        ui.painter().rect_stroke(rect, 2.0, ring, egui::StrokeKind::Inside);
    }
    let indicator = match problem.severity {
        Severity::Error => IndicatorState::Error,
        Severity::Warning => IndicatorState::Warning,
    };
    indicator.paint(ui, pos2(rect.left() + 12.0, rect.center().y), 4.5);
    let painter = ui.painter().with_clip_rect(rect);
    let figures = FontId::monospace(11.5);
    let place = format!("{line:>5}  {}", problem.code);
    let at = pos2(rect.left() + 24.0, rect.center().y);
    let place = painter.text(at, Align2::LEFT_CENTER, place, figures, palette.weak_text);
    let body = TextStyle::Body.resolve(ui.style());
    let at = pos2(place.right() + 12.0, rect.center().y);
    let message = painter.text(at, Align2::LEFT_CENTER, &problem.message, body.clone(), palette.text);
    if let Some(hint) = &problem.hint {
        let at = pos2(message.right() + 12.0, rect.center().y);
        painter.text(at, Align2::LEFT_CENTER, hint, body, palette.weak_text);
    }
    if response.on_hover_text(problem.in_full()).clicked() {
        actions.push(MclAction::Select(problem.range.start, problem.range.end));
    }
}

/// "2 errors, 1 warning"; nothing when there are none.
pub fn count_text(document: &Document) -> String {
    match document.findings.counts() {
        (0, 0) => String::new(),
        (errors, 0) => format!(" ({errors})"),
        (errors, warnings) => format!(" ({errors} + {warnings})"),
    }
}
