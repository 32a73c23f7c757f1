//! The left side: devices, screens, and Stop All at the bottom.

use egui::{Align, Button, Layout, Panel, RichText, Role, ScrollArea, Ui, WidgetInfo};

use super::devices::devices_ui;
use super::heading_ui;
use crate::gui::command::{Command, Commands};
use crate::gui::model::Model;
use crate::gui::model::screen::Screen;
use crate::gui::widgets::stop;

pub fn left_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    Panel::bottom("stop").resizable(false).show_separator_line(false).frame(egui::Frame::new()).show(
        ui,
        |ui| {
            ui.add_space(6.0);
            let response = stop::stop_ui(ui, model.is_connected());
            if stop::pressed(&response) {
                commands.push(Command::Stop);
            }
        },
    );
    egui::CentralPanel::no_frame().show(ui, |ui| {
        ScrollArea::vertical().show(ui, |ui| {
            devices_ui(ui, model, commands);
            ui.add_space(10.0);
            screens_ui(ui, model.screen, commands);
            if model.front.worlds.is_some() {
                ui.add_space(10.0);
                world_ui(ui, &mut model.front.world.open);
            }
        });
    });
}

/// Shows and hides the panel of the simulated controller's world.
fn world_ui(ui: &mut Ui, open: &mut bool) {
    heading_ui(ui, "Simulator");
    ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        let button = Button::selectable(*open, "Simulated world").right_text(RichText::new("Ctrl+B").small());
        let note = "Load, batteries, switches, inputs and faults of the simulated controller";
        let response = ui.add(button);
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, *open, "Simulated world"));
        if response.on_hover_text(note).clicked() {
            *open = !*open;
        }
    });
}

fn screens_ui(ui: &mut Ui, current: Screen, commands: &mut Commands) {
    heading_ui(ui, "Screens");
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        for (index, screen) in Screen::ALL.into_iter().enumerate() {
            let missing = screen.missing();
            let shortcut = RichText::new(format!("Ctrl+{}", index + 1)).small();
            let button = Button::selectable(current == screen, screen.title());
            let button = if missing.is_none() {
                button.right_text(shortcut)
            } else {
                button.right_text(RichText::new("later").small())
            };
            let response = ui.add_enabled(missing.is_none(), button);
            let enabled = missing.is_none();
            response.widget_info(|| {
                WidgetInfo::selected(Role::Button, enabled, current == screen, screen.title())
            });
            if let Some(why) = missing {
                response.on_disabled_hover_text(why);
            } else if response.clicked() {
                commands.push(Command::Show(screen));
            }
        }
    });
}
