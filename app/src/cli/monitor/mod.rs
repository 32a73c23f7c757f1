//! `brushwork monitor`: traffic in words, of packet serial and of both Motion Mind protocols.
//!
//! Three sources: this program's own polling ([`own`]), another program's traffic that is passed on ([`tap`]), and bytes from
//! a file ([`file`]). All of them end as [`Record`]s.

pub mod args;
mod decoder;
mod file;
mod follower;
mod mind;
mod own;
mod tap;

use std::time::Duration;

use brushwork_link::device::FamilyChoice;
use brushwork_mcp_wire::packet_serial::{Generation, hex};
use serde_json::json;

use super::client;
use super::exit::Exit;
use super::interrupt::Interrupt;
use super::output::{Output, OutputError};
use args::MonitorArgs;
use follower::Follower;

/// Room for the bytes in a line of text; more push the meaning to the right.
const HEX_COLUMN: usize = 32;
/// Bytes that a line of text shows; JSON has all.
const SHOWN_BYTES: usize = 32;

/// Bytes that went one way, and what they mean.
#[derive(Clone, Debug, PartialEq)]
struct Record {
    /// Since the start of the monitor, for the first of the bytes; none from a file.
    at: Option<Duration>,
    direction: Direction,
    /// None where an answer is missing.
    bytes: Vec<u8>,
    text: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    ToController,
    FromController,
}

/// Monitors until the time is over, the source ends, or the program is interrupted.
pub fn run(args: &MonitorArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    let done = match (&args.decode, args.pty.is_some() || args.tcp.is_some()) {
        (Some(path), _) => file::run(args, path, out),
        (None, true) => tap::run(args, out, interrupt),
        (None, false) => own::run(args, out, interrupt),
    };
    done.map_or_else(|exit| exit, |()| Exit::Done)
}

/// Who follows the traffic that the arguments ask for.
fn follower(args: &MonitorArgs) -> Result<Follower, Exit> {
    let target = client::target(&args.connect)?;
    // Bytes from a file come from no target, unless one is named for its family.
    let family = if args.decode.is_some() && args.connect.family != FamilyChoice::Auto {
        args.connect.family
    } else {
        client::family(&target, &args.connect)
    };
    let generation = args.generation.and_then(Generation::from_number);
    Ok(Follower::new(family == FamilyChoice::MotionMind, generation))
}

fn print(args: &MonitorArgs, record: &Record, out: &mut Output) -> Result<(), OutputError> {
    if args.json {
        return out.json_line(&json!({
            "time_s": record.at.map(|at| at.as_secs_f64()),
            "direction": record.direction.key(),
            "hex": hex(&record.bytes),
            "text": record.text,
        }));
    }
    let time = record.at.map(|at| format!("{:11.6}  ", at.as_secs_f64())).unwrap_or_default();
    let (arrow, bytes) = (record.direction.arrow(), shortened(&record.bytes));
    out.line(format!("{time}{arrow} {bytes:<HEX_COLUMN$}  {}", record.text))
}

fn shortened(bytes: &[u8]) -> String {
    match bytes.split_at_checked(SHOWN_BYTES) {
        Some((shown, rest)) if !rest.is_empty() => format!("{} … and {} more", hex(shown), rest.len()),
        _ => hex(bytes),
    }
}

impl Direction {
    fn key(self) -> &'static str {
        match self {
            Self::ToController => "to_controller",
            Self::FromController => "from_controller",
        }
    }

    fn arrow(self) -> char {
        match self {
            Self::ToController => '>',
            Self::FromController => '<',
        }
    }
}
