//! The File menu (MCP manual 1.2.6): MCL programs, and what is new: profiles.

use egui::Key;

use super::{Action, Keys, Menu, always, connected, ctrl, ctrl_shift, mcl_missing, place};
use crate::gui::command::Command;
use crate::gui::model::general::Sheet;
use crate::gui::model::screen::Screen;

pub(super) const ACTIONS: &[Action] = &[
    Action {
        id: "file.new",
        title: "New MCL Program",
        place: place(Menu::File, 0),
        keys: ctrl(Key::N),
        help: "Begins an empty MCL program.",
        ready: mcl_missing,
        is_on: None,
        command: |_| Command::Show(Screen::MclEditor),
    },
    Action {
        id: "file.open",
        title: "Open MCL Program…",
        place: place(Menu::File, 0),
        keys: ctrl(Key::O),
        help: "Opens an MCL program from a file.",
        ready: mcl_missing,
        is_on: None,
        command: |_| Command::Show(Screen::MclEditor),
    },
    Action {
        id: "file.save",
        title: "Save MCL Program",
        place: place(Menu::File, 0),
        keys: ctrl(Key::S),
        help: "Saves the open MCL program to its file.",
        ready: mcl_missing,
        is_on: None,
        command: |_| Command::Show(Screen::MclEditor),
    },
    Action {
        id: "file.save-as",
        title: "Save MCL Program As…",
        place: place(Menu::File, 0),
        keys: ctrl_shift(Key::S),
        help: "Saves the open MCL program under another name.",
        ready: mcl_missing,
        is_on: None,
        command: |_| Command::Show(Screen::MclEditor),
    },
    Action {
        id: "file.open-profile",
        title: "Open Profile…",
        place: place(Menu::File, 1),
        keys: ctrl_shift(Key::O),
        help: "Reads a file of settings, to be compared with the controller and taken over.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::OpenProfile),
    },
    Action {
        id: "file.save-profile",
        title: "Save Profile…",
        place: place(Menu::File, 1),
        keys: Keys::None,
        help: "Keeps the controller's settings in a file.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::SaveProfile),
    },
    Action {
        id: "file.compare",
        title: "Compare Settings…",
        place: place(Menu::File, 1),
        keys: Keys::None,
        help: "Shows any two of RAM, EEPROM, profile, factory settings and backups side by side.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Compare),
    },
    Action {
        id: "file.backups",
        title: "Backups…",
        place: place(Menu::File, 1),
        keys: Keys::None,
        help: "Lists what was kept before each write, save and firmware change, to be restored.",
        ready: connected,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Backups),
    },
    Action {
        id: "file.exit",
        title: "Exit",
        place: place(Menu::File, 2),
        keys: ctrl(Key::Q),
        help: "Stops all motors, disconnects, and closes the window.",
        ready: always,
        is_on: None,
        command: |_| Command::Exit,
    },
];
