//! `brushwork firmware update`: backup, risk, loader, pages.

use crate::messages::{CliFirmwareMessage, CliScriptMessage};
use brushwork_core::addresses;
use brushwork_core::messages::CoreStatusMessage;
use brushwork_link::work::receive_within;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use brushwork_link::device::{PollRate, RiskAccepted};
use brushwork_link::{ConnectTarget, Event, Request};
use brushwork_mcp_client::firmware::{Firmware, Progress, RESUME_NOTE, Sent, risks, suit, suit_model};
use brushwork_mcp_wire::loader::Image;
use brushwork_mcp_wire::models;
use crossbeam_channel::RecvTimeoutError;

use super::args::UpdateArgs;
use crate::settings::controller::Controller;
use crate::settings::{ask, backups};
use crate::{Exit, Interrupt, NewFile, Output, client, say};
use brushwork_core::keep::{OpenUpdate, Store};
use brushwork_core::session::Simulation;
use brushwork_core::session::firmware::{LoaderPlace, Upload, UploadEvent};
use brushwork_core::update::{self, Expected, Kept};
use brushwork_link::bounded;

/// How long the controller may take to stop its motors and enter the loader.
const ENTER_LIMIT: Duration = Duration::from_secs(60);
/// How long one look at the events waits.
const SLICE: Duration = Duration::from_millis(50);

/// Updates, or resumes an update.
pub fn run(args: &UpdateArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let target = client::target(&args.connect)?;
    let bytes = bounded::read_file(&args.file).map_err(|error| {
        Exit::Failed.saying(CliScriptMessage::NotRead {
            file: args.file.display().to_string(),
            error: error.to_string(),
        })
    })?;
    if args.resume {
        let image = resumed_image(args, bytes, &target)?;
        accept(args, is_simulated(args, &target), &|| interrupt.breathe())?;
        interrupt.hold_line();
        let announced = image.simulated().map(|simulated| simulated.version);
        let expected = Expected::resumed(&Store::of_user(), args.connect.place(), announced);
        let sent = send(LoaderPlace::of(&target, None), image, interrupt)?;
        return verify(&sent, &expected, None, args, out, interrupt);
    }
    if let Some(path) = &args.backup {
        backup_file(path, args).check()?;
    }
    let controller = Controller::connect(&args.connect, interrupt)?;
    let image = fresh_image(args, bytes, &controller)?;
    accept(args, is_simulated(args, &target), &|| controller.breathe())?;
    let kept = back_up(args, &controller, out)?;
    let simulation = controller.client.simulation();
    let place = LoaderPlace::of(&target, simulation.clone());
    if simulation.is_none() {
        note(args, &controller, &kept)?;
    }
    let expected = Expected {
        before: Some(controller.identity().version_text.clone()),
        announced: image.simulated().map(|simulated| simulated.version),
        kept: Some(kept),
    };
    enter_loader(&controller, interrupt)?;
    drop(controller);
    let sent = send(place, image, interrupt)?;
    verify(&sent, &expected, simulation, args, out, interrupt)
}

/// Keeps that an update was begun here, so that a silent controller is known for what it is.
fn note(args: &UpdateArgs, controller: &Controller<'_>, kept: &Kept) -> Result<(), Exit> {
    let begun = OpenUpdate {
        place: args.connect.place().to_owned(),
        model: kept.profile.subject.model.key.to_owned(),
        before: controller.identity().version_text.trim().to_owned(),
        file: args.file.clone(),
        backup: kept.name.clone(),
    };
    Store::of_user()
        .open_update(&begun)
        .map_err(|error| Exit::Failed.saying(CliFirmwareMessage::NotSentFor { why: error.to_string() }))
}

/// The image for a controller that has told who it is.
fn fresh_image(args: &UpdateArgs, bytes: Vec<u8>, controller: &Controller<'_>) -> Result<Image, Exit> {
    let mut identity = controller.identity().clone();
    identity.simulated |= args.simulated;
    let model = models::identify(&identity.version_text);
    suit(bytes, &identity, model, controller.client.stream).map_err(|error| not_sent(args, &error))
}

