//! The Device menu (MCP manual 1.2.8) with Ion Studio's keys, and what is new: links, arming, encoders.

use brushwork_link::device::ArmScope;
use brushwork_script::language::Language;
use brushwork_values::Motor;
use egui::Key;

use super::{Action, Keys, Ready, always, connected, ctrl, ctrl_shift, key, only, settings_idle};
use crate::command::Command;
use crate::debugger::DebugAction;
use crate::family::Ability;
use crate::mcl::MclAction;
use crate::model::{Arming, Model, Phase, Screen, Section, Sheet, Tab};
use crate::tune::{Loop, TuneAction};

pub(super) const ACTIONS: &[Action] = &[
    entry!(Device 0 "device.stop", "Stop All", "Stops all motors of every open link, at once.",
        Keys::Stop, always, |_| Command::Stop),
    entry!(Device 0 "device.arm", "Arm This Screen", "Lets the open screen move motors, or disarms it and stops them.",
        ctrl_shift(Key::A), can_arm, arm_or_disarm, on |model| model.front.link.arming != Arming::Disarmed),
    entry!(Device 1 "device.connect", "Connect to the Chosen Device", "Opens a link to the device that is chosen in the list, or brings it to the front.",
        ctrl_shift(Key::C), always, |_| Command::Connect),
    entry!(Device 1 "device.disconnect", "Disconnect from the Device in Front", "Stops the motors and closes the link in front, or gives up opening it.",
        ctrl_shift(Key::D), has_link, |model| Command::Disconnect(model.front.id())),
    entry!(Device 1 "device.next", "Next Open Device", "Puts the next open link in front; what was armed is disarmed and stopped.",
        ctrl(Key::PageDown), has_others, |model| Command::Front(model.neighbour(true))),
    entry!(Device 1 "device.previous", "Previous Open Device", "Puts the previous open link in front; what was armed is disarmed and stopped.",
        ctrl(Key::PageUp), has_others, |model| Command::Front(model.neighbour(false))),
    entry!(Device 2 "device.canopen", "Connect CANopen Bus…", "Connects to a CANopen bus through a GridConnect adapter.",
        Keys::None, always, |_| Command::OpenCanOpen),
    entry!(Device 2 "device.firmware", "Firmware…", "Shows what firmware is installed and what is known about it, and updates it from a file of yours.",
        Keys::None, |model| has(model, Ability::Firmware, always), |_| Command::OpenFirmware),
    entry!(Device 2 "device.examine", "Examine This Controller…", "Finds out what the controller answers and how, for a report that you can send. It reads; whatever does more is asked for first.",
        Keys::None, connected, |_| Command::OpenExamination),
    entry!(Device 2 "device.addresses", "Give Boards Their Addresses…", "Gives boards that are to share a line their addresses, one board at a time.",
        Keys::None, has_line, |_| Command::OpenAddressing),
    entry!(Device 3 "device.read-settings", "Read Settings…", "Reads the controller's settings, from what it works with or from its EEPROM.",
        key(Key::F8), settings_idle, |_| Command::OpenSheet(Sheet::Read)),
    entry!(Device 3 "device.default-settings", "Default Settings…", "Restores the factory settings on the controller.",
        Keys::None, settings_idle, |_| Command::OpenSheet(Sheet::Defaults)),
    entry!(Device 3 "device.write-settings", "Write Settings…", "Shows the edits, old and new, and writes them to the controller's RAM.",
        key(Key::F9), has_changes, |_| Command::OpenSheet(Sheet::Write)),
    entry!(Device 3 "device.save-settings", "Save Settings…", "Saves the controller's settings to its EEPROM, so that they outlive a power cycle.",
        key(Key::F10), settings_idle, |_| Command::OpenSheet(Sheet::Save)),
    entry!(Device 3 "device.conflicts", "Settings Conflicts", "Lists settings that contradict each other, with the way to each.",
        Keys::None, |model| has(model, Ability::Conflicts, connected), |_| Command::ShowSettings(Section::Conflicts)),
    entry!(Device 3 "device.recipes", "Recipes…", "Home and limit switches, sticks, encoders, brakes and the like: wiring, settings, and what comes of them.",
        Keys::None, has_recipes, |_| Command::ShowSettings(Section::Recipes)),
    entry!(Device 3 "device.clamp-test", "Voltage Clamp Test…", "Goes to the guided test of the voltage clamp; it moves a motor once armed and started there.",
        Keys::None, |model| has(model, Ability::ClampTest, connected), |_| Command::ShowSettings(Section::ClampTest)),
    entry!(Device 3 "device.measure-qpps", "Measure QPPS…", "Goes to the guided measurement of full speed; it moves a motor once armed and started there.",
        Keys::None, |model| has(model, Ability::Qpps, connected), |_| Command::OpenDrawer(Screen::Pwm, Tab::Qpps)),
    entry!(Device 3 "device.tune-velocity", "Tune Velocity…", "Goes to guided tuning of the velocity loop; it moves a motor once armed and started there.",
        Keys::None, |model| has_loop(model, Screen::Velocity), |_| Command::OpenDrawer(Screen::Velocity, Tab::Tune)),
    entry!(Device 3 "device.tune-position", "Tune Position…", "Goes to guided tuning of the position loop; it moves a motor once armed and started there.",
        Keys::None, |model| has_loop(model, Screen::Position), |_| Command::OpenDrawer(Screen::Position, Tab::Tune)),
    entry!(Device 3 "device.tune-m1", "Tune Motor 1", "Starts the guided tuning of motor 1 on the open and armed Velocity or Position screen.",
        Keys::None, can_tune, |_| Command::Tune(TuneAction::Start(Motor::M1))),
    entry!(Device 3 "device.tune-m2", "Tune Motor 2", "Starts the guided tuning of motor 2 on the open and armed Velocity or Position screen.",
        Keys::None, |model| has(model, Ability::SecondMotor, can_tune), |_| Command::Tune(TuneAction::Start(Motor::M2))),
    entry!(Device 3 "device.by-hand", "Calibrate by Hand…", "Goes to the assistant that turns the gains with you, step by step, on the open screen or the Velocity screen.",
        Keys::None, |model| has(model, Ability::ByHand, connected), calibrate_by_hand),
    entry!(Device 3 "device.generator", "Setpoint Generator…", "Goes to the generator of steps, squares, trapezoids and jogs of the open screen, or of the PWM screen.",
        Keys::None, |model| has(model, Ability::Generator, connected), open_generator),
    entry!(Device 4 "device.check-mcl", "Check MCL", "Compiles the open MCL program and checks it for errors.",
        key(Key::F7), always, |_| Command::Mcl(MclAction::Check)),
    entry!(Device 4 "device.download-mcl", "Download MCL", "Downloads the MCL program to the controller's flash memory; MeccCode runs on the simulated board.",
        key(Key::F5), can_download_or_run, |_| Command::DownloadMcl),
    entry!(Device 4 "device.download-image", "Download the Maker's Image File…", "Downloads a script that the maker's own program has compiled, for real controllers.",
        Keys::None, |model| has(model, Ability::Scripts, connected), |_| Command::Mcl(MclAction::ChooseImage)),
    entry!(Device 4 "device.start-script", "Start Script", "Starts the program that is in the controller; MeccCode is put into the simulated board's memory and begins there.",
        Keys::None, can_start_or_run, |model| match runs_on_board(model) { true => Command::Debug(DebugAction::Run), false => Command::StartScript }),
    entry!(Device 4 "device.stop-script", "Stop Script", "Stops the program that runs in the controller; on a simulated board the host library takes its place.",
        Keys::None, can_stop_or_leave, |model| match runs_on_board(model) { true => Command::RunLibrary, false => Command::StopScript }),
    entry!(Device 5 "device.zero-m1", "Zero Encoder M1", "Sets the count of encoder 1 to zero.",
        Keys::None, connected, |_| Command::ZeroEncoder(Motor::M1)),
    entry!(Device 5 "device.zero-m2", "Zero Encoder M2", "Sets the count of encoder 2 to zero.",
        Keys::None, |model| has(model, Ability::SecondMotor, connected), |_| Command::ZeroEncoder(Motor::M2)),
    entry!(Device 5 "device.reset-estop", "Reset Emergency Stop (E-Stop)", "Ends an emergency stop where the controller lets software do so.",
        Keys::None, |model| has(model, Ability::EmergencyStop, connected), |_| Command::ResetEmergencyStop),
    entry!(Device 5 "device.learn-anew", "Learn Its Commands Again", "Forgets which commands this firmware has and lacks, here and on this computer, and asks for them again.",
        Keys::None, disarmed, |_| Command::LearnAnew),
    entry!(Device 5 "device.raw", "Raw Settings…", "Writes one number to a register whose meaning is not public, at your own risk, with a backup before and an undo after.",
        Keys::None, connected, |_| Command::OpenRaw),
];

