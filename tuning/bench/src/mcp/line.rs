//! The link of the bench to a simulated MCP or RoboClaw: packet serial in virtual time, with latency, jitter and loss.

use crate::line::{Bench, SimulatedLine};
use brushwork_mcp_axis::{Carrier, Timed};
use brushwork_mcp_sim::controller::Controller;
use brushwork_mcp_wire::packet_serial::{
    Address, Generation, Given, ReplyProgress, Request, Typed, parse_reply,
};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_tuning::axis::{AxisError, Exchange};
use std::time::Duration;

/// How long a reply is waited for, s.
const REPLY_TIMEOUT_S: f64 = 0.010;
/// On a slow line it is so many times the usual latency: both ways, each up to 1.6 times that, and some more.
const PATIENCE: f64 = 4.0;

impl Bench for Controller {
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
        // The actions used here name no settings.
        let _ = self.apply(action);
    }
}

impl Carrier for SimulatedLine<Controller> {
    fn transact<const L: u8>(&mut self, command: Typed<L>, given: &[Given<L>]) -> Timed<L> {
        if self.is_stopped() {
            return Err(AxisError::Stopped);
        }
        let generation = self.generation();
        let request = Request::typed(Address::DEFAULT, command, generation, given)
            .map_err(|error| AxisError::Refused(error.to_string()))?;
        let bytes = request.encode(generation).map_err(|error| AxisError::Refused(error.to_string()))?;
        let sent = self.now;
        let deadline = sent + Duration::from_secs_f64(REPLY_TIMEOUT_S.max(PATIENCE * self.usual_latency_s()));
        let dead = self.is_dead();
        let (lost_request, lost_reply) = (self.is_lost() || dead, self.is_lost() || dead);
        let (up, down) = (self.latency(), self.latency());
        self.advance(sent + up);
        if lost_request {
            self.advance(deadline);
            return Err(AxisError::NoReply);
        }
        self.unit.receive(StreamIndex::Usb, &bytes);
        self.sent.push(bytes);
        let left = self.unit.next_output_at();
        let arrives = left.map(|at| at + down).filter(|at| *at <= deadline && !lost_reply);
        self.advance(arrives.unwrap_or(deadline));
        let reply = self.unit.take_output(StreamIndex::Usb).unwrap_or_default();
        if arrives.is_none() {
            return Err(AxisError::NoReply);
        }
        self.read_late();
        match parse_reply(&request, generation, &reply) {
            ReplyProgress::Done { values, .. } => {
                let values = command.reply(values).ok_or(AxisError::NoReply)?;
                Ok((Exchange { sent, received: self.now }, values))
            }
            ReplyProgress::NeedMore { .. }
            | ReplyProgress::BadCrc { .. }
            | ReplyProgress::BadAck { .. }
            | ReplyProgress::Malformed { .. } => Err(AxisError::NoReply),
        }
    }

    fn now(&mut self) -> Duration {
        self.now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.wait(time)
    }

    fn is_simulated(&self) -> bool {
        !self.passes_for_real
    }

    fn stolen(&mut self) -> Duration {
        self.take_stolen()
    }

    fn generation(&self) -> Generation {
        self.unit.config().generation
    }

    fn stream(&self) -> Option<usize> {
        Some(StreamIndex::Usb.index())
    }
}
