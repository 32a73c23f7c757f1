//! Opens what the user names: a serial port, a TCP server, or a controller that is simulated in this program.
//!
//! Shared by the window and the command line. Opening may wait for the operating system, so the window does it on
//! another thread. What is opened is driven through [`DeviceHandle`]; this module sends nothing.

use std::sync::Arc;

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_canopen::bus::Monitor;
use brushwork_link::capability::KeepsCapabilities;
use brushwork_link::device::{Addresses, DeviceHandle, DeviceOptions, DeviceThread, PollRate};
use brushwork_link::driver::{CanLine, can_line};
use brushwork_link::family::{FamilyRef, families};
use brushwork_link::loan::KeepsLoans;
use brushwork_link::transport::{ConnectTarget, OpenError, PortInfo, Stream, Transport, list_ports, ports};
use brushwork_link::{Clock, FamilyChoice, HiddenSettings, Message};

use crate::guardian;
use crate::keep::Store;
use crate::stop::outside;

pub mod browser;
pub mod bus;
pub mod firmware;
pub mod in_step;
pub mod line;
pub mod simulation;
pub mod turned;

pub use simulation::{LIKE, Simulation, SimulationError};

/// An open link.
pub struct Session {
    /// The link's device thread.
    pub device: DeviceHandle,
    /// The simulated machine behind it, if it runs in this program. It lives on as long as somebody holds it.
    pub simulation: Option<Arc<Simulation>>,
    /// What is heard of the nodes, on a CAN bus.
    pub bus: Option<Monitor>,
}

/// How a link is opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SessionOptions {
    /// Which units to look for.
    pub addresses: Addresses,
    /// Which protocol family the units speak, where the target does not say so.
    pub family: FamilyChoice,
    /// How often the signals are read at first.
    pub poll: PollRate,
}

/// Why a link could not be opened. Each is a whole sentence for the user.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The port or the connection.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The simulated controller.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A CAN bus where no family has nodes.
    #[error(
        "Could not look for nodes on the CAN bus: this program has no family of controllers that are nodes."
    )]
    NoNodes,
    /// A web page reaches no network and no port but those that were chosen.
    #[error(
        "{target} cannot be reached from a web page. A page has simulated controllers and the serial ports that were chosen for it in its \
         browser; for anything else install Brushwork on this computer."
    )]
    NotFromPage {
        /// What was to be opened.
        target: String,
    },
    /// A web page turns all its links itself, and work on one of them may keep the others waiting.
    #[error(
        "{target} was not opened: a web page that reaches a real controller has no other link open, so that nothing keeps it from \
         stopping the motors. Disconnect the other one first."
    )]
    OneAtATime {
        /// What was to be opened.
        target: String,
    },
    /// The port is that of a controller in its firmware loader.
    #[error(
        "{port} is a controller that waits in its firmware loader ({product}), which answers nothing else. Switch it off and on; if it \
         is still there as {product}, resume its update: brushwork firmware update FILE --connect {port} --resume --model MODEL"
    )]
    InLoader {
        /// The port.
        port: String,
        /// What it calls itself on USB.
        product: String,
    },
    /// The thread that would own the link.
    #[error("Could not start the thread that owns the link: {0}. Close other programs and try again.")]
    Thread(#[source] std::io::Error),
}

/// Opens `target`. A simulated controller is started, unless `running` is the one that the target names: then its
/// cable is plugged into again.
///
/// # Errors
/// A sentence: the port, the connection or the simulated controller cannot be opened.
pub fn open(
    target: &ConnectTarget,
    options: SessionOptions,
    clock: Arc<dyn Clock>,
    running: Option<Arc<Simulation>>,
) -> Result<Session, SessionError> {
    let ports = list_ports().unwrap_or_default();
    if let Some(waiting) = loader_of(target, &ports) {
        return Err(waiting);
    }
    let mut session = open_line(target, options, clock, running, &ports)?;
    if let Some(hold) = outside::hold(target, session.device.stopper()) {
        session.device.keep(Box::new(hold));
    }
    Ok(session)
}

