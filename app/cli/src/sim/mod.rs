//! `brushwork sim`: simulated controllers for other programs, on a pseudo-terminal or a TCP port.

mod control;

use crate::messages::CliSimMessage;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use brushwork_canopen::adapter::Form;
use brushwork_plant::faults::{FAULT_SYNTAX, Fault, FaultTextError};
use brushwork_plant::presets::presets;
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use clap::ArgMatches;
use crossbeam_channel::Receiver;

use super::args::SimArgs;
use super::family::families;
use super::{Exit, Family, Interrupt, NewFile, Output, OutputError, Simulated, say};
use brushwork_core::examine::like;
use brushwork_core::session::line::SimulatedLine;

/// Time between two looks at the server, and between two writes of the truth.
const WATCH_INTERVAL: Duration = Duration::from_millis(100);

/// Serves until interrupted.
pub fn run(
    args: &SimArgs,
    typed: &ArgMatches,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    if args.list {
        list(out)?;
        return Ok(Exit::Done);
    }
    let simulated = match &args.like {
        Some(report) => imitate(report)?,
        None => simulate(args, typed)?,
    };
    serve(args, simulated, out, interrupt)
}

/// The units of the family that has a model of those that are named, and of the first family where none has one. Of several the last
/// says why they do not go together.
fn simulate(args: &SimArgs, typed: &ArgMatches) -> Result<Simulated, Exit> {
    let is_named = |family: &&&dyn Family| {
        let mut keys = family.family().models().iter().map(|model| model.key);
        keys.any(|key| args.model.iter().any(|named| named.eq_ignore_ascii_case(key)))
    };
    let family = families().iter().rev().find(is_named).or(families().first()).ok_or(Exit::Usage)?;
    let others = families().iter().filter(|other| other.family() != family.family());
    match others.filter_map(|other| other.misplaced(typed)).next() {
        Some(sentence) => Err(Exit::Usage.saying(sentence)),
        None => family.simulate(typed),
    }
}

/// A unit that behaves as a report says. What it cannot imitate is said.
fn imitate(report: &Path) -> Result<Simulated, Exit> {
    let (_, started, unlike) =
        like(report).map_err(|why| Exit::Usage.saying(CliSimMessage::NotStarted { why: why.to_string() }))?;
    unlike.iter().for_each(say);
    let what = format!("A unit as {} says", report.display());
    Ok(Simulated { line: SimulatedLine::new(started.machine), what, is_found: true })
}

fn start(args: &SimArgs, line: SimulatedLine) -> Result<SimHandle<SimulatedLine>, Exit> {
    let endpoint = endpoint(args)?;
    let faults = args.fault.iter().map(|text| fault(text)).collect::<Result<_, _>>()?;
    let stream = args.port().index();
    let options = ServerOptions { stream, pace: args.pace, faults, seed: args.seed };
    Server::spawn(line, options, &endpoint)
        .map_err(|error| Exit::Failed.saying(CliSimMessage::NotStarted { why: error.to_string() }))
}

fn endpoint(args: &SimArgs) -> Result<Endpoint, Exit> {
    match (&args.pty, &args.tcp) {
        (Some(link), _) => Ok(Endpoint::Pty { link: link.clone() }),
        (None, Some(address)) => address
            .parse::<SocketAddr>()
            .map(Endpoint::Tcp)
            .map_err(|_| Exit::Usage.saying(CliSimMessage::NoAddress { address: address.to_string() })),
        (None, None) if cfg!(windows) => Ok(Endpoint::Tcp(SocketAddr::from(([127, 0, 0, 1], 0)))),
        (None, None) => Ok(Endpoint::Pty { link: default_link() }),
    }
}

fn default_link() -> PathBuf {
    std::env::temp_dir().join("brushwork-sim")
}

fn fault(text: &str) -> Result<Fault, Exit> {
    text.parse().map_err(|error: FaultTextError| {
        Exit::Usage.saying(CliSimMessage::NoFault {
            text: text.to_string(),
            error: error.to_string(),
            syntax: FAULT_SYNTAX,
        })
    })
}

fn serve(
    args: &SimArgs,
    simulated: Simulated,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    let Simulated { line, what, is_found } = simulated;
    let mut truth = args.truth.as_deref().map(|path| truth_file(path, args));
    truth.as_ref().map_or(Ok(()), NewFile::check)?;
    let server = &start(args, line)?;
    interrupt.hold_line();
    let place = server.address();
    let greeting = match args.can {
        Some(form) => {
            let form = if form == Form::default() { String::new() } else { format!(",form={}", form.key()) };
            format!(
                "{what}, behind a CAN adapter on {place}\nConnect with: brushwork --open can:{place}{form}"
            )
        }
        None if is_found => format!("{what}, on {place}\nConnect with: brushwork --open {place}"),
        None => format!("{what}, on {place}"),
    };
    if out.line(greeting).is_err() {
        return Err(Exit::Interrupted);
    }
    say(CliSimMessage::CtrlCEnds);
    let control = if args.control { control::lines() } else { None };
    let mut next_truth = Instant::now();
    while !interrupt.sleep(WATCH_INTERVAL) {
        if !server.is_running() {
            return Err(Exit::Failed.saying(CliSimMessage::Ended));
        }
        for line in control.iter().flat_map(Receiver::try_iter) {
            control::obey(&line, server);
        }
        if let Some(file) = &mut truth
            && Instant::now() >= next_truth
        {
            next_truth = Instant::now() + WATCH_INTERVAL;
            let text = serde_json::to_string_pretty(&*server.views()).unwrap_or_default();
            // Replaced as a whole, so that a reader never sees half of it.
            file.write(text.as_bytes())?;
        }
    }
    Ok(Exit::Done)
}

fn truth_file<'p>(path: &'p Path, args: &SimArgs) -> NewFile<'p> {
    let file = NewFile::new(path, args.replace);
    match &args.script {
        Some(script) => file.apart_from(script),
        None => file,
    }
}

fn list(out: &mut Output) -> Result<(), OutputError> {
    let models: Vec<Vec<String>> = families()
        .iter()
        .flat_map(|family| {
            family.family().models().iter().map(|model| {
                let simulated = family.simulated(model);
                [model.key, simulated.rating, simulated.assumed].map(str::to_owned).to_vec()
            })
        })
        .collect();
    out.table(&["MODEL", "RATING", "ASSUMED"], &models)?;
    out.line("")?;
    let rows: Vec<Vec<String>> =
        presets().iter().map(|preset| vec![preset.key.clone(), preset.description.clone()]).collect();
    out.table(&["PRESET", "WHAT"], &rows)
}
