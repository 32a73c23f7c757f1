//! One command to one unit and its reply, as packets or as objects of a node.

use crate::can::{Place, carry_out};
use crate::packet::{Ask, gate, transact, typed_reply};
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Reply, Tries};
use brushwork_mcp_wire::packet_serial::{Address, Effect, Generation, Read, Request, Typed, number};
use brushwork_values::Value;

/// Who is spoken to and in which widths.
#[derive(Clone, Copy, Debug)]
pub struct Speaker {
    pub address: Address,
    pub generation: Generation,
    pub wire: Wire,
}

/// How commands reach the unit.
#[derive(Clone, Copy, Debug)]
pub enum Wire {
    /// As packets.
    Packets,
    /// As accesses to the objects of a node.
    Objects(Place),
}

impl Speaker {
    /// A unit on packet serial.
    pub fn packets(address: Address, generation: Generation) -> Self {
        Self { address, generation, wire: Wire::Packets }
    }

    /// Its number on its bus: the address, or the node id.
    pub fn id(self) -> u8 {
        match self.wire {
            Wire::Packets => self.address.get(),
            Wire::Objects(place) => place.node.get(),
        }
    }

    /// Sends a command whose values are all numbers.
    pub fn ask<const L: u8>(
        self,
        line: &mut Line<'_>,
        command: Typed<L>,
        values: &[i64],
    ) -> Result<Reply<Read<L>>, ExchangeError> {
        let values = values.iter().map(|&value| Value::Int(value)).collect();
        typed_reply(self.ask_values(line, command.number(), values)?, command)
    }

    pub fn ask_values(
        self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Reply, ExchangeError> {
        let request = Request { address: self.address, command, values };
        let ask = Ask {
            request: &request,
            generation: self.generation,
            permit: line.permit(),
            retries: line.retries(),
        };
        let form = gate(&ask)?;
        if form.effect.may_move() {
            line.motion_begins();
        }
        let can_be_learned = matches!(form.effect, Effect::Query | Effect::Setting)
            && !line.is_stopping()
            && line.exchange().capabilities().knows(self.id());
        let title =
            || ask.request.row().map_or_else(String::new, |row| row.title(self.generation).to_owned());
        if can_be_learned && line.exchange().capabilities().lacks(self.id(), command) {
            return Err(ExchangeError::Absent { command: title() });
        }
        let retries_before = line.exchange().retries();
        let result = self.send(line, &ask);
        if can_be_learned && self.learn(line, command, &result, retries_before)? {
            return Err(ExchangeError::Absent { command: title() });
        }
        result
    }

    fn send(self, line: &mut Line<'_>, ask: &Ask<'_>) -> Result<Reply, ExchangeError> {
        match self.wire {
            Wire::Packets => {
                let (exchange, watch) = line.parts();
                transact(exchange, watch, ask)
            }
            Wire::Objects(place) => carry_out(line, place, ask),
        }
    }

    /// Takes note of how the unit took a command. Whether the firmware is found to lack it: nothing came to it, and the version came right after.
    #[allow(clippy::wildcard_enum_match_arm, reason = "an error that tells nothing of the firmware")]
    pub fn learn(
        self,
        line: &mut Line<'_>,
        command: u8,
        result: &Result<Reply, ExchangeError>,
        retries_before: u64,
    ) -> Result<bool, ExchangeError> {
        let again = line.exchange().retries() - retries_before;
        let again = u32::try_from(again).unwrap_or(u32::MAX);
        match result {
            Ok(reply) => {
                let took = reply.span.replied_at.saturating_sub(reply.span.requested_at);
                line.exchange().capabilities().answered(self.id(), command, took, again);
            }
            Err(ExchangeError::Refused { is_absent, .. }) => {
                line.exchange().capabilities().refused(self.id(), command, *is_absent);
            }
            Err(ExchangeError::BadAcknowledgement { .. }) => {
                line.exchange().capabilities().refused(self.id(), command, false);
            }
            // While motors may run, nothing is asked only in order to learn.
            Err(ExchangeError::TimedOut { heard: 0, tries: Tries(tries), .. })
                if self.is_packets() && !line.permit().motion =>
            {
                let request = Request::new(self.address, number::READ_VERSION, &[]);
                let permit = line.permit();
                let ask = Ask { request: &request, generation: self.generation, permit, retries: 0 };
                return match self.send(line, &ask) {
                    Ok(_) => Ok(line.exchange().capabilities().silent(self.id(), command, *tries)),
                    Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
                    Err(_) => Ok(false),
                };
            }
            Err(_) => {}
        }
        Ok(false)
    }

    fn is_packets(self) -> bool {
        matches!(self.wire, Wire::Packets)
    }

    /// As [`Speaker::ask`], but `None` where the unit does not know the command: it answers nothing, or nothing that fits, or
    /// its generation has no such command.
    pub fn ask_if_known<const L: u8>(
        self,
        line: &mut Line<'_>,
        command: Typed<L>,
    ) -> Result<Option<Reply<Read<L>>>, ExchangeError> {
        match self.ask(line, command, &[]) {
            Ok(reply) => Ok(Some(reply)),
            Err(ExchangeError::Unsupported { .. }) => Ok(None),
            Err(error) if error.is_unusable_answer() => Ok(None),
            Err(error) => Err(error),
        }
    }
}
