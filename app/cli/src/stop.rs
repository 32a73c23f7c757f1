//! `brushwork stop`: all motors on a line off, at once, and what could still drive them.
//!
//! The stop goes out before anybody is looked for, to whoever may be there; then the units are found and each is asked to confirm.

use crate::messages::{CliLinkMessage, CliStopMessage};
use std::time::{Duration, Instant};

use brushwork_link::device::{Addresses, DeviceHandle, Event, Identity, PollRate, StopReport, UnitStop};
use brushwork_link::transport::ConnectTarget;
use brushwork_link::{FamilyChoice, Message, SystemClock};
use serde_json::{Value, json};

use super::addresses::{Line, in_words};
use super::args::StopArgs;
use super::client::{self, CONNECT_LIMIT};
use super::{Exit, Interrupt, Output, OutputError, family, say};
use brushwork_core::session::{self, Session, SessionOptions};
use brushwork_core::stop::{matters, place};

/// How long the controllers may take to confirm: late replies at 2400 bit/s take 6 s.
const STOP_LIMIT: Duration = Duration::from_secs(10);

/// Stops the lines, all at once, and prints what became of each.
pub fn run(args: &StopArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let lines: Vec<Line<'_>> = args.line.lines().collect();
    let stopped = stop_lines(&lines, interrupt);
    if let [one] = stopped.as_slice() {
        let stopped = one.as_ref().map_err(|exit| *exit)?;
        let printed = if args.json { out.json(&stopped.to_json()) } else { stopped.print(out) };
        printed?;
        return Ok(stopped.exit());
    }
    let mut objects = Vec::new();
    let mut worst = Exit::Done;
    for (line, stopped) in lines.iter().zip(&stopped) {
        let exit = stopped.as_ref().map_or_else(|exit| *exit, LineStop::exit);
        worst = worst.or_worse(exit);
        match stopped {
            Ok(stopped) if !args.json => stopped.print(out)?,
            Ok(_) => {}
            Err(_) => say(CliLinkMessage::NotStoppedAt { place: line.connect.to_owned() }),
        }
        let result = stopped.as_ref().ok().map(LineStop::to_json);
        objects.push(json!({ "connect": line.connect, "exit_code": exit as u8, "result": result }));
    }
    if args.json {
        out.json(&objects)?;
    }
    Ok(worst)
}

