//! The View menu: the screens in Ion Studio's order, panels, theme and size.

use egui::{Key, ThemePreference};

use super::{Action, Keys, Ready, always, ctrl, ctrl_shift, key, only, shift};
use crate::actions::messages::ActionMessage;
use crate::command::Command;
use crate::language::Language;
use crate::model::{Model, Screen};

/// A row for a screen: its title stands once, in [`Screen`].
macro_rules! screen {
    ($screen:ident $id:literal, $key:ident, $help:literal) => {
        entry!(View 0 $id, Screen::$screen.title(), $help,
            ctrl(Key::$key), |model| there_is(model, Screen::$screen), |_| Command::Show(Screen::$screen),
            on |model| model.screen == Screen::$screen)
    };
}

macro_rules! theme {
    ($id:literal, $title:literal, $theme:ident, $help:literal) => {
        entry!(View 2 $id, $title, $help,
            Keys::None, always, |_| Command::Theme(ThemePreference::$theme),
            on |model| model.appearance.theme == ThemePreference::$theme)
    };
}

macro_rules! language {
    ($id:literal, $title:literal, $language:ident, $help:literal) => {
        entry!(View 2 $id, $title, $help,
            Keys::None, always, |_| Command::Language(Language::$language),
            on |model| model.appearance.language == Language::$language)
    };
}

pub(super) const ACTIONS: &[Action] = &[
    screen!(DeviceStatus "view.device-status", Num1, "Indicators, events and what keeps the motors from running."),
    screen!(GeneralSettings "view.general", Num2, "The controller's settings: limits, inputs, pins, profiles."),
    screen!(Pwm "view.pwm", Num3, "Drives the motors by duty and measures their top speed."),
    screen!(Velocity "view.velocity", Num4, "Settings of the velocity loops, and driving by speed."),
    screen!(Position "view.position", Num5, "Settings of the position loops, and driving to positions."),
    screen!(MclEditor "view.mcl", Num6, "Programs that run in the controller."),
    screen!(Motion "view.motion", Num7, "What moves a controller that is not driven from here."),
    screen!(Inputs "view.inputs", Num8, "Analog inputs, switches and radio control of a Motion Mind."),
    screen!(Terminal "view.command-terminal", Num9, "Commands to a Motion Mind by hand, with what they mean."),
    entry!(View 1 "view.palette", "Command Palette…", "Searches everything that can be done by name.",
        ctrl_shift(Key::P), always, |_| Command::OpenPalette),
    entry!(View 1 "view.next-region", "Next Region", "Puts the keyboard into the next part of the window: devices, screen, controls, graph, panels, message.",
        key(Key::F6), always, |_| Command::NextRegion { forward: true }),
    entry!(View 1 "view.previous-region", "Previous Region", "Puts the keyboard into the part of the window before.",
        shift(Key::F6), always, |_| Command::NextRegion { forward: false }),
    entry!(View 1 "view.world", "Simulated World", "Shows and hides the loads, batteries, switches and faults of a simulated controller.",
        ctrl(Key::B), has_world, |_| Command::ToggleWorld, on |model| model.front.world.open),
    entry!(View 1 "view.traffic", "Traffic", "Shows and hides every transaction on the wire, decoded, with its bytes.",
        ctrl(Key::T), always, |_| Command::ToggleTraffic, on |model| model.front.traffic.open),
    entry!(View 1 "view.pause-traffic", "Pause the Traffic", "Stops and continues the recording of transactions; the link goes on.",
        Keys::None, shows_traffic, |model| Command::PauseTraffic(!model.front.traffic.log.paused),
        on |model| model.front.traffic.log.paused),
    entry!(View 1 "view.clear-history", "Clear the Event History", "Empties the list of events on the Device Status screen.",
        Keys::None, always, |_| Command::ClearHistory),
    theme!("view.theme-system", "Theme as the System", System, "Light or dark as the desktop has it."),
    theme!("view.theme-light", "Light Theme", Light, "Dark text on a light ground."),
    theme!("view.theme-dark", "Dark Theme", Dark, "Light text on a dark ground."),
    language!("view.english", "English", English, "The window in English."),
    language!(
        "view.german",
        "Deutsch",
        German,
        "The window's menus, bars and start page in German; the rest is English."
    ),
    entry!(View 2 "view.plain", "Plain Edges", "Draws without smoothing, which saves processor time where there is no graphics card.",
        Keys::None, always, |model| Command::PlainEdges(!model.appearance.plain), on |model| model.appearance.plain),
    entry!(View 3 "view.larger", "Larger", "Makes everything in the window larger.",
        ctrl(Key::Plus), always, |model| Command::Scale(model.appearance.scale_percent.saturating_add(10))),
    entry!(View 3 "view.smaller", "Smaller", "Makes everything in the window smaller.",
        ctrl(Key::Minus), always, |model| Command::Scale(model.appearance.scale_percent.saturating_sub(10))),
    entry!(View 3 "view.normal-size", "Normal Size", "Makes everything in the window as large as it is at first.",
        ctrl(Key::Num0), always, |_| Command::Scale(100)),
];

/// Whether the controller in front has a screen.
fn shows_traffic(model: &Model) -> Ready {
    only(model.front.traffic.open, "The traffic is not shown.")
}

fn there_is(model: &Model, screen: Screen) -> Ready {
    let name = model.front.family().name();
    let why = ActionMessage::NoSuchScreen { name }.to_string();
    only(model.front.screens().contains(&screen), why)
}

fn has_world(model: &Model) -> Ready {
    only(model.front.worlds.is_some(), "The controller in front is not a simulated one.")
}
