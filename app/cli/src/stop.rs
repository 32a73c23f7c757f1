//! `brushwork stop`: all motors on a line off, at once, and what could still drive them.
//!
//! A program of the same user that holds the line is asked to stop it. Otherwise the stop goes out before anybody is looked for, to whoever may be
//! there; then the units are found and each is asked to confirm.

use crate::messages::{CliLinkMessage, CliStopMessage};
use brushwork_core::addresses::in_words;
use std::time::{Duration, Instant};

use brushwork_link::device::{Addresses, DeviceHandle, Event, Identity, PollRate, StopReport};
use brushwork_link::transport::{ConnectTarget, OpenError};
use brushwork_link::{FamilyChoice, Message, SystemClock};
use serde_json::{Value, json};

use super::addresses::Line;
use super::args::StopArgs;
use super::client::{self, CONNECT_LIMIT};
use super::{Exit, Interrupt, Output, OutputError, family, say};
use brushwork_core::session::{self, Session, SessionError, SessionOptions};
use brushwork_core::stop::outside::{self, Asked, Holder};
use brushwork_core::stop::{LineStop, STOP_LIMIT, StoppedUnit, matters};

/// How long a program that has let go of a line may take to be gone, its guardian included.
const HAND_OVER_LIMIT: Duration = Duration::from_secs(2);
/// Time between two tries to open its port.
const HAND_OVER_INTERVAL: Duration = Duration::from_millis(20);

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
        let exit = stopped.as_ref().map_or_else(|exit| *exit, Stopped::exit);
        worst = worst.or_worse(exit);
        match stopped {
            Ok(stopped) if !args.json => stopped.print(out)?,
            Ok(_) => {}
            Err(_) => say(CliLinkMessage::NotStoppedAt { place: line.connect.to_owned() }),
        }
        let result = stopped.as_ref().ok().map(Stopped::to_json);
        objects.push(json!({ "connect": line.connect, "exit_code": exit as u8, "result": result }));
    }
    if args.json {
        out.json(&objects)?;
    }
    Ok(worst)
}

