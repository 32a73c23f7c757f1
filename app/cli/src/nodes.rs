//! `brushwork nodes`: who is on a CANopen bus, and starting a node that stands.

use crate::messages::CliLinkMessage;
use brushwork_canopen::NodeId;
use brushwork_canopen::bus::Who;
use brushwork_link::ConnectTarget;

use super::args::NodesArgs;
use super::{Exit, Interrupt, Output, say};
use brushwork_core::session::bus::{self, BusList, Started};

/// Starts a node if that is asked for, then searches and prints.
pub fn run(args: &NodesArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let target: ConnectTarget = args.connect.parse().map_err(|error| {
        Exit::Usage.saying(CliLinkMessage::NoTarget { target: args.connect.clone(), error })
    })?;
    if let Some(node) = args.start {
        let node = NodeId::new(node).ok_or(Exit::Usage)?;
        let started = bus::start(&target, None, node).map_err(|sentence| Exit::NoLink.saying(sentence))?;
        say(started.message(node));
        if matches!(started, Started::Still(_)) {
            return Err(Exit::Refused);
        }
    }
    let list = bus::look(&target, &|| !interrupt.is_raised());
    if interrupt.is_raised() {
        return Err(Exit::Interrupted);
    }
    print(args, &list.map_err(|sentence| Exit::NoLink.saying(sentence))?, out)
}

fn print(args: &NodesArgs, list: &BusList, out: &mut Output) -> Result<Exit, Exit> {
    if args.json {
        out.json(list)?;
    } else if !list.nodes.is_empty() {
        let rows: Vec<Vec<String>> = list
            .nodes
            .iter()
            .map(|view| {
                vec![view.node.get().to_string(), view.state_text(), view.heartbeat_text(), view.who_text()]
            })
            .collect();
        out.table(&["NODE", "STATE", "HEARTBEAT", "WHO"], &rows)?;
        out.lines(&list.emergencies)?;
    }
    if let Some(failure) = &list.failure {
        return Err(Exit::NoLink.saying(failure));
    }
    let is_doubled = list.nodes.iter().any(|view| view.who == Who::Several);
    Ok(if is_doubled { Exit::Refused } else { Exit::Done })
}
