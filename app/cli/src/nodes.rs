//! `brushwork nodes`: who is on a CANopen bus.

use std::time::{Duration, Instant};

use brushwork_link::{Event, Identity, PollRate, SystemClock};
use serde_json::json;

use super::args::NodesArgs;
use super::client::next_event;
use super::{Exit, Interrupt, Output};
use brushwork_core::session::{self, SessionOptions};

/// How long the search may take: all node ids are asked at once, and each that answers is then identified.
const SEARCH_LIMIT: Duration = Duration::from_secs(60);

/// Searches and prints.
pub fn run(args: &NodesArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let target = args.connect.parse().map_err(|error| {
        Exit::Usage.saying(format!("Could not understand --connect {}: {error}.", args.connect))
    })?;
    let options = SessionOptions { poll: PollRate::Off, ..SessionOptions::default() };
    let session = session::open(&target, options, SystemClock::shared(), None)
        .map_err(|error| Exit::NoLink.saying(error))?;
    let deadline = Instant::now() + SEARCH_LIMIT;
    let mut nodes: Vec<Identity> = Vec::new();
    while Instant::now() < deadline {
        match next_event(&session.device, interrupt)? {
            Some(Event::Connected(identity)) => nodes.push(identity),
            Some(Event::Selected { .. }) => return print(args, &nodes, out),
            _ => {}
        }
    }
    Err(Exit::NoLink.saying(format!(
        "Could not list the nodes: the search did not end within {} s.",
        SEARCH_LIMIT.as_secs()
    )))
}

fn print(args: &NodesArgs, nodes: &[Identity], out: &mut Output) -> Result<Exit, Exit> {
    if !nodes.iter().all(Identity::is_node) {
        return Err(Exit::Usage.saying(format!(
            "{} is no CAN adapter. Write can: in front of an adapter's port.",
            args.connect
        )));
    }
    if args.json {
        out.json(&json!({ "nodes": nodes }))?;
        return Ok(Exit::Done);
    }
    let rows: Vec<Vec<String>> = nodes
        .iter()
        .map(|node| {
            vec![
                node.address.to_string(),
                node.version_text.clone(),
                node.generation.number().to_string(),
                node.notes.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "),
            ]
        })
        .collect();
    out.table(&["NODE", "CONTROLLER", "GENERATION", "WHAT IT TELLS"], &rows)?;
    Ok(Exit::Done)
}
