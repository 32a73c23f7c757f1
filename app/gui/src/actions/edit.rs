//! The Edit menu (MCP manual 1.2.7) below the rows for MCL programs: edits of settings.

use egui::Key;

use super::{Action, Keys, Menu, Ready, connected, ctrl, place};
use crate::command::Command;
use crate::model::Model;
use crate::model::general::Sheet;

pub(super) const ACTIONS: &[Action] = &[
    Action {
        id: "edit.find-setting",
        title: "Find a Setting…",
        place: place(Menu::Edit, 9),
        keys: ctrl(Key::F),
        help: "Goes to General Settings and to its search field.",
        ready: connected,
        is_on: None,
        command: |_| Command::FindSetting,
    },
    Action {
        id: "edit.revert-settings",
        title: "Revert All Edits of Settings",
        place: place(Menu::Edit, 9),
        keys: Keys::None,
        help: "Drops every edit of a setting that was not written to the controller.",
        ready: has_edits,
        is_on: None,
        command: |_| Command::RevertSettings,
    },
    Action {
        id: "edit.copy-motor",
        title: "Copy Motor 1 to Motor 2…",
        place: place(Menu::Edit, 9),
        keys: Keys::None,
        help: "Shows what would make the settings of motor 2 those of motor 1, as edits to be written.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::CopyMotor),
    },
];

fn has_edits(model: &Model) -> Ready {
    let has = model.front.settings.unit().is_some_and(|unit| !unit.edits().is_empty() || unit.has_typed());
    if has { Ok(()) } else { Err("No setting was edited.".into()) }
}