/// The image for a controller that cannot tell who it is any more.
fn resumed_image(args: &UpdateArgs, bytes: Vec<u8>, target: &ConnectTarget) -> Result<Image, Exit> {
    let name = args.model.as_deref().unwrap_or_default();
    let Some(model) = models::lookup(name) else {
        return Err(Exit::Usage.saying(CliFirmwareMessage::NoModel { name: name.to_string() }));
    };
    suit_model(bytes, model, is_simulated(args, target)).map_err(|error| not_sent(args, &error))
}

fn not_sent(args: &UpdateArgs, why: &dyn std::fmt::Display) -> Exit {
    Exit::Refused.saying(CliFirmwareMessage::FileNotSent {
        file: args.file.display().to_string(),
        why: why.to_string(),
    })
}

fn is_simulated(args: &UpdateArgs, target: &ConnectTarget) -> bool {
    args.simulated || matches!(target, ConnectTarget::Sim(_))
}

/// Shows the risks and waits until they are accepted.
fn accept(args: &UpdateArgs, simulated: bool, breathe: &dyn Fn() -> Result<(), Exit>) -> Result<(), Exit> {
    say(CliFirmwareMessage::ReadThis);
    for risk in risks(simulated) {
        say(CliFirmwareMessage::Risk { risk: risk.to_string() });
    }
    if args.resume {
        say(CliFirmwareMessage::Risk { risk: RESUME_NOTE.to_string() });
    }
    if args.accept_risk {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        return Err(Exit::Refused.saying(CliFirmwareMessage::AcceptRisk));
    }
    let _ = write!(io::stderr(), "Type \"update\" to accept these risks: ");
    if ask::line(breathe)?.trim() == "update" {
        return Ok(());
    }
    Err(Exit::Refused.saying(CliFirmwareMessage::NotSent))
}

fn backup_file<'p>(path: &'p Path, args: &UpdateArgs) -> NewFile<'p> {
    NewFile::new(path, args.replace).apart_from(&args.file)
}

/// Reads the settings into a profile. Without a whole backup nothing is erased.
fn back_up(args: &UpdateArgs, controller: &Controller<'_>, out: &mut Output) -> Result<Kept, Exit> {
    let report = controller.read()?;
    let exit = if report.is_whole() { Exit::Failed } else { Exit::Refused };
    let kept = update::keep(&report, controller.identity(), &controller.unit, &Store::of_user())
        .map_err(|why| exit.saying(CliFirmwareMessage::NotSentFor { why: why.to_string() }))?;
    let profile = &kept.profile;
    let model = profile.subject.model.key;
    let path = args.backup.clone().unwrap_or_else(|| {
        // Colons do not go into file names everywhere. Of several controllers each has its own.
        let address =
            args.connect.address.as_ref().map(|_| format!("{}-", addresses::name(profile.address.get())));
        let of_unit = address.unwrap_or_default();
        let name = format!("backup-{model}-{of_unit}{}.json", profile.date.replace(':', ""));
        args.file.parent().unwrap_or_else(|| Path::new("")).join(name)
    });
    backup_file(&path, args)
        .write(profile.to_json().as_bytes())
        .map_err(|error| Exit::Failed.saying(CliFirmwareMessage::NotSentFor { why: error.to_string() }))?;
    out.line(format!("The settings are backed up in {}.", path.display()))?;
    Ok(kept)
}

/// Stops the motors and sends the controller into its loader; ends the link.
fn enter_loader(controller: &Controller<'_>, interrupt: &Interrupt) -> Result<(), Exit> {
    let request = Request::EnterLoader(RiskAccepted::by_the_user());
    controller.device().request(request).map_err(|refused| {
        Exit::Refused.saying(CliFirmwareMessage::NotEntered { refused: refused.to_string() })
    })?;
    let deadline = Instant::now() + ENTER_LIMIT;
    while Instant::now() < deadline {
        match client::next_event(controller.device(), interrupt)? {
            Some(Event::LoaderEntered) => return Ok(()),
            Some(Event::Failure(failure)) => return Err(Exit::Refused.saying(failure)),
            _ => {}
        }
    }
    Err(Exit::NoLink.saying(CliFirmwareMessage::LoaderLate))
}

