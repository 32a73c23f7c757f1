//! Why a simulated machine cannot be served.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Why a simulated machine cannot be served.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServerError {
    /// This system has none.
    #[error("this system has no pseudo-terminals, so --pty cannot be used: use --tcp 127.0.0.1:PORT")]
    NoPseudoTerminals,
    /// The system refused one.
    #[error("no pseudo-terminal could be opened: {step} failed ({source})")]
    PseudoTerminal {
        /// What was tried.
        step: &'static str,
        /// The system's answer.
        #[source]
        source: io::Error,
    },
    /// Something else is where the link should be.
    #[error(
        "{} is already there ({what}): remove it, or choose another path",
        link.display()
    )]
    LinkTaken {
        /// The path.
        link: PathBuf,
        /// What is there.
        what: String,
    },
    /// The link could not be made.
    #[error("the link {} to the pseudo-terminal could not be made ({source})", link.display())]
    Link {
        /// The path.
        link: PathBuf,
        /// The system's answer.
        #[source]
        source: io::Error,
    },
    /// An address that others could reach.
    #[error(
        "controllers are only served on this computer, not on {address}: anybody on the network could drive them. Use 127.0.0.1 \
         or [::1]"
    )]
    NotLoopback {
        /// As given.
        address: SocketAddr,
    },
    /// The port could not be opened.
    #[error("nothing can listen on {address} ({source}); is another program using that port?")]
    Listen {
        /// As given.
        address: SocketAddr,
        /// The system's answer.
        #[source]
        source: io::Error,
    },
    /// The system gave no thread.
    #[error("the system gave no thread for the simulated controller")]
    Thread(#[source] io::Error),
    /// A channel was asked for, but the machine is served elsewhere.
    #[error("this simulated controller is served on {address}, not inside the program")]
    NotInProcess {
        /// Where it is served.
        address: String,
    },
    /// The cable is out.
    #[error("the simulated controller is unplugged: plug it in again before connecting to it")]
    Unplugged,
    /// The server has ended.
    #[error("the simulated controller has ended")]
    Ended,
    /// The server takes no more commands for now.
    #[error("the simulated controller is busy and takes no more commands for now")]
    Busy,
}
