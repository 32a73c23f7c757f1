//! `brushwork script start` and `stop`.
//!
//! Starting needs arming, as driving does, and the arming is this loop's: a terminal that hangs ends the script too.

use crate::messages::{CliScriptMessage, CliUnitsMessage};
use std::time::{Duration, Instant};

use brushwork_link::PollRate;
use brushwork_link::device::{ArmScope, DisarmReason, Event, Request};

use super::args::{StartArgs, StopArgs};
use super::download;
use crate::client::{arm_all, ask, event_of};
use crate::joined::{self, JoinedLine};
use crate::stop::stop_all_driven;
use crate::{ConnectArgs, Exit, Interrupt, say};

/// Downloads if asked to, arms, starts, waits, stops. Several controllers, also on several lines, do it together: all of them or none.
pub fn start(args: &StartArgs, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let image = args.file.as_deref().map(download::image_of).transpose()?;
    let lines = open(&args.connect, interrupt)?;
    if let Some(image) = &image {
        for (line, unit) in lines.iter().flat_map(|line| line.units.iter().map(move |unit| (line, unit))) {
            if line.units.len() > 1 {
                ask(line.client.device(), Request::Select(unit.address))?;
            }
            download::to_unit(&line.client, unit, image.clone(), args.simulated, interrupt)?;
        }
    }
    lines.iter().try_for_each(JoinedLine::join)?;
    let devices: Vec<_> = lines.iter().map(|line| line.client.device()).collect();
    arm_all(&devices, ArmScope::Script, interrupt)?;
    let mut lost = None;
    let ran = run(&lines, args.duration, &mut lost, interrupt);
    // A line that is lost hears nothing any more.
    let left = lines.iter().enumerate().filter(|(index, _)| Some(*index) != lost).map(|(_, line)| line);
    ran.and(stop_lines(left)).map(|()| Exit::Done)
}

/// Stops the script and the motors.
pub fn stop(args: &StopArgs, interrupt: &Interrupt) -> Result<Exit, Exit> {
    stop_lines(open(&args.connect, interrupt)?.iter()).map(|()| Exit::Done)
}

fn open(args: &ConnectArgs, interrupt: &Interrupt) -> Result<Vec<JoinedLine>, Exit> {
    let lines = joined::open(args, PollRate::Off, interrupt)?;
    match lines.iter().find_map(|line| Some((line, line.silent()?))) {
        Some((line, addresses)) => {
            let place = line.place.clone();
            Err(Exit::NoLink.saying(CliUnitsMessage::Silent { addresses, place }))
        }
        None => Ok(lines),
    }
}

fn stop_lines<'l>(lines: impl Iterator<Item = &'l JoinedLine>) -> Result<(), Exit> {
    let links: Vec<_> = lines.map(|line| (line.client.device(), line.units.as_slice())).collect();
    stop_all_driven(&links)
}

/// Keeps the scripts running until the time is over or something ends one of them; `lost` is the line whose link is gone.
fn run(
    lines: &[JoinedLine],
    duration: Option<Duration>,
    lost: &mut Option<usize>,
    interrupt: &Interrupt,
) -> Result<(), Exit> {
    for line in lines {
        ask(line.client.device(), Request::StartScript)?;
    }
    let begun_at = Instant::now();
    while duration.is_none_or(|duration| begun_at.elapsed() < duration) {
        for (index, line) in lines.iter().enumerate() {
            lines.iter().for_each(|line| line.client.device().renew());
            let event = event_of(line.client.device(), lines.len(), interrupt);
            match event.inspect_err(|exit| *lost = (*exit == Exit::NoLink).then_some(index))? {
                Some(Event::Failure(failure)) => return Err(Exit::Refused.saying(failure)),
                Some(Event::Disarmed(reason)) => {
                    // That of another program is said once it has come to its end.
                    if reason != DisarmReason::StopFromOutside {
                        say(CliScriptMessage::Stopping { reason: reason.to_string() });
                    }
                    if reason != DisarmReason::LinkLost {
                        return Err(Exit::Refused);
                    }
                    *lost = Some(index);
                    return Err(Exit::NoLink);
                }
                _ => {}
            }
        }
    }
    Ok(())
}
