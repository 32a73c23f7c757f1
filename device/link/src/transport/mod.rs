//! Ways to carry bytes to a controller: serial port (a pseudo-terminal included), TCP, in-process.
//!
//! A transport knows no protocol and keeps no time; it moves bytes and says when the far end is gone.

mod available;
mod byte_stream;
pub mod channel;
mod error;
mod late;
mod port_info;
pub mod ports;
mod refused;
pub mod serial;
mod stream;
pub mod target;
pub mod tcp;

pub use byte_stream::{SecondWay, Transport, TransportError, WRITE_TIMEOUT};
pub use channel::ChannelTransport;
pub use error::{OpenError, TargetError};
pub use port_info::PortInfo;
pub use ports::list_ports;
pub use refused::owning_group;
pub use serial::SerialTransport;
pub use stream::Stream;
pub use target::ConnectTarget;
pub use tcp::TcpTransport;
