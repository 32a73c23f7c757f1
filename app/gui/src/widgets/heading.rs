//! The heading of a group.

use egui::{RichText, Ui};

use crate::theme::Palette;

/// The heading of a group.
pub fn heading_ui(ui: &mut Ui, text: &str) {
    let color = Palette::of(ui).weak_text;
    ui.label(RichText::new(text.to_uppercase()).small().color(color));
}
