//! The Edit menu (MCP manual 1.2.7) below the rows for MCL programs: edits of settings.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::{Action, Keys, Ready, connected, ctrl, only};
use crate::command::Command;
use crate::messages::CompareMessage;
use crate::model::{Model, Sheet, UnitSettings};

pub(super) const ACTIONS: &[Action] = &[
    entry!(Edit 9 "edit.find-setting", "Find a Setting…", "Goes to General Settings and to its search field.",
        ctrl(Key::F), connected, |_| Command::FindSetting),
    entry!(Edit 9 "edit.undo-settings", "Undo Edit of Settings", "Takes the last edit of settings back that was not written.",
        Keys::Beside(KeyboardShortcut::new(Modifiers::COMMAND, Key::Z)), can_undo, |_| Command::StepSettings { again: false }),
    entry!(Edit 9 "edit.redo-settings", "Redo Edit of Settings", "Does the last edit of settings again that was taken back.",
        Keys::Beside(KeyboardShortcut::new(Modifiers::COMMAND, Key::Y)), can_redo, |_| Command::StepSettings { again: true }),
    entry!(Edit 9 "edit.revert-settings", "Revert All Edits of Settings", "Drops every edit of a setting that was not written to the controller.",
        Keys::None, has_edits, |_| Command::RevertSettings),
    entry!(Edit 9 "edit.copy-motor", "Copy Motor 1 to Motor 2…", "Shows what would make the settings of motor 2 those of motor 1, as edits to be written.",
        Keys::None, connected, |_| Command::OpenSheet(Sheet::CopyMotor)),
    entry!(Edit 9 "edit.copy-unit", "Copy Settings from Another Unit…", "Sets the settings of another unit of the open links beside those of this one, to be taken over as edits.",
        Keys::None, can_copy_unit, |_| Command::CopyUnit),
];

fn can_copy_unit(model: &Model) -> Ready {
    connected(model)?;
    only(!model.other_units().is_empty(), CompareMessage::NoOtherUnit.to_string())
}

fn can_undo(model: &Model) -> Ready {
    only(
        model.front.settings.unit().is_some_and(UnitSettings::can_undo),
        "No setting was edited since the last write.",
    )
}

fn can_redo(model: &Model) -> Ready {
    only(
        model.front.settings.unit().is_some_and(UnitSettings::can_redo),
        "No edit of a setting was taken back.",
    )
}

fn has_edits(model: &Model) -> Ready {
    let has = model.front.settings.unit().is_some_and(|unit| !unit.edits().is_empty() || unit.has_typed());
    only(has, "No setting was edited.")
}
