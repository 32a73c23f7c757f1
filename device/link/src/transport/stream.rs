//! The serial streams of a controller, one of which a port is wired to.

use super::error::TargetError;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// One of the controller's serial streams, as commands 145 and 146 count them (MCP manual 2.3.1, command 145).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stream {
    /// The USB connector.
    Usb,
    /// RS-232, UART0.
    Rs232,
    /// TTL, UART1.
    Ttl1,
    /// TTL, UART2.
    Ttl2,
    /// TTL, UART3.
    Ttl3,
}

impl Stream {
    /// All of them in the order of their index.
    pub const ALL: [Self; 5] = [Self::Usb, Self::Rs232, Self::Ttl1, Self::Ttl2, Self::Ttl3];

    /// Index in the records of commands 145 and 146.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// Name on the command line and in files: "usb", "rs232", "ttl1".
    #[must_use]
    pub fn key(self) -> &'static str {
        ["usb", "rs232", "ttl1", "ttl2", "ttl3"][self.index()]
    }

    /// Name for people, as Ion Studio writes it.
    #[must_use]
    pub fn label(self) -> &'static str {
        ["USB", "RS232 UART0", "TTL UART1", "TTL UART2", "TTL UART3"][self.index()]
    }
}

impl fmt::Display for Stream {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.label())
    }
}

impl FromStr for Stream {
    type Err = TargetError;

    fn from_str(text: &str) -> Result<Self, TargetError> {
        Self::ALL
            .into_iter()
            .find(|stream| stream.key().eq_ignore_ascii_case(text))
            .ok_or_else(|| TargetError::Stream { given: text.to_owned() })
    }
}
