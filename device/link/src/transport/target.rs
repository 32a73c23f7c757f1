//! What the user types to say where a controller is.
//!
//! `/dev/ttyACM0`, `COM3`, `tcp:host:port` and `sim:mcp266`; serial ports take options behind a comma:
//! `/dev/ttyUSB0,baud=115200,stream=ttl1`, `COM4,family=mcp`. `can:` in front of a port or TCP address says that a CAN adapter is there:
//! `can:/dev/ttyUSB0,node=3,form=binary`. Any other text is taken as the path of a serial port, so that
//! links, pseudo-terminals and names this program has never heard of work too.

pub use super::error::{OpenError, TargetError};
pub use super::stream::Stream;

use super::byte_stream::Transport;
use super::serial::SerialTransport;
use super::tcp::TcpTransport;
use crate::family::{FamilyChoice, families};
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use std::fmt;
use std::str::FromStr;

/// Baud rate of an adapter for a CAN bus when none is given. Assumed: the makers' manuals name no common one.
pub const DEFAULT_ADAPTER_BAUD: u32 = 115_200;

/// Where a controller is to be found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConnectTarget {
    /// A serial port or pseudo-terminal.
    Serial {
        /// Path or COM name, as typed.
        path: String,
        /// Baud rate; over USB the controller ignores it.
        baud: u32,
        /// Which of the controller's streams the port is wired to, when the user said so.
        stream: Option<Stream>,
        /// Which protocol family the controllers on it speak.
        family: FamilyChoice,
    },
    /// A TCP server.
    Tcp {
        /// "host:port".
        address: String,
        /// Which of the controller's streams the server is wired to, when the user said so.
        stream: Option<Stream>,
        /// Which protocol family the controllers on it speak.
        family: FamilyChoice,
    },
    /// A CAN bus behind an adapter on a serial port or a TCP server.
    Can {
        /// Where the adapter is.
        adapter: Box<ConnectTarget>,
        /// The node to speak to; all that answer when none is named.
        node: Option<NodeId>,
        /// How the adapter writes frames.
        form: Form,
    },
    /// A simulated controller in this program; the text says which and is read by the application.
    Sim(String),
}

impl ConnectTarget {
    /// Opens a serial port or a TCP connection. A simulated controller is started by the application.
    pub fn open(&self) -> Result<Box<dyn Transport>, OpenError> {
        match self {
            Self::Serial { path, baud, .. } => Ok(Box::new(SerialTransport::open(path, *baud)?)),
            Self::Tcp { address, .. } => match TcpTransport::connect(address) {
                Ok(transport) => Ok(Box::new(transport)),
                Err(source) => Err(OpenError::Tcp { address: address.clone(), source }),
            },
            Self::Can { adapter, .. } => adapter.open(),
            Self::Sim(_) => Err(OpenError::SimulatedElsewhere),
        }
    }

    /// The protocol family the user named.
    #[must_use]
    pub fn family(&self) -> FamilyChoice {
        match self {
            Self::Serial { family, .. } | Self::Tcp { family, .. } => *family,
            Self::Can { .. } => bus_family(),
            Self::Sim(_) => FamilyChoice::AUTO,
        }
    }

    /// The stream the user named.
    #[must_use]
    pub fn stream(&self) -> Option<Stream> {
        match self {
            Self::Serial { stream, .. } | Self::Tcp { stream, .. } => *stream,
            Self::Can { .. } | Self::Sim(_) => None,
        }
    }
}

impl FromStr for ConnectTarget {
    type Err = TargetError;

    fn from_str(text: &str) -> Result<Self, TargetError> {
        let text = text.trim();
        if text.is_empty() {
            return Err(TargetError::Empty);
        }
        if let Some(rest) = strip_scheme(text, "sim:") {
            return Ok(Self::Sim(rest.to_owned()));
        }
        if let Some(rest) = strip_scheme(text, "can:") {
            return parse_can(rest);
        }
        let (place, options) = split_options(text)?;
        match strip_scheme(place, "tcp:") {
            Some(address) => parse_tcp(address, &options),
            None => Ok(Self::Serial {
                path: place.to_owned(),
                baud: options.baud.unwrap_or_else(|| options.family.default_baud()),
                stream: options.stream,
                family: options.family,
            }),
        }
    }
}

