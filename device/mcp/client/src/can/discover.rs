//! Finding the nodes of a bus: by their heartbeats, and by asking every node id at once.

use crate::can::access::read;
use crate::can::monitor::Monitor;
use crate::can::place::Place;
use crate::controller::identify_node;
use crate::messages::{McpCauseMessage, McpIdentityMessage, McpRemedyMessage};
use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::nmt::objects;
use brushwork_canopen::sdo::Transfer;
use brushwork_canopen::{Function, NodeId};
use brushwork_link::Message;
use brushwork_link::device::StopBytes;
use brushwork_link::device::controller::{Controller, DiscoverError, Line, Search};
use brushwork_link::device::{Addresses, DeviceOptions};
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing};
use brushwork_link::failure::Failure;
use brushwork_link::messages::ActMessage;
use brushwork_mcp_wire::canopen::objects::{TEXT, index_of};
use brushwork_mcp_wire::packet_serial::number;
use std::collections::BTreeSet;
use std::time::Duration;

/// How long answers and heartbeats are waited for: a node that beats once a second is heard.
const LISTEN_FOR: Duration = Duration::from_millis(1200);

/// A controller, or why a node is none.
type Found = Result<Box<dyn Controller>, String>;

/// MCP controllers on a CANopen bus.
pub struct CanOpen {
    form: Form,
    monitor: Monitor,
}

impl CanOpen {
    /// Nodes behind an adapter that writes frames in `form`. `monitor` is that of the link's [`BusTransport`](crate::can::BusTransport).
    #[must_use]
    pub fn new(form: Form, monitor: Monitor) -> Self {
        Self { form, monitor }
    }

    fn place(&self, node: NodeId) -> Place {
        Place { node, form: self.form }
    }

    /// The nodes that answer or are heard.
    fn nodes(&self, line: &mut Line<'_>, addresses: Addresses) -> Result<Vec<NodeId>, ExchangeError> {
        match addresses {
            Addresses::Only(id) => Ok(NodeId::new(id).into_iter().collect()),
            Addresses::These(set) => Ok(set.iter().filter_map(NodeId::new).collect()),
            Addresses::Scan | Addresses::Factory => {
                let mut found = self.ask_all(line)?;
                found.extend(self.monitor.nodes());
                Ok(found.into_iter().collect())
            }
        }
    }

    /// Asks every node id for its device type, which every CANopen device has, and listens who answers.
    fn ask_all(&self, line: &mut Line<'_>) -> Result<BTreeSet<NodeId>, ExchangeError> {
        let ask = Transfer::upload(objects::DEVICE_TYPE, 0).begin();
        let bytes: Vec<u8> = NodeId::all().flat_map(|node| self.place(node).request(ask)).collect();
        let outgoing =
            Outgoing { bytes: &bytes, reply_length: 0, patience: LISTEN_FOR, retries: 0, once: false };
        let mut found = BTreeSet::new();
        let (mut decoder, mut heard) = (Decoder::new(self.form), 0);
        let (exchange, watch) = line.parts();
        let listened = exchange.exchange(&outgoing, watch, &mut |bytes| {
            for frame in decoder.feed_all(bytes.get(heard..).unwrap_or_default()) {
                if let Some(Function::SdoResponse(node)) = Function::of(frame.id()) {
                    found.insert(node);
                }
            }
            heard = bytes.len();
            Judgement::Elsewhere
        });
        match listened {
            Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
            // The time is over, as it should be.
            _ => Ok(found),
        }
    }

    /// Finds out all about one node; `None` if nobody answers, a clause if it is none of this family.
    fn identify(
        &self,
        line: &mut Line<'_>,
        node: NodeId,
        simulated: bool,
    ) -> Result<Option<Found>, ExchangeError> {
        let place = self.place(node);
        let version = match read(line, place, index_of(number::READ_VERSION), TEXT) {
            Ok((bytes, _)) => String::from_utf8_lossy(&bytes).trim().to_owned(),
            Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
            Err(error) if error.is_no_answer() => return Ok(None),
            Err(error) => {
                return Ok(Some(Err(format!("{node} has no version of an MCP ({})", error.full()))));
            }
        };
        let mut notes = identity_notes(line, place)?;
        if let Some(state) = self.monitor.state(node) {
            notes.push(McpIdentityMessage::Heartbeat { state: state.to_string() }.into());
        }
        let unit = identify_node(line, place, &self.monitor, &version, simulated, notes)?;
        Ok(Some(Ok(Box::new(unit))))
    }
}

impl Search for CanOpen {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let heard_before = line.exchange().statistics().bytes_in;
        let mut units = Vec::new();
        let mut others = Vec::new();
        for node in self.nodes(line, options.addresses)? {
            match self.identify(line, node, options.simulated)? {
                Some(Ok(unit)) => units.push(unit),
                Some(Err(why)) => others.push(why),
                None => {}
            }
        }
        if units.is_empty() {
            let heard = line.exchange().statistics().bytes_in - heard_before;
            let failure = nothing_there(line, options.addresses, &others, heard);
            return Err(DiscoverError::NothingThere(failure));
        }
        Ok(units)
    }

    fn stop_bytes(&self, addresses: Addresses) -> StopBytes {
        let reported = |node: &NodeId| match addresses {
            Addresses::These(set) => set.contains(node.get()),
            Addresses::Scan | Addresses::Only(_) | Addresses::Factory => true,
        };
        let each = |node| self.place(node).stop_bytes(false);
        NodeId::all().filter(reported).map(each).reduce(StopBytes::with).unwrap_or_default()
    }
}

/// Vendor, product, revision and serial number, as far as the node tells them.
fn identity_notes(line: &mut Line<'_>, place: Place) -> Result<Vec<Message>, ExchangeError> {
    let mut reported = Vec::new();
    for (subindex, name) in [(1, "vendor"), (2, "product"), (3, "revision"), (4, "serial number")] {
        match read(line, place, objects::IDENTITY, subindex) {
            Ok((bytes, _)) => {
                let hex: String = bytes.iter().rev().map(|byte| format!("{byte:02X}")).collect();
                reported.push(format!("{name} 0x{hex}"));
            }
            Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
            Err(_) => {}
        }
    }
    let identity = McpIdentityMessage::CanOpenIdentity { parts: reported.join(", ") };
    Ok(if reported.is_empty() { Vec::new() } else { vec![identity.into()] })
}

fn nothing_there(line: &mut Line<'_>, addresses: Addresses, others: &[String], heard: u64) -> Failure {
    let on = line.exchange().port();
    let asked = match addresses {
        Addresses::Scan | Addresses::Factory => McpCauseMessage::NoNodeAnswered,
        Addresses::Only(id) => McpCauseMessage::NodeSilent { id },
        Addresses::These(set) => {
            let each: Vec<_> = set.iter().map(|id| id.to_string()).collect();
            McpCauseMessage::NodesSilent { listed: each.join(", ") }
        }
    };
    let asked = asked.into();
    let (came_back, remedy) = match (others, heard) {
        ([], 0) => (McpCauseMessage::AdapterSilent { asked }, McpRemedyMessage::CheckAdapter),
        ([], _) => (McpCauseMessage::AdapterWorks { asked }, McpRemedyMessage::CheckNode),
        (others, _) => {
            (McpCauseMessage::OtherNodes { listed: others.join("; ") }, McpRemedyMessage::GiveNode)
        }
    };
    Failure::new(ActMessage::FindController, on, came_back, remedy)
}
