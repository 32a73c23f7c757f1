//! The Help menu (MCP manual 1.2.9): pages drawn from the tables in place of PDF files.

use egui::Key;

use super::{Action, Keys, Menu, always, key, place};
use crate::command::Command;
use crate::model::help::HelpPage;

macro_rules! page {
    ($id:literal, $title:literal, $group:literal, $keys:expr, $page:ident, $help:literal) => {
        Action {
            id: $id,
            title: $title,
            place: place(Menu::Help, $group),
            keys: $keys,
            help: $help,
            ready: always,
            is_on: None,
            command: |_| Command::OpenHelp(HelpPage::$page),
        }
    };
}

pub(super) const ACTIONS: &[Action] = &[
    page!(
        "help.first-steps",
        "First Steps",
        0,
        key(Key::F1),
        FirstSteps,
        "From an empty window to a motor that turns."
    ),
    page!(
        "help.tuning",
        "How Tuning Works",
        0,
        Keys::None,
        Tuning,
        "How the tuner works, what its figures mean, and what it refuses."
    ),
    page!(
        "help.motion-mind",
        "Motion Mind 3",
        0,
        Keys::None,
        MotionMind,
        "How to connect, drive and tune a Motion Mind 3; its commands, registers and bits."
    ),
    page!(
        "help.settings",
        "Settings Reference",
        1,
        Keys::None,
        Settings,
        "Every setting: unit, range, default, and how it is read and written."
    ),
    page!(
        "help.packet-serial",
        "Packet Serial Reference",
        1,
        Keys::None,
        PacketSerial,
        "Every command of the protocol, byte by byte, and the bits of the status word."
    ),
    page!(
        "help.mcl",
        "MCL Reference",
        1,
        Keys::None,
        Mcl,
        "Every command, operator, modifier, type and register of the MCL language, and where the manual contradicts itself."
    ),
    page!(
        "help.shortcuts",
        "Keyboard Shortcuts",
        2,
        key(Key::F2),
        Shortcuts,
        "Every key that does something."
    ),
    page!(
        "help.about",
        "About Brushwork",
        3,
        Keys::None,
        About,
        "Version, licence and what it is built with."
    ),
];
