//! The command palette: everything that can be done, searched by name and run by key.

use crate::language::{said, word};
use crate::messages::WindowStatusMessage;
use crate::shell::messages::ShellMessage;
use egui::{
    Align2, Area, Button, Context, Frame, Id, Key, Modifiers, Order, Role, ScrollArea, Ui, WidgetInfo, vec2,
};

use crate::actions::{self, Ready};
use crate::command::{Command, Commands};
use crate::model::palette::{Palette, fitting};
use crate::model::{Connection, Model};
use crate::theme::Palette as Colours;
use crate::widgets::text_field::text_field_ui;

const WIDTH: f32 = 540.0;
const LIST_HEIGHT: f32 = 340.0;
const FROM_TOP: f32 = 60.0;

/// One row of the palette.
struct Row {
    name: String,
    /// Its name beside why it cannot be done, which is told in English.
    refused: String,
    keys: String,
    ready: Ready,
    command: Command,
}

pub fn palette_ui(ctx: &Context, model: &mut Model, commands: &mut Commands) {
    let Some(mut palette) = model.palette.take() else { return };
    let area = Area::new(Id::unique("command palette")).order(Order::Foreground);
    let area = area.anchor(Align2::CENTER_TOP, vec2(0.0, FROM_TOP)).constrain(true);
    let rows = rows(ctx, model);
    let shown = area.show(ctx, |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_width(WIDTH);
            contents_ui(ui, &mut palette, &rows)
        })
    });
    let done = shown.inner.inner;
    let left = !palette.is_new && shown.response.clicked_elsewhere();
    palette.is_new = false;
    match done {
        Some(Done::Run(index)) => run(&rows[index], model, commands),
        Some(Done::Close) => {}
        None if left => {}
        None => model.palette = Some(palette),
    }
}

/// How the palette ends.
enum Done {
    Close,
    Run(usize),
}

fn run(row: &Row, model: &mut Model, commands: &mut Commands) {
    match &row.ready {
        Ok(()) => commands.push(row.command.clone()),
        Err(why) => model
            .messages
            .warn(WindowStatusMessage::NotNow { act: row.refused.clone(), why: why.to_string() }),
    }
}

/// Every action, then the other open devices and the recent connections.
fn rows(ctx: &Context, model: &Model) -> Vec<Row> {
    let of_action = |action: &actions::Action| Row {
        name: format!(
            "{}: {}",
            word("menu", action.place.menu.title()),
            action.said(model).trim_end_matches('…')
        ),
        refused: format!("{}: {}", action.place.menu.title(), action.title.trim_end_matches('…')),
        keys: action.keys_text(ctx),
        ready: (action.ready)(model),
        command: (action.command)(model),
    };
    let of_connection = |connection: &Connection| {
        let target = connection.target.as_deref()?;
        let (name, command) = (
            said(&ShellMessage::BringToFront { target: target.to_string() }),
            Command::Front(connection.id()),
        );
        Some(Row { refused: name.clone(), name, keys: String::new(), ready: Ok(()), command })
    };
    let of_recent = |target: &String| Row {
        name: said(&ShellMessage::ConnectTo { target: target.clone() }),
        refused: target.clone(),
        keys: String::new(),
        ready: Ok(()),
        command: Command::ConnectTo(target.clone()),
    };
    let actions = actions::all().map(of_action);
    actions
        .chain(model.others.iter().filter_map(of_connection))
        .chain(model.devices.recent.iter().map(of_recent))
        .collect()
}

fn contents_ui(ui: &mut Ui, palette: &mut Palette, rows: &[Row]) -> Option<Done> {
    let names: Vec<String> = rows.iter().map(|row| row.name.clone()).collect();
    let (up, down, enter, escape) = ui.input_mut(|input| {
        let mut pressed = |key| input.consume_key(Modifiers::NONE, key);
        (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter), input.key_pressed(Key::Escape))
    });
    let field = text_field_ui(
        ui,
        &mut palette.query,
        &word("bar", "Command"),
        &word("bar", "Type what you want to do"),
    );
    if palette.is_new || enter {
        field.request_focus();
    }
    if field.changed() {
        palette.chosen = 0;
    }
    let found = fitting(&palette.query, &names);
    let last = found.len().saturating_sub(1);
    palette.chosen = match (up, down) {
        (true, _) => palette.chosen.saturating_sub(1),
        (_, true) => (palette.chosen + 1).min(last),
        _ => palette.chosen.min(last),
    };
    let clicked = list_ui(ui, rows, &found, palette.chosen, up || down);
    if escape {
        return Some(Done::Close);
    }
    // Before anything was typed or walked to, nothing is meant: letters may still be on their way.
    let is_meant = palette.chosen > 0 || !palette.query.trim().is_empty();
    let entered = found.get(palette.chosen).copied().filter(|_| enter && is_meant);
    clicked.or(entered).map(Done::Run)
}

/// The rows that fit; the one that was clicked.
fn list_ui(ui: &mut Ui, rows: &[Row], found: &[usize], chosen: usize, moved: bool) -> Option<usize> {
    let mut clicked = None;
    ScrollArea::vertical().max_height(LIST_HEIGHT).min_scrolled_height(LIST_HEIGHT).show(ui, |ui| {
        ui.set_min_width(WIDTH - 16.0);
        if found.is_empty() {
            ui.label(word("bar", "Nothing is called that. Try fewer letters."));
        }
        for (place, index) in found.iter().enumerate() {
            let row = &rows[*index];
            let color = if row.ready.is_ok() { Colours::of(ui).text } else { Colours::of(ui).weak_text };
            let text = egui::RichText::new(&row.name).color(color);
            let button = Button::selectable(place == chosen, text).shortcut_text(row.keys.as_str());
            let response = ui.add_sized(vec2(ui.available_width(), 24.0), button);
            response.widget_info(|| {
                WidgetInfo::selected(Role::ListBoxOption, row.ready.is_ok(), place == chosen, &row.name)
            });
            if moved && place == chosen {
                response.scroll_to_me(None);
            }
            let response = match &row.ready {
                Ok(()) => response,
                Err(why) => response.on_hover_text(&**why),
            };
            if response.clicked() {
                clicked = Some(*index);
            }
        }
    });
    clicked
}