/// A thread for each line, so that none waits for the replies of another.
fn stop_lines(lines: &[Line<'_>], interrupt: &Interrupt) -> Vec<Result<LineStop, Exit>> {
    std::thread::scope(|scope| {
        let stop = |line| move || stop_line(line, interrupt);
        let start =
            |line| std::thread::Builder::new().name("stop".to_owned()).spawn_scoped(scope, stop(line));
        let begun: Vec<_> = lines.iter().map(start).collect();
        let ended = lines.iter().zip(begun).map(|(line, thread)| match thread {
            Ok(thread) => thread.join().unwrap_or(Err(Exit::Failed)),
            // Without a thread it is this one's turn.
            Err(_) => stop_line(line, interrupt),
        });
        ended.collect()
    })
}

/// Stops what else is on a line, after its own unit was stopped, and says on standard error what became of it. Nobody else there is
/// nothing to speak of.
pub fn stop_the_rest(line: &Line<'_>, own: &Identity) {
    let Ok(stopped) = stop_line(line, &Interrupt::default()) else { return };
    for unit in stopped.report.units.iter().filter(|unit| unit.address != own.address && unit.confirmed) {
        say(stopped.sentence(unit));
    }
    stopped.warnings().into_iter().for_each(say);
}

/// What became of the stop of a line.
struct LineStop {
    units: Vec<Identity>,
    report: StopReport,
    asked: Addresses,
    /// From the request to the last byte handed to the port.
    latency: Duration,
}

fn stop_line(line: &Line<'_>, interrupt: &Interrupt) -> Result<LineStop, Exit> {
    let target = client::line_target(line)?;
    let asked = match line.sought() {
        // No other is told anything, where one is named too.
        Addresses::Only(number) => Addresses::These([number].into_iter().collect()),
        sought @ (Addresses::Scan | Addresses::These(_) | Addresses::Factory) => sought,
    };
    let open = |family| {
        let options = SessionOptions { addresses: asked, poll: PollRate::Off, family };
        session::open(&target, options, SystemClock::shared(), None)
            .map_err(|error| Exit::NoLink.saying(error))
    };
    let on_can = matches!(target, ConnectTarget::Can { .. });
    let mut session = open(line.family)?;
    let mut found = stop_and_find(&session, on_can, interrupt)?;
    let named = if target.family() == FamilyChoice::AUTO { line.family } else { target.family() };
    let is_unknown = || !on_can && session::family_at(&target, named) == FamilyChoice::AUTO;
    if found.is_err() && asked == Addresses::Scan && is_unknown() {
        // When the line was opened it was not searched for all units that these families can have on it.
        for family in family::families().iter().filter(|family| family.stopped_addresses().is_empty()) {
            if found.is_err() {
                drop(session);
                session = open(FamilyChoice::of(family.family()))?;
                found = stop_and_find(&session, on_can, interrupt)?;
            }
        }
    }
    let (units, first) = found.map_err(|sentence| {
        say(sentence);
        if !on_can {
            say(CliLinkMessage::NotConfirmedByAll);
        }
        client::with_loader(Exit::NoLink, line.connect)
    })?;
    if on_can {
        session.device.stop_all();
    }
    let report = wait_for_report(&session.device)?;
    let latency = first.as_ref().unwrap_or(&report).latency();
    Ok(LineStop { units, report, asked, latency })
}

/// Who is on the line, and the report of the stop that went out before; or a sentence on why nobody was found.
type Found = Result<(Vec<Identity>, Option<StopReport>), String>;

/// Has the stop written at once, and finds the units. On a CAN bus the nodes are found first: there are others than controllers
/// there, to which a stop would be a write to some object of their own.
fn stop_and_find(session: &Session, on_can: bool, interrupt: &Interrupt) -> Result<Found, Exit> {
    let device = &session.device;
    if !on_can {
        device.stop_all();
    }
    let (mut units, mut first) = (Vec::new(), None);
    let deadline = Instant::now() + CONNECT_LIMIT;
    while Instant::now() < deadline {
        match client::look_for_event(device, interrupt)? {
            Ok(Some(Event::Connected(identity))) => units.push(identity),
            Ok(Some(Event::Stopped(report))) if units.is_empty() => first = first.or(Some(report)),
            Ok(Some(Event::Selected { .. })) => return Ok(Ok((units, first))),
            Ok(Some(Event::Failure(failure))) => say(failure.to_string()),
            Ok(_) => {}
            Err(failure) => return Ok(Err(failure.to_string())),
        }
    }
    Ok(Err(format!("No controller identified itself within {} s.", CONNECT_LIMIT.as_secs())))
}

/// Waits for the stop that was asked for; a signal does not cut this short, since it ends by itself.
fn wait_for_report(device: &DeviceHandle) -> Result<StopReport, Exit> {
    let deadline = Instant::now() + STOP_LIMIT;
    let deaf = Interrupt::default();
    while Instant::now() < deadline {
        if let Some(Event::Stopped(report)) = client::next_event(device, &deaf)? {
            return Ok(report);
        }
    }
    Err(Exit::Refused.saying(CliLinkMessage::NotConfirmed { seconds: STOP_LIMIT.as_secs() }))
}

/// Stops what a command has set in motion, and says what is not plainly stopped. A signal does not cut this short.
///
/// # Errors
/// The stop was not confirmed, or a loop was left off, so that nothing holds the motor now.
pub fn stop_driven(device: &DeviceHandle, identity: &Identity) -> Result<(), Exit> {
    device.stop_all();
    let report = wait_for_report(device)?;
    matters(&report, std::slice::from_ref(identity)).into_iter().for_each(|(_, text)| say(text));
    if report.confirmed() && !report.left_a_loop_off() { Ok(()) } else { Err(Exit::Refused) }
}

impl LineStop {
    fn exit(&self) -> Exit {
        match (self.report.confirmed(), self.asked) {
            (false, _) => Exit::Refused,
            (true, Addresses::These(_)) if !self.silent().is_empty() => Exit::NoLink,
            (true, _) => Exit::Done,
        }
    }

    fn is_of_nodes(&self) -> bool {
        self.units.iter().any(Identity::is_node)
    }

    /// The addresses that the stop was written to, where they were not asked for.
    fn written_to(&self) -> Vec<u8> {
        let unit = self.units.first().filter(|_| !self.is_of_nodes());
        unit.map_or_else(Vec::new, |unit| family::of(unit.family).stopped_addresses())
    }

    /// The addresses at which nobody answered: of those that were asked for, or of all that the stop was written to.
    fn silent(&self) -> Vec<u8> {
        let answered = |address: &u8| {
            self.units.iter().any(|unit| unit.address == *address || unit.also_answers.contains(address))
        };
        let asked: Vec<u8> = match self.asked {
            Addresses::These(set) => set.iter().collect(),
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => self.written_to(),
        };
        asked.into_iter().filter(|address| !answered(address)).collect()
    }

    fn sentence(&self, unit: &UnitStop) -> String {
        let identity = self.units.iter().find(|identity| identity.address == unit.address);
        let buffers = match unit.buffers_empty {
            Some(true) => ", buffers empty",
            Some(false) => ", buffers not empty",
            None => "",
        };
        let one_motor = identity.is_some_and(|identity| identity.capabilities().motors == 1);
        format!(
            "{}: {}{buffers} ({:.2} ms to the wire).",
            place(&self.units, unit.address),
            if one_motor { "motor stopped" } else { "both motors stopped" },
            self.latency.as_secs_f64() * 1e3
        )
    }

    /// What is not plainly stopped, and what was not reached.
    fn warnings(&self) -> Vec<Message> {
        let matters = matters(&self.report, &self.units).into_iter();
        let mut lines: Vec<Message> = matters.map(|(_, text)| text).collect();
        let silent = self.silent();
        match self.asked {
            Addresses::These(_) if !silent.is_empty() => {
                lines.push(CliStopMessage::NotHeard { addresses: in_words(&silent) }.into());
            }
            Addresses::These(_) => {}
            _ if self.is_of_nodes() => lines.push(CliStopMessage::OtherNodes.into()),
            _ if self.written_to().is_empty() => lines.push(CliStopMessage::Broadcast.into()),
            _ if !silent.is_empty() => {
                lines.push(CliStopMessage::Silent { addresses: in_words(&silent) }.into());
            }
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => {}
        }
        lines
    }

    fn print(&self, out: &mut Output) -> Result<(), OutputError> {
        let confirmed = self.report.units.iter().filter(|unit| unit.confirmed);
        out.lines(confirmed.map(|unit| self.sentence(unit)))?;
        self.warnings().into_iter().for_each(say);
        Ok(())
    }

    fn to_json(&self) -> Value {
        let model = |address| self.units.iter().find(|unit| unit.address == address).map(Identity::title);
        let units: Vec<_> = self
            .report
            .units
            .iter()
            .map(|unit| {
                json!({
                    "address": unit.address,
                    "model": model(unit.address),
                    "confirmed": unit.confirmed,
                    "buffers_empty": unit.buffers_empty,
                    "still_driven_by": unit.still_driven_by,
                    "failures": unit.failures,
                })
            })
            .collect();
        json!({
            "confirmed": self.report.confirmed(),
            "latency_s": self.latency.as_secs_f64(),
            "units": units,
            "no_answer_from": self.silent(),
        })
    }
}
