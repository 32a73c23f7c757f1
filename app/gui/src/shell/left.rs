//! The left side: devices, screens, and Stop All at the bottom.

use egui::{Align, Button, Label, Layout, Panel, RichText, Role, ScrollArea, Ui, WidgetInfo};

use super::devices::devices_ui;
use crate::command::{Command, Commands};
use crate::focus::{Region, region_ui};
use crate::keys::as_written;
use crate::language::word;
use crate::model::{Connection, Model};
use crate::theme::Palette;
use crate::widgets::{heading_ui, stop};

pub fn left_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    Panel::bottom("stop").resizable(false).show_separator_line(false).frame(egui::Frame::new()).show(
        ui,
        |ui| {
            script_ui(ui, model);
            ui.add_space(6.0);
            let response = stop::stop_ui(ui, model.connections().any(Connection::is_connected));
            if stop::pressed(&response) {
                commands.push(Command::Stop);
            }
        },
    );
    egui::CentralPanel::no_frame().show(ui, |ui| {
        ScrollArea::vertical().show(ui, |ui| {
            region_ui(ui, Region::Devices);
            devices_ui(ui, model, commands);
            ui.add_space(10.0);
            screens_ui(ui, model, commands);
            if model.front.worlds.is_some() {
                ui.add_space(10.0);
                world_ui(ui, &mut model.front.world.open);
            }
        });
    });
}

/// A script that runs is told on every screen, above what ends it.
fn script_ui(ui: &mut Ui, model: &Model) {
    let Some(notice) = model.front.script_notice() else { return };
    ui.add_space(4.0);
    let color = Palette::of(ui).warning;
    let note = if model.front.script_is_paused() {
        word(
            "bar",
            "The debugger holds the script where it is. Its last motor commands stay in force: Stop All stops the motors and ends it.",
        )
    } else {
        word(
            "bar",
            "A script commands the motors by itself. Stop All ends it; so does leaving the MCL screen it was started from.",
        )
    };
    ui.add(Label::new(RichText::new(notice).strong().color(color)).truncate()).on_hover_text(note);
}

/// Shows and hides the panel of the simulated controller's world.
fn world_ui(ui: &mut Ui, open: &mut bool) {
    heading_ui(ui, &word("bar", "Simulator"));
    ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        let title = word("bar", "Simulated world");
        let button = Button::selectable(*open, &title)
            .right_text(RichText::new(as_written(ui.ctx(), "Ctrl+B")).small());
        let note = word("bar", "Load, batteries, switches, inputs and faults of the simulated controller");
        let response = ui.add(button);
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, *open, &title));
        if response.on_hover_text(note).clicked() {
            *open = !*open;
        }
    });
}

fn screens_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let (family, current) = (model.front.family(), model.screen);
    heading_ui(ui, &word("bar", "Screens"));
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        for screen in model.front.screens() {
            let (title, is_current) = (word("screen", family.title(screen)), current == screen);
            let keys = format!("Ctrl+{}", screen as usize + 1);
            let shortcut = RichText::new(as_written(ui.ctx(), &keys)).small();
            let response = ui.add(Button::selectable(is_current, &title).right_text(shortcut));
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_current, &title));
            if response.clicked() {
                commands.push(Command::Show(screen));
            }
        }
    });
}