fn open_line(
    target: &ConnectTarget,
    options: SessionOptions,
    clock: Arc<dyn Clock>,
    running: Option<Arc<Simulation>>,
    ports: &[PortInfo],
) -> Result<Session, SessionError> {
    let (transport, simulation, clock) = match target {
        ConnectTarget::Sim(text) => {
            let simulation = simulation_of(text, running)?;
            let (transport, clock) = simulation.connect_in_step(&*clock)?;
            (transport, Some(simulation), clock)
        }
        ConnectTarget::Serial { .. } | ConnectTarget::Tcp { .. } | ConnectTarget::Can { .. } => {
            (target.open()?, None, clock)
        }
    };
    if let Some((node, form)) = on_can(target, simulation.as_deref()) {
        let options =
            node.map_or(options, |node| SessionOptions { addresses: Addresses::Only(node.get()), ..options });
        return spawn_on_can(transport, clock, options, form, simulation);
    }
    let named = simulation.as_deref().map_or_else(|| target.family(), Simulation::family);
    let options = SessionOptions {
        family: match named {
            FamilyChoice::AUTO => settled(target, options.family, ports),
            named => named,
        },
        ..options
    };
    let stream = simulation.as_ref().map_or_else(|| stream_of(target), |running| Some(running.stream()));
    spawn(transport, clock, options, stream, simulation)
}

/// What a target is whose port calls itself a loader on USB.
fn loader_of(target: &ConnectTarget, ports: &[PortInfo]) -> Option<SessionError> {
    let ConnectTarget::Serial { path, .. } = target else { return None };
    let port = ports.iter().find(|port| port.is_loader() && port.name == firmware::real_path(path))?;
    Some(SessionError::InLoader { port: path.clone(), product: port.product.clone().unwrap_or_default() })
}

/// The family to look for at a target: the chosen one, else the one that alone can be there.
#[must_use]
pub fn family_at(target: &ConnectTarget, chosen: FamilyChoice) -> FamilyChoice {
    settled(target, chosen, &list_ports().unwrap_or_default())
}

/// A controller that waits in its firmware loader erases its program at one byte, the greeting, which the question for another
/// family may hold. So where an update was begun and did not end, only its family is looked for; likewise on a controller's own USB.
fn settled(target: &ConnectTarget, chosen: FamilyChoice, ports: &[PortInfo]) -> FamilyChoice {
    if chosen != FamilyChoice::AUTO {
        return chosen;
    }
    // What cannot be read is told when nobody answers.
    let update = Store::of_user().update_at(&target.to_string()).ok().flatten();
    let begun =
        |family: &&FamilyRef| update.as_ref().is_some_and(|update| family.model(&update.model).is_some());
    let port = match target {
        ConnectTarget::Serial { path, .. } => ports
            .iter()
            .find(|port| port.name == firmware::real_path(path))
            .and_then(|port| port.product.as_deref()),
        ConnectTarget::Tcp { .. } | ConnectTarget::Can { .. } | ConnectTarget::Sim(_) => None,
    };
    let plugged = |family: &&FamilyRef| port.is_some_and(|product| family.usb_product(product).is_some());
    let only = families().iter().find(|family| begun(family) || plugged(family));
    only.map_or(chosen, |family| FamilyChoice::of(*family))
}

/// What is known of a target at which nobody answers: an update that was begun there and did not end.
#[must_use]
pub fn waiting_at(target: &str) -> Option<Message> {
    Store::of_user().waiting_at(target)
}

/// A line, and the simulated machine behind it if it runs in this program.
pub type BareLine = (Box<dyn Transport>, Option<Arc<Simulation>>);

/// Opens the bare line to `target`, for those who carry bytes themselves. As for [`open`], a simulated controller is started
/// unless `running` is the one.
///
/// # Errors
/// As for [`open`].
pub fn connect(target: &ConnectTarget, running: Option<Arc<Simulation>>) -> Result<BareLine, SessionError> {
    let ConnectTarget::Sim(text) = target else {
        return Ok((target.open()?, None));
    };
    let simulation = simulation_of(text, running)?;
    Ok((Box::new(simulation.connect()?), Some(simulation)))
}

/// The simulated machine that is meant, started unless it runs.
fn simulation_of(text: &str, running: Option<Arc<Simulation>>) -> Result<Arc<Simulation>, SimulationError> {
    match running.filter(|running| running.is(text)) {
        Some(running) => Ok(running),
        None => Ok(Arc::new(Simulation::start(text)?)),
    }
}

/// Whether a CAN bus is at the end of a target: the node that is meant, if one is, and the adapter's form.
fn on_can(target: &ConnectTarget, simulation: Option<&Simulation>) -> Option<(Option<NodeId>, Form)> {
    match target {
        ConnectTarget::Can { node, form, .. } => Some((*node, *form)),
        ConnectTarget::Serial { .. } | ConnectTarget::Tcp { .. } | ConnectTarget::Sim(_) => {
            simulation?.can_form.map(|form| (None, form))
        }
    }
}

