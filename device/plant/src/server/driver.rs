//! The thread that advances a machine with the wall clock and carries its bytes.

use super::clock::Clock;
use super::error::ServerError;
use super::handle::{Command, SimHandle, Views};
use super::line::{Heard, Line};
use super::pace::{Pace, SharedPace};
use super::stack::Stack;
use super::wait::wake_exactly;
use crate::machine::{Machine, PACKET_GAP, StreamIndex};
use crate::world::WorldAction;
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
/// Bytes are given so much longer to come through the system before a gap counts as one.
const DELIVERY: Duration = Duration::from_millis(1);
/// The same for machines that take a shorter gap than that of packet serial for one: a client that sends byte by byte is held up for
/// longer than this only on a computer that is busy with other things.
const SHORT_GAP_DELIVERY: Duration = Duration::from_millis(3);
/// How often the worlds are shown.
const SHOW_EVERY: Duration = Duration::from_millis(20);
/// At full speed the machine runs for so long before the line and the commands are looked at again.
const STRETCH: Duration = Duration::from_millis(4);
/// So much of the machine's time is run before it is asked whether it still wants to be at full speed.
const STRIDE: Duration = Duration::from_millis(1);

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
    pace: SharedPace,
    incoming: Vec<u8>,
    gap: Option<Gap>,
}

