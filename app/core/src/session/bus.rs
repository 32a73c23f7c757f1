//! A CAN bus without a link to one of its controllers: who is there, and starting a node that stands.
//!
//! Shared by the window and the command line. Looking writes to no node but the read of a device type; starting writes the one NMT
//! command that a person asked for.

use brushwork_link::work::receive_within;
use std::sync::Arc;
use std::time::{Duration, Instant};

use brushwork_canopen::NodeId;
use brushwork_canopen::bus::{Monitor, NodeView, Who};
use brushwork_canopen::nmt::{Command, State};
use brushwork_link::device::{Event, PollRate};
use brushwork_link::driver::{CanLine, can_line};
use brushwork_link::transport::ConnectTarget;
use brushwork_link::{Failure, Message, SystemClock};
use serde::Serialize;

use crate::messages::{BusMessage, CoreActMessage, CoreRemedyMessage};

use super::{SessionError, SessionOptions, Simulation, connect, on_can, open};

/// How long a search may take: all node ids are asked at once, and each that answers is then identified.
const SEARCH_LIMIT: Duration = Duration::from_secs(60);
/// How long a node that was started has for a heartbeat that says so: those of many devices come once a second.
const START_LIMIT: Duration = Duration::from_secs(3);
/// How long one read of the line waits.
const SLICE: Duration = Duration::from_millis(50);

/// Who is on a bus.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BusList {
    /// Every node that was heard or has answered.
    pub nodes: Vec<NodeView>,
    /// Emergencies that were heard meanwhile, as sentences.
    pub emergencies: Vec<String>,
    /// Why no controller of this program can be talked to, where none can.
    #[serde(skip)]
    pub failure: Option<String>,
}

/// What came of starting a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Started {
    /// Its heartbeat says that it is operational.
    Operational,
    /// Its heartbeat still says this.
    Still(State),
    /// It sends no heartbeat, so that nobody knows.
    NotTold,
}

impl BusList {
    /// What a monitor knows now.
    #[must_use]
    pub fn of(monitor: &Monitor) -> Self {
        let emergencies = monitor.emergencies().into_iter().map(|logged| {
            let emergency = logged.emergency;
            format!("{}: emergency {:04X}, {}", emergency.node, emergency.code, emergency.class())
        });
        Self { nodes: monitor.views(), emergencies: emergencies.collect(), failure: None }
    }

    /// Whether a controller of this program is among them.
    #[must_use]
    pub fn has_controller(&self) -> bool {
        self.nodes.iter().any(|view| matches!(view.who, Who::Controller(_)))
    }
}

impl Started {
    /// What it means, as a sentence.
    #[must_use]
    pub fn message(self, node: NodeId) -> Message {
        match self {
            Self::Operational => BusMessage::Operational { node }.into(),
            Self::Still(state) => BusMessage::Still { node, state: state.to_string() }.into(),
            Self::NotTold => BusMessage::NotTold { node }.into(),
        }
    }
}

/// Looks who is on the bus behind `target`.
///
/// # Errors
/// The line cannot be opened, or the target is no CAN adapter.
pub fn look(target: &ConnectTarget, goes_on: &dyn Fn() -> bool) -> Result<BusList, Message> {
    let options = SessionOptions { poll: PollRate::Off, ..SessionOptions::default() };
    let session = open(target, options, SystemClock::shared(), None).map_err(Message::error)?;
    let monitor = session.bus.as_ref().ok_or_else(|| no_adapter(target))?;
    let begun_at = Instant::now();
    while goes_on() && begun_at.elapsed() < SEARCH_LIMIT {
        match receive_within(session.device.events(), SLICE) {
            Ok(Event::Selected { .. }) => return Ok(BusList::of(monitor)),
            Ok(Event::Lost(failure)) => {
                return Ok(BusList { failure: Some(failure.to_string()), ..BusList::of(monitor) });
            }
            Ok(_) | Err(_) => {}
        }
    }
    Err(BusMessage::NotListed { seconds: SEARCH_LIMIT.as_secs() }.into())
}

/// Starts one node by an NMT command, and listens for what it says then.
///
/// # Errors
/// The line cannot be opened or is lost, or the target is no CAN adapter.
pub fn start(
    target: &ConnectTarget,
    simulation: Option<Arc<Simulation>>,
    node: NodeId,
) -> Result<Started, Message> {
    let (transport, simulation) = connect(target, simulation).map_err(Message::error)?;
    let (_, form) = on_can(target, simulation.as_deref()).ok_or_else(|| no_adapter(target))?;
    let CanLine { mut transport, monitor, .. } = can_line(transport, &SystemClock::shared(), form)
        .ok_or_else(|| Message::error(SessionError::NoNodes))?;
    monitor.command(Command::Start, node);
    let begun_at = Instant::now();
    let mut bytes = [0; 256];
    while begun_at.elapsed() < START_LIMIT {
        transport.read(&mut bytes, SLICE).map_err(|error| {
            let (tried, remedy) = (CoreActMessage::StartNode { node }, CoreRemedyMessage::CheckAdapter);
            Failure::new(tried, target.to_string(), Message::error(error), remedy).message()
        })?;
        if monitor.state(node) == Some(State::Operational) {
            return Ok(Started::Operational);
        }
    }
    Ok(monitor.state(node).map_or(Started::NotTold, Started::Still))
}

fn no_adapter(target: &ConnectTarget) -> Message {
    BusMessage::NoAdapter { target: target.to_string() }.into()
}
