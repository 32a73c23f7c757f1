//! Finding the nodes of a bus: by their heartbeats, and by asking every node id at once.

use crate::can::access::read;
use crate::can::place::Place;
use crate::controller::identify_node;
use crate::messages::{McpCauseMessage, McpIdentityMessage, McpRemedyMessage};
use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::bus::{Monitor, Who};
use brushwork_canopen::nmt::{State, objects};
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
use std::collections::BTreeMap;
use std::time::Duration;

/// How long answers and heartbeats are waited for: a node that beats once a second is heard.
const LISTEN_FOR: Duration = Duration::from_millis(1200);

/// How long the answers of nodes that are named are waited for: two devices with one number answer one right after the other.
const LISTEN_TO_NAMED: Duration = Duration::from_millis(200);

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

    /// The nodes that answer or are heard, and those that are named.
    fn nodes(&self, line: &mut Line<'_>, addresses: Addresses) -> Result<Vec<NodeId>, ExchangeError> {
        let named: Vec<NodeId> = match addresses {
            Addresses::Only(id) => NodeId::new(id).into_iter().collect(),
            Addresses::These(set) => set.iter().filter_map(NodeId::new).collect(),
            Addresses::Scan | Addresses::Factory => {
                let all: Vec<NodeId> = NodeId::all().collect();
                let mut found = self.ask(line, &all, LISTEN_FOR)?;
                found.extend(self.monitor.nodes());
                found.sort_unstable();
                found.dedup();
                return Ok(found);
            }
        };
        if self.ask(line, &named, LISTEN_TO_NAMED)?.is_empty() {
            // A node that is stopped answers nothing, and tells so with its next heartbeat.
            self.ask(line, &named, LISTEN_FOR)?;
        }
        Ok(named)
    }

    /// Asks nodes for their device type, which every CANopen device has, and listens who answers. A node id from which two answers
    /// come is two devices.
    fn ask(
        &self,
        line: &mut Line<'_>,
        nodes: &[NodeId],
        listen_for: Duration,
    ) -> Result<Vec<NodeId>, ExchangeError> {
        let ask = Transfer::upload(objects::DEVICE_TYPE, 0).begin();
        let bytes: Vec<u8> = nodes.iter().flat_map(|node| self.place(*node).request(ask)).collect();
        let outgoing =
            Outgoing { bytes: &bytes, reply_length: 0, patience: listen_for, retries: 0, once: false };
        let mut answers: BTreeMap<NodeId, u32> = BTreeMap::new();
        let (mut decoder, mut heard) = (Decoder::new(self.form), 0);
        let (exchange, watch) = line.parts();
        let listened = exchange.exchange(&outgoing, watch, &mut |bytes| {
            for frame in decoder.feed_all(bytes.get(heard..).unwrap_or_default()) {
                if let Some(Function::SdoResponse(node)) = Function::of(frame.id()) {
                    *answers.entry(node).or_default() += 1;
                }
            }
            heard = bytes.len();
            Judgement::Elsewhere
        });
        match listened {
            Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
            // The time is over, as it should be.
            _ => {
                for (node, count) in &answers {
                    self.monitor.know(*node, if *count > 1 { Who::Several } else { Who::Unknown });
                }
                Ok(answers.into_keys().collect())
            }
        }
    }

    /// Finds out all about one node; `None` if nobody answers, a clause if it is none of this family.
    fn identify(
        &self,
        line: &mut Line<'_>,
        node: NodeId,
        simulated: bool,
    ) -> Result<Option<Found>, ExchangeError> {
        let is_several =
            self.monitor.views().iter().any(|view| view.node == node && view.who == Who::Several);
        if is_several {
            return Ok(Some(Err(format!("several devices answer as {node}"))));
        }
        if self.monitor.state(node) == Some(State::Stopped) {
            return Ok(Some(Err(format!("{node} is stopped, so that it answers nothing"))));
        }
        let place = self.place(node);
        let version = match read(line, place, index_of(number::READ_VERSION), TEXT) {
            Ok((bytes, _)) => String::from_utf8_lossy(&bytes).trim().to_owned(),
            Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
            Err(error) if error.is_no_answer() => return Ok(None),
            Err(error) => {
                self.monitor.know(node, Who::Foreign(self.told_of_itself(line, place)?));
                return Ok(Some(Err(format!("{node} has no version of an MCP ({})", error.full()))));
            }
        };
        self.monitor.know(node, Who::Controller(version.clone()));
        line.exchange().capabilities().introduce(node.get(), &format!("{version} as a node"));
        let mut notes = identity_notes(line, place)?;
        if let Some(state) = self.monitor.state(node) {
            notes.push(McpIdentityMessage::Heartbeat { state: state.to_string() }.into());
        }
        let unit = identify_node(line, place, &self.monitor, &version, simulated, notes)?;
        Ok(Some(Ok(Box::new(unit))))
    }
}

impl CanOpen {
    /// What a device that is none of this family tells of itself: its name, else its device type.
    fn told_of_itself(&self, line: &mut Line<'_>, place: Place) -> Result<String, ExchangeError> {
        for object in [objects::DEVICE_NAME, objects::DEVICE_TYPE] {
            match read(line, place, object, 0) {
                Ok((bytes, _)) if object == objects::DEVICE_NAME => {
                    return Ok(String::from_utf8_lossy(&bytes).trim().to_owned());
                }
                Ok((bytes, _)) => {
                    let hex: String = bytes.iter().rev().map(|byte| format!("{byte:02X}")).collect();
                    return Ok(format!("device type 0x{hex}"));
                }
                Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
                Err(_) => {}
            }
        }
        Ok("it tells neither name nor device type".to_owned())
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
            let stopped = self.monitor.views().into_iter().filter(|view| view.state == Some(State::Stopped));
            let stopped: Vec<NodeId> = stopped.map(|view| view.node).collect();
            let failure = nothing_there(line, options.addresses, &others, &stopped, heard);
            return Err(DiscoverError::NothingThere(failure));
        }
        Ok(units)
    }

    /// To the controllers that have been identified so far. Before that nobody knows whose objects 0x2020 and 0x2021 are.
    fn stop_bytes(&self, _: Addresses) -> StopBytes {
        let each = |node| self.place(node).stop_bytes(false);
        self.monitor.controllers().into_iter().map(each).reduce(StopBytes::with).unwrap_or_default()
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

fn nothing_there(
    line: &mut Line<'_>,
    addresses: Addresses,
    others: &[String],
    stopped: &[NodeId],
    heard: u64,
) -> Failure {
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
    if let [first, ..] = stopped {
        let came_back = McpCauseMessage::OtherNodes { listed: others.join("; ") };
        let remedy = McpRemedyMessage::StartNode { id: first.get() };
        return Failure::new(ActMessage::FindController, on, came_back, remedy);
    }
    let (came_back, remedy) = match (others, heard) {
        ([], 0) => (McpCauseMessage::AdapterSilent { asked }, McpRemedyMessage::CheckAdapter),
        ([], _) => (McpCauseMessage::AdapterWorks { asked }, McpRemedyMessage::CheckNode),
        (others, _) => {
            (McpCauseMessage::OtherNodes { listed: others.join("; ") }, McpRemedyMessage::GiveNode)
        }
    };
    Failure::new(ActMessage::FindController, on, came_back, remedy)
}
