//! What is asked of the gains that were found and of whatever runs, in the Device menu: their buttons stand on their screens.

use super::{Action, Keys, Ready, connected, only, settings_idle};
use crate::command::{Command, GuidedAction};
use crate::family::Ability;
use crate::model::generator::mode_of;
use crate::model::{Model, Phase, SettingsAction};
use crate::tune::{Loop, TuneAction};

pub(super) const ACTIONS: &[Action] = &[
    entry!(Device 6 "device.apply-gains", "Apply Gains", "Writes the gains that the open tuning screen considers to the controller's RAM and reads them back.",
        Keys::None, can_apply, |_| Command::Tune(TuneAction::Apply)),
    entry!(Device 6 "device.verify-gains", "Verify Gains", "Moves the motor with the considered gains and compares it with the prediction, on an armed screen.",
        Keys::None, can_verify, |_| Command::Tune(TuneAction::Verify)),
    entry!(Device 6 "device.undo-gains", "Undo Applied Gains", "Writes back what RAM held before gains were applied.",
        Keys::None, can_undo, |_| Command::Tune(TuneAction::Undo)),
    entry!(Device 6 "device.run-profile", "Run the Generator's Profile", "Plays the profile of the open and armed screen once.",
        Keys::None, can_play, |_| Command::Guided(GuidedAction::Play)),
    entry!(Device 7 "device.cancel", "Cancel What Runs", "Ends the tuning run, the profile, the download or the work with settings that is under way.",
        Keys::None, |model| running(model).map(|_| ()).ok_or_else(|| "Nothing runs that could be cancelled.".into()),
        |model| running(model).unwrap_or(Command::DismissMessage)),
    entry!(Device 7 "device.reconnect", "Reconnect", "Opens the link in front again, after it was lost or closed. Nothing is armed by it.",
        Keys::None, can_reconnect, |model| model.front.target.clone().map_or(Command::Connect, Command::ConnectTo)),
    entry!(Device 7 "device.keep-backup", "Back Up Now", "Keeps a copy of the settings on this computer, without writing any to the controller.",
        Keys::None, settings_idle, |_| Command::BackUp),
];

/// The loop whose tuning is open, with nothing else under way.
fn free_loop(model: &Model) -> Result<Loop, super::Refused> {
    connected(model)?;
    let which = Loop::of(model.screen).ok_or("Tuning is on the Velocity and Position screens.")?;
    only(!model.front.is_guided(), "A job moves the motors already.")?;
    only(!model.front.settings.is_busy(), "Settings are read or written. Wait for it or cancel it.")?;
    Ok(which)
}

fn can_apply(model: &Model) -> Ready {
    let which = free_loop(model)?;
    let has_gains = model.front.tune.front(which).run().is_some_and(|run| run.shown.is_some());
    only(has_gains, "No gains were found yet. Tune the motor first.")
}

fn can_verify(model: &Model) -> Ready {
    can_apply(model)?;
    let scope = Loop::of(model.screen).map(Loop::scope);
    only(scope.is_some_and(|scope| model.front.link.arming.is_armed_for(scope)), "Arm this screen first.")
}

fn can_undo(model: &Model) -> Ready {
    let which = free_loop(model)?;
    only(model.front.tune.front(which).undo.is_some(), "No gains were applied since they were read.")
}

fn can_play(model: &Model) -> Ready {
    connected(model)?;
    if let Some(why) = model.front.family().lacks(Ability::Generator) {
        return Err(why.into());
    }
    let scope = model.screen.arm_scope();
    let Some((scope, mode)) = scope.and_then(|scope| Some((scope, mode_of(scope)?))) else {
        return Err("The generator is on the PWM, Velocity and Position screens.".into());
    };
    only(!model.front.is_guided(), "A job moves the motors already.")?;
    only(model.front.link.arming.is_armed_for(scope), "Arm this screen first.")?;
    model.front.plan(mode).map(|_| ()).map_err(|why| why.to_string().into())
}

/// What ends the work that is under way.
fn running(model: &Model) -> Option<Command> {
    let front = &model.front;
    if front.tune.is_running() {
        return Some(Command::Tune(TuneAction::Cancel));
    }
    if front.generator.job.is_running() || front.qpps.job.is_running() {
        return Some(Command::Guided(GuidedAction::Cancel));
    }
    if front.script.job.is_running() {
        return Some(Command::CancelDownload);
    }
    front.settings.running().map(|_| Command::Settings(SettingsAction::Cancel))
}

fn can_reconnect(model: &Model) -> Ready {
    only(model.front.target.is_some(), "Nothing was connected yet. Choose a device in the list.")?;
    only(model.front.phase == Phase::Closed, "The link is open.")
}
