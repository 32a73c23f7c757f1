//! The File menu (MCP manual 1.2.6) below the rows for MCL programs: profiles, backups, the end.

use egui::Key;

use super::{Action, Keys, Menu, always, connected, ctrl, ctrl_shift, place};
use crate::command::Command;
use crate::model::general::Sheet;

pub(super) const ACTIONS: &[Action] = &[
    Action {
        id: "file.open-profile",
        title: "Open Profile…",
        place: place(Menu::File, 2),
        keys: ctrl_shift(Key::O),
        help: "Reads a file of settings, to be compared with the controller and taken over.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::OpenProfile),
    },
    Action {
        id: "file.save-profile",
        title: "Save Profile…",
        place: place(Menu::File, 2),
        keys: Keys::None,
        help: "Keeps the controller's settings in a file.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::SaveProfile),
    },
    Action {
        id: "file.compare",
        title: "Compare Settings…",
        place: place(Menu::File, 2),
        keys: Keys::None,
        help: "Shows any two of RAM, EEPROM, profile, factory settings and backups side by side.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Compare),
    },
    Action {
        id: "file.backups",
        title: "Backups…",
        place: place(Menu::File, 2),
        keys: Keys::None,
        help: "Lists what was kept before each write, save and firmware change, to be restored.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Backups),
    },
    Action {
        id: "file.exit",
        title: "Exit",
        place: place(Menu::File, 3),
        keys: ctrl(Key::Q),
        help: "Stops all motors, disconnects, and closes the window.",
        ready: always,
        is_on: None,
        command: |_| Command::Exit,
    },
];
