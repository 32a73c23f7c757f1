//! `brushwork script autorun` and `status`.

use crate::messages::CliScriptMessage;
use std::time::Duration;

use brushwork_link::settings::{Ending, begin_command, end_act};
use brushwork_link::{ExchangeError, Failure, Wire};
use brushwork_mcp_client::messages::McpActMessage;
use brushwork_mcp_client::script::{Autorun, read_autorun, set_autorun};
use brushwork_plant::world::{ScriptRun, ScriptView};
use serde_json::json;

use super::args::{AutorunArgs, StatusArgs};
use crate::settings::controller::Controller;
use crate::work::Finished;
use crate::{Exit, Interrupt, Output, say};

/// More than reading takes at the slowest rates.
const LIMIT: Duration = Duration::from_secs(30);
/// The same with everything read for a backup before.
const SETTING_LIMIT: Duration = Duration::from_secs(300);
/// What is told of controllers that are not simulated in this program.
const UNKNOWN: &str =
    "No command of the protocol tells whether a script runs; nothing was started over this link.";

/// Tells or sets autorun.
pub fn autorun(args: &AutorunArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    controller.announce();
    let wanted = args.delay;
    let (subject, mut keeper) = (controller.subject, controller.keeper());
    let finished = controller.run(McpActMessage::SetAutorun, SETTING_LIMIT, move |wire| {
        if let Some(delay) = wanted {
            begin_command(wire, subject, false, &mut *keeper)?;
            let set = set_autorun(wire, delay.0);
            end_act(wire, &mut *keeper, if set.is_ok() { Ending::Known } else { Ending::Open });
            set?;
        }
        read_autorun(wire).map_err(|error| failure(&error, wire))
    })?;
    let kept = value_of(finished)?;
    if args.json {
        out.json(&json!({ "autorun_delay_ms": milliseconds(kept) }))?;
    } else {
        out.line(sentence(kept))?;
        if wanted.is_some() {
            say(CliScriptMessage::AutorunInRam);
        }
    }
    Ok(Exit::Done)
}

/// Tells what is known of the script.
pub fn status(args: &StatusArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    controller.announce();
    let finished = controller.run(McpActMessage::ReadAutorun, LIMIT, move |wire| {
        read_autorun(wire).map_err(|error| failure(&error, wire))
    })?;
    let autorun = value_of(finished)?;
    let view = view_of(&controller);
    if args.json {
        out.json(&json!({ "autorun_delay_ms": milliseconds(autorun), "script": view }))?;
        return Ok(Exit::Done);
    }
    out.line(sentence(autorun))?;
    match &view {
        Some(view) => out.line(state_sentence(view))?,
        None => out.line(UNKNOWN)?,
    }
    Ok(Exit::Done)
}

/// What a controller that is simulated in this program knows of itself.
fn view_of(controller: &Controller<'_>) -> Option<ScriptView> {
    let simulation = controller.client.simulation()?;
    let unit = simulation.unit_of(controller.identity().address)?;
    simulation.views().get(unit)?.script.clone()
}

fn state_sentence(view: &ScriptView) -> String {
    match &view.run {
        ScriptRun::Idle => "No script was started since power-up.".to_owned(),
        ScriptRun::Running { line } => format!("A script runs; it is on line {line}."),
        ScriptRun::Ended { line } => format!("The script has ended on line {line}."),
        ScriptRun::Stopped { line } => format!("The script was stopped on line {line}."),
        ScriptRun::Faulted { line, what } => {
            format!("The script was stopped on line {line} by a fault: {what}.")
        }
    }
}

fn sentence(autorun: Autorun) -> String {
    autorun.map_or("Autorun is off.".to_owned(), |delay| {
        format!("Autorun is on: the script starts {} ms after power-up.", delay.as_millis())
    })
}

fn milliseconds(autorun: Autorun) -> Option<u64> {
    autorun.map(|delay| delay.as_millis() as u64)
}

fn failure(error: &ExchangeError, wire: &dyn Wire) -> Failure {
    error.failure(McpActMessage::SetAutorun, wire.describe())
}

fn value_of<T>(finished: Finished<Result<T, Failure>>) -> Result<T, Exit> {
    match (finished.value, finished.broken) {
        (_, Some(exit)) => Err(exit),
        (Ok(value), None) => Ok(value),
        (Err(failure), None) => Err(Exit::Refused.saying(failure)),
    }
}
