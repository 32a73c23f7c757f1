//! The MCL screen: toolbar, arm bar, tabs, text with its gutter, the line below it, and the panel at the bottom.

use egui::{CentralPanel, Frame, Panel as Area, Ui};

use super::panel::Tab;
use super::strip::strip_ui;
use super::tabs::tabs_ui;
use super::toolbar::toolbar_ui;
use super::view::view_ui;
use super::wish::MclWish;
use crate::gui::command::{Command, Commands};
use crate::gui::debugger;
use crate::gui::model::Model;

/// Height of the panel at first, and what it can be dragged to.
const PANEL_HEIGHT: f32 = 150.0;
const DEBUGGER_HEIGHT: f32 = 280.0;
const PANEL_RANGE: std::ops::RangeInclusive<f32> = 90.0..=520.0;

/// Draws the screen.
pub fn screen_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let mut wishes = Vec::new();
    let bare = Frame::new();
    toolbar_ui(ui, model, commands);
    ui.add_space(2.0);
    tabs_ui(ui, &model.mcl, &mut wishes);
    ui.add_space(2.0);
    Area::bottom("mcl panel tabs").resizable(false).show_separator_line(false).frame(bare).show(ui, |ui| {
        panel_tabs_ui(ui, model, &mut wishes);
    });
    if model.mcl.panel.open {
        // The debugger has more to show, so it keeps a height of its own.
        let (id, height) = match model.mcl.panel.tab {
            Tab::Debugger => ("mcl debugger", DEBUGGER_HEIGHT),
            _ => ("mcl panel", PANEL_HEIGHT),
        };
        let area = Area::bottom(id).resizable(true).default_size(height);
        area.size_range(PANEL_RANGE).frame(bare).show(ui, |ui| panel_ui(ui, model, commands));
    }
    CentralPanel::no_frame().show(ui, |ui| {
        Area::bottom("mcl strip").resizable(false).show_separator_line(false).frame(bare).show(ui, |ui| {
            strip_ui(ui, model.mcl.front());
        });
        CentralPanel::no_frame().show(ui, |ui| view_ui(ui, &mut model.mcl, &mut wishes));
    });
    commands.extend(wishes.into_iter().map(Command::Mcl));
}

fn panel_tabs_ui(ui: &mut Ui, model: &Model, wishes: &mut Vec<MclWish>) {
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for tab in Tab::ALL {
            let shown = model.mcl.panel.open && model.mcl.panel.tab == tab;
            if ui.selectable_label(shown, tab.title()).clicked() {
                wishes.push(MclWish::ShowPanel(tab));
            }
        }
    });
}

fn panel_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    ui.take_available_space();
    match model.mcl.panel.tab {
        Tab::Problems => {
            ui.label("No problems.");
        }
        Tab::Debugger => debugger::debug_ui(ui, model, commands),
        Tab::Terminal => debugger::terminal_ui(ui, model, commands),
    }
}
