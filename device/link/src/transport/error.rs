//! What is said of a text that names no controller, and of a port that cannot be opened.

use brushwork_values::Message;

/// Text that names no target.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TargetError {
    /// Nothing was typed.
    #[error("no port was named. Give a path such as /dev/ttyACM0 or COM3, tcp:host:port, or sim:mcp266")]
    Empty,
    /// "tcp:" without host or port.
    #[error("\"{given}\" is no TCP address. Write tcp:host:port, for example tcp:127.0.0.1:5000")]
    TcpAddress {
        /// What stood behind "tcp:".
        given: String,
    },
    /// A baud rate out of range.
    #[error("\"{given}\" is no baud rate. Packet serial takes 300 to 1000000")]
    Baud {
        /// What was given.
        given: String,
    },
    /// A latency out of range.
    #[error("\"{given}\" is no latency. Give how long replies may take, 1 to 10000 ms")]
    Latency {
        /// What was given.
        given: String,
    },
    /// A node id out of range.
    #[error("\"{given}\" is no node id. CANopen has 1 to 127")]
    Node {
        /// What was given.
        given: String,
    },
    /// An unknown form of adapter.
    #[error("\"{given}\" is no form of a CAN adapter. Use ascii or binary")]
    Form {
        /// What was given.
        given: String,
    },
    /// An unknown protocol family.
    #[error("{why}")]
    Family {
        /// What was given, and what there is.
        why: String,
    },
    /// An unknown stream.
    #[error("\"{given}\" is no stream of the controller. Use usb, rs232, ttl1, ttl2 or ttl3")]
    Stream {
        /// What was given.
        given: String,
    },
}

/// Why a target could not be opened; each says its remedy.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The user may not open the device.
    #[error("Could not open {path}: permission denied. {remedy}")]
    Permission {
        /// The device.
        path: String,
        /// Which group to join and how.
        remedy: Message,
    },
    /// Another program holds the port.
    #[error(
        "Could not open {path}: {holder} is using it. Close that program (or its connection) and try again."
    )]
    Busy {
        /// The device.
        path: String,
        /// The program and its process number where they can be found out, else "another program".
        holder: String,
    },
    /// There is no such device.
    #[error(
        "Could not open {path}: there is no such port. Check the cable and the name; `brushwork list` shows the ports that are there."
    )]
    NotFound {
        /// The path as typed.
        path: String,
    },
    /// The path is a file of another kind.
    #[error(
        "Could not open {path}: it is not a serial port ({detail}). Give the path of a serial port or pseudo-terminal."
    )]
    NotASerialPort {
        /// The path as typed.
        path: String,
        /// What the operating system said.
        detail: String,
    },
    /// Any other refusal by the system.
    #[error(
        "Could not open {path} at {baud} baud: {detail}. Check that the port takes this baud rate, unplug the adapter and plug it in again."
    )]
    Port {
        /// The path as typed.
        path: String,
        /// The baud rate asked for.
        baud: u32,
        /// What the operating system said.
        detail: String,
    },
    /// A browser did not open it for its page.
    #[error(
        "Could not open {path} at {baud} baud: the browser says \"{said}\" Another program or tab may hold it, or your user may have no right \
         to it. Close the other one; the installed program tells more."
    )]
    Browser {
        /// The name it has in the page.
        path: String,
        /// The baud rate asked for.
        baud: u32,
        /// The browser's own sentence.
        said: String,
    },
    /// The TCP connection was not made.
    #[error(
        "Could not connect to tcp:{address}: {source}. Check that the server runs and that host and port are right."
    )]
    Tcp {
        /// "host:port".
        address: String,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// A simulated controller was asked of this crate.
    #[error(
        "Could not open the simulated controller here: the application starts it. Open it from the device list."
    )]
    SimulatedElsewhere,
}