/// A thread for each line, so that none waits for the replies of another.
fn stop_lines(lines: &[Line<'_>], interrupt: &Interrupt) -> Vec<Result<Stopped, Exit>> {
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
    for unit in stopped.stop.units.iter().filter(|unit| unit.address != own.address && unit.confirmed) {
        say(stopped.sentence(unit));
    }
    stopped.warnings().into_iter().for_each(say);
}

/// What became of the stop of a line.
struct Stopped {
    stop: LineStop,
    asked: Addresses,
    /// The program that did it, where it was another one.
    by: Option<Holder>,
}

fn stop_line(line: &Line<'_>, interrupt: &Interrupt) -> Result<Stopped, Exit> {
    let target = client::line_target(line)?;
    let asked = match line.sought() {
        // No other is told anything, where one is named too.
        Addresses::Only(number) => Addresses::These([number].into_iter().collect()),
        sought @ (Addresses::Scan | Addresses::These(_) | Addresses::Factory) => sought,
    };
    let open = |family| {
        let options = SessionOptions { addresses: asked, poll: PollRate::Off, family };
        session::open(&target, options, SystemClock::shared(), None).inspect(|_| interrupt.hold_line())
    };
    let on_can = matches!(target, ConnectTarget::Can { .. });
    let mut session = match by_holder(&target, asked, interrupt, || open(line.family))? {
        Way::Stopped(stopped) => return Ok(stopped),
        Way::Open(session) => session,
    };
    let mut found = stop_and_find(&session, on_can, interrupt)?;
    let named = if target.family() == FamilyChoice::AUTO { line.family } else { target.family() };
    let is_unknown = || !on_can && session::family_at(&target, named) == FamilyChoice::AUTO;
    if found.is_err() && asked == Addresses::Scan && is_unknown() {
        // When the line was opened it was not searched for all units that these families can have on it.
        for family in family::families().iter().filter(|family| family.stopped_addresses().is_empty()) {
            if found.is_err() {
                drop(session);
                session = open(FamilyChoice::of(family.family())).map_err(no_link)?;
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
    let mut stop = LineStop::of(&units, &report);
    stop.latency = first.as_ref().unwrap_or(&report).latency();
    Ok(Stopped { stop, asked, by: None })
}

/// The way on after whoever may hold the line was asked.
enum Way {
    /// It was stopped by its holder.
    Stopped(Stopped),
    /// It is open here, and to be stopped.
    Open(Session),
}

/// Has the line stopped by the program that holds it, or opens it where none does or where it has let go of it.
fn by_holder(
    target: &ConnectTarget,
    asked: Addresses,
    interrupt: &Interrupt,
    open: impl Fn() -> Result<Session, SessionError>,
) -> Result<Way, Exit> {
    let begun_at = Instant::now();
    let mut leaves = false;
    loop {
        match outside::ask(target, asked, &|| !interrupt.is_raised()) {
            Asked::Stopped(holder, stop) => {
                return Ok(Way::Stopped(Stopped { stop, asked, by: Some(holder) }));
            }
            Asked::NotServed(holder) => {
                say(CliLinkMessage::By { holder: holder.name() });
                return Err(
                    Exit::Refused.saying(CliLinkMessage::NotConfirmed { seconds: STOP_LIMIT.as_secs() })
                );
            }
            Asked::Silent(holder) => {
                let process = holder.process;
                say(match holder.is_halted() {
                    Some(true) => CliLinkMessage::HolderHalted { holder: holder.name(), process },
                    Some(false) | None => CliLinkMessage::HolderSilent { holder: holder.name(), process },
                });
                leaves = false;
            }
            Asked::Gone(_) => leaves = true,
            Asked::Nobody => {}
            Asked::Interrupted => return Err(Exit::Interrupted),
        }
        match open() {
            Ok(session) => return Ok(Way::Open(session)),
            Err(SessionError::Open(OpenError::Busy { .. }))
                if leaves && begun_at.elapsed() < HAND_OVER_LIMIT =>
            {
                interrupt.sleep(HAND_OVER_INTERVAL);
            }
            Err(error) => return Err(no_link(error)),
        }
    }
}

fn no_link(error: SessionError) -> Exit {
    Exit::NoLink.saying(error)
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

/// Stops what a command has set in motion on several links at a time, each with its units, and says what is not plainly stopped. A signal does
/// not cut this short.
///
/// # Errors
/// The stop was not confirmed, or a loop was left off, so that nothing holds the motor now; of the worst.
pub fn stop_all_driven(links: &[(&DeviceHandle, &[Identity])]) -> Result<(), Exit> {
    // Each has its stop before any is waited for.
    links.iter().for_each(|(device, _)| device.stop_all());
    let mut ended = Ok(());
    for (device, units) in links {
        let came = wait_for_report(device).and_then(|report| {
            matters(&report, units).into_iter().for_each(|(_, text)| say(text));
            if report.confirmed() && !report.left_a_loop_off() { Ok(()) } else { Err(Exit::Refused) }
        });
        ended = ended.and(came);
    }
    ended
}

impl Stopped {
    fn exit(&self) -> Exit {
        match (self.stop.is_confirmed(), self.asked) {
            (false, _) => Exit::Refused,
            (true, Addresses::These(_)) if !self.silent().is_empty() => Exit::NoLink,
            (true, _) => Exit::Done,
        }
    }

    fn is_of_nodes(&self) -> bool {
        self.stop.units.iter().any(|unit| unit.is_node)
    }

    /// The addresses that the stop was written to, where they were not asked for.
    fn written_to(&self) -> Vec<u8> {
        let unit = self.stop.units.first().filter(|_| !self.is_of_nodes());
        let family = unit.and_then(StoppedUnit::family);
        family.map_or_else(Vec::new, |family| family::of(family).stopped_addresses())
    }

    /// The addresses at which nobody answered: of those that were asked for, or of all that the stop was written to.
    fn silent(&self) -> Vec<u8> {
        let answered = |address: &u8| {
            let mut units = self.stop.units.iter();
            units.any(|unit| unit.address == *address || unit.also_answers.contains(address))
        };
        let asked: Vec<u8> = match self.asked {
            Addresses::These(set) => set.iter().collect(),
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => self.written_to(),
        };
        asked.into_iter().filter(|address| !answered(address)).collect()
    }

    fn sentence(&self, unit: &StoppedUnit) -> String {
        let buffers = match unit.buffers_empty {
            Some(true) => ", buffers empty",
            Some(false) => ", buffers not empty",
            None => "",
        };
        format!(
            "{}: {}{buffers} ({:.2} ms to the wire).",
            unit.place,
            if unit.has_one_motor { "motor stopped" } else { "both motors stopped" },
            self.stop.latency.as_secs_f64() * 1e3
        )
    }

    /// What is not plainly stopped, and what was not reached.
    fn warnings(&self) -> Vec<Message> {
        let mut lines = self.stop.matters();
        let silent = self.silent();
        match self.asked {
            Addresses::These(_) if !silent.is_empty() => {
                lines.push(CliStopMessage::NotHeard { addresses: in_words(&silent) }.into());
            }
            Addresses::These(_) => {}
            _ if self.is_of_nodes() => lines.push(CliStopMessage::OtherNodes.into()),
            _ if self.written_to().is_empty() => lines.push(CliStopMessage::Broadcast.into()),
            _ if !silent.is_empty() && self.by.is_some() => {
                lines.push(CliStopMessage::NotLookedFor { addresses: in_words(&silent) }.into());
            }
            _ if !silent.is_empty() => {
                lines.push(CliStopMessage::Silent { addresses: in_words(&silent) }.into());
            }
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => {}
        }
        lines
    }

    fn print(&self, out: &mut Output) -> Result<(), OutputError> {
        let confirmed = self.stop.units.iter().filter(|unit| unit.confirmed);
        out.lines(confirmed.map(|unit| self.sentence(unit)))?;
        if let Some(holder) = &self.by {
            say(CliLinkMessage::By { holder: holder.name() });
        }
        self.warnings().into_iter().for_each(say);
        Ok(())
    }

    fn to_json(&self) -> Value {
        let units: Vec<_> = self
            .stop
            .units
            .iter()
            .map(|unit| {
                json!({
                    "address": unit.address,
                    "model": unit.model,
                    "confirmed": unit.confirmed,
                    "buffers_empty": unit.buffers_empty,
                    "still_driven_by": unit.still_driven_by,
                    "failures": unit.failures,
                })
            })
            .collect();
        let mut stopped = json!({
            "confirmed": self.stop.is_confirmed(),
            "latency_s": self.stop.latency.as_secs_f64(),
            "units": units,
            "no_answer_from": self.silent(),
        });
        if let Some(holder) = &self.by {
            stopped["by"] = json!({ "program": holder.program, "process": holder.process });
        }
        stopped
    }
}
