//! The Edit menu (MCP manual 1.2.7): the MCL editor's commands, and what is new: edits of settings.

use egui::Key;

use super::{Action, Keys, Menu, Ready, connected, ctrl, mcl_missing, place};
use crate::gui::command::Command;
use crate::gui::model::Model;
use crate::gui::model::general::Sheet;
use crate::gui::model::screen::Screen;

/// One command of the MCL editor's text field, which takes its keys by itself.
const fn in_editor(id: &'static str, title: &'static str, keys: &'static str, help: &'static str) -> Action {
    Action {
        id,
        title,
        place: place(Menu::Edit, 0),
        keys: Keys::Elsewhere(keys),
        help,
        ready: mcl_missing,
        is_on: None,
        command: |_| Command::Show(Screen::MclEditor),
    }
}

pub(super) const ACTIONS: &[Action] = &[
    in_editor("edit.undo", "Undo", "Ctrl+Z", "Takes back the last edit of the MCL program."),
    in_editor("edit.redo", "Redo", "Ctrl+Y", "Does the last edit that was taken back again."),
    in_editor("edit.cut", "Cut", "Ctrl+X", "Cuts the selected text out of the MCL program."),
    in_editor("edit.copy", "Copy", "Ctrl+C", "Copies the selected text of the MCL program."),
    in_editor("edit.paste", "Paste", "Ctrl+V", "Pastes text into the MCL program."),
    Action {
        id: "edit.find-setting",
        title: "Find a Setting…",
        place: place(Menu::Edit, 1),
        keys: ctrl(Key::F),
        help: "Goes to General Settings and to its search field.",
        ready: connected,
        is_on: None,
        command: |_| Command::FindSetting,
    },
    Action {
        id: "edit.revert-settings",
        title: "Revert All Edits of Settings",
        place: place(Menu::Edit, 1),
        keys: Keys::None,
        help: "Drops every edit of a setting that was not written to the controller.",
        ready: has_edits,
        is_on: None,
        command: |_| Command::RevertSettings,
    },
    Action {
        id: "edit.copy-motor",
        title: "Copy Motor 1 to Motor 2…",
        place: place(Menu::Edit, 1),
        keys: Keys::None,
        help: "Shows what would make the settings of motor 2 those of motor 1, as edits to be written.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::CopyMotor),
    },
];

fn has_edits(model: &Model) -> Ready {
    let has = model.front.general.unit().is_some_and(|unit| !unit.edits().is_empty() || unit.has_typed());
    if has { Ok(()) } else { Err("No setting was edited.".into()) }
}
