//! A line between the device loop and a simulated controller, in virtual time.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use brushwork_link::{Clock as _, Transport, TransportError, VirtualClock};
use brushwork_mcp_sim::controller::Bus;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::WorldAction;

use super::lockstep::Gate;

/// A simulated bus and the clock it shares with its client. Clones are the same.
pub struct Line<M = Bus> {
    bus: Arc<Mutex<M>>,
    stream: StreamIndex,
    name: &'static str,
    pub clock: VirtualClock,
    rest: Vec<u8>,
    swallowed: Arc<Mutex<Option<Swallowed>>>,
    cut: Arc<Mutex<Option<Cut>>>,
    gate: Option<Gate>,
}

/// Something done to the machine right after a command has reached it.
struct Cut {
    /// Where in a request its number stands.
    place: usize,
    command: u8,
    /// Commands of that number that pass before.
    passing: usize,
    action: WorldAction,
}

/// A command that gets lost, and what comes back instead.
struct Swallowed {
    command: u8,
    reply: Vec<u8>,
}

impl<M> Clone for Line<M> {
    fn clone(&self) -> Self {
        Self {
            bus: self.bus.clone(),
            stream: self.stream,
            name: self.name,
            clock: self.clock.clone(),
            rest: self.rest.clone(),
            swallowed: self.swallowed.clone(),
            cut: self.cut.clone(),
            gate: self.gate.clone(),
        }
    }
}

impl Line {
    pub fn new(bus: Bus) -> Self {
        let stream = bus.stream();
        Self::of(bus, stream, "sim:mcp266")
    }
}

impl<M: Machine> Line<M> {
    /// A line to any machine, on a stream of it, as a person would name it.
    pub fn of(bus: M, stream: StreamIndex, name: &'static str) -> Self {
        let swallowed = Arc::default();
        Self {
            bus: Arc::new(Mutex::new(bus)),
            stream,
            name,
            clock: VirtualClock::new(),
            rest: Vec::new(),
            swallowed,
            cut: Arc::default(),
            gate: None,
        }
    }

    /// The same line for the device loop, which waits for the window at `gate`.
    pub fn through(&self, gate: Gate) -> Self {
        Self { gate: Some(gate), ..self.clone() }
    }

    fn advance_to(&self, time: Duration) {
        match &self.gate {
            Some(gate) => gate.advance_to(time),
            None => self.clock.advance_to(time),
        }
    }

    /// From now on a command does not reach the controller; what stands for its reply comes back at once.
    pub fn swallow(&self, command: u8, reply: &[u8]) {
        *self.swallowed.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(Swallowed { command, reply: reply.to_vec() });
    }

    /// Does something to the machine as soon as a command has reached it so many times.
    pub fn after(&self, command: u8, times: usize, action: WorldAction) {
        *self.cut.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(Cut { place: 1, command, passing: times.saturating_sub(1), action });
    }

    /// The same for the binary frames of a Motion Mind, which begin with their command.
    pub fn after_frame(&self, command: u8, times: usize, action: WorldAction) {
        *self.cut.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(Cut { place: 0, command, passing: times.saturating_sub(1), action });
    }

    fn cut(&self, request: &[u8]) {
        let mut planned = self.cut.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(cut) = planned.as_mut().filter(|cut| request.get(cut.place) == Some(&cut.command)) else {
            return;
        };
        if cut.passing > 0 {
            cut.passing -= 1;
        } else if let Some(cut) = planned.take() {
            self.with(|bus| bus.apply(0, &cut.action));
        }
    }

    /// The reply to a request that is swallowed.
    fn instead_of(&self, request: &[u8]) -> Option<Vec<u8>> {
        let swallowed = self.swallowed.lock().unwrap_or_else(PoisonError::into_inner);
        let of_this = swallowed.as_ref().filter(|swallowed| request.get(1) == Some(&swallowed.command))?;
        Some(of_this.reply.clone())
    }

    /// Does something with the bus, which is first brought to the present.
    pub fn with<T>(&self, act: impl FnOnce(&mut M) -> T) -> T {
        let mut bus = self.lock();
        bus.advance(self.clock.now());
        act(&mut bus)
    }

    fn lock(&self) -> MutexGuard<'_, M> {
        self.bus.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn plugged(bus: &M) -> Result<(), TransportError> {
        let gone = || TransportError::Gone { detail: "the cable was pulled out".to_owned() };
        if bus.plugged() { Ok(()) } else { Err(gone()) }
    }

    fn wait_until(&self, deadline: Duration) -> Result<Vec<u8>, TransportError> {
        loop {
            let mut bus = self.lock();
            bus.advance(self.clock.now());
            Self::plugged(&bus)?;
            if let Some(bytes) = bus.take_output(self.stream) {
                return Ok(bytes);
            }
            if self.clock.now() >= deadline {
                return Ok(Vec::new());
            }
            let next = bus.next_output_at().map_or(deadline, |at| at.min(deadline));
            // The window looks at the bus too.
            drop(bus);
            self.advance_to(next);
        }
    }
}

impl<M: Machine> Transport for Line<M> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        if let Some(reply) = self.instead_of(bytes) {
            self.rest.extend(reply);
            return Ok(());
        }
        self.with(|bus| {
            Self::plugged(bus)?;
            bus.receive(self.stream, bytes);
            Ok(())
        })?;
        self.cut(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        if self.rest.is_empty() {
            self.rest = self.wait_until(self.clock.now() + timeout)?;
        }
        let count = self.rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.rest[..count]);
        self.rest.drain(..count);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let kept = std::mem::take(&mut self.rest).len();
        self.with(|bus| {
            let late =
                std::iter::from_fn(|| bus.take_output(self.stream)).map(|bytes| bytes.len()).sum::<usize>();
            Ok(kept + late)
        })
    }

    fn describe(&self) -> String {
        self.name.to_owned()
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }
}