/// Which nodes to look for. What was asked may be an address of packet serial, which a node does not have.
fn can_addresses(addresses: Addresses) -> Addresses {
    match addresses {
        Addresses::Only(address) if NodeId::new(address).is_none() => Addresses::Scan,
        addresses @ (Addresses::Scan | Addresses::Only(_) | Addresses::These(_) | Addresses::Factory) => {
            addresses
        }
    }
}

fn spawn_on_can(
    transport: Box<dyn Transport>,
    clock: Arc<dyn Clock>,
    options: SessionOptions,
    form: Form,
    simulation: Option<Arc<Simulation>>,
) -> Result<Session, SessionError> {
    let alone = simulation.clone().filter(|simulation| simulation.is_single());
    let options = DeviceOptions {
        addresses: can_addresses(options.addresses),
        poll: options.poll,
        simulated: simulation.is_some(),
        // Hidden settings are found by address, which nodes share.
        hidden: alone.map(|simulation| simulation as Arc<dyn HiddenSettings>),
        capabilities: keeper(simulation.as_deref()),
        loans: simulation.is_none().then(|| Arc::new(Store::of_user()) as Arc<dyn KeepsLoans>),
        guardian: if simulation.is_none() { guardian::of_program() } else { None },
        ..DeviceOptions::default()
    };
    let CanLine { transport, search, monitor } =
        can_line(transport, &clock, form).ok_or(SessionError::NoNodes)?;
    let device = DeviceThread::spawn_family(transport, clock, options, search);
    Ok(Session { device: device.map_err(SessionError::Thread)?, simulation, bus: Some(monitor) })
}

/// The stream of the controller that a port is wired to: as the user said, or as the port's name tells.
fn stream_of(target: &ConnectTarget) -> Option<Stream> {
    target.stream().or_else(|| match target {
        ConnectTarget::Serial { path, .. } => ports::stream_of(path, &list_ports().unwrap_or_default()),
        ConnectTarget::Tcp { .. } | ConnectTarget::Can { .. } | ConnectTarget::Sim(_) => None,
    })
}

/// Where what firmware answers is kept. A unit that is simulated here has what its faults say this time.
fn keeper(simulation: Option<&Simulation>) -> Option<Arc<dyn KeepsCapabilities>> {
    simulation.is_none().then(|| Arc::new(Store::of_user()) as Arc<dyn KeepsCapabilities>)
}

fn spawn(
    transport: Box<dyn Transport>,
    clock: Arc<dyn Clock>,
    options: SessionOptions,
    stream: Option<Stream>,
    simulation: Option<Arc<Simulation>>,
) -> Result<Session, SessionError> {
    let hidden = simulation.clone().map(|simulation| simulation as Arc<dyn HiddenSettings>);
    let options = DeviceOptions {
        addresses: options.addresses,
        family: options.family,
        poll: options.poll,
        stream,
        simulated: simulation.is_some(),
        hidden,
        capabilities: keeper(simulation.as_deref()),
        loans: simulation.is_none().then(|| Arc::new(Store::of_user()) as Arc<dyn KeepsLoans>),
        guardian: if simulation.is_none() { guardian::of_program() } else { None },
        ..DeviceOptions::default()
    };
    let device = DeviceThread::spawn(transport, clock, options).map_err(SessionError::Thread)?;
    Ok(Session { device, simulation, bus: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(product: &str) -> PortInfo {
        PortInfo {
            name: "/dev/ttyACM7".to_owned(),
            is_usb: true,
            product: Some(product.to_owned()),
            ..PortInfo::default()
        }
    }

    #[test]
    fn on_a_controllers_own_usb_no_other_family_is_looked_for() {
        brushwork_link::install(&[&brushwork_mcp_client::McpDriver]);
        let target: ConnectTarget = "/dev/ttyACM7".parse().unwrap();
        let found = |product| settled(&target, FamilyChoice::AUTO, &[port(product)]).key();
        assert_eq!(found("MCP266 2x60A"), "mcp");
        assert_eq!(found("FT232R USB UART"), "auto", "an adapter may have any family behind it");
    }

    #[test]
    fn a_port_that_calls_itself_a_loader_is_told_as_one_and_not_opened() {
        brushwork_link::install(&[&brushwork_mcp_client::McpDriver]);
        let target: ConnectTarget = "/dev/ttyACM7".parse().unwrap();
        assert!(loader_of(&target, &[port("MCP266 2x60A")]).is_none());
        let sentence = loader_of(&target, &[port("MCP266ASTULDR")]).unwrap().to_string();
        assert!(sentence.contains("waits in its firmware loader (MCP266ASTULDR)"), "{sentence}");
        assert!(sentence.contains("--connect /dev/ttyACM7 --resume"), "{sentence}");
    }
}