impl fmt::Display for ConnectTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial { path, baud, family, .. } => {
                f.write_str(path)?;
                if *baud != family.default_baud() {
                    write!(f, ",baud={baud}")?;
                }
            }
            Self::Tcp { address, .. } => write!(f, "tcp:{address}")?,
            Self::Can { adapter, node, form } => {
                match adapter.as_ref() {
                    Self::Serial { path, baud, .. } => {
                        write!(f, "can:{path}")?;
                        if *baud != DEFAULT_ADAPTER_BAUD {
                            write!(f, ",baud={baud}")?;
                        }
                    }
                    other @ (Self::Tcp { .. } | Self::Can { .. } | Self::Sim(_)) => {
                        write!(f, "can:{other}")?;
                    }
                }
                if let Some(node) = node {
                    write!(f, ",node={}", node.get())?;
                }
                if *form != Form::default() {
                    write!(f, ",form={}", form.key())?;
                }
            }
            Self::Sim(what) => write!(f, "sim:{what}")?,
        }
        self.stream().map_or(Ok(()), |stream| write!(f, ",stream={}", stream.key()))?;
        match self.family() {
            FamilyChoice::AUTO => Ok(()),
            _ if matches!(self, Self::Can { .. }) => Ok(()),
            family => write!(f, ",family={family}"),
        }
    }
}

/// The family whose units are nodes of a CAN bus.
fn bus_family() -> FamilyChoice {
    let found = families().iter().find(|family| family.is_on_can_buses());
    found.map_or(FamilyChoice::AUTO, |family| FamilyChoice::of(*family))
}

/// Reads what stands behind "can:".
fn parse_can(text: &str) -> Result<ConnectTarget, TargetError> {
    let (mut node, mut form, mut baud) = (None, Form::default(), DEFAULT_ADAPTER_BAUD);
    let mut place = text;
    while let Some((before, last)) = place.rsplit_once(',') {
        if let Some(given) = last.strip_prefix("node=") {
            node = Some(parse_node(given)?);
        } else if let Some(given) = last.strip_prefix("form=") {
            form = Form::from_key(given).ok_or_else(|| TargetError::Form { given: given.to_owned() })?;
        } else if let Some(given) = last.strip_prefix("baud=") {
            baud = parse_baud(given)?;
        } else {
            break;
        }
        place = before;
    }
    if place.is_empty() {
        return Err(TargetError::Empty);
    }
    let adapter = match strip_scheme(place, "tcp:") {
        Some(address) => parse_tcp(address, &Options::default())?,
        None => {
            ConnectTarget::Serial { path: place.to_owned(), baud, stream: None, family: FamilyChoice::AUTO }
        }
    };
    Ok(ConnectTarget::Can { adapter: Box::new(adapter), node, form })
}

fn parse_node(given: &str) -> Result<NodeId, TargetError> {
    let node = given.parse().ok().and_then(NodeId::new);
    node.ok_or_else(|| TargetError::Node { given: given.to_owned() })
}

/// The options behind the commas.
#[derive(Default)]
struct Options {
    baud: Option<u32>,
    stream: Option<Stream>,
    family: FamilyChoice,
}

/// Takes known options off the end; a comma before anything else belongs to the path.
fn split_options(text: &str) -> Result<(&str, Options), TargetError> {
    let mut options = Options::default();
    let mut place = text;
    while let Some((before, last)) = place.rsplit_once(',') {
        if let Some(given) = last.strip_prefix("baud=") {
            options.baud = Some(parse_baud(given)?);
        } else if let Some(given) = last.strip_prefix("stream=") {
            options.stream = Some(given.parse()?);
        } else if let Some(given) = last.strip_prefix("family=") {
            options.family = given.parse().map_err(|why| TargetError::Family { why })?;
        } else {
            break;
        }
        place = before;
    }
    if place.is_empty() { Err(TargetError::Empty) } else { Ok((place, options)) }
}

fn parse_baud(given: &str) -> Result<u32, TargetError> {
    given
        .parse()
        .ok()
        .filter(|baud| (300..=1_000_000).contains(baud))
        .ok_or_else(|| TargetError::Baud { given: given.to_owned() })
}

fn parse_tcp(address: &str, options: &Options) -> Result<ConnectTarget, TargetError> {
    let named = address
        .rsplit_once(':')
        .is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port != 0));
    if !named {
        return Err(TargetError::TcpAddress { given: address.to_owned() });
    }
    Ok(ConnectTarget::Tcp { address: address.to_owned(), stream: options.stream, family: options.family })
}

/// Strips "tcp:" or "sim:" in either case. One letter before the colon would be a Windows drive, so the
/// schemes are longer.
fn strip_scheme<'a>(text: &'a str, scheme: &str) -> Option<&'a str> {
    let head = text.get(..scheme.len())?;
    head.eq_ignore_ascii_case(scheme).then(|| &text[scheme.len()..])
}
