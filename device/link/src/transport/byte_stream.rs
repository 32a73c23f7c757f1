//! A two-way stream of bytes to a controller, and why bytes could not be moved.

use std::io;
use std::process::Stdio;
use std::sync::Arc;
use std::time::Duration;

/// How long a write may wait for room before the link counts as stuck.
pub const WRITE_TIMEOUT: Duration = Duration::from_millis(250);

/// A two-way stream of bytes.
pub trait Transport: Send {
    /// Hands all of `bytes` to the far end, waiting at most [`WRITE_TIMEOUT`] for room.
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError>;

    /// Reads what is there into `buffer` and returns how much; waits up to `timeout` for the first byte.
    /// Zero means that nothing came in that time.
    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError>;

    /// Throws away what has arrived and was not read; returns how many bytes those were, as far as known.
    fn discard_input(&mut self) -> Result<usize, TransportError>;

    /// The far end as a person would name it: "/dev/ttyACM0", "tcp:127.0.0.1:5000".
    fn describe(&self) -> String;

    /// Time one byte takes on the wire (ten bits); `None` where no baud rate limits it.
    fn byte_time(&self) -> Option<Duration>;

    /// Changes the rate of the line, bits a second; `false` where it has none that could be changed.
    ///
    /// # Errors
    /// The port refuses it.
    fn set_baud(&mut self, _baud: u32) -> Result<bool, TransportError> {
        Ok(false)
    }

    /// How long an answer may take beyond its time on the wire: the controller's turnaround, the
    /// adapter's latency timer and the operating system together.
    fn latency(&self) -> Duration {
        Duration::from_millis(60)
    }

    /// Another way to write to the same far end, for a second process.
    ///
    /// # Errors
    /// There is none, or the system gave none.
    fn second_way(&self) -> io::Result<SecondWay> {
        Err(io::Error::new(io::ErrorKind::Unsupported, "a line of this kind is open to one program alone"))
    }
}

/// Another way to write to a far end, for a second process.
#[derive(Debug)]
pub enum SecondWay {
    /// The line is open for it, as its standard input.
    Open(Stdio),
    /// The system opens such a line to one process at a time: when the first one is gone, this target leads there.
    Later(String),
}

/// Why bytes could not be moved. Every one of these means that the link is lost.
#[derive(Clone, Debug, thiserror::Error)]
pub enum TransportError {
    /// The far end closed the connection or the device was pulled out.
    #[error("the far end is gone ({detail})")]
    Gone {
        /// What the operating system said.
        detail: String,
    },
    /// The far end takes no bytes.
    #[error("the port took only {written} of {length} bytes within {} ms", WRITE_TIMEOUT.as_millis())]
    WriteStuck {
        /// Bytes taken.
        written: usize,
        /// Bytes offered.
        length: usize,
    },
    /// Any other fault of the port.
    #[error("{action} the port failed")]
    Io {
        /// "reading from" or "writing to".
        action: &'static str,
        /// The operating system's error.
        #[source]
        source: Arc<io::Error>,
    },
}

impl TransportError {
    /// Sorts an operating system error into "gone" and everything else.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub(crate) fn from_io(action: &'static str, error: io::Error) -> Self {
        use io::ErrorKind as Kind;
        match error.kind() {
            Kind::BrokenPipe
            | Kind::ConnectionReset
            | Kind::ConnectionAborted
            | Kind::NotConnected
            | Kind::UnexpectedEof
            | Kind::NotFound => Self::Gone { detail: error.to_string() },
            _ => Self::Io { action, source: Arc::new(error) },
        }
    }

    /// The error and its cause in one line.
    #[must_use]
    pub fn full(&self) -> String {
        match self {
            Self::Io { source, .. } => format!("{self}: {source}"),
            Self::Gone { .. } | Self::WriteStuck { .. } => self.to_string(),
        }
    }
}
