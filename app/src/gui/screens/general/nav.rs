//! The parts of the settings at the left: the unit's own, then its pins (MCP manual 1.9.2).

use brushwork_link::settings::SettingsTable;
use egui::{Align, Button, Layout, RichText, Role, ScrollArea, Ui, WidgetInfo};

use crate::gui::model::general::{General, Section, UnitSettings, sections};
use crate::gui::shell::heading_ui;

/// Room that the scroll bar may take.
const BAR_WIDTH: f32 = 10.0;

pub fn nav_ui(ui: &mut Ui, general: &mut General) {
    let Some(unit) = general.unit() else { return };
    let current = (!general.is_filtered()).then_some(general.section);
    let mut wanted = None;
    ScrollArea::vertical().id_salt("sections").auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        ui.set_max_width(ui.available_width() - BAR_WIDTH);
        let sections = sections(unit.table());
        for (heading, pins) in [("Unit", false), ("Pin settings", true)] {
            if sections.iter().any(|(section, _)| section.is_pin() == pins) {
                heading_ui(ui, heading);
            }
            for (section, name) in sections.iter().filter(|(section, _)| section.is_pin() == pins) {
                if section_ui(ui, name, current == Some(*section), edits_in(unit, *section)) {
                    wanted = Some(*section);
                }
            }
            ui.add_space(6.0);
        }
    });
    if let Some(section) = wanted {
        general.section = section;
        general.search.clear();
        general.only_changed = false;
        general.explained = None;
    }
}

fn section_ui(ui: &mut Ui, name: &str, is_current: bool, edits: usize) -> bool {
    let response = ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        let button = Button::selectable(is_current, name).truncate();
        let mark = if edits == 0 { String::new() } else { format!("{edits} changed") };
        ui.add(button.right_text(RichText::new(mark).small()))
    });
    let response = response.inner;
    let spoken = format!("Section {name}");
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_current, &spoken));
    response.on_hover_text(name).clicked()
}

fn edits_in(unit: &UnitSettings, section: Section) -> usize {
    let table: &SettingsTable = unit.table();
    let keys = unit.edits().iter().filter_map(|(key, _)| table.row(key));
    keys.filter(|row| Section::of(row) == section).count()
}
