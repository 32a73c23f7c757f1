//! The Debug menu: the MCL debugger of simulated controllers.

use brushwork_script::debug::StepKind;
use egui::{Key, KeyboardShortcut, Modifiers};

use super::{Action, Keys, Menu, Ready, key, place, shift};
use crate::command::Command;
use crate::debugger;
use crate::debugger::DebugAction;
use crate::model::Model;
use crate::model::screen::Screen;

macro_rules! action {
    ($id:literal, $title:literal, $group:literal, $keys:expr, $help:literal, $ready:expr, $action:expr) => {
        Action {
            id: $id,
            title: $title,
            place: place(Menu::Debug, $group),
            keys: $keys,
            help: $help,
            ready: $ready,
            is_on: None,
            command: |_| Command::Debug($action),
        }
    };
}

pub(super) const ACTIONS: &[Action] = &[
    action!(
        "debug.run",
        "Run or Continue",
        0,
        key(Key::F6),
        "Lets a paused script go on, or starts the program that is in the simulated controller.",
        not_running,
        DebugAction::Run
    ),
    action!(
        "debug.pause",
        "Pause Script",
        0,
        ctrl_key(Key::F6),
        "Stops the script before its next line. The motors go on unless the world is frozen too.",
        running,
        DebugAction::Pause
    ),
    action!(
        "debug.step-into",
        "Step Into",
        1,
        key(Key::F11),
        "Runs one line; a GOSUB leads into its subroutine.",
        paused,
        DebugAction::Step(StepKind::Into)
    ),
    action!(
        "debug.step-over",
        "Step Over",
        1,
        key(Key::F12),
        "Runs one line with the subroutines it calls.",
        paused,
        DebugAction::Step(StepKind::Over)
    ),
    action!(
        "debug.step-out",
        "Step Out",
        1,
        shift(Key::F11),
        "Runs on until the subroutine has returned.",
        paused,
        DebugAction::Step(StepKind::Out)
    ),
    action!(
        "debug.run-to-cursor",
        "Run to Cursor",
        1,
        shift(Key::F6),
        "Runs on to the line of the caret, or the next one that has code.",
        has_script,
        DebugAction::RunToCursor
    ),
    action!(
        "debug.breakpoint",
        "Set or Remove Breakpoint",
        2,
        ctrl_key(Key::F8),
        "Sets a breakpoint at the line of the caret, or takes it away.",
        on_screen,
        DebugAction::ToggleBreakpoint
    ),
    action!(
        "debug.clear-breakpoints",
        "Remove All Breakpoints",
        2,
        Keys::None,
        "Takes away every breakpoint of the program.",
        on_screen,
        DebugAction::ClearBreakpoints
    ),
];

const fn ctrl_key(key: Key) -> Keys {
    Keys::Shortcut(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

fn on_screen(model: &Model) -> Ready {
    if model.screen == Screen::MclEditor { Ok(()) } else { Err("Open the MCL Editor first.".into()) }
}

fn can_debug(model: &Model) -> Ready {
    on_screen(model)?;
    debugger::why_not(model).map_or(Ok(()), Err)
}

fn has_script(model: &Model) -> Ready {
    can_debug(model)?;
    let debug = &model.front.debug;
    if debug.is_paused() || debug.is_running() {
        Ok(())
    } else {
        Err("No script runs: download the program and start it.".into())
    }
}

fn paused(model: &Model) -> Ready {
    can_debug(model)?;
    if model.front.debug.is_paused() { Ok(()) } else { Err("The script is not paused.".into()) }
}

fn running(model: &Model) -> Ready {
    can_debug(model)?;
    if model.front.debug.is_running() { Ok(()) } else { Err("No script runs.".into()) }
}

fn not_running(model: &Model) -> Ready {
    can_debug(model)?;
    if model.front.debug.is_running() { Err("The script runs already.".into()) } else { Ok(()) }
}
