//! What the user types to say where a controller is.
//!
//! `/dev/ttyACM0`, `COM3`, `tcp:host:port` and `sim:mcp266`; serial ports take options behind a comma:
//! `/dev/ttyUSB0,baud=115200,stream=ttl1`, `COM4,family=mcp`. `can:` in front of a port or TCP address says that a CAN adapter is there:
//! `can:/dev/ttyUSB0,node=3,form=binary`. `latency=800` lets replies take 800 ms, as over a slow radio. Any other text is taken as the path of a serial port, so that
//! links, pseudo-terminals and names this program has never heard of work too.

pub use super::error::{OpenError, TargetError};
pub use super::stream::Stream;

use super::byte_stream::Transport;
use super::late::Late;
use super::serial::SerialTransport;
use super::tcp::TcpTransport;
use crate::family::{FamilyChoice, families};
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use std::fmt;
use std::str::FromStr;
use std::time::Duration;

/// Baud rate of an adapter for a CAN bus when none is given. Assumed: the makers' manuals name no common one.
pub const DEFAULT_ADAPTER_BAUD: u32 = 115_200;

/// What a user may say of a line beyond where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineOptions {
    /// Which of the controller's streams it is wired to.
    pub stream: Option<Stream>,
    /// Which protocol family the controllers on it speak.
    pub family: FamilyChoice,
    /// How long replies may take beyond the time of their bytes, where that is more than what is found out without being told.
    pub latency: Option<Duration>,
}

/// Where a controller is to be found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConnectTarget {
    /// A serial port or pseudo-terminal.
    Serial {
        /// Path or COM name, as typed.
        path: String,
        /// Baud rate; over USB the controller ignores it.
        baud: u32,
        /// What else was said of the line.
        line: LineOptions,
    },
    /// A TCP server.
    Tcp {
        /// "host:port".
        address: String,
        /// What else was said of the line.
        line: LineOptions,
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
        let transport: Box<dyn Transport> = match self {
            Self::Serial { path, baud, .. } => Box::new(SerialTransport::open(path, *baud)?),
            Self::Tcp { address, .. } => match TcpTransport::connect(address) {
                Ok(transport) => Box::new(transport),
                Err(source) => return Err(OpenError::Tcp { address: address.clone(), source }),
            },
            Self::Can { adapter, .. } => return adapter.open(),
            Self::Sim(_) => return Err(OpenError::SimulatedElsewhere),
        };
        Ok(match self.line().latency {
            Some(latency) => Box::new(Late::new(transport, latency)),
            None => transport,
        })
    }

    /// What the user said of the line, of the adapter's where there is one.
    fn line(&self) -> LineOptions {
        match self {
            Self::Serial { line, .. } | Self::Tcp { line, .. } => *line,
            Self::Can { adapter, .. } => adapter.line(),
            Self::Sim(_) => LineOptions::default(),
        }
    }

    /// The protocol family the user named.
    #[must_use]
    pub fn family(&self) -> FamilyChoice {
        if matches!(self, Self::Can { .. }) { bus_family() } else { self.line().family }
    }

    /// The stream the user named.
    #[must_use]
    pub fn stream(&self) -> Option<Stream> {
        if matches!(self, Self::Can { .. }) { None } else { self.line().stream }
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
            Some(address) => parse_tcp(address, options.line),
            None => Ok(Self::Serial {
                path: place.to_owned(),
                baud: options.baud.unwrap_or_else(|| options.line.family.default_baud()),
                line: options.line,
            }),
        }
    }
}

impl fmt::Display for ConnectTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial { path, baud, line } => {
                f.write_str(path)?;
                if *baud != line.family.default_baud() {
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
                    Self::Tcp { address, .. } => write!(f, "can:tcp:{address}")?,
                    other @ (Self::Can { .. } | Self::Sim(_)) => write!(f, "can:{other}")?,
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
        self.line().latency.map_or(Ok(()), |latency| write!(f, ",latency={}", latency.as_millis()))?;
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
    let mut line = LineOptions::default();
    let mut place = text;
    while let Some((before, last)) = place.rsplit_once(',') {
        if let Some(given) = last.strip_prefix("node=") {
            node = Some(parse_node(given)?);
        } else if let Some(given) = last.strip_prefix("form=") {
            form = Form::from_key(given).ok_or_else(|| TargetError::Form { given: given.to_owned() })?;
        } else if let Some(given) = last.strip_prefix("baud=") {
            baud = parse_baud(given)?;
        } else if let Some(given) = last.strip_prefix("latency=") {
            line.latency = Some(parse_latency(given)?);
        } else {
            break;
        }
        place = before;
    }
    if place.is_empty() {
        return Err(TargetError::Empty);
    }
    let adapter = match strip_scheme(place, "tcp:") {
        Some(address) => parse_tcp(address, line)?,
        None => ConnectTarget::Serial { path: place.to_owned(), baud, line },
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
    line: LineOptions,
}

/// Takes known options off the end; a comma before anything else belongs to the path.
fn split_options(text: &str) -> Result<(&str, Options), TargetError> {
    let mut options = Options::default();
    let mut place = text;
    while let Some((before, last)) = place.rsplit_once(',') {
        if let Some(given) = last.strip_prefix("baud=") {
            options.baud = Some(parse_baud(given)?);
        } else if let Some(given) = last.strip_prefix("stream=") {
            options.line.stream = Some(given.parse()?);
        } else if let Some(given) = last.strip_prefix("family=") {
            options.line.family = given.parse().map_err(|why| TargetError::Family { why })?;
        } else if let Some(given) = last.strip_prefix("latency=") {
            options.line.latency = Some(parse_latency(given)?);
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

fn parse_latency(given: &str) -> Result<Duration, TargetError> {
    let latency_ms = given.parse().ok().filter(|latency_ms| (1..=10_000).contains(latency_ms));
    latency_ms.map(Duration::from_millis).ok_or_else(|| TargetError::Latency { given: given.to_owned() })
}

fn parse_tcp(address: &str, line: LineOptions) -> Result<ConnectTarget, TargetError> {
    let named = address
        .rsplit_once(':')
        .is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port != 0));
    if !named {
        return Err(TargetError::TcpAddress { given: address.to_owned() });
    }
    Ok(ConnectTarget::Tcp { address: address.to_owned(), line })
}

/// Strips "tcp:" or "sim:" in either case. One letter before the colon would be a Windows drive, so the
/// schemes are longer.
fn strip_scheme<'a>(text: &'a str, scheme: &str) -> Option<&'a str> {
    let head = text.get(..scheme.len())?;
    head.eq_ignore_ascii_case(scheme).then(|| &text[scheme.len()..])
}
