//! The link of the bench to a simulated Motion Mind: frames or lines in virtual time, at a baud rate, with latency, jitter and loss.

use super::population::MindSpecimen;
use crate::line::{Bench, SimulatedLine};
use brushwork_motion_mind_axis::{BITS_PER_BYTE, MindCarrier, worked_at};
use brushwork_motion_mind_sim::{MotionMind, Protocol};
use brushwork_motion_mind_wire::{
    Address, Command, Part, Progress, Reply, Returns, encode_frame, encode_line, parse_frame_reply,
    parse_line_reply,
};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_tuning::axis::{AxisError, Exchange};
use std::time::Duration;

/// How long a reply is waited for beyond its bytes: the manual says at most 10 ms, and 50 for long lines, s.
const REPLY_TIMEOUT_S: (f64, f64) = (0.015, 0.055);
impl Bench for MotionMind {
    fn time(&self) -> Duration {
        self.now()
    }

    fn pass(&mut self, to: Duration) {
        self.advance(to);
    }

    fn look(&self) -> WorldView {
        self.view()
    }

    fn undergo(&mut self, action: &WorldAction) {
        self.apply(action);
    }
}

/// A line to a unit.
#[derive(Debug)]
pub struct MindLine {
    /// The line beneath.
    pub line: SimulatedLine<MotionMind>,
    bits_per_second: u32,
}

impl MindLine {
    /// The line of a plant, its unit switched on half a second ago.
    #[must_use]
    pub fn new(specimen: &MindSpecimen) -> Self {
        Self::of(specimen.controller(), specimen)
    }

    /// The same to a unit that is set up otherwise.
    #[must_use]
    pub fn of(unit: MotionMind, specimen: &MindSpecimen) -> Self {
        let mut line = SimulatedLine::new(unit, specimen.link);
        line.idle(Duration::from_millis(500));
        Self { line, bits_per_second: specimen.unit.bits_per_second }
    }
}

fn parsed(protocol: Protocol, command: &Command, bytes: &[u8]) -> Option<Reply> {
    let progress = match protocol {
        Protocol::Binary => parse_frame_reply(Address::FACTORY, command, Returns::default(), bytes),
        Protocol::Text => parse_line_reply(command, Returns::default(), bytes),
    };
    match progress {
        Progress::Done { reply, .. } => Some(reply),
        Progress::Incomplete | Progress::Bad(_) => None,
    }
}

impl MindCarrier for MindLine {
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn transact(&mut self, command: &Command) -> Result<(Exchange, Reply), AxisError> {
        let protocol = self.line_protocol();
        let line = &mut self.line;
        if line.is_stopped() {
            return Err(AxisError::Stopped);
        }
        let bytes = match protocol {
            Protocol::Binary => encode_frame(Address::FACTORY, command),
            Protocol::Text => encode_line(Address::FACTORY, command).map(String::into_bytes),
        };
        let bytes = bytes.map_err(|error| AxisError::Refused(error.to_string()))?;
        let per_byte = |count: usize| {
            Duration::from_secs_f64(count as f64 * BITS_PER_BYTE / f64::from(self.bits_per_second))
        };
        let dead = line.is_dead();
        let (lost_request, lost_reply) = (line.is_lost() || dead, line.is_lost() || dead);
        let (up, down) = (line.latency(), line.latency());
        let sent = line.now;
        let arrived = sent + up + per_byte(bytes.len());
        let timeout_s = match command {
            Command::ReadText(Part::All) => REPLY_TIMEOUT_S.1,
            _ => REPLY_TIMEOUT_S.0,
        };
        let deadline = arrived + Duration::from_secs_f64(timeout_s);
        line.advance(arrived);
        if lost_request {
            line.advance(deadline);
            return Err(AxisError::NoReply);
        }
        line.unit.receive(&bytes);
        line.sent.push(bytes.clone());
        let Some(leaves) = line.unit.next_output_at().filter(|at| *at <= deadline) else {
            line.advance(deadline);
            return Err(AxisError::NoReply);
        };
        line.advance(leaves);
        let reply = line.unit.take_output().unwrap_or_default();
        line.advance(leaves + per_byte(reply.len()) + down);
        if lost_reply {
            line.advance(deadline.max(line.now));
            return Err(AxisError::NoReply);
        }
        line.read_late();
        let at = worked_at(
            (sent, line.now),
            (bytes.len(), reply.len()),
            self.bits_per_second,
            (protocol, command),
        );
        parsed(protocol, command, &reply).map(|reply| (at, reply)).ok_or(AxisError::NoReply)
    }

    fn protocol(&self) -> Protocol {
        self.line_protocol()
    }

    fn bits_per_second(&self) -> Option<u32> {
        Some(self.bits_per_second)
    }

    fn now(&mut self) -> Duration {
        self.line.now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.line.wait(time)
    }

    fn stolen(&mut self) -> Duration {
        self.line.take_stolen()
    }
}

impl MindLine {
    fn line_protocol(&self) -> Protocol {
        self.line.unit.protocol()
    }
}
