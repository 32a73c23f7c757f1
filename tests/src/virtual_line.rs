//! A line between the client's transport and a simulated machine in virtual time: hours pass in a moment, and
//! every run is the same.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use brushwork_link::UnitAddress;
use brushwork_link::exchange::Exchange;
use brushwork_link::{Clock, HiddenSettings, Transport, TransportError, VirtualClock};
use brushwork_mcp_client::packet::PacketWire;
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_plant::machine::{Machine, StreamIndex};

/// A machine and the clock that it shares with its clients. Clones are the same machine.
pub struct VirtualLine<M> {
    machine: Arc<Mutex<M>>,
    clock: VirtualClock,
    stream: StreamIndex,
    /// What a read had no room for.
    rest: Vec<u8>,
}

impl<M> Clone for VirtualLine<M> {
    fn clone(&self) -> Self {
        let (machine, clock) = (Arc::clone(&self.machine), self.clock.clone());
        Self { machine, clock, stream: self.stream, rest: Vec::new() }
    }
}

impl<M: Machine + 'static> VirtualLine<M> {
    /// A line to a stream of a machine.
    pub fn new(machine: M, stream: StreamIndex) -> Self {
        let clock = VirtualClock::new();
        clock.advance_to(machine.now());
        Self { machine: Arc::new(Mutex::new(machine)), clock, stream, rest: Vec::new() }
    }

    /// The clock.
    pub fn clock(&self) -> &VirtualClock {
        &self.clock
    }

    /// Does something with the machine, which is first brought to the present.
    pub fn with<T>(&self, act: impl FnOnce(&mut M) -> T) -> T {
        let mut machine = self.lock();
        machine.advance(self.clock.now());
        act(&mut machine)
    }

    /// Lets time pass.
    pub fn pass(&self, time: Duration) {
        self.clock.advance(time);
        self.with(|_| ());
    }

    /// A client of packet serial on this line.
    pub fn wire(&self, address: Address, generation: Generation, simulated: bool) -> PacketWire {
        let exchange = Exchange::new(Box::new(self.clone()), Arc::new(self.clock.clone()));
        PacketWire::new(exchange, address, generation, simulated)
    }

    /// All that has arrived by now, as far as there is room.
    pub fn read_all(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let mut count = self.read(buffer, Duration::ZERO)?;
        while count > 0 && count < buffer.len() {
            match self.read(&mut buffer[count..], Duration::ZERO)? {
                0 => break,
                more => count += more,
            }
        }
        Ok(count)
    }

    /// The next reply, or nothing when none leaves until `deadline`.
    fn wait_for_output(&self, deadline: Duration) -> Result<Vec<u8>, TransportError> {
        let mut machine = self.lock();
        loop {
            machine.advance(self.clock.now());
            if !machine.plugged() {
                return Err(Self::gone());
            }
            if let Some(bytes) = machine.take_output(self.stream) {
                return Ok(bytes);
            }
            if self.clock.now() >= deadline {
                return Ok(Vec::new());
            }
            self.clock.advance_to(machine.next_output_at().map_or(deadline, |at| at.min(deadline)));
        }
    }

    fn lock(&self) -> MutexGuard<'_, M> {
        self.machine.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn gone() -> TransportError {
        TransportError::Gone { detail: "unplugged".to_owned() }
    }
}

impl<M: Machine + 'static> Transport for VirtualLine<M> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.with(|machine| {
            if !machine.plugged() {
                return Err(Self::gone());
            }
            machine.receive(self.stream, bytes);
            Ok(())
        })
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        if self.rest.is_empty() {
            self.rest = self.wait_for_output(self.clock.now() + timeout)?;
        }
        let count = self.rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.rest[..count]);
        self.rest.drain(..count);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let rest = std::mem::take(&mut self.rest).len();
        self.with(|machine| {
            let mut count = rest;
            while let Some(bytes) = machine.take_output(self.stream) {
                count += bytes.len();
            }
            Ok(count)
        })
    }

    fn describe(&self) -> String {
        "the simulated controller".to_owned()
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }
}

/// The hidden settings of one simulated unit, whatever its address.
pub struct HiddenOf(pub VirtualLine<brushwork_mcp_sim::controller::Bus>);

impl std::fmt::Debug for HiddenOf {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("HiddenOf")
    }
}

impl HiddenSettings for HiddenOf {
    fn get(&self, _address: UnitAddress, key: &str) -> Option<i64> {
        self.0.with(|bus| bus.controllers()[0].settings().hidden(key).ok())
    }

    fn set(&self, _address: UnitAddress, key: &str, raw: i64) -> Result<(), String> {
        let action = brushwork_plant::world::WorldAction::SetHidden { key: key.to_owned(), value: raw };
        self.0.with(|bus| bus.controllers_mut()[0].apply(&action)).map_err(|error| format!("{error}."))
    }
}
