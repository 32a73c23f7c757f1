//! A request as bytes, how its reply is judged, and when both were on the wire.

use super::error::{ExchangeError, Tries};
use std::time::Duration;

/// A controller forgets an unfinished packet after this long without a byte (MCP manual 2.2.4: "more than 10 ms").
pub const PACKET_GAP: Duration = Duration::from_millis(10);
/// A request is sent again at most this often (public clients, 2015-2025: two or three tries).
pub const RETRIES: u32 = 2;

/// A request as bytes, with what is needed to wait for its reply.
#[derive(Clone, Copy, Debug)]
pub struct Outgoing<'a> {
    /// The bytes.
    pub bytes: &'a [u8],
    /// Length of the reply: of the longest where it goes by its content, since a serial server or a radio may hand a reply over when it is whole.
    pub reply_length: usize,
    /// Time the controller may take beyond the link's own latency, for work such as erasing.
    pub patience: Duration,
    /// How often it may be sent again after a fault.
    pub retries: u32,
    /// Whether it does something that must not be done twice. Such a request goes out once, and a failure after that
    /// says that it may have been carried out.
    pub once: bool,
}

/// What the judge of a reply says about the bytes so far.
#[derive(Clone, Debug)]
pub enum Judgement {
    /// At least this many more bytes are needed.
    More(usize),
    /// What came belongs to others on a shared bus: the time that is left stays as it is.
    Elsewhere,
    /// Complete; this many bytes belong to it.
    Good(usize),
    /// It cannot become a good one.
    Bad(Fault),
}

/// What is wrong with a reply.
#[derive(Clone, Debug)]
pub enum Fault {
    /// The CRC does not fit.
    Crc {
        /// CRC of what was received.
        expected: u16,
        /// CRC that was received.
        got: u16,
    },
    /// An acknowledgement was due.
    Acknowledgement(u8),
    /// The unit says that it does not know the request.
    NotUnderstood(String),
    /// Anything else.
    Malformed(String),
}

impl Fault {
    pub(super) fn error(self, tries: Tries) -> ExchangeError {
        match self {
            Self::Crc { expected, got } => ExchangeError::BadCrc { expected, got, tries },
            Self::Acknowledgement(got) => ExchangeError::BadAcknowledgement { got, tries },
            Self::NotUnderstood(what) => ExchangeError::NotUnderstood { what, tries },
            Self::Malformed(what) => ExchangeError::Malformed { what, tries },
        }
    }
}

/// Host times of one exchange.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// When the request was written.
    pub requested_at: Duration,
    /// When the reply was complete.
    pub replied_at: Duration,
}
