//! What contradicts itself in the settings as they are wanted, each with the way to its row.

use brushwork_link::settings::Row;
use egui::{Button, Label, Layout, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};

use crate::messages::ButtonMessage;
use crate::model::{GeneralView, IndicatorState};
use crate::screens::general::sheet_parts::text_ui;

pub fn conflicts_ui(ui: &mut Ui, general: &mut GeneralView<'_>, height: f32) {
    let Some(unit) = general.unit() else { return };
    let conflicts = unit.conflicts();
    let mut wanted = None;
    // Beside the panel of the simulated world less is in view than there is room for rows.
    let in_view = ui.clip_rect().right() - ui.cursor().left();
    let size = vec2(ui.available_width().min(in_view), height);
    ui.allocate_ui_with_layout(size, Layout::top_down(egui::Align::Min), |ui| {
        ui.set_min_height(height);
        ui.label(RichText::new("Conflicts").size(16.0).strong());
        if conflicts.is_empty() {
            text_ui(
                ui,
                "Nothing contradicts itself: each pin has one function, and each action can be triggered.",
            );
            return;
        }
        text_ui(ui, "Each of these settings is allowed alone; together they do not do what they look like.");
        ScrollArea::vertical().id_salt("conflicts").auto_shrink(false).show(ui, |ui| {
            for conflict in &conflicts {
                let title = conflict.keys.first().and_then(|key| unit.table().row(key)).map(Row::title);
                ui.horizontal_top(|ui| {
                    IndicatorState::Warning.ui(ui, vec2(18.0, 18.0), 6.0);
                    let text_width = (ui.available_width() - 90.0).max(120.0);
                    ui.allocate_ui(vec2(text_width, 0.0), |ui| {
                        ui.set_width(text_width);
                        ui.add(Label::new(conflict.sentence.to_string()).wrap());
                    });
                    let response = ui.add(Button::new("Go to"));
                    let spoken = ButtonMessage::GoTo { place: title.unwrap_or_default() }.to_string();
                    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &spoken));
                    if response.clicked() {
                        wanted = conflict.keys.first().cloned();
                    }
                });
                ui.add_space(4.0);
            }
        });
    });
    if let Some(key) = wanted {
        general.go_to(&key);
    }
}
