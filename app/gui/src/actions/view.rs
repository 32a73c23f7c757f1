//! The View menu: the screens in Ion Studio's order, panels, theme and size.

use egui::{Key, ThemePreference};

use super::{Action, Keys, Menu, Ready, always, ctrl, ctrl_shift, place};
use crate::command::Command;
use crate::model::Model;
use crate::model::screen::Screen;

/// A row for a screen: its title stands once, in [`Screen`].
macro_rules! screen {
    ($id:literal, $screen:ident, $key:ident, $help:literal) => {
        Action {
            id: $id,
            title: Screen::$screen.title(),
            place: place(Menu::View, 0),
            keys: ctrl(Key::$key),
            help: $help,
            ready: |model| there_is(model, Screen::$screen),
            is_on: Some(|model| model.screen == Screen::$screen),
            command: |_| Command::Show(Screen::$screen),
        }
    };
}

macro_rules! theme {
    ($id:literal, $title:literal, $theme:ident, $help:literal) => {
        Action {
            id: $id,
            title: $title,
            place: place(Menu::View, 2),
            keys: Keys::None,
            help: $help,
            ready: always,
            is_on: Some(|model| model.appearance.theme == ThemePreference::$theme),
            command: |_| Command::Theme(ThemePreference::$theme),
        }
    };
}

pub(super) const ACTIONS: &[Action] = &[
    screen!(
        "view.device-status",
        DeviceStatus,
        Num1,
        "Indicators, events and what keeps the motors from running."
    ),
    screen!(
        "view.general",
        GeneralSettings,
        Num2,
        "The controller's settings: limits, inputs, pins, profiles."
    ),
    screen!("view.pwm", Pwm, Num3, "Drives the motors by duty and measures their top speed."),
    screen!("view.velocity", Velocity, Num4, "Settings of the velocity loops, and driving by speed."),
    screen!("view.position", Position, Num5, "Settings of the position loops, and driving to positions."),
    screen!("view.mcl", MclEditor, Num6, "Programs that run in the controller."),
    screen!("view.motion", Motion, Num7, "What moves a controller that is not driven from here."),
    screen!("view.inputs", Inputs, Num8, "Analog inputs, switches and radio control of a Motion Mind."),
    screen!(
        "view.command-terminal",
        Terminal,
        Num9,
        "Commands to a Motion Mind by hand, with what they mean."
    ),
    Action {
        id: "view.palette",
        title: "Command Palette…",
        place: place(Menu::View, 1),
        keys: ctrl_shift(Key::P),
        help: "Searches everything that can be done by name.",
        ready: always,
        is_on: None,
        command: |_| Command::OpenPalette,
    },
    Action {
        id: "view.world",
        title: "Simulated World",
        place: place(Menu::View, 1),
        keys: ctrl(Key::B),
        help: "Shows and hides the loads, batteries, switches and faults of a simulated controller.",
        ready: has_world,
        is_on: Some(|model| model.front.world.open),
        command: |_| Command::ToggleWorld,
    },
    Action {
        id: "view.traffic",
        title: "Traffic",
        place: place(Menu::View, 1),
        keys: ctrl(Key::T),
        help: "Shows and hides every transaction on the wire, decoded, with its bytes.",
        ready: always,
        is_on: Some(|model| model.front.traffic.open),
        command: |_| Command::ToggleTraffic,
    },
    Action {
        id: "view.pause-traffic",
        title: "Pause the Traffic",
        place: place(Menu::View, 1),
        keys: Keys::None,
        help: "Stops and continues the recording of transactions; the link goes on.",
        ready: |model| match model.front.traffic.open {
            true => Ok(()),
            false => Err("The traffic is not shown.".into()),
        },
        is_on: Some(|model| model.front.traffic.log.is_paused()),
        command: |model| Command::PauseTraffic(!model.front.traffic.log.is_paused()),
    },
    Action {
        id: "view.clear-history",
        title: "Clear the Event History",
        place: place(Menu::View, 1),
        keys: Keys::None,
        help: "Empties the list of events on the Device Status screen.",
        ready: always,
        is_on: None,
        command: |_| Command::ClearHistory,
    },
    theme!("view.theme-system", "Theme as the System", System, "Light or dark as the desktop has it."),
    theme!("view.theme-light", "Light Theme", Light, "Dark text on a light ground."),
    theme!("view.theme-dark", "Dark Theme", Dark, "Light text on a dark ground."),
    Action {
        id: "view.plain",
        title: "Plain Edges",
        place: place(Menu::View, 2),
        keys: Keys::None,
        help: "Draws without smoothing, which saves processor time where there is no graphics card.",
        ready: always,
        is_on: Some(|model| model.appearance.plain),
        command: |model| Command::PlainEdges(!model.appearance.plain),
    },
    Action {
        id: "view.larger",
        title: "Larger",
        place: place(Menu::View, 3),
        keys: ctrl(Key::Plus),
        help: "Makes everything in the window larger.",
        ready: always,
        is_on: None,
        command: |model| Command::Scale(model.appearance.scale_percent.saturating_add(10)),
    },
    Action {
        id: "view.smaller",
        title: "Smaller",
        place: place(Menu::View, 3),
        keys: ctrl(Key::Minus),
        help: "Makes everything in the window smaller.",
        ready: always,
        is_on: None,
        command: |model| Command::Scale(model.appearance.scale_percent.saturating_sub(10)),
    },
    Action {
        id: "view.normal-size",
        title: "Normal Size",
        place: place(Menu::View, 3),
        keys: ctrl(Key::Num0),
        help: "Makes everything in the window as large as it is at first.",
        ready: always,
        is_on: None,
        command: |_| Command::Scale(100),
    },
];

/// Whether the controller in front has a screen.
fn there_is(model: &Model, screen: Screen) -> Ready {
    match model.front.screens().contains(&screen) {
        true => Ok(()),
        false => Err(format!(
            "A controller like the {} has no such screen as it is set.",
            model.front.family().name()
        )
        .into()),
    }
}

fn has_world(model: &Model) -> Ready {
    if model.front.worlds.is_some() {
        Ok(())
    } else {
        Err("The controller in front is not a simulated one.".into())
    }
}
