//! The Debug menu: the MCL debugger of simulated controllers.

use brushwork_script::debug::StepKind;
use brushwork_script::language::Language;
use egui::Key;

use super::{Action, Keys, Ready, ctrl, key, only, shift};
use crate::command::Command;
use crate::debugger::{self, DebugAction};
use crate::model::{Model, Screen};

pub(super) const ACTIONS: &[Action] = &[
    entry!(Debug 0 "debug.run", "Run or Continue", "Lets a paused script go on, or starts the program that is in the simulated controller.",
        ctrl(Key::F5), not_running, |_| Command::Debug(DebugAction::Run)),
    entry!(Debug 0 "debug.pause", "Pause Script", "Stops the script before its next line. The motors go on unless the world is frozen too.",
        ctrl(Key::F6), running, |_| Command::Debug(DebugAction::Pause)),
    entry!(Debug 1 "debug.step-into", "Step Into", "Runs one line; a GOSUB leads into its subroutine.",
        key(Key::F11), paused, |_| Command::Debug(DebugAction::Step(StepKind::Into))),
    entry!(Debug 1 "debug.step-over", "Step Over", "Runs one line with the subroutines it calls.",
        key(Key::F12), paused, |_| Command::Debug(DebugAction::Step(StepKind::Over))),
    entry!(Debug 1 "debug.step-out", "Step Out", "Runs on until the subroutine has returned.",
        shift(Key::F11), paused, |_| Command::Debug(DebugAction::Step(StepKind::Out))),
    entry!(Debug 1 "debug.run-to-cursor", "Run to Cursor", "Runs on to the line of the caret, or the next one that has code.",
        ctrl(Key::F10), has_script, |_| Command::Debug(DebugAction::RunToCursor)),
    entry!(Debug 2 "debug.breakpoint", "Set or Remove Breakpoint", "Sets a breakpoint at the line of the caret, or takes it away.",
        ctrl(Key::F8), on_screen, |_| Command::Debug(DebugAction::ToggleBreakpoint)),
    entry!(Debug 2 "debug.clear-breakpoints", "Remove All Breakpoints", "Takes away every breakpoint of the program.",
        Keys::None, on_screen, |_| Command::Debug(DebugAction::ClearBreakpoints)),
];

fn on_screen(model: &Model) -> Ready {
    only(model.screen == Screen::MclEditor, "Open the MCL Editor first.")
}

fn can_debug(model: &Model) -> Ready {
    on_screen(model)?;
    debugger::why_not(model).map_or(Ok(()), Err)
}

fn has_script(model: &Model) -> Ready {
    can_debug(model)?;
    let debug = &model.front.debug;
    only(debug.is_paused() || debug.is_running(), "No script runs: download the program and start it.")
}

fn paused(model: &Model) -> Ready {
    can_debug(model)?;
    only(model.front.debug.is_paused(), "The script is not paused.")
}

fn running(model: &Model) -> Ready {
    can_debug(model)?;
    only(model.front.debug.is_running(), "No script runs.")
}

fn not_running(model: &Model) -> Ready {
    can_debug(model)?;
    let takes_its_place = model.front.debug.takes_mecc && model.mcl.front().language() == Language::Mecc;
    only(takes_its_place || !model.front.debug.is_running(), "The script runs already.")
}
