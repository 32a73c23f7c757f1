//! A window above the screen, as the assistants have it: it never covers what is always in view, and F6 finds it.

use egui::{Context, Label, Rect, RichText, ScrollArea, Ui, Vec2, Window, vec2};

use crate::focus::{Region, region_ui};
use crate::keys::escape_closes;
use crate::model::Gravity;
use crate::theme::Palette;

/// Room that is left beside a window that is as big as it may be.
const MARGIN: Vec2 = vec2(24.0, 60.0);
/// Less than this shows nothing of use.
const LEAST: Vec2 = vec2(420.0, 260.0);

/// Draws the window within `room`; whether it is still open. Esc closes it but for the time that its work goes on.
pub fn dialog_ui(
    ctx: &Context,
    (title, is_running): (&str, bool),
    (room, size): (Rect, Vec2),
    contents_ui: impl FnOnce(&mut Ui),
) -> bool {
    let mut open = true;
    let size = size.min(room.size() - MARGIN);
    let shown = Window::new(title)
        .open(&mut open)
        .collapsible(false)
        .default_size(size)
        .default_pos(room.center() - size / 2.0)
        .min_size(LEAST)
        .constrain_to(room)
        .show(ctx, |ui| {
            ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
                // What is drawn to be measured alone takes no keyboard.
                if !ui.is_sizing_pass() {
                    region_ui(ui, Region::Dialog);
                }
                contents_ui(ui);
            });
        });
    open && (is_running || !escape_closes(ctx, shown.as_ref()))
}

/// What the window is for.
pub fn weak_ui(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).weak()).wrap());
}

/// What came of the last step.
pub fn said_ui(ui: &mut Ui, said: Option<&(Gravity, brushwork_link::Message)>) {
    let Some((gravity, text)) = said else { return };
    let palette = Palette::of(ui);
    let text = RichText::new(text.to_string());
    ui.add_space(4.0);
    ui.add(
        Label::new(match gravity {
            Gravity::Note => text,
            Gravity::Warning => text.color(palette.warning),
            Gravity::Error => text.color(palette.error),
        })
        .wrap(),
    );
}
