//! Events with their handlers, waits, pointers into memory, and what is handed to the board.
//!
//! Events are raised from outside, between two runs of the machine, so that nothing has to be looked at from instruction to instruction: a
//! handler is called at the beginning of a run, where events are let in again, and where another handler has returned.

use super::events::{Kept, after_ticks};
use super::{Call, FaultKind, Host, Machine, State};
use crate::op::Op;
use crate::program::{Program, limits};

type Done = Result<(), FaultKind>;

impl Machine {
    /// An event has come: its handler is called as soon as the program is not in a wait, not in another handler, and lets events in; of
    /// several the one with the lowest number first. One that comes again before that counts once, one without a handler not at all.
    pub fn raise(&mut self, event: u32) {
        if self.events.handlers.contains_key(&event) {
            self.events.raised |= 1 << event;
        }
    }

    /// Whether the handler of an event runs.
    #[must_use]
    pub fn is_in_handler(&self) -> bool {
        self.events.in_handler
    }

    #[inline(never)]
    pub(super) fn serve_event(&mut self) {
        let events = &mut self.events;
        if events.raised == 0 || !events.are_let_in || events.in_handler {
            return;
        }
        let event = events.raised.trailing_zeros();
        events.raised &= events.raised - 1;
        let Some(to) = events.handlers.get(&event).copied() else { return };
        if self.calls.len() >= limits::CALLS {
            return self.fault(self.at, FaultKind::CallsTooDeep);
        }
        events.in_handler = true;
        let interrupted = Some(self.result);
        let (returns_to, base) = (self.at, self.stack.len());
        self.calls.push(Call { returns_to, entered_at: to, base, interrupted });
        self.at = to;
    }

    /// Whether an event waits for its handler and may call it with the next instruction.
    #[must_use]
    pub fn has_event(&self) -> bool {
        self.events.raised != 0 && self.events.are_let_in && !self.events.in_handler
    }

    pub(super) fn handler_returned(&mut self) {
        self.events.in_handler = false;
        self.serve_event();
    }

    /// Puts back what the subroutine kept that has just returned.
    pub(super) fn put_back(&mut self) {
        let depth = self.calls.len();
        while let Some(kept) = self.kept.pop_if(|kept| kept.depth > depth) {
            self.memory.put(kept.first, &kept.bytes);
        }
    }

    #[inline(never)]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub(super) fn on_board<H: Host + ?Sized>(&mut self, op: Op, program: &Program, host: &mut H) -> Done {
        match op {
            Op::Handle(event, to) => {
                self.events.handlers.insert(event, to);
            }
            Op::Events(on) => {
                self.events.are_let_in = on;
                self.serve_event();
            }
            Op::Wait(parts) => {
                let until = after_ticks(host.now(), self.pop()?, parts);
                self.state = State::Pausing { until };
            }
            Op::Board(command) => {
                let arguments = self.pop_many(command.arguments())?;
                let given = host.board(command, &arguments);
                if command.gives() {
                    self.push(given)?;
                }
                self.wait_for(host);
            }
            Op::LoadByte => {
                let address = self.pop()?;
                let byte = self.checked(address, 1)?[0];
                self.push(byte.into())?;
            }
            Op::Send(count) => {
                let address = self.pop()?;
                host.send(self.checked(address, count)?);
                self.wait_for(host);
            }
            Op::Receive(count) => {
                let address = self.pop()?;
                self.checked(address, count)?;
                let mut bytes = host.receive();
                bytes.resize(count as usize, 0);
                self.memory.put(address, &bytes);
            }
            Op::Fill(to, from, count) => {
                let range = from as usize..from as usize + count as usize;
                self.memory.put(to, program.data.get(range).ok_or(FaultKind::BadJump)?);
            }
            Op::Keep(first, count) => {
                let bytes = self.memory.slice(first, count).to_vec();
                let all: usize = self.kept.iter().map(|kept| kept.bytes.len()).sum();
                if all + bytes.len() > limits::KEPT_BYTES || self.kept.len() >= 2 * limits::CALLS {
                    return Err(FaultKind::StackFull);
                }
                self.kept.push(Kept { depth: self.calls.len(), first, bytes });
            }
            other => self.stream(other, program, host)?,
        }
        Ok(())
    }

    /// Bytes of memory behind a pointer.
    fn checked(&self, address: u32, count: u32) -> Result<&[u8], FaultKind> {
        let slice = self.memory.slice(address, count);
        if slice.len() == count as usize {
            return Ok(slice);
        }
        let bytes = u32::try_from(self.memory.bytes().len()).unwrap_or(u32::MAX);
        Err(FaultKind::OutsideMemory { address: address.max(bytes), bytes })
    }
}
