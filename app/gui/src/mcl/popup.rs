//! Draws what floats over the text: words that could be typed, and what a word means.

use egui::{
    Align2, Area, Context, Frame, Id, Order, Pos2, Rect, RichText, Role, Sense, TextStyle, Ui, WidgetInfo,
    pos2, vec2,
};

use super::complete::{Completion, ROWS};
use super::language::Hover;
use crate::mcl::messages::PanelMessage;
use crate::theme::Palette;

const WIDTH: f32 = 380.0;
const ROW_HEIGHT: f32 = 20.0;

/// Draws the list below (or above) the word that is being typed; the row that was clicked.
pub fn completion_ui(ctx: &Context, list: &Completion, at: Rect) -> Option<usize> {
    let shown = list.entries.len().min(ROWS);
    let height = shown as f32 * ROW_HEIGHT + 12.0;
    let below = at.bottom() + height < ctx.content_rect().bottom();
    let place =
        if below { at.left_bottom() + vec2(0.0, 2.0) } else { pos2(at.left(), at.top() - height - 2.0) };
    let area = Area::new(Id::unique("mcl completion")).order(Order::Foreground).fixed_pos(place);
    let shown = area
        .constrain(true)
        .show(ctx, |ui| Frame::popup(ui.style()).inner_margin(4).show(ui, |ui| list_ui(ui, list)).inner);
    shown.inner
}

fn list_ui(ui: &mut Ui, list: &Completion) -> Option<usize> {
    ui.set_width(WIDTH);
    ui.spacing_mut().item_spacing.y = 0.0;
    let count = list.entries.len();
    let first = list.chosen.saturating_sub(ROWS / 2).min(count.saturating_sub(ROWS));
    let mut clicked = None;
    for (index, entry) in list.entries.iter().enumerate().skip(first).take(ROWS) {
        let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, ROW_HEIGHT), Sense::click());
        let chosen = index == list.chosen;
        let spoken = PanelMessage::Word { word: entry.word.to_string() }.to_string();
        response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, chosen, &spoken));
        let palette = Palette::of(ui);
        if chosen || response.hovered() {
            let fill = if chosen { palette.chosen } else { palette.raised };
            ui.painter().rect_filled(rect, 3.0, fill);
        }
        let painter = ui.painter().with_clip_rect(rect);
        let mono = TextStyle::Monospace.resolve(ui.style());
        let small = TextStyle::Small.resolve(ui.style());
        let left = rect.left_center() + vec2(4.0, 0.0);
        let word = painter.text(left, Align2::LEFT_CENTER, &entry.word, mono, palette.text);
        let kind = format!("{:?}", entry.kind).to_lowercase();
        let reported = if entry.detail.is_empty() { kind } else { format!("{}   {kind}", entry.detail) };
        let room = rect.with_min_x(word.right() + 12.0);
        let right = room.right_center() - vec2(4.0, 0.0);
        let painter = painter.with_clip_rect(room);
        painter.text(right, Align2::RIGHT_CENTER, reported, small, palette.weak_text);
        if response.clicked() {
            clicked = Some(index);
        }
    }
    clicked
}

/// What is shown where the pointer rests on the text.
pub fn hover_ui(ui: &mut Ui, hover: &Hover, value: Option<&str>) {
    ui.set_max_width(460.0);
    for problem in &hover.problems {
        ui.label(problem);
    }
    let Some(help) = &hover.help else { return };
    if !hover.problems.is_empty() {
        ui.separator();
    }
    ui.label(RichText::new(&help.title).strong().monospace());
    if !help.syntax.is_empty() {
        ui.monospace(&help.syntax);
    }
    ui.label(&help.text);
    if let Some(value) = value {
        ui.strong(PanelMessage::ValueNow { value: value.to_string() }.to_string());
    }
    for fact in &help.facts {
        ui.label(RichText::new(fact).weak().small());
    }
}

/// Where the list of words hangs: a rectangle around the place in the text.
pub fn anchor(at: Pos2, row: f32) -> Rect {
    Rect::from_min_size(at, vec2(1.0, row))
}
