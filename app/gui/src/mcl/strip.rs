//! The line below the text: the syntax of the command that is being typed (MCP manual 3.4.1), where the caret is, and how the file is
//! written. It is always as high, so that nothing jumps.

use brushwork_script::mcl::index::SyntaxHint;
use egui::text::{LayoutJob, TextFormat};
use egui::{Align, ComboBox, FontId, Layout, Role, Sense, Ui, WidgetInfo, vec2};

use super::disk::{Encoding, LineEnds};
use super::{Document, MclAction};
use crate::mcl::messages::PanelMessage;
use crate::theme::Palette;
use crate::widgets::choice_ui;

const HEIGHT: f32 = 26.0;
/// Room for the place of the caret.
const PLACE_WIDTH: f32 = 190.0;

pub fn strip_ui(ui: &mut Ui, document: &Document, actions: &mut Vec<MclAction>) {
    let palette = Palette::of(ui);
    let size = vec2(ui.available_width(), HEIGHT);
    ui.painter().rect_filled(egui::Rect::from_min_size(ui.cursor().min, size), 0.0, palette.raised);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.set_min_height(HEIGHT);
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.spacing_mut().interact_size.y = 20.0;
        ends_ui(ui, document, actions);
        encoding_ui(ui, document, actions);
        place_ui(ui, document);
        syntax_ui(ui, document);
    });
}

fn encoding_ui(ui: &mut Ui, document: &Document, actions: &mut Vec<MclAction>) {
    let now = document.format.encoding;
    let (list, mut chosen) = (ComboBox::from_id_salt("mcl encoding").width(64.0), now);
    let shown = choice_ui(ui, list, "Encoding", &mut chosen, Encoding::ALL, Encoding::title);
    if chosen != now {
        actions.push(MclAction::SetEncoding(chosen));
    }
    shown.on_hover_text("How the file's letters are written");
}

fn ends_ui(ui: &mut Ui, document: &Document, actions: &mut Vec<MclAction>) {
    let now = document.format.ends;
    let (list, mut chosen) = (ComboBox::from_id_salt("mcl line ends").width(44.0), now);
    let shown = choice_ui(ui, list, "Line ends", &mut chosen, LineEnds::ALL, LineEnds::title);
    if chosen != now {
        actions.push(MclAction::SetLineEnds(chosen));
    }
    shown.on_hover_text("How the file's lines end");
}

fn place_ui(ui: &mut Ui, document: &Document) {
    let (rect, response) = ui.allocate_exact_size(vec2(PLACE_WIDTH, HEIGHT), Sense::hover());
    let place = place_text(document);
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &place));
    let at = rect.right_center() - vec2(4.0, 0.0);
    let color = Palette::of(ui).weak_text;
    ui.painter().text(at, egui::Align2::RIGHT_CENTER, place, FontId::monospace(11.5), color);
}

/// "Line 3, column 5"; how much is selected.
fn place_text(document: &Document) -> String {
    let (line, column) = (document.caret_line() + 1, document.text.column(document.caret.head) + 1);
    match document.text.slice(document.caret.range()).chars().count() {
        0 => PanelMessage::Caret { line, column }.to_string(),
        count => PanelMessage::Selected { count, line }.to_string(),
    }
}

/// The syntax line, with the argument that is being typed in the colour of the text.
fn syntax_ui(ui: &mut Ui, document: &Document) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let Some(hint) = document.syntax() else { return };
    let palette = Palette::of(ui);
    let spoken = PanelMessage::Syntax { syntax: hint.word.syntax.to_string() }.to_string();
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let mut job = LayoutJob::default();
    for (text, here) in parts(&hint) {
        let color = if here { palette.text } else { palette.weak_text };
        let mut format = TextFormat::simple(FontId::monospace(12.0), color);
        if here {
            format.underline = egui::Stroke::new(1.5, palette.accent);
        }
        job.append(text, 0.0, format);
    }
    let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
    let painter = ui.painter().with_clip_rect(rect);
    let top = rect.center().y - galley.size().y / 2.0;
    painter.galley(egui::pos2(rect.left() + 8.0, top), galley, palette.text);
    response.on_hover_text(format!("{}\n{}", hint.word.syntax, hint.word.help));
}

/// The syntax line in pieces: the command word, its arguments and what stands between them; true for what is being typed.
fn parts(hint: &SyntaxHint) -> Vec<(&'static str, bool)> {
    let syntax = hint.word.syntax;
    let begin = syntax.find(' ').map_or(syntax.len(), |space| space + 1);
    let mut parts = vec![(&syntax[..begin], false)];
    let (mut depth, mut argument, mut from) = (0i32, 0, begin);
    for (at, letter) in syntax.char_indices().skip_while(|(at, _)| *at < begin) {
        match letter {
            '[' | '(' | '{' => depth += 1,
            ']' | ')' | '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push((&syntax[from..at], argument == hint.argument));
                parts.push((&syntax[at..=at], false));
                argument += 1;
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push((&syntax[from..], argument == hint.argument));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_script::mcl::index::syntax_at;

    #[test]
    fn the_argument_that_is_typed_is_set_off() {
        let line = "move 0, 1000, ";
        let hint = syntax_at(line, line.len()).unwrap();
        let parts = parts(&hint);
        let whole: String = parts.iter().map(|(text, _)| *text).collect();
        assert_eq!(whole, hint.word.syntax);
        let here: Vec<&str> = parts.iter().filter(|(_, here)| *here).map(|(text, _)| text.trim()).collect();
        assert_eq!(here, ["accel"]);
    }
}