/// Sends it and shows how far it is, until it ends. Ctrl-C counts only before the erase.
fn send(place: LoaderPlace, image: Image, interrupt: &Interrupt) -> Result<Sent, Exit> {
    let upload = Upload::start(place, Firmware(image))
        .map_err(|why| Exit::Failed.saying(CoreStatusMessage::Because { why: why.into() }))?;
    let mut shown = String::new();
    let mut warned = false;
    let mut erasing = false;
    loop {
        if interrupt.is_raised() && !warned {
            warned = true;
            upload.cancel();
            if erasing {
                say(CliFirmwareMessage::GoesOn);
            }
        }
        match receive_within(upload.events(), SLICE) {
            Ok(UploadEvent::Progress(progress)) => {
                erasing |= !progress.is_harmless();
                tell(progress, &mut shown);
            }
            Ok(UploadEvent::Ended(Ok(sent))) => return Ok(sent),
            Ok(UploadEvent::Ended(Err(failure))) => {
                say(CliFirmwareMessage::Failed { failure });
                // Before the erase a signal ends it; nothing else has that code.
                return Err(if warned && !erasing { Exit::Interrupted } else { Exit::NoLink });
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Exit::Failed.saying(CliFirmwareMessage::InternalError));
            }
        }
    }
}

/// One line for each step, and for each tenth of the pages.
fn tell(progress: Progress, shown: &mut String) {
    let line = match progress {
        Progress::Greeting => "Waiting for the loader.".to_owned(),
        Progress::Erasing => "Erasing. Do not switch anything off.".to_owned(),
        Progress::Writing { pages, of } => {
            let tenths = (pages * 10).checked_div(of).unwrap_or(0);
            format!("Writing: page {} of {of} ({} %).", of * tenths / 10, tenths * 10)
        }
    };
    if line != *shown {
        say(&line);
        *shown = line;
    }
}

/// Waits for the controller, and compares its version and its settings with those of before.
fn verify(
    sent: &Sent,
    expected: &Expected,
    simulation: Option<Arc<Simulation>>,
    args: &UpdateArgs,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    out.line(sent.sentence())?;
    say(CliFirmwareMessage::Waiting);
    let target = client::target(&args.connect)?;
    let options = client::options(&target, &args.connect, PollRate::Off);
    let back = update::wait_for_return(&target, options, simulation.as_ref(), &|| !interrupt.is_raised());
    if let Err(why) = back {
        if interrupt.is_raised() {
            return Err(Exit::Interrupted);
        }
        say(CliFirmwareMessage::NotBack { why: why.to_string() });
        return Err(client::with_loader(Exit::NoLink, args.connect.place()));
    }
    let controller = Controller::connect_to(&args.connect, simulation, interrupt)?;
    let verdict = expected.verdict(controller.identity());
    out.line(verdict.sentence())?;
    let exit = if verdict.is_good() { Exit::Done } else { Exit::NotTaken };
    let Some(kept) = &expected.kept else { return Ok(exit) };
    let compared = kept.compare(&controller.read_quietly()?);
    out.line(compared.sentence())?;
    out.lines(compared.differences.iter().map(|line| format!("  {line}")))?;
    if compared.differences.is_empty() {
        return Ok(exit);
    }
    let restored = restore(&controller, kept, args, out)?;
    Ok(if exit == Exit::Done { restored } else { exit })
}

/// Writes the backup back where that is wanted; else says how.
fn restore(
    controller: &Controller<'_>,
    kept: &Kept,
    args: &UpdateArgs,
    out: &mut Output,
) -> Result<Exit, Exit> {
    let question = "Write the settings of the backup back and save them?";
    let is_wanted =
        args.restore || (io::stdin().is_terminal() && ask::agreed(question, false, controller).is_ok());
    if !is_wanted {
        out.line(format!(
            "To write them back: brushwork settings restore {} --save --connect {}",
            kept.name,
            args.connect.place()
        ))?;
        return Ok(Exit::Different);
    }
    backups::write_back(controller, &kept.name, out)
}
