//! The Device menu (MCP manual 1.2.8) with Ion Studio's keys, and what is new: links, arming, encoders.

use brushwork_link::device::ArmScope;
use brushwork_values::Motor;
use egui::Key;

use super::{Action, Keys, Menu, Ready, always, connected, ctrl, ctrl_shift, key, place, settings_idle};
use crate::command::Command;
use crate::family::Ability;
use crate::mcl::MclAction;
use crate::model::drawer::Tab;
use crate::model::general::{Section, Sheet};
use crate::model::link::Arming;
use crate::model::screen::Screen;
use crate::model::{Model, Phase};
use crate::tune::{Loop, TuneAction};

pub(super) const ACTIONS: &[Action] = &[
    Action {
        id: "device.stop",
        title: "Stop All",
        place: place(Menu::Device, 0),
        keys: Keys::Elsewhere("Space or Esc"),
        help: "Stops all motors of every open link, at once.",
        ready: always,
        is_on: None,
        command: |_| Command::Stop,
    },
    Action {
        id: "device.arm",
        title: "Arm This Screen",
        place: place(Menu::Device, 0),
        keys: ctrl_shift(Key::A),
        help: "Lets the open screen move motors, or disarms it and stops them.",
        ready: can_arm,
        is_on: Some(|model| model.front.link.arming != Arming::Disarmed),
        command: arm_or_disarm,
    },
    Action {
        id: "device.connect",
        title: "Connect to the Chosen Device",
        place: place(Menu::Device, 1),
        keys: ctrl_shift(Key::C),
        help: "Opens a link to the device that is chosen in the list, or brings it to the front.",
        ready: always,
        is_on: None,
        command: |_| Command::Connect,
    },
    Action {
        id: "device.disconnect",
        title: "Disconnect from the Device in Front",
        place: place(Menu::Device, 1),
        keys: ctrl_shift(Key::D),
        help: "Stops the motors and closes the link in front, or gives up opening it.",
        ready: has_link,
        is_on: None,
        command: |model| Command::Disconnect(model.front.id()),
    },
    Action {
        id: "device.next",
        title: "Next Open Device",
        place: place(Menu::Device, 1),
        keys: ctrl(Key::PageDown),
        help: "Puts the next open link in front; what was armed is disarmed and stopped.",
        ready: has_others,
        is_on: None,
        command: |model| Command::Front(model.neighbour(true)),
    },
    Action {
        id: "device.previous",
        title: "Previous Open Device",
        place: place(Menu::Device, 1),
        keys: ctrl(Key::PageUp),
        help: "Puts the previous open link in front; what was armed is disarmed and stopped.",
        ready: has_others,
        is_on: None,
        command: |model| Command::Front(model.neighbour(false)),
    },
    Action {
        id: "device.canopen",
        title: "Connect CANopen Bus…",
        place: place(Menu::Device, 2),
        keys: Keys::None,
        help: "Connects to a CANopen bus through a GridConnect adapter.",
        ready: always,
        is_on: None,
        command: |_| Command::OpenCanOpen,
    },
    Action {
        id: "device.firmware",
        title: "Firmware…",
        place: place(Menu::Device, 2),
        keys: Keys::None,
        help: "Shows what firmware is installed and what is known about it, and updates it from a file of yours.",
        ready: |model| has(model, Ability::Firmware, always),
        is_on: None,
        command: |_| Command::OpenFirmware,
    },
    Action {
        id: "device.read-settings",
        title: "Read Settings…",
        place: place(Menu::Device, 3),
        keys: key(Key::F8),
        help: "Reads the controller's settings, from what it works with or from its EEPROM.",
        ready: settings_idle,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Read),
    },
    Action {
        id: "device.default-settings",
        title: "Default Settings…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Restores the factory settings on the controller.",
        ready: settings_idle,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Defaults),
    },
    Action {
        id: "device.write-settings",
        title: "Write Settings…",
        place: place(Menu::Device, 3),
        keys: key(Key::F9),
        help: "Shows the edits, old and new, and writes them to the controller's RAM.",
        ready: has_changes,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Write),
    },
    Action {
        id: "device.save-settings",
        title: "Save Settings…",
        place: place(Menu::Device, 3),
        keys: key(Key::F10),
        help: "Saves the controller's settings to its EEPROM, so that they outlive a power cycle.",
        ready: settings_idle,
        is_on: None,
        command: |_| Command::OpenSheet(Sheet::Save),
    },
    Action {
        id: "device.conflicts",
        title: "Settings Conflicts",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Lists settings that contradict each other, with the way to each.",
        ready: |model| has(model, Ability::Conflicts, connected),
        is_on: None,
        command: |_| Command::ShowSettings(Section::Conflicts),
    },
    Action {
        id: "device.clamp-test",
        title: "Voltage Clamp Test…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Goes to the guided test of the voltage clamp; it moves a motor once armed and started there.",
        ready: |model| has(model, Ability::ClampTest, connected),
        is_on: None,
        command: |_| Command::ShowSettings(Section::ClampTest),
    },
    Action {
        id: "device.measure-qpps",
        title: "Measure QPPS…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Goes to the guided measurement of full speed; it moves a motor once armed and started there.",
        ready: |model| has(model, Ability::Qpps, connected),
        is_on: None,
        command: |_| Command::OpenDrawer(Screen::Pwm, Tab::Qpps),
    },
    Action {
        id: "device.tune-velocity",
        title: "Tune Velocity…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Goes to guided tuning of the velocity loop; it moves a motor once armed and started there.",
        ready: |model| has_loop(model, Screen::Velocity),
        is_on: None,
        command: |_| Command::OpenDrawer(Screen::Velocity, Tab::Tune),
    },
    Action {
        id: "device.tune-position",
        title: "Tune Position…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Goes to guided tuning of the position loop; it moves a motor once armed and started there.",
        ready: |model| has_loop(model, Screen::Position),
        is_on: None,
        command: |_| Command::OpenDrawer(Screen::Position, Tab::Tune),
    },
    Action {
        id: "device.tune-m1",
        title: "Tune Motor 1",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Starts the guided tuning of motor 1 on the open and armed Velocity or Position screen.",
        ready: can_tune,
        is_on: None,
        command: |_| Command::Tune(TuneAction::Start(Motor::M1)),
    },
    Action {
        id: "device.tune-m2",
        title: "Tune Motor 2",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Starts the guided tuning of motor 2 on the open and armed Velocity or Position screen.",
        ready: |model| has(model, Ability::SecondMotor, can_tune),
        is_on: None,
        command: |_| Command::Tune(TuneAction::Start(Motor::M2)),
    },
    Action {
        id: "device.by-hand",
        title: "Calibrate by Hand…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Goes to the assistant that turns the gains with you, step by step, on the open screen or the Velocity screen.",
        ready: |model| has(model, Ability::ByHand, connected),
        is_on: None,
        command: |model| {
            let screen = if model.screen == Screen::Position { Screen::Position } else { Screen::Velocity };
            Command::OpenDrawer(screen, Tab::ByHand)
        },
    },
    Action {
        id: "device.generator",
        title: "Setpoint Generator…",
        place: place(Menu::Device, 3),
        keys: Keys::None,
        help: "Goes to the generator of steps, squares, trapezoids and jogs of the open screen, or of the PWM screen.",
        ready: |model| has(model, Ability::Generator, connected),
        is_on: None,
        command: |model| {
            let drives = matches!(model.screen, Screen::Pwm | Screen::Velocity | Screen::Position);
            Command::OpenDrawer(if drives { model.screen } else { Screen::Pwm }, Tab::Generator)
        },
    },
    Action {
        id: "device.check-mcl",
        title: "Check MCL",
        place: place(Menu::Device, 4),
        keys: key(Key::F7),
        help: "Compiles the open MCL program and checks it for errors.",
        ready: always,
        is_on: None,
        command: |_| Command::Mcl(MclAction::Check),
    },
    Action {
        id: "device.download-mcl",
        title: "Download MCL",
        place: place(Menu::Device, 4),
        keys: key(Key::F5),
        help: "Downloads the MCL program to the controller's flash memory.",
        ready: |model| has(model, Ability::Scripts, can_download),
        is_on: None,
        command: |_| Command::DownloadMcl,
    },
    Action {
        id: "device.download-image",
        title: "Download the Maker's Image File…",
        place: place(Menu::Device, 4),
        keys: Keys::None,
        help: "Downloads a script that the maker's own program has compiled, for real controllers.",
        ready: |model| has(model, Ability::Scripts, connected),
        is_on: None,
        command: |_| Command::Mcl(MclAction::ChooseImage),
    },
    Action {
        id: "device.start-script",
        title: "Start Script",
        place: place(Menu::Device, 4),
        keys: Keys::None,
        help: "Starts the program that is in the controller.",
        ready: |model| has(model, Ability::Scripts, can_start_script),
        is_on: None,
        command: |_| Command::StartScript,
    },
    Action {
        id: "device.stop-script",
        title: "Stop Script",
        place: place(Menu::Device, 4),
        keys: Keys::None,
        help: "Stops the program that runs in the controller.",
        ready: |model| has(model, Ability::Scripts, connected),
        is_on: None,
        command: |_| Command::StopScript,
    },
    Action {
        id: "device.zero-m1",
        title: "Zero Encoder M1",
        place: place(Menu::Device, 5),
        keys: Keys::None,
        help: "Sets the count of encoder 1 to zero.",
        ready: connected,
        is_on: None,
        command: |_| Command::ZeroEncoder(Motor::M1),
    },
    Action {
        id: "device.zero-m2",
        title: "Zero Encoder M2",
        place: place(Menu::Device, 5),
        keys: Keys::None,
        help: "Sets the count of encoder 2 to zero.",
        ready: |model| has(model, Ability::SecondMotor, connected),
        is_on: None,
        command: |_| Command::ZeroEncoder(Motor::M2),
    },
    Action {
        id: "device.reset-estop",
        title: "Reset Emergency Stop (E-Stop)",
        place: place(Menu::Device, 5),
        keys: Keys::None,
        help: "Ends an emergency stop where the controller lets software do so.",
        ready: |model| has(model, Ability::EmergencyStop, connected),
        is_on: None,
        command: |_| Command::ResetEmergencyStop,
    },
];

