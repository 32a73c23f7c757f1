//! `brushwork script start` and `stop`.
//!
//! Starting needs arming, as driving does, and the arming is this loop's: a terminal that hangs ends the script too.

use crate::messages::CliScriptMessage;
use std::time::{Duration, Instant};

use brushwork_link::device::{ArmScope, DisarmReason, Event, Request};

use super::args::{StartArgs, StopArgs};
use super::download;
use crate::client::{arm, ask};
use crate::settings::controller::Controller;
use crate::stop::stop_driven;
use crate::{Exit, Interrupt, say};

/// Downloads if asked to, arms, starts, waits, stops.
pub fn start(args: &StartArgs, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let image = args.file.as_deref().map(download::image_of).transpose()?;
    let controller = Controller::connect(&args.connect, interrupt)?;
    controller.announce();
    if let Some(image) = image {
        download::to_controller(&controller, image, args.simulated)?;
    }
    arm(controller.device(), ArmScope::Script, interrupt)?;
    let ran = run(&controller, args.duration);
    if ran != Err(Exit::NoLink) {
        stop_driven(controller.device(), controller.identity())?;
    }
    ran
}

/// Stops the script and the motors.
pub fn stop(args: &StopArgs, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    controller.announce();
    stop_driven(controller.device(), controller.identity())?;
    Ok(Exit::Done)
}

fn run(controller: &Controller<'_>, duration: Option<Duration>) -> Result<Exit, Exit> {
    ask(controller.device(), Request::StartScript)?;
    let begun_at = Instant::now();
    while duration.is_none_or(|duration| begun_at.elapsed() < duration) {
        controller.device().renew();
        match controller.next_event()? {
            Some(Event::Failure(failure)) => return Err(Exit::Refused.saying(failure)),
            Some(Event::Disarmed(reason)) => {
                // That of another program is said once it has come to its end.
                if reason != DisarmReason::StopFromOutside {
                    say(CliScriptMessage::Stopping { reason: reason.to_string() });
                }
                return Err(if reason == DisarmReason::LinkLost { Exit::NoLink } else { Exit::Refused });
            }
            _ => {}
        }
    }
    Ok(Exit::Done)
}
