//! The menu bar, drawn from the table of actions.

use egui::{Button, MenuBar, Response, Role, ScrollArea, Ui, WidgetInfo};

use crate::actions::{self, Action, Menu};
use crate::command::Commands;
use crate::keys::as_written;
use crate::language::word;
use crate::model::Model;

/// So that titles and keys stand clear of each other.
const MENU_WIDTH: f32 = 300.0;
/// The menu bar, the Stop button and the space around them.
const BELOW: f32 = 136.0;

pub fn menu_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    MenuBar::new().ui(ui, |ui| {
        for menu in Menu::ALL {
            ui.menu_button(word("menu", menu.title()), |ui| {
                // A long menu scrolls: it never hangs over the Stop button.
                let room = ui.ctx().content_rect().height() - BELOW;
                let scroll = ScrollArea::vertical().max_height(room).min_scrolled_height(room);
                scroll.show(ui, |ui| items_ui(ui, menu, model, commands));
            });
        }
    });
}

fn items_ui(ui: &mut Ui, menu: Menu, model: &Model, commands: &mut Commands) {
    ui.set_min_width(MENU_WIDTH);
    ui.spacing_mut().item_spacing.y = 1.0;
    let mut group = None;
    for action in actions::of_menu(menu) {
        if group.replace(action.place.group).is_some_and(|before| before != action.place.group) {
            ui.separator();
        }
        if item_ui(ui, action, model).clicked() {
            commands.push((action.command)(model));
            ui.close();
        }
    }
}

fn item_ui(ui: &mut Ui, action: &Action, model: &Model) -> Response {
    let ready = (action.ready)(model);
    let is_on = action.is_on.is_some_and(|is_on| is_on(model));
    let title = action.said(model);
    let button = Button::selectable(is_on, &title).shortcut_text(action.keys_text(ui.ctx()));
    let response = ui.add_enabled(ready.is_ok(), button);
    response.widget_info(|| match action.is_on {
        Some(_) => WidgetInfo::selected(Role::MenuItemCheckBox, ready.is_ok(), is_on, &title),
        None => WidgetInfo::labeled(Role::MenuItem, ready.is_ok(), &title),
    });
    let reported = ready.err().unwrap_or_else(|| as_written(ui.ctx(), &action.help(model)).into());
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(&*reported));
    response.on_hover_text(&*reported).on_disabled_hover_text(&*reported)
}