/// What has to be so, unless the controller in front is of a family that lacks the thing altogether.
fn has(model: &Model, ability: Ability, ready: fn(&Model) -> Ready) -> Ready {
    model.front.family().lacks(ability).map_or_else(|| ready(model), |why| Err(why.into()))
}

/// Guided tuning of a loop: the mode of the controller may leave it no such loop.
fn has_loop(model: &Model, screen: Screen) -> Ready {
    connected(model)?;
    only(model.front.screens().contains(&screen), "This controller has no such loop as it is set.")
}

fn has_recipes(model: &Model) -> Ready {
    connected(model)?;
    only(
        model.front.family().recipes().is_some(),
        "There are no recipes for this controller. Its settings stand in General Settings.",
    )
}

fn can_tune(model: &Model) -> Ready {
    connected(model)?;
    let Some(which) = Loop::of(model.screen) else {
        return Err("Tuning is on the Velocity and Position screens.".into());
    };
    if let Some(why) = model.front.cannot_tune() {
        return Err(why.into());
    }
    only(!model.front.is_guided(), "A job moves the motors already.")?;
    only(model.front.link.arming.is_armed_for(which.scope()), "Arm this screen first.")
}

fn can_arm(model: &Model) -> Ready {
    connected(model)?;
    let why = "This screen moves no motor. Go to the PWM, Velocity, Position or MCL screen first.";
    only(model.arm_scope().is_some(), why)
}