/// What follows bytes until it is known whether the line was silent long enough to discard the packet they are in.
#[derive(Clone, Copy)]
struct Gap {
    /// The machine's time does not go past this before.
    ends_at: Duration,
    /// A line that is empty then was silent.
    judged_at: Duration,
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
        let pace = SharedPace::default();
        let driver = Self {
            stack,
            stream,
            line,
            plugged: true,
            commands,
            views: views.clone(),
            shown_at: machine_start,
            clock: Clock::starting_at(machine_start),
            pace: pace.clone(),
            incoming: Vec::new(),
            gap: None,
        };
        let thread = thread::Builder::new()
            .name("sim-server".to_owned())
            .spawn(move || driver.run())
            .map_err(ServerError::Thread)?;
        Ok(SimHandle::new(sender, views, pace, address, thread))
    }

    fn run(mut self) {
        wake_exactly();
        while self.turn().is_continue() {}
    }

    fn turn(&mut self) -> ControlFlow<()> {
        self.obey()?;
        self.follow_plug()?;
        self.hurry();
        let now = self.advance();
        while let Some(reply) = self.stack.take_output(self.stream) {
            self.clock.shared().machine_answers();
            self.line.send(&reply);
        }
        // What a script says on a stream that leads nowhere.
        for stream in StreamIndex::ALL.into_iter().filter(|stream| *stream != self.stream) {
            while self.stack.take_output(stream).is_some() {}
        }
        if now >= self.shown_at + SHOW_EVERY {
            self.show(now);
        }
        self.incoming.clear();
        // The wall clock has gone on since the machine was brought up to it.
        let looked_at = self.clock.now(self.stack.now());
        let patience = self.patience(looked_at);
        // It may look later than that, but for a reply that is to leave.
        let reply = self.stack.next_output_at().map(|at| self.clock.to_wall(at.saturating_sub(looked_at)));
        self.clock.rest(reply);
        let heard = self.line.receive(&mut self.incoming, patience);
        self.hear(looked_at);
        if heard == Heard::ClientLeft {
            if self.line.has_rts() {
                self.hold_rts(false);
            }
            self.stack.clear();
        }
        ControlFlow::Continue(())
    }

    /// Hands over what has come. A line that is looked at after the gap and found empty has been silent for so long.
    fn hear(&mut self, looked_at: Duration) {
        if self.incoming.is_empty() {
            // At full speed the time of the machine does not tell how long the line was silent; this thread has waited for it.
            let full_speed = self.clock.pace() == Pace::Max;
            self.gap = self.gap.filter(|gap| looked_at < gap.judged_at && !full_speed);
        } else {
            let now = self.advance();
            self.stack.receive(self.stream, &self.incoming);
            if self.clock.shared().is_shared() {
                // Time has stood still since they were written: the machine itself sees how long the line was silent.
                return;
            }
            let heard_at = self.clock.now(now);
            let silence = self.stack.silence();
            let delivery = if silence < PACKET_GAP { SHORT_GAP_DELIVERY } else { DELIVERY };
            let judged_at = heard_at + silence + self.clock.to_machine(delivery);
            self.gap = Some(Gap { ends_at: now + silence, judged_at });
        }
    }

    /// Brings the machine up to the wall clock, but not past a gap that may be this thread's own: when the system has not let
    /// it run, bytes that came in time are still unread.
    fn advance(&mut self) -> Duration {
        let wall = self.clock.now(self.stack.now());
        let now = self.gap.map_or(wall, |gap| wall.min(gap.ends_at));
        self.stack.advance(now);
        now
    }

    /// At full speed: runs the machine for a stretch of the wall clock, unless somebody has something to look at.
    fn hurry(&mut self) {
        self.clock.set_pace(self.pace.get(), self.stack.now());
        if self.clock.pace() != Pace::Max {
            return;
        }
        let until = Instant::now() + STRETCH;
        while Instant::now() < until {
            if self.stack.wants_real_time() {
                self.pace.set(Pace::default());
                self.clock.set_pace(Pace::default(), self.stack.now());
                return;
            }
            let next = self.stack.now() + STRIDE;
            let to = self.gap.map_or(next, |gap| next.min(gap.ends_at));
            if to <= self.stack.now() {
                return;
            }
            self.stack.advance(to);
        }
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
                            let shared = self.clock.shared();
                            let ends =
                                if self.stack.plugged() { self.line.new_channel(shared) } else { None };
                            if ends.is_some() {
                                self.hold_rts(true);
                            }
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

    /// The host's end of a USB port holds RTS as long as it is open, so that packet serial is spoken on it (MCP manual 1.9.3).
    fn hold_rts(&mut self, on: bool) {
        for unit in 0..self.stack.units() {
            self.stack.apply(unit, &WorldAction::SetRts { on });
        }
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

    /// How long to wait for bytes: until the next reply leaves, a gap is over, or a tick.
    fn patience(&self, now: Duration) -> Duration {
        if self.clock.pace() == Pace::Max {
            return if self.gap.is_some() { DELIVERY } else { Duration::ZERO };
        }
        let wall = |time: Duration| self.clock.to_wall(time);
        let reply = self.stack.next_output_at();
        let reply = reply.map(|at| wall(at.saturating_sub(now)).saturating_sub(WAKE_EARLY));
        let gap = self.gap.map(|gap| wall(gap.judged_at.saturating_sub(now)));
        [reply, gap].into_iter().flatten().fold(TICK, Duration::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::Faulty;
    use crate::pacing::Paced;

    const COMMAND: [u8; 8] = [0x80, 34, 0, 0, 0, 0, 0x98, 0x17];

    /// Acknowledges eight bytes that come without a gap of 10 ms among them.
    #[derive(Default)]
    struct Acknowledging {
        now: Duration,
        heard: usize,
        heard_at: Duration,
        replies: usize,
    }

    impl Machine for Acknowledging {
        fn now(&self) -> Duration {
            self.now
        }

        fn receive(&mut self, _: StreamIndex, bytes: &[u8]) {
            self.heard = bytes.len() + if self.now - self.heard_at > PACKET_GAP { 0 } else { self.heard };
            self.heard_at = self.now;
            if self.heard == COMMAND.len() {
                (self.heard, self.replies) = (0, self.replies + 1);
            }
        }

        fn advance(&mut self, to: Duration) {
            self.now = self.now.max(to);
        }

        fn next_output_at(&self) -> Option<Duration> {
            (self.replies > 0).then_some(self.now)
        }

        fn take_output(&mut self, _: StreamIndex) -> Option<Vec<u8>> {
            self.replies = self.replies.checked_sub(1)?;
            Some(vec![0xFF])
        }

        fn bits_per_second(&self, _: StreamIndex) -> u32 {
            115_200
        }

        fn units(&self) -> usize {
            0
        }

        fn apply(&mut self, _: usize, _: &WorldAction) {}

        fn views(&self) -> Vec<crate::world::WorldView> {
            Vec::new()
        }

        fn plugged(&self) -> bool {
            true
        }
    }

    /// A client whose second half packet comes 14 ms after the first; the thread may oversleep.
    struct SlowLine {
        halves: Arc<Mutex<Vec<Vec<u8>>>>,
        oversleeps: bool,
        silent_for: Duration,
        sent: Arc<Mutex<Vec<u8>>>,
    }

    const PAUSE: Duration = Duration::from_millis(14);

    impl Line for SlowLine {
        fn receive(&mut self, bytes: &mut Vec<u8>, timeout: Duration) -> Heard {
            let mut halves = self.halves.lock().expect("no test panics with it");
            let first = halves.len() == 2;
            let waited = if self.oversleeps { PAUSE } else { timeout };
            if !first {
                thread::sleep(waited);
                self.silent_for += waited;
            }
            if (first || self.silent_for >= PAUSE) && !halves.is_empty() {
                bytes.extend(halves.remove(0));
            }
            Heard::Line
        }

        fn send(&mut self, reply: &[u8]) {
            self.sent.lock().expect("no test panics with it").extend(reply);
        }

        fn unplug(&mut self) {}

        fn plug_in(&mut self) -> Result<(), ServerError> {
            Ok(())
        }
    }

    fn answer_to(oversleeps: bool) -> Vec<u8> {
        let stack = Paced::new(Faulty::new(Acknowledging::default(), Vec::new(), 0), false);
        let (_commands, commands) = bounded(COMMANDS);
        let sent = Arc::new(Mutex::new(Vec::new()));
        let halves = Arc::new(Mutex::new(vec![COMMAND[..3].to_vec(), COMMAND[3..].to_vec()]));
        let line =
            SlowLine { halves: halves.clone(), oversleeps, silent_for: Duration::ZERO, sent: sent.clone() };
        let machine_start = stack.now();
        let mut driver = Driver {
            views: Arc::new(Mutex::new(Arc::new(stack.views()))),
            stack,
            stream: StreamIndex::Usb,
            line: Box::new(line),
            plugged: true,
            commands,
            shown_at: machine_start,
            clock: Clock::starting_at(machine_start),
            pace: SharedPace::default(),
            incoming: Vec::new(),
            gap: None,
        };
        let all_is_sent = || halves.lock().expect("no test panics with it").is_empty();
        while !all_is_sent() {
            assert!(driver.turn().is_continue());
        }
        // The answer, if there is one, leaves in the turns after that.
        for _ in 0..4 {
            assert!(driver.turn().is_continue());
        }
        let sent = sent.lock().expect("no test panics with it");
        sent.clone()
    }

    #[test]
    fn bytes_that_waited_for_a_thread_that_overslept_are_still_one_packet() {
        assert_eq!(answer_to(true), [0xFF]);
    }

    #[test]
    fn a_gap_that_was_seen_discards_the_packet() {
        assert_eq!(answer_to(false), Vec::<u8>::new());
    }
}
