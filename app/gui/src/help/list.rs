//! A reference of help as a list that can be searched, where a click chooses the entry that is shown.

use egui::{Atom, Button, Panel, Role, ScrollArea, Ui, WidgetInfo};

use crate::messages::NameMessage;
use crate::model::help::Help;

const LIST_WIDTH: f32 = 262.0;

/// One entry of a list.
pub struct Entry {
    pub key: String,
    pub title: String,
    /// What a search looks through, in small letters.
    pub words: String,
}

/// The list at the left; a click chooses an entry.
pub fn list_ui(ui: &mut Ui, entries: &[Entry], help: &mut Help) {
    let wanted: Vec<String> = help.search.to_lowercase().split_whitespace().map(str::to_owned).collect();
    let fits = |entry: &&Entry| wanted.iter().all(|word| entry.words.contains(word));
    let found: Vec<&Entry> = entries.iter().filter(fits).collect();
    let frame = egui::Frame::new().inner_margin(egui::Margin { right: 8, ..Default::default() });
    Panel::left("entries").resizable(false).exact_size(LIST_WIDTH).frame(frame).show(ui, |ui| {
        ui.weak(NameMessage::Of { number: found.len(), all: entries.len() }.to_string());
        let height = ui.spacing().interact_size.y;
        ScrollArea::vertical().auto_shrink([false; 2]).show_rows(ui, height, found.len(), |ui, shown| {
            for entry in &found[shown] {
                let chosen = help.entry.as_deref() == Some(entry.key.as_str());
                let size = egui::vec2(ui.available_width(), height);
                let button = Button::selectable(chosen, (&entry.title, Atom::grow())).truncate();
                let response = ui.add(button.min_size(size));
                response
                    .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, chosen, &entry.title));
                if response.on_hover_text(&entry.title).clicked() {
                    help.entry = Some(entry.key.clone());
                }
            }
        });
    });
}
