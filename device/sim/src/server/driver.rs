//! The thread that advances a machine with the wall clock and carries its bytes.

use super::Stack;
use super::error::ServerError;
use super::handle::{Command, SimHandle, Views};
use super::line::{Heard, Line};
use super::wait::wake_exactly;
use crate::machine::{Machine, StreamIndex};
use crossbeam_channel::{Receiver, TryRecvError, bounded};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Commands that may wait for the thread.
const COMMANDS: usize = 64;
/// Longest wait. Bytes and replies do not wait for it, commands and snapshots do; the machine catches up with it in microseconds.
const TICK: Duration = Duration::from_millis(5);
/// The system wakes a sleeping thread this much late or less, so that much before a reply leaves the thread stays awake.
const WAKE_EARLY: Duration = Duration::from_micros(80);
/// How often the worlds are shown.
const SHOW_EVERY: Duration = Duration::from_millis(20);
/// After a longer gap (the computer slept, the program was stopped) the machine's time does not catch up but goes on from where
/// it was.
const LONGEST_CATCH_UP: Duration = Duration::from_millis(250);

/// A machine on its endpoint.
pub struct Driver<M: Machine> {
    stack: Stack<M>,
    stream: StreamIndex,
    line: Box<dyn Line>,
    plugged: bool,
    commands: Receiver<Command<M>>,
    views: Views,
    shown_at: Duration,
    clock: Clock,
    incoming: Vec<u8>,
}

/// The wall clock, less the time that was skipped.
struct Clock {
    start: Instant,
    machine_start: Duration,
    skipped: Duration,
}

impl<M: Machine + 'static> Driver<M> {
    /// Starts the thread.
    pub fn spawn(
        stack: Stack<M>,
        stream: StreamIndex,
        line: Box<dyn Line>,
        address: String,
    ) -> Result<SimHandle<M>, ServerError> {
        let (sender, commands) = bounded(COMMANDS);
        let views: Views = Arc::new(Mutex::new(Arc::new(stack.views())));
        let machine_start = stack.now();
        let driver = Self {
            stack,
            stream,
            line,
            plugged: true,
            commands,
            views: views.clone(),
            shown_at: machine_start,
            clock: Clock { start: Instant::now(), machine_start, skipped: Duration::ZERO },
            incoming: Vec::new(),
        };
        let thread = thread::Builder::new()
            .name("sim-server".to_owned())
            .spawn(move || driver.run())
            .map_err(ServerError::Thread)?;
        Ok(SimHandle::new(sender, views, address, thread))
    }

    fn run(mut self) {
        wake_exactly();
        while self.turn().is_continue() {}
    }

    fn turn(&mut self) -> ControlFlow<()> {
        self.obey()?;
        self.follow_plug()?;
        let now = self.advance();
        while let Some(reply) = self.stack.take_output(self.stream) {
            self.line.send(&reply);
        }
        if now >= self.shown_at + SHOW_EVERY {
            self.show(now);
        }
        self.incoming.clear();
        let patience = self.patience();
        let heard = self.line.receive(&mut self.incoming, patience);
        if !self.incoming.is_empty() {
            self.advance();
            self.stack.receive(self.stream, &self.incoming);
        }
        if heard == Heard::ClientLeft {
            self.stack.clear();
        }
        ControlFlow::Continue(())
    }

    /// Brings the machine up to the wall clock.
    fn advance(&mut self) -> Duration {
        let now = self.clock.now(self.stack.now());
        self.stack.advance(now);
        now
    }

    fn obey(&mut self) -> ControlFlow<()> {
        let mut obeyed = false;
        loop {
            match self.commands.try_recv() {
                Ok(command) => {
                    obeyed = true;
                    self.advance();
                    match command {
                        Command::Apply(unit, action) => self.stack.apply(unit, &action),
                        Command::Inspect(inspect) => inspect(self.stack.inner_mut().inner_mut()),
                        Command::NewChannel(reply) => {
                            let ends = if self.stack.plugged() { self.line.new_channel() } else { None };
                            // Whoever asked may have gone.
                            let _ = reply.send(ends);
                        }
                    }
                }
                Err(TryRecvError::Disconnected) => return ControlFlow::Break(()),
                Err(TryRecvError::Empty) => break,
            }
        }
        if obeyed {
            self.show(self.stack.now());
        }
        ControlFlow::Continue(())
    }

    /// Takes the endpoint away or brings it back with the cable. An endpoint that cannot be brought back is the end.
    fn follow_plug(&mut self) -> ControlFlow<()> {
        let plugged = self.stack.plugged();
        if plugged != self.plugged {
            self.plugged = plugged;
            if plugged {
                if self.line.plug_in().is_err() {
                    return ControlFlow::Break(());
                }
            } else {
                self.stack.clear();
                self.line.unplug();
            }
        }
        ControlFlow::Continue(())
    }

    fn show(&mut self, now: Duration) {
        self.shown_at = now;
        let views = Arc::new(self.stack.views());
        *self.views.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = views;
    }

    /// How long to wait for bytes: until the next reply leaves, or a tick.
    fn patience(&mut self) -> Duration {
        let Some(at) = self.stack.next_output_at() else { return TICK };
        // The wall clock has gone on since the machine was brought up to it.
        let left = at.saturating_sub(self.clock.now(self.stack.now()));
        left.saturating_sub(WAKE_EARLY).min(TICK)
    }
}

impl Clock {
    /// The machine's time by the wall clock; the machine itself stands at `machine_now`.
    fn now(&mut self, machine_now: Duration) -> Duration {
        let now = self.machine_start + self.start.elapsed() - self.skipped;
        let behind = now.saturating_sub(machine_now);
        if behind <= LONGEST_CATCH_UP {
            return now;
        }
        self.skipped += behind;
        machine_now
    }
}
