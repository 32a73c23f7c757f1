//! Monitoring this program's own traffic: its polling, from the moment the controller is found.

use crate::messages::CliMonitorMessage;
use std::time::Instant;

use brushwork_link::device::{Event, PollRate, Request};

use super::args::MonitorArgs;
use super::record::{Direction, Record, print};
use crate::{Exit, Interrupt, Output, client, say};

/// Polls and prints what goes over the wire.
pub fn run(args: &MonitorArgs, out: &mut Output, interrupt: &Interrupt) -> Result<(), Exit> {
    let session = client::open(&args.connect, PollRate::DEFAULT, None)?;
    interrupt.hold_line();
    // The queue of a thread that has just started has room.
    let _ = session.device.request(Request::Trace(true));
    let start = Instant::now();
    let mut first = None;
    while args.duration.is_none_or(|duration| start.elapsed() < duration) {
        match client::next_event(&session.device, interrupt)? {
            Some(Event::Traffic { traffic, text, .. }) => {
                let at = traffic.at.saturating_sub(*first.get_or_insert(traffic.at));
                let direction =
                    if traffic.sent { Direction::ToController } else { Direction::FromController };
                print(args.json, &Record { at: Some(at), direction, bytes: traffic.bytes, text }, out)?;
            }
            Some(Event::Connected(identity)) => say(CliMonitorMessage::Watches {
                title: identity.title().to_owned(),
                unit: identity.place(),
                port: identity.port.clone(),
                generation: identity.generation,
            }),
            Some(Event::Failure(failure)) => say(failure.to_string()),
            _ => {}
        }
    }
    Ok(())
}
