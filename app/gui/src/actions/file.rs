//! The File menu (MCP manual 1.2.6) below the rows for MCL programs: profiles, backups, the end.

use egui::Key;

use super::{Action, Keys, always, connected, ctrl, ctrl_shift};
use crate::command::Command;
use crate::model::Model;
use crate::model::general::Sheet;

pub(super) const ACTIONS: &[Action] = &[
    entry!(File 2 "file.open-file", "Open File…", "Opens a profile, backup, recording, tuning report, script or firmware image where it belongs.",
        Keys::None, always, |_| Command::ChooseFile),
    entry!(File 2 "file.open-profile", "Open Profile…", "Reads a file of settings, to be compared with the controller and taken over.",
        ctrl_shift(Key::O), always, |model| with_or_without(model, Sheet::OpenProfile, Command::ChooseFile)),
    entry!(File 2 "file.save-profile", "Save Profile…", "Keeps the controller's settings in a file.",
        Keys::None, connected, |_| Command::OpenSheet(Sheet::SaveProfile)),
    entry!(File 2 "file.compare", "Compare Settings…", "Shows any two of RAM, EEPROM, profile, factory settings and backups side by side.",
        Keys::None, connected, |_| Command::OpenSheet(Sheet::Compare)),
    entry!(File 2 "file.to-all", "Profile to All Units…", "Gives the open profile to every unit of the open links; what changes on each is shown first.",
        Keys::None, connected, |_| Command::OpenToAll),
    entry!(File 2 "file.backups", "Backups…", "Lists what was kept before each write, save and firmware change, to be restored.",
        Keys::None, always, |model| with_or_without(model, Sheet::Backups, Command::ListBackups)),
    entry!(File 3 "file.exit", "Exit", "Stops all motors, disconnects, and closes the window.",
        ctrl(Key::Q), always, |_| Command::Exit),
];

/// A sheet beside the controller, or what there is of it without one.
fn with_or_without(model: &Model, sheet: Sheet, without: Command) -> Command {
    if model.is_connected() { Command::OpenSheet(sheet) } else { without }
}