/// What has to be so, unless the controller in front is of a family that lacks the thing altogether.
fn has(model: &Model, ability: Ability, ready: fn(&Model) -> Ready) -> Ready {
    match model.front.family().lacks(ability) {
        Some(why) => Err(why.into()),
        None => ready(model),
    }
}

/// Guided tuning of a loop: the mode of the controller may leave it no such loop.
fn has_loop(model: &Model, screen: Screen) -> Ready {
    connected(model)?;
    match model.front.screens().contains(&screen) {
        true => Ok(()),
        false => Err("This controller has no such loop as it is set.".into()),
    }
}

fn can_tune(model: &Model) -> Ready {
    connected(model)?;
    let Some(which) = Loop::of(model.screen) else {
        return Err("Tuning is on the Velocity and Position screens.".into());
    };
    if let Some(why) = model.front.cannot_tune() {
        return Err(why.into());
    }
    if model.front.is_guided() {
        return Err("A job moves the motors already.".into());
    }
    if model.front.link.arming.is_armed_for(which.scope()) {
        Ok(())
    } else {
        Err("Arm this screen first.".into())
    }
}

fn can_arm(model: &Model) -> Ready {
    connected(model)?;
    match model.arm_scope() {
        Some(_) => Ok(()),
        None => {
            Err("This screen moves no motor. Go to the PWM, Velocity, Position or MCL screen first.".into())
        }
    }
}

