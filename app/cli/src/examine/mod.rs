//! `brushwork examine`: finds out what a controller answers and how, and writes a report that its owner can send.

mod args;

use crate::messages::CliJobMessage;
use std::io::{self, IsTerminal as _, Write as _};

use brushwork_core::examine::{Examining, Need, Step, Way};
use brushwork_core::keep::{Keeping, Store, TrialKeeper, UnitId};
use brushwork_link::transport::list_ports;
use brushwork_link::{ArmScope, Job, PollRate, WriteOptions};

pub use args::ExamineArgs;

use super::client::{arm, start};
use super::settings::ask::{is_yes, line};
use super::work::{self, Moves};
use super::{Client, Exit, Interrupt, NewFile, Output, say};

const NOBODY: &str = "Not asked: there was no terminal to ask at, and --yes did not name its step.";
const REFUSED: &str = "Not asked: the owner did not agree.";
const ENDED: &str = "Not asked: the examination was ended before.";
const FAILED: &str = "Not asked: its step could not be taken to the end.";

/// Examines, step by step, and writes what was found, also where something broke in.
pub fn run(args: &ExamineArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let [mut json, mut text] =
        [&args.json, &args.output].map(|path| path.as_deref().map(|path| NewFile::new(path, args.replace)));
    for file in [&json, &text].into_iter().flatten() {
        file.check()?;
    }
    let client = Client::connect(&args.connect, PollRate::Off, interrupt)?;
    let examining = Examining::begin(&client.identity).map_err(|sentence| Exit::Refused.saying(sentence))?;
    check_steps(args, &examining)?;
    let unit = UnitId::new(&client.identity, &list_ports().unwrap_or_default());
    let raw_writes = Store::of_user().raw_writes(&unit).inspect_err(|fault| say(fault.to_string()));
    examining.note_raw_writes(raw_writes.unwrap_or_default());
    let mut ended = Ok(());
    for step in examining.steps() {
        ended = ended.and_then(|()| take(step, args, &client, &examining, interrupt));
        let why = if ended.is_err() { ENDED } else { FAILED };
        examining.not_asked(step, why);
    }
    let found = examining.found();
    if let Some(file) = &mut json {
        file.write(found.json().as_bytes())?;
    }
    match &mut text {
        Some(file) => file.write(found.text().as_bytes())?,
        None => out.line(found.text().trim_end())?,
    }
    ended.map(|()| Exit::Done)
}

fn check_steps(args: &ExamineArgs, examining: &Examining) -> Result<(), Exit> {
    let keys: Vec<&str> =
        examining.steps().iter().filter(|step| step.need > Need::Read).map(|step| step.key).collect();
    match args.yes.iter().find(|named| !keys.contains(&named.as_str())) {
        None => Ok(()),
        Some(named) => {
            Err(Exit::Usage
                .saying(CliJobMessage::NoStep { named: named.to_string(), steps: keys.join(", ") }))
        }
    }
}

/// Takes a step if it may be taken. What fails in it ends it and not the examination; what breaks in ends that.
fn take(
    step: &'static Step,
    args: &ExamineArgs,
    client: &Client,
    examining: &Examining,
    interrupt: &Interrupt,
) -> Result<(), Exit> {
    if examining.is_shut(step) {
        return Ok(());
    }
    if let Some(why) = refusal(step, args, client, interrupt)? {
        examining.not_asked(step, why);
        return Ok(());
    }
    let options =
        WriteOptions { own_stream: client.stream, simulated: client.identity.simulated, as_read: true };
    let unit = UnitId::new(&client.identity, &list_ports().unwrap_or_default());
    let keeper = Keeping::new(Store::of_user()).keeper(unit, &client.identity.version_text);
    let taking = examining.take(step, Way { motor: args.motor(), options }, TrialKeeper::new(keeper));
    let prepared = taking.prepare().map_or(Ok(()), |job| finish(client, job, interrupt));
    let armed = match taking.moves() {
        true => prepared.and_then(|()| arm(client.device(), ArmScope::CommandLine, interrupt)),
        false => prepared,
    };
    let worked = armed.and_then(|()| finish(client, taking.work(), interrupt));
    // A raised interrupt has ended the step; it must not keep anything from being put back.
    let back = taking.put_back().map_or(Ok(()), |job| {
        let back = finish(client, job, &Interrupt::default()).map(drop);
        if back.is_ok() && step.need != Need::Save {
            say(CliJobMessage::StepPutBack);
        }
        back
    });
    match worked.and(back) {
        Err(Exit::Refused) => {
            examining.not_asked(step, FAILED);
            Ok(())
        }
        other => other,
    }
}

/// Why a step may not be taken; `None` where it may.
fn refusal(
    step: &Step,
    args: &ExamineArgs,
    client: &Client,
    interrupt: &Interrupt,
) -> Result<Option<&'static str>, Exit> {
    if step.need == Need::Read || args.yes.iter().any(|named| named == step.key) {
        return Ok(None);
    }
    if !io::stdin().is_terminal() {
        return Ok(Some(NOBODY));
    }
    let _ = write!(io::stderr(), "\nTo {}: {}\nDo it? [y/N] ", step.title, step.does);
    let answer = line(&|| client.next_event(interrupt).map(drop))?;
    Ok((!is_yes(&answer)).then_some(REFUSED))
}

/// Runs a job to its end, renewing the dead-man. Ctrl-C stops the motors of one that moves, and cancels it.
fn finish<T: Send + 'static>(client: &Client, job: Job<T>, interrupt: &Interrupt) -> Result<T, Exit> {
    let limit = job.time_limit();
    let ticket = start(client.device(), job)?;
    let report = work::wait(client, &ticket, limit, Moves::Yes, interrupt)?;
    work::value(ticket.ending(report.ending), &report.name, Exit::Refused, interrupt)
}
