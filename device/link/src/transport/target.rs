//! What the user types to say where a controller is.
//!
//! `/dev/ttyACM0`, `COM3`, `tcp:host:port` and `sim:mcp266`; serial ports take options behind a comma:
//! `/dev/ttyUSB0,baud=115200,stream=ttl1`, `COM4,family=motion-mind`. `can:` in front of a port or TCP address says that a CAN adapter is there:
//! `can:/dev/ttyUSB0,node=3,form=binary`. Any other text is taken as the path of a serial port, so that
//! links, pseudo-terminals and names this program has never heard of work too.

pub use super::error::{OpenError, TargetError};
pub use super::stream::Stream;

use super::byte_stream::Transport;
use super::serial::SerialTransport;
use super::tcp::TcpTransport;
use crate::device::FamilyChoice;
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use std::fmt;
use std::str::FromStr;

/// Baud rate of a serial port when none is given: the default of the family (public clients, 2015-2025).
pub const DEFAULT_BAUD: u32 = 38_400;
/// The same of a Motion Mind, with switch 5 off.
pub const MOTION_MIND_BAUD: u32 = 19_200;

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
            Self::Can { .. } => FamilyChoice::PacketSerial,
            Self::Sim(_) => FamilyChoice::Auto,
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
                baud: options.baud.unwrap_or_else(|| default_baud(options.family)),
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
                if *baud != default_baud(*family) {
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
                    other => write!(f, "can:{other}")?,
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
            FamilyChoice::Auto => Ok(()),
            _ if matches!(self, Self::Can { .. }) => Ok(()),
            family => write!(f, ",family={family}"),
        }
    }
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
            ConnectTarget::Serial { path: place.to_owned(), baud, stream: None, family: FamilyChoice::Auto }
        }
    };
    Ok(ConnectTarget::Can { adapter: Box::new(adapter), node, form })
}

fn parse_node(given: &str) -> Result<NodeId, TargetError> {
    let node = given.parse().ok().and_then(NodeId::new);
    node.ok_or_else(|| TargetError::Node { given: given.to_owned() })
}

/// The baud rate of a port that none was named for. Switch 5 of a Motion Mind chooses 9600 or 19200.
fn default_baud(family: FamilyChoice) -> u32 {
    if family == FamilyChoice::MotionMind { MOTION_MIND_BAUD } else { DEFAULT_BAUD }
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
            options.family = given.parse().map_err(|_| TargetError::Family { given: given.to_owned() })?;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn serial(path: &str, baud: u32, stream: Option<Stream>) -> ConnectTarget {
        ConnectTarget::Serial { path: path.to_owned(), baud, stream, family: FamilyChoice::Auto }
    }

    fn can(adapter: ConnectTarget, node: Option<NodeId>, form: Form) -> ConnectTarget {
        ConnectTarget::Can { adapter: Box::new(adapter), node, form }
    }

    #[test]
    fn every_form_of_target_is_understood() {
        let cases = [
            ("/dev/ttyACM0", serial("/dev/ttyACM0", 38_400, None)),
            ("COM3", serial("COM3", 38_400, None)),
            (r"\\.\COM12,baud=9600", serial(r"\\.\COM12", 9_600, None)),
            ("/dev/ttyUSB0,baud=115200,stream=ttl1", serial("/dev/ttyUSB0", 115_200, Some(Stream::Ttl1))),
            ("my,odd,link", serial("my,odd,link", 38_400, None)),
            (
                "tcp:127.0.0.1:5000",
                ConnectTarget::Tcp {
                    address: "127.0.0.1:5000".into(),
                    stream: None,
                    family: FamilyChoice::Auto,
                },
            ),
            (
                "TCP:[::1]:5000,stream=rs232",
                ConnectTarget::Tcp {
                    address: "[::1]:5000".into(),
                    stream: Some(Stream::Rs232),
                    family: FamilyChoice::Auto,
                },
            ),
            ("sim:mcp266,generation=4", ConnectTarget::Sim("mcp266,generation=4".into())),
            ("can:COM7", can(serial("COM7", 115_200, None), None, Form::Ascii)),
            (
                "can:/dev/ttyUSB0,baud=230400,node=3,form=binary",
                can(serial("/dev/ttyUSB0", 230_400, None), NodeId::new(3), Form::Binary),
            ),
            (
                "CAN:tcp:localhost:4000,node=127",
                can(
                    ConnectTarget::Tcp {
                        address: "localhost:4000".into(),
                        stream: None,
                        family: FamilyChoice::Auto,
                    },
                    NodeId::new(127),
                    Form::Ascii,
                ),
            ),
        ];
        for (text, target) in cases {
            assert_eq!(text.parse::<ConnectTarget>().unwrap(), target, "{text}");
        }
    }

    #[test]
    fn a_motion_mind_has_a_baud_rate_of_its_own_unless_one_is_named() {
        let baud = |text: &str| match text.parse::<ConnectTarget>().unwrap() {
            ConnectTarget::Serial { baud, .. } => baud,
            other => panic!("{other}"),
        };
        assert_eq!(baud("COM3,family=motion-mind"), 19_200);
        assert_eq!(baud("COM3,baud=38400,family=motion-mind"), 38_400);
    }

    #[test]
    fn a_target_prints_as_it_is_typed() {
        for text in [
            "can:/dev/ttyUSB0,baud=9600,node=3,form=binary",
            "can:tcp:[::1]:5000",
            "/dev/ttyACM0",
            "/dev/ttyUSB0,family=motion-mind",
            "tcp:[::1]:5000,family=mcp",
            "COM3,baud=9600,stream=usb",
            "tcp:[::1]:5000,stream=ttl3",
            "sim:mcp266",
        ] {
            assert_eq!(text.parse::<ConnectTarget>().unwrap().to_string(), text);
        }
    }

    #[test]
    fn a_bad_target_says_what_would_be_good() {
        let sentence = |text: &str| text.parse::<ConnectTarget>().unwrap_err().to_string();
        assert!(sentence("  ").contains("/dev/ttyACM0"));
        assert!(sentence(",baud=9600").contains("no port was named"));
        assert!(sentence("tcp:host").contains("tcp:host:port"));
        assert!(sentence("tcp::80").contains("tcp:host:port"));
        assert!(sentence("COM3,baud=12").contains("300 to 1000000"));
        assert!(sentence("COM3,family=can").contains("motion-mind"));
        assert!(sentence("COM3,stream=can").contains("rs232"));
        assert!(sentence("can:COM3,node=0").contains("1 to 127"));
        assert!(sentence("can:COM3,form=slcan").contains("ascii or binary"));
        assert!(sentence("can:").contains("no port was named"));
    }
}
