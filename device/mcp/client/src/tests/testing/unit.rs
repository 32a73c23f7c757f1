//! A bus of units that answer from the command table with values a test sets: enough to test the device thread's rules.
//! How a controller behaves is the simulator's business and is tested against it elsewhere.

use crate::tests::testing::{Answers, ms};
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{
    Address, Direction, FramerEvent, Generation, Request, RequestFramer, encode_reply, number,
};
use brushwork_values::{Field, Kind, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// A command that a unit took.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Taken {
    /// When its last byte was written.
    pub at: Duration,
    /// The unit.
    pub address: u8,
    /// The command.
    pub command: u8,
    /// Its raw numbers.
    pub values: Vec<i64>,
}

/// What the test can set and see.
pub struct Bus {
    /// Units that answer.
    pub addresses: BTreeSet<u8>,
    /// Firmware of all of them.
    pub generation: Generation,
    /// What they call themselves.
    pub version: String,
    /// Commands to which nothing comes back.
    pub mute: BTreeSet<u8>,
    /// Nothing comes back at all.
    pub dead: bool,
    /// Reads whose values are not all zero, by command.
    pub values: BTreeMap<u8, Vec<Value>>,
    /// Time to the reply, by command; else [`Bus::delay`].
    pub slow: BTreeMap<u8, Duration>,
    /// Time to a reply.
    pub delay: Duration,
    /// Everything that was taken.
    pub taken: Vec<Taken>,
    /// When the last reply left: one that is slow holds up those behind it, as controllers answer in order.
    replied_at: Duration,
    framer: RequestFramer,
}

/// A bus that test and transport share.
pub type SharedBus = Arc<Mutex<Bus>>;

impl Bus {
    /// One MCP266 of generation 1 at 0x80, armed for: USB times out after a second, Serial is priority 1.
    pub fn shared() -> SharedBus {
        let mut bus = Self {
            addresses: BTreeSet::from([0x80]),
            generation: Generation::Gen1,
            version: "MCP266 2x60A v1.0.0".to_owned(),
            mute: BTreeSet::new(),
            dead: false,
            values: BTreeMap::new(),
            slow: BTreeMap::new(),
            delay: ms(1),
            taken: Vec::new(),
            replied_at: Duration::ZERO,
            framer: RequestFramer::new(Generation::Gen1),
        };
        bus.set(number::READ_PRIORITIES, &[1, 0, 0]);
        bus.set(number::READ_BUFFERS, &[0x80, 0x80]);
        bus.set_streams(&[1000; 5]);
        Arc::new(Mutex::new(bus))
    }

    /// Sets the numbers that a read returns.
    pub fn set(&mut self, command: u8, values: &[i64]) {
        self.values.insert(command, values.iter().map(|&value| Value::Int(value)).collect());
    }

    /// Sets the time-outs of the streams, all of them packet serial at 115200.
    pub fn set_streams(&mut self, timeouts_ms: &[i64]) {
        let records = timeouts_ms.iter().map(|timeout| vec![1, 115_200, *timeout]).collect();
        self.values.insert(number::READ_STREAMS, vec![Value::Records(records)]);
    }

    /// Takes bytes and says what comes back.
    pub fn take(&mut self, bytes: &[u8], now: Duration) -> Answers {
        let mut answers = Answers::new();
        for byte in bytes {
            if let Some(FramerEvent::Request(framed)) = self.framer.feed(*byte, now) {
                answers.extend(self.answer(&framed.request(), now));
            }
        }
        answers
    }

    /// The commands taken so far, without their times.
    pub fn commands(&self) -> Vec<u8> {
        self.taken.iter().map(|taken| taken.command).collect()
    }

    /// How often a command was taken.
    pub fn count(&self, command: u8) -> usize {
        self.taken.iter().filter(|taken| taken.command == command).count()
    }

    fn answer(&mut self, request: &Request, now: Duration) -> Option<(Duration, Vec<u8>)> {
        let address = request.address.get();
        if !self.addresses.contains(&address) {
            return None;
        }
        let values = request.values.iter().filter_map(Value::as_int).collect();
        self.taken.push(Taken { at: now, address, command: request.command, values });
        if self.dead || self.mute.contains(&request.command) {
            return None;
        }
        let form = request.row()?.form(self.generation)?;
        let values = match self.values.get(&request.command) {
            Some(values) => values.clone(),
            None => form.reply.fields().iter().map(|field| self.default_of(field)).collect(),
        };
        let values = if form.direction == Direction::Write { Vec::new() } else { values };
        let reply = encode_reply(request, self.generation, &values).ok()?;
        let delay = self.slow.get(&request.command).copied().unwrap_or(self.delay);
        self.replied_at = self.replied_at.max(now + delay);
        Some((self.replied_at - now, reply))
    }

    fn default_of(&self, field: &Field) -> Value {
        match field.kind {
            Kind::Text { .. } => Value::Text(self.version.clone()),
            Kind::Counted(_) => Value::Records(Vec::new()),
            Kind::Bytes(count) => Value::Bytes(vec![0; count]),
            Kind::Ascii36 | Kind::Utf16Le36 => Value::Text(String::new()),
            _ => Value::Int(0),
        }
    }
}

/// Sets the generation of a bus before anything is sent.
pub fn of_generation(bus: &SharedBus, generation: Generation) {
    let mut bus = bus.lock().unwrap();
    bus.generation = generation;
    bus.framer = RequestFramer::new(generation);
}

/// Makes the units RoboClaws that throw away what they do not know and all that follows it, until the line was silent for 10 ms.
pub fn of_roboclaws(bus: &SharedBus) {
    let mut bus = bus.lock().unwrap();
    bus.version = "USB Roboclaw 2x7a v4.2.8".to_owned();
    bus.framer = RequestFramer::for_family(bus.generation, Family::RoboClaw);
}

/// All eight addresses answer, as over USB.
pub fn answer_all_eight(bus: &SharedBus) {
    bus.lock().unwrap().addresses = Address::ALL.into_iter().map(Address::get).collect();
}