fn can_download(model: &Model) -> Ready {
    connected(model)?;
    match model.front.script.is_running() {
        true => Err("A download runs already. Wait for it or cancel it.".into()),
        false => Ok(()),
    }
}

/// A script can move motors, so starting one is a motion.
fn can_start_script(model: &Model) -> Ready {
    connected(model)?;
    if model.front.link.arming.is_armed_for(ArmScope::Script) {
        return Ok(());
    }
    Err("A script can move motors. Arm the MCL Editor screen first.".into())
}

fn arm_or_disarm(model: &Model) -> Command {
    match model.arm_scope() {
        Some(scope) if model.front.link.arming == Arming::Disarmed => Command::Arm(scope),
        _ => Command::Disarm,
    }
}

fn has_link(model: &Model) -> Ready {
    match model.front.phase {
        Phase::Open { .. } | Phase::Opening { .. } => Ok(()),
        Phase::Closed | Phase::Closing { .. } => Err("No link is open.".into()),
    }
}

fn has_others(model: &Model) -> Ready {
    if model.others.is_empty() { Err("No other device is open.".into()) } else { Ok(()) }
}

fn has_changes(model: &Model) -> Ready {
    settings_idle(model)?;
    let has = model.front.settings.unit().is_some_and(|unit| !unit.edits().is_empty());
    if has { Ok(()) } else { Err("No setting was edited.".into()) }
}
