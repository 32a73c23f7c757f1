//! A simulated machine in real time: on a pseudo-terminal, on TCP, or on channels inside the program.
//!
//! [`Server::spawn`] gives a machine its own thread, which advances it with the wall clock, hands it the bytes that arrive and
//! sends each reply in one write. Whoever holds the [`SimHandle`] acts on the machine's world and looks at it. This is the one
//! part of the crate with a clock, a thread and IO.

mod bench;
mod channel;
mod channel_ends;
mod clock;
mod driver;
mod error;
mod handle;
mod line;
mod pace;
#[cfg(unix)]
mod pty;
mod shared_time;
mod stack;
mod tcp;
mod wait;

pub use bench::{VirtualSpeed, measure_speed};
pub use channel_ends::ChannelEnds;
pub use error::ServerError;
pub use handle::SimHandle;
pub use line::{Heard, Line};
pub use pace::Pace;
pub use shared_time::{ClientTime, SharedTime};

use crate::faults::{Fault, Faulty};
use crate::machine::{Machine, StreamIndex};
use crate::pacing::Paced;
use driver::Driver;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Where a machine is reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// A pseudo-terminal, with a symbolic link to it.
    Pty {
        /// Where the link is made; it is removed at the end.
        link: PathBuf,
    },
    /// A TCP port, for one client at a time. Only loopback addresses are taken. Port 0 takes any free one.
    Tcp(SocketAddr),
    /// Channels inside the program: [`SimHandle::new_channel`] connects a client.
    Channel,
}

/// How a machine is served.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ServerOptions {
    /// Which of its streams the bytes belong to.
    pub stream: StreamIndex,
    /// Whether bytes take their time at the stream's rate.
    pub pace: bool,
    /// Faults to play; their times count from the start of the machine.
    pub faults: Vec<Fault>,
    /// Which bytes the faults meet.
    pub seed: u64,
}

/// Starts servers.
#[derive(Debug)]
pub struct Server;

impl Server {
    /// Opens the endpoint and serves the machine on it, on a thread of its own, until the handle is dropped or stopped.
    ///
    /// # Errors
    /// The endpoint cannot be opened, or the system gives no thread.
    pub fn spawn<M: Machine + 'static>(
        machine: M,
        options: ServerOptions,
        endpoint: &Endpoint,
    ) -> Result<SimHandle<M>, ServerError> {
        let (line, address) = open(endpoint)?;
        let stack = Paced::new(Faulty::new(machine, options.faults, options.seed), options.pace);
        Driver::spawn(stack, options.stream, line, address)
    }
}

/// Opens an endpoint for somebody who serves it with a machine of another kind, and says where it is reached.
///
/// # Errors
/// The endpoint cannot be opened.
pub fn open(endpoint: &Endpoint) -> Result<(Box<dyn Line>, String), ServerError> {
    match endpoint {
        Endpoint::Pty { link } => open_pty(link),
        Endpoint::Tcp(address) => {
            let line = tcp::TcpLine::open(*address)?;
            let address = format!("tcp:{}", line.address());
            Ok((Box::new(line), address))
        }
        Endpoint::Channel => Ok((Box::new(channel::ChannelLine::default()), "in-process".to_owned())),
    }
}

#[cfg(unix)]
fn open_pty(link: &std::path::Path) -> Result<(Box<dyn Line>, String), ServerError> {
    Ok((Box::new(pty::PtyLine::open(link)?), link.display().to_string()))
}

#[cfg(not(unix))]
fn open_pty(_: &std::path::Path) -> Result<(Box<dyn Line>, String), ServerError> {
    Err(ServerError::NoPseudoTerminals)
}
