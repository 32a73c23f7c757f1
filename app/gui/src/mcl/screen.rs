//! The MCL screen: toolbar, tabs, text with its gutter, the line below it, the panel, and the arm switch at the bottom.

use egui::{CentralPanel, Frame, Panel as Area, Ui};

use super::ask::ask_ui;
use super::findbar::findbar_ui;
use super::notices::notices_ui;
use super::runbar::{reasons_ui, runbar_ui};
use super::strip::strip_ui;
use super::tabs::tabs_ui;
use super::toolbar::toolbar_ui;
use super::view::view_ui;
use super::{MclAction, Tab, list};
use crate::command::{Command, Commands};
use crate::debugger;
use crate::model::Model;

/// Height of the panel at first, and what it can be dragged to.
const PANEL_HEIGHT: f32 = 118.0;
const DEBUGGER_HEIGHT: f32 = 280.0;
/// Of the arm switch.
const SWITCH_HEIGHT: f32 = 32.0;
/// A screen without room for more.
const LOW: f32 = 560.0;
/// One in which the debugger would leave the text no room.
const LOWEST: f32 = 500.0;
const PANEL_RANGE: std::ops::RangeInclusive<f32> = 80.0..=520.0;

/// Draws the screen.
pub fn screen_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let mut actions = Vec::new();
    let room = ui.available_rect_before_wrap();
    let bare = Frame::new();
    toolbar_ui(ui, model, commands);
    notices_ui(ui, &model.mcl, &mut actions);
    tabs_ui(ui, &model.mcl, &mut actions);
    findbar_ui(ui, &mut model.mcl, &mut actions);
    Area::bottom("mcl panel tabs").resizable(false).show_separator_line(false).frame(bare).show(ui, |ui| {
        panel_tabs_ui(ui, model, &mut actions, commands);
    });
    if model.mcl.panel.open {
        // The debugger has more to show, so it keeps a height of its own. In a low window the text keeps most of the room.
        let (id, height) = match model.mcl.panel.tab {
            // The line where the script stands has to stay in view.
            Tab::Debugger if room.height() < LOWEST => ("mcl debugger", DEBUGGER_HEIGHT * 0.65),
            Tab::Debugger => ("mcl debugger", DEBUGGER_HEIGHT),
            _ if room.height() < LOW => ("mcl panel", PANEL_HEIGHT * 0.7),
            Tab::Problems | Tab::Terminal => ("mcl panel", PANEL_HEIGHT),
        };
        let area = Area::bottom(id).resizable(true).default_size(height);
        area.size_range(PANEL_RANGE).frame(bare).show(ui, |ui| panel_ui(ui, model, &mut actions, commands));
    }
    CentralPanel::no_frame().show(ui, |ui| {
        Area::bottom("mcl strip").resizable(false).show_separator_line(false).frame(bare).show(ui, |ui| {
            strip_ui(ui, model.mcl.front(), &mut actions);
        });
        CentralPanel::no_frame().show(ui, |ui| {
            let debug = &model.front.debug;
            view_ui(ui, &mut model.mcl, &|name| debug.value_of(name), &mut actions);
        });
    });
    ask_ui(ui.ctx(), &mut model.mcl, room, &mut actions);
    commands.extend(actions.into_iter().map(Command::Mcl));
}

fn panel_tabs_ui(ui: &mut Ui, model: &mut Model, actions: &mut Vec<MclAction>, commands: &mut Commands) {
    ui.add_space(2.0);
    reasons_ui(ui, model, commands);
    ui.horizontal(|ui| {
        // As high as the switch, so that all stands on one line.
        ui.set_min_height(SWITCH_HEIGHT);
        ui.spacing_mut().item_spacing.x = 4.0;
        for tab in Tab::ALL {
            let shown = model.mcl.panel.open && model.mcl.panel.tab == tab;
            let count =
                if tab == Tab::Problems { list::count_text(model.mcl.front()) } else { String::new() };
            if ui.selectable_label(shown, format!("{}{count}", tab.title())).clicked() {
                actions.push(MclAction::ShowPanel(tab));
            }
        }
        ui.separator();
        runbar_ui(ui, model, commands);
    });
}

fn panel_ui(ui: &mut Ui, model: &mut Model, actions: &mut Vec<MclAction>, commands: &mut Commands) {
    ui.take_available_space();
    match model.mcl.panel.tab {
        Tab::Problems => list::list_ui(ui, model.mcl.front(), actions),
        Tab::Debugger => debugger::debug_ui(ui, model, commands),
        Tab::Terminal => debugger::terminal_ui(ui, model, commands),
    }
}
