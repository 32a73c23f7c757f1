//! The heading of a group.

use egui::{RichText, Ui};

/// The heading of a group.
pub fn heading_ui(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text.to_uppercase()).small().weak());
}
