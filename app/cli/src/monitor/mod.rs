//! `brushwork monitor`: traffic in words, of whichever family.
//!
//! Three sources: this program's own polling ([`own`]), another program's traffic that is passed on ([`tap`]), and bytes from
//! a file ([`file`]). All of them end as [`record::Record`]s.

pub mod args;
pub mod awaited;
mod chosen;
mod file;
pub mod follower;
mod own;
pub mod record;
mod tap;

pub use file::meanings;

use super::{Exit, Interrupt, Output};
use args::MonitorArgs;

/// Monitors until the time is over, the source ends, or the program is interrupted.
pub fn run(args: &MonitorArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let done = match (&args.decode, args.pty.is_some() || args.tcp.is_some()) {
        (Some(path), _) => file::run(args, path, out),
        (None, true) => tap::run(args, out, interrupt),
        (None, false) => own::run(args, out, interrupt),
    };
    done.map(|()| Exit::Done)
}
