//! `brushwork firmware update`: backup, risk, loader, pages.

use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use brushwork_link::device::RiskAccepted;
use brushwork_link::{ConnectTarget, Event, Request};
use brushwork_mcp_client::firmware::{Progress, RESUME_NOTE, Sent, risks, suit, suit_model};
use brushwork_mcp_wire::loader::Image;
use brushwork_mcp_wire::models;
use crossbeam_channel::RecvTimeoutError;

use super::args::UpdateArgs;
use crate::settings::ask;
use crate::settings::controller::Controller;
use crate::{Exit, Interrupt, NewFile, Output, client, say};
use brushwork_core::keep::Store;
use brushwork_core::session::firmware::{LoaderPlace, Upload, UploadEvent};

/// How long the controller may take to stop its motors and enter the loader.
const ENTER_LIMIT: Duration = Duration::from_secs(60);
/// How long one look at the events waits.
const SLICE: Duration = Duration::from_millis(50);

/// Updates, or resumes an update.
pub fn run(args: &UpdateArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let target = client::target(&args.connect)?;
    let bytes = std::fs::read(&args.file)
        .map_err(|error| Exit::Failed.saying(format!("Could not read {}: {error}.", args.file.display())))?;
    if args.resume {
        let image = resumed_image(args, bytes, &target)?;
        accept(args, is_simulated(args, &target), &|| interrupted(interrupt))?;
        let sent = send(LoaderPlace::of(&target, None), image, interrupt)?;
        return done(&sent, None, args, out);
    }
    if let Some(path) = &args.backup {
        backup_file(path, args).check()?;
    }
    let controller = Controller::connect(&args.connect, interrupt)?;
    let image = fresh_image(args, bytes, &controller)?;
    accept(args, is_simulated(args, &target), &|| controller.breathe())?;
    let backup = back_up(args, &controller, out)?;
    let place = LoaderPlace::of(&target, controller.client.simulation());
    enter_loader(&controller, interrupt)?;
    let sent = send(place, image, interrupt)?;
    done(&sent, Some(&backup), args, out)
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
        return Err(Exit::Usage.saying(format!("\"{name}\" is no model. `brushwork sim --list` names them.")));
    };
    suit_model(bytes, model, is_simulated(args, target)).map_err(|error| not_sent(args, &error))
}

fn not_sent(args: &UpdateArgs, why: &dyn std::fmt::Display) -> Exit {
    Exit::Refused.saying(format!("{} is not sent: {why}.", args.file.display()))
}

fn is_simulated(args: &UpdateArgs, target: &ConnectTarget) -> bool {
    args.simulated || matches!(target, ConnectTarget::Sim(_))
}

/// Shows the risks and waits until they are accepted.
fn accept(args: &UpdateArgs, simulated: bool, breathe: &dyn Fn() -> Result<(), Exit>) -> Result<(), Exit> {
    say("Before you update, read this:");
    for risk in risks(simulated) {
        say(format!("  - {risk}"));
    }
    if args.resume {
        say(format!("  - {RESUME_NOTE}"));
    }
    if args.accept_risk {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        return Err(Exit::Refused.saying(
            "Nobody can be asked here: give --accept-risk to update all the same. Nothing was sent.",
        ));
    }
    let _ = write!(io::stderr(), "Type \"update\" to accept these risks: ");
    if ask::line(breathe)?.trim() == "update" {
        return Ok(());
    }
    Err(Exit::Refused.saying("Nothing was sent."))
}

fn interrupted(interrupt: &Interrupt) -> Result<(), Exit> {
    if interrupt.sleep(SLICE) { Err(Exit::Interrupted) } else { Ok(()) }
}

fn backup_file<'p>(path: &'p Path, args: &UpdateArgs) -> NewFile<'p> {
    NewFile::new(path, args.replace).apart_from(&args.file)
}

/// Reads the settings into a profile. Without a whole backup nothing is erased.
fn back_up(args: &UpdateArgs, controller: &Controller<'_>, out: &mut Output) -> Result<PathBuf, Exit> {
    let report = controller.read()?;
    let exit = if report.is_whole() { Exit::Failed } else { Exit::Refused };
    let (profile, _) = Store::of_user()
        .back_up_for_firmware(&controller.unit, controller.identity(), &report)
        .map_err(|error| exit.saying(format!("{error} Nothing was sent.")))?;
    let model = profile.subject.model.key;
    let path = args.backup.clone().unwrap_or_else(|| {
        // Colons do not go into file names everywhere.
        let name = format!("backup-{model}-{}.json", profile.date.replace(':', ""));
        args.file.parent().unwrap_or_else(|| Path::new("")).join(name)
    });
    backup_file(&path, args)
        .write(profile.to_json().as_bytes())
        .map_err(|error| Exit::Failed.saying(format!("{error} Nothing was sent.")))?;
    out.line(format!("The settings are backed up in {}.", path.display()))?;
    Ok(path)
}

/// Stops the motors and sends the controller into its loader; ends the link.
fn enter_loader(controller: &Controller<'_>, interrupt: &Interrupt) -> Result<(), Exit> {
    let request = Request::EnterLoader(RiskAccepted::by_the_user());
    controller
        .device()
        .request(request)
        .map_err(|refused| Exit::Refused.saying(format!("Could not enter the firmware loader: {refused}")))?;
    let deadline = Instant::now() + ENTER_LIMIT;
    while Instant::now() < deadline {
        match client::next_event(controller.device(), interrupt)? {
            Some(Event::LoaderEntered) => return Ok(()),
            Some(Event::Failure(failure)) => return Err(Exit::Refused.saying(failure)),
            _ => {}
        }
    }
    Err(Exit::NoLink.saying(
        "Could not enter the firmware loader: the controller did not get there in time. Nothing was erased.",
    ))
}

/// Sends it and shows how far it is, until it ends. Ctrl-C counts only before the erase.
fn send(place: LoaderPlace, image: Image, interrupt: &Interrupt) -> Result<Sent, Exit> {
    let upload = Upload::start(place, image).map_err(|why| Exit::Failed.saying(format!("{why}.")))?;
    let mut shown = String::new();
    let mut warned = false;
    let mut erasing = false;
    loop {
        if interrupt.is_raised() && !warned {
            warned = true;
            upload.cancel();
            if erasing {
                say(
                    "\nThe update cannot be stopped now: the controller would be left without firmware. It goes on.",
                );
            }
        }
        match upload.events().recv_timeout(SLICE) {
            Ok(UploadEvent::Progress(progress)) => {
                erasing |= !progress.is_harmless();
                tell(progress, &mut shown);
            }
            Ok(UploadEvent::Ended(Ok(sent))) => return Ok(sent),
            Ok(UploadEvent::Ended(Err(failure))) => {
                say(format!("\n{failure}"));
                // Before the erase a signal ends it; nothing else has that code.
                return Err(if warned && !erasing { Exit::Interrupted } else { Exit::NoLink });
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(
                    Exit::Failed.saying("Could not send the firmware: an internal error. Please report it.")
                );
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

fn done(sent: &Sent, backup: Option<&Path>, args: &UpdateArgs, out: &mut Output) -> Result<Exit, Exit> {
    out.line(format!("{} The controller restarts.", sent.sentence()))?;
    let connect = &args.connect.connect;
    if let Some(backup) = backup {
        let backup = backup.display();
        out.line(format!(
            "Then compare the settings with the backup, and restore them if you need to:\n  \
             brushwork settings diff {backup} --connect {connect}\n  \
             brushwork settings import {backup} --connect {connect}"
        ))?;
    }
    Ok(Exit::Done)
}
