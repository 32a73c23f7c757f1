//! The window of help: first steps, the references drawn from the tables, shortcuts, and what Brushwork is.

use egui::{Context, Frame, Margin, Rect, ScrollArea, Ui, Window, vec2};

use super::keys::escape_closes;
use super::model::Model;
use super::model::help::{Help, pages};
use super::model::help_page::HelpPage;
use super::screens::face;
use super::widgets::text_field::text_field_ui;

pub mod list;
pub mod mcl;
mod pages;
mod tuning;

/// Draws the window, if it is open, within `room`: it never covers what lies outside.
pub fn help_ui(ctx: &Context, model: &mut Model, room: Rect) {
    let Some(page) = model.help.page else { return };
    let mut open = true;
    let size = vec2(780.0, 520.0).min(room.size() - vec2(24.0, 60.0));
    let shown = Window::new("Brushwork help")
        .open(&mut open)
        .collapsible(false)
        .default_size(size)
        .default_pos(room.center() - size / 2.0 - vec2(0.0, 16.0))
        .min_size(vec2(420.0, 240.0))
        .constrain_to(room)
        .show(ctx, |ui| page_ui(ui, page, &mut model.help));
    if !open || escape_closes(ctx, shown.as_ref()) {
        model.help = Help::default();
    }
}

fn page_ui(ui: &mut Ui, page: HelpPage, help: &mut Help) {
    ui.horizontal_wrapped(|ui| {
        for each in pages() {
            if ui.selectable_label(each == page, each.title).clicked() {
                help.open(each);
            }
        }
    });
    if page.is_searched {
        let field = text_field_ui(ui, &mut help.search, "Search this page", "Search");
        if std::mem::take(&mut help.wants_focus) {
            field.request_focus();
        }
    }
    ui.separator();
    match page {
        HelpPage::FIRST_STEPS => scrolled_ui(ui, pages::first_steps_ui),
        HelpPage::TUNING => scrolled_ui(ui, tuning::tuning_ui),
        HelpPage::SHORTCUTS => scrolled_ui(ui, |ui| pages::shortcuts_ui(ui, &help.search)),
        HelpPage::ABOUT => scrolled_ui(ui, pages::about_ui),
        // One of a family's own.
        page => {
            face::all().any(|face| face.help_ui(ui, page, help));
        }
    }
}

pub(super) fn scrolled_ui(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        Frame::new().inner_margin(Margin::symmetric(8, 2)).show(ui, contents);
    });
}
