//! `brushwork stop`: both motors off, at once, and what could still drive them.

use std::time::{Duration, Instant};

use brushwork_link::device::{Event, Identity, PollRate, StopReport};
use serde_json::json;

use super::args::StopArgs;
use super::client::Client;
use super::exit::Exit;
use super::interrupt::Interrupt;
use super::output::{Output, OutputError, say};

/// How long the controller may take to confirm.
const STOP_LIMIT: Duration = Duration::from_secs(5);

/// Connects, stops and prints the report.
pub fn run(args: &StopArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    let client = match Client::connect(&args.connect, PollRate::Off, interrupt) {
        Ok(client) => client,
        Err(exit) => return exit,
    };
    client.device().stop_all();
    match wait_for_report(&client) {
        Err(exit) => exit,
        Ok(report) => {
            let printed =
                if args.json { print_json(&report, out) } else { print(&report, &client.identity, out) };
            match printed {
                Err(error) => error.into(),
                Ok(()) if report.confirmed() => Exit::Done,
                Ok(()) => Exit::Refused,
            }
        }
    }
}

/// Waits for the stop that was asked for; a signal does not cut this short, since it ends by itself.
pub fn wait_for_report(client: &Client) -> Result<StopReport, Exit> {
    let deadline = Instant::now() + STOP_LIMIT;
    let deaf = Interrupt::default();
    while Instant::now() < deadline {
        if let Some(Event::Stopped(report)) = client.next_event(&deaf)? {
            return Ok(report);
        }
    }
    say(format!(
        "Stop was sent, but the controller did not confirm it within {} s. Cut the motor power.",
        STOP_LIMIT.as_secs()
    ));
    Err(Exit::Refused)
}

/// Says what is not plainly stopped.
pub fn warnings(report: &StopReport, identity: &Identity) -> Vec<String> {
    let mut lines = Vec::new();
    for unit in &report.units {
        if !unit.confirmed {
            lines.push(format!(
                "{} did not confirm the stop. Cut the motor power.",
                place(identity, unit.address)
            ));
        }
        lines.extend(unit.still_driven_by.iter().cloned());
        lines.extend(unit.failures.iter().map(ToString::to_string));
    }
    lines
}

fn print(report: &StopReport, identity: &Identity, out: &mut Output) -> Result<(), OutputError> {
    for unit in report.units.iter().filter(|unit| unit.confirmed) {
        let buffers = match unit.buffers_empty {
            Some(true) => ", buffers empty",
            Some(false) => ", buffers not empty",
            None => "",
        };
        out.line(format!(
            "{}: {}{buffers} ({:.2} ms to the wire).",
            place(identity, unit.address),
            if identity.capabilities().motors == 1 { "motor stopped" } else { "both motors stopped" },
            report.latency().as_secs_f64() * 1e3
        ))?;
    }
    warnings(report, identity).into_iter().for_each(say);
    Ok(())
}

/// Where a unit is on its bus, as its family says it.
fn place(identity: &Identity, address: u8) -> String {
    if identity.address == address { identity.place() } else { format!("{address:#04x}") }
}

fn print_json(report: &StopReport, out: &mut Output) -> Result<(), OutputError> {
    let units: Vec<_> = report
        .units
        .iter()
        .map(|unit| {
            json!({
                "address": unit.address,
                "confirmed": unit.confirmed,
                "buffers_empty": unit.buffers_empty,
                "still_driven_by": unit.still_driven_by,
                "failures": unit.failures,
            })
        })
        .collect();
    out.json(&json!({
        "confirmed": report.confirmed(),
        "latency_s": report.latency().as_secs_f64(),
        "units": units,
    }))
}
