//! One command to one unit and its reply, as packets or as objects of a node.

use crate::can::{Place, carry_out};
use crate::packet::{Ask, gate, transact, typed_reply};
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Reply};
use brushwork_mcp_wire::packet_serial::{Address, Generation, Read, Request, Typed};
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
        if gate(&ask)?.effect.may_move() {
            line.motion_begins();
        }
        match self.wire {
            Wire::Packets => {
                let (exchange, watch) = line.parts();
                transact(exchange, watch, &ask)
            }
            Wire::Objects(place) => carry_out(line, place, &ask),
        }
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
