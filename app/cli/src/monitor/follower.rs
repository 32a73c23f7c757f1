//! Whoever follows the traffic of a line: packet serial or the Motion Minds.

use std::time::Duration;

use brushwork_link::FamilyChoice;
use brushwork_mcp_wire::packet_serial::{ACK, Address, Generation, PACKET_GAP, Request, number, scale};
use brushwork_motion_mind_wire::ACK as MIND_ACK;

use super::args::MonitorArgs;
use super::decoder::Decoder;
use super::mind::MindDecoder;
use super::record::Record;
use crate::client;
use crate::exit::Exit;

/// Follows a conversation of either family.
pub enum Follower {
    /// MCP and RoboClaw.
    Packets(Box<Decoder>),
    /// Motion Minds, in either of their protocols.
    Minds(Box<MindDecoder>),
}

/// What stands one unit that the client had told to move.
pub struct Stop {
    /// Who, for sentences.
    pub who: String,
    /// One write each, with a pause before each.
    pub writes: Vec<Vec<u8>>,
    /// An acknowledge begins so.
    pub acknowledge: &'static [u8],
}

impl Follower {
    /// For Motion Minds, or for packet serial of a generation that is fixed or followed.
    pub fn new(is_motion_mind: bool, generation: Option<Generation>) -> Self {
        if is_motion_mind {
            Self::Minds(Box::default())
        } else {
            Self::Packets(Box::new(Decoder::new(generation)))
        }
    }

    /// Takes bytes of the client.
    pub fn client_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        match self {
            Self::Packets(decoder) => decoder.client_sent(bytes, now),
            Self::Minds(decoder) => decoder.client_sent(bytes, now),
        }
    }

    /// Takes bytes of the controller.
    pub fn controller_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record> {
        match self {
            Self::Packets(decoder) => decoder.controller_sent(bytes, now),
            Self::Minds(decoder) => decoder.controller_sent(bytes, now),
        }
    }

    /// Whether an answer is due.
    pub fn awaits_reply(&self) -> bool {
        match self {
            Self::Packets(decoder) => decoder.awaits_reply(),
            Self::Minds(decoder) => decoder.awaits_reply(),
        }
    }

    /// Whether a command is open that further bytes may complete.
    pub fn may_become_whole(&self) -> bool {
        match self {
            Self::Packets(decoder) => decoder.may_become_whole(),
            Self::Minds(decoder) => decoder.may_become_whole(),
        }
    }

    /// Tells the time while nothing comes.
    pub fn silence(&mut self, now: Duration) -> Vec<Record> {
        match self {
            Self::Packets(decoder) => decoder.silence(now),
            Self::Minds(decoder) => decoder.silence(now),
        }
    }

    /// Tells the time while nothing comes from the client.
    pub fn client_silence(&mut self, now: Duration) -> Vec<Record> {
        match self {
            Self::Packets(decoder) => decoder.client_silence(now),
            Self::Minds(decoder) => decoder.client_silence(now),
        }
    }

    /// The client has gone.
    pub fn client_left(&mut self, now: Duration) -> Vec<Record> {
        match self {
            Self::Packets(decoder) => decoder.client_left(now),
            Self::Minds(decoder) => decoder.client_left(now),
        }
    }

    /// What stands the units that were told to move and not to stand since.
    pub fn stops(&self) -> Vec<Stop> {
        match self {
            Self::Packets(decoder) => {
                let of = |address: &Address| stop_of(*address, decoder.generation());
                decoder.moved().iter().filter_map(of).collect()
            }
            Self::Minds(decoder) => {
                let moved = decoder.moved().iter();
                moved
                    .map(|moved| {
                        let writes = moved.stops();
                        let is_text = writes.iter().any(|bytes| bytes.ends_with(b"\n"));
                        let acknowledge: &[u8] = if is_text { b"OK" } else { &[MIND_ACK] };
                        Stop { who: format!("the motor of {}", moved.address), writes, acknowledge }
                    })
                    .collect()
            }
        }
    }

    /// The pause after which what a client left half sent is over.
    pub fn gap(&self) -> Duration {
        2 * PACKET_GAP
    }
}

fn stop_of(address: Address, generation: Generation) -> Option<Stop> {
    const DUTY_ZERO: [i64; 4] = [0, scale::MAX_DUTY_ACCEL_RAW, 0, scale::MAX_DUTY_ACCEL_RAW];
    let request = Request::new(address, number::DUTY_ACCEL_BOTH, &DUTY_ZERO);
    let writes = vec![request.encode(generation).ok()?];
    Some(Stop { who: format!("both motors of {address}"), writes, acknowledge: &[ACK] })
}

/// Who follows the traffic that the arguments ask for.
pub fn follower(args: &MonitorArgs) -> Result<Follower, Exit> {
    let target = client::target(&args.connect)?;
    // Bytes from a file come from no target, unless one is named for its family.
    let family = if args.decode.is_some() && args.connect.family != FamilyChoice::AUTO {
        args.connect.family
    } else {
        client::family(&target, &args.connect)
    };
    let generation = args.generation.and_then(Generation::from_number);
    Ok(Follower::new(family == FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND), generation))
}