/// A MeccCode program goes to a simulated board, past the wire.
fn can_download_or_run(model: &Model) -> Ready {
    if model.mcl.front().language() == Language::Mecc {
        let why = "MeccCode runs on a simulated board alone. Connect to one that runs it first.";
        return only(model.front.debug.takes_mecc, why);
    }
    has(model, Ability::Scripts, can_download)
}

/// Whether the program in front is one that the simulated board in front runs out of its memory.
fn runs_on_board(model: &Model) -> bool {
    model.front.debug.takes_mecc && model.mcl.front().language() == Language::Mecc
}

fn can_start_or_run(model: &Model) -> Ready {
    if runs_on_board(model) {
        return Ok(());
    }
    has(model, Ability::Scripts, can_start_script)
}

fn can_stop_or_leave(model: &Model) -> Ready {
    if runs_on_board(model) {
        return Ok(());
    }
    has(model, Ability::Scripts, connected)
}

fn can_download(model: &Model) -> Ready {
    connected(model)?;
    let waits = "A download runs already. Wait for it or cancel it.";
    only(!model.front.script.job.is_running(), waits)
}

/// A script can move motors, so starting one is a motion.
fn can_start_script(model: &Model) -> Ready {
    connected(model)?;
    let is_armed = model.front.link.arming.is_armed_for(ArmScope::Script);
    only(is_armed, "A script can move motors. Arm the MCL Editor screen first.")
}

fn arm_or_disarm(model: &Model) -> Command {
    match model.arm_scope() {
        Some(scope) if model.front.link.arming == Arming::Disarmed => Command::Arm(scope),
        _ => Command::Disarm,
    }
}

fn calibrate_by_hand(model: &Model) -> Command {
    let screen = if model.screen == Screen::Position { Screen::Position } else { Screen::Velocity };
    Command::OpenDrawer(screen, Tab::ByHand)
}

fn open_generator(model: &Model) -> Command {
    let drives = matches!(model.screen, Screen::Pwm | Screen::Velocity | Screen::Position);
    Command::OpenDrawer(if drives { model.screen } else { Screen::Pwm }, Tab::Generator)
}

fn has_link(model: &Model) -> Ready {
    only(matches!(model.front.phase, Phase::Open { .. } | Phase::Opening { .. }), "No link is open.")
}

/// The line that boards are to share is open, or was.
fn has_line(model: &Model) -> Ready {
    only(model.front.target.is_some(), "Connect to the line first: to the port that the boards will share.")
}

fn disarmed(model: &Model) -> Ready {
    connected(model)?;
    only(
        model.front.link.arming == Arming::Disarmed,
        "Disarm first: what a controller answers is not learned while anything is armed.",
    )
}

fn has_others(model: &Model) -> Ready {
    only(!model.others.is_empty(), "No other device is open.")
}

fn has_changes(model: &Model) -> Ready {
    settings_idle(model)?;
    let has = model.front.settings.unit().is_some_and(|unit| !unit.edits().is_empty());
    only(has, "No setting was edited.")
}
