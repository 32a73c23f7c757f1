//! The device loop on a thread of its own, in lockstep with the window: it runs up to the time it was granted and waits
//! there, in the middle of a job if need be, until the window has drawn its frame.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use brushwork_link::device::{DeviceLoop, Step};
use brushwork_link::{Clock, VirtualClock};

/// How long the loop may compute, in real time, before the test is given up.
const PATIENCE: Duration = Duration::from_secs(120);

/// Whose turn it is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Turn {
    Window,
    Loop,
}

struct State {
    turn: Turn,
    /// The loop does not let time pass this.
    limit: Duration,
    /// The thread hands the loop back when it is next at rest.
    hand_over: bool,
    /// The thread has come to its end.
    ended: bool,
}

/// A clock that nobody on the loop's thread can turn beyond what was granted. Clones are the same.
#[derive(Clone)]
pub struct Gate {
    clock: VirtualClock,
    state: Arc<(Mutex<State>, Condvar)>,
}

impl Gate {
    pub fn new(clock: VirtualClock) -> Self {
        let state = State { turn: Turn::Window, limit: Duration::ZERO, hand_over: false, ended: false };
        Self { clock, state: Arc::new((Mutex::new(state), Condvar::new())) }
    }

    /// Turns the clock on to `time`, with a wait for the window at each time granted.
    pub fn advance_to(&self, time: Duration) {
        loop {
            let limit = self.lock().limit;
            self.clock.advance_to(time.min(limit));
            if self.clock.now() >= time {
                return;
            }
            self.give_turn();
        }
    }

    /// Lets the window draw, and waits for the next grant.
    fn give_turn(&self) {
        let mut state = self.lock();
        state.turn = Turn::Window;
        self.state.1.notify_all();
        let granted = self.state.1.wait_while(state, |state| state.turn == Turn::Window);
        drop(granted.unwrap_or_else(PoisonError::into_inner));
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Clock for Gate {
    fn now(&self) -> Duration {
        self.clock.now()
    }

    fn sleep(&self, time: Duration) {
        self.advance_to(self.clock.now() + time);
    }
}

/// A device loop that is turned by grants of time.
pub struct Lockstep {
    gate: Gate,
    thread: Option<JoinHandle<Option<DeviceLoop>>>,
}

impl Lockstep {
    /// A loop whose clock and transport wait at `gate`.
    pub fn new(gate: Gate, device_loop: DeviceLoop) -> Self {
        let of_thread = gate.clone();
        let builder = std::thread::Builder::new().name("device loop in lockstep".to_owned());
        let thread = builder.spawn(move || turn(&of_thread, device_loop)).expect("the system gives a thread");
        Self { gate, thread: Some(thread) }
    }

    /// Lets the loop run until `time`.
    pub fn run_until(&self, time: Duration) {
        let mut state = self.gate.lock();
        (state.limit, state.turn) = (time, Turn::Loop);
        self.gate.state.1.notify_all();
        let is_at_work = |state: &mut State| state.turn == Turn::Loop && !state.ended;
        let waited = self.gate.state.1.wait_timeout_while(state, PATIENCE, is_at_work);
        let (state, waited) = waited.unwrap_or_else(PoisonError::into_inner);
        drop(state);
        assert!(!waited.timed_out(), "the device loop hangs");
        self.gate.clock.advance_to(time);
    }

    /// Takes the loop back, to turn it by hand. It must not be in the middle of a job.
    pub fn into_loop(mut self) -> DeviceLoop {
        let thread = self.thread.take().expect("taken once, here");
        let mut state = self.gate.lock();
        (state.hand_over, state.limit, state.turn) = (true, Duration::MAX, Turn::Loop);
        self.gate.state.1.notify_all();
        let waited = self.gate.state.1.wait_timeout_while(state, PATIENCE, |state| !state.ended);
        let (state, waited) = waited.unwrap_or_else(PoisonError::into_inner);
        drop(state);
        assert!(!waited.timed_out(), "the device loop hangs");
        thread.join().expect("the loop does not panic").expect("the link is open")
    }
}

impl Drop for Lockstep {
    /// The window is gone: the loop runs on alone until it has seen that.
    fn drop(&mut self) {
        let mut state = self.gate.lock();
        (state.limit, state.turn) = (Duration::MAX, Turn::Loop);
        drop(state);
        self.gate.state.1.notify_all();
    }
}

/// What the thread does. Gives the loop back when asked, nothing when the link has ended.
fn turn(gate: &Gate, mut device_loop: DeviceLoop) -> Option<DeviceLoop> {
    let _end = GiveTurnAtEnd(gate);
    loop {
        let (limit, hand_over) = {
            let state = gate.lock();
            (state.limit, state.hand_over)
        };
        if hand_over {
            return Some(device_loop);
        }
        if gate.now() >= limit || gate.lock().turn == Turn::Window {
            gate.give_turn();
            continue;
        }
        match device_loop.step() {
            Step::Again => {}
            Step::IdleUntil(at) => gate.clock.advance_to(at.min(limit)),
            Step::Ended => return None,
        }
    }
}

/// The window is not left waiting, whatever ends the thread.
struct GiveTurnAtEnd<'a>(&'a Gate);

impl Drop for GiveTurnAtEnd<'_> {
    fn drop(&mut self) {
        let mut state = self.0.lock();
        (state.turn, state.ended) = (Turn::Window, true);
        drop(state);
        self.0.state.1.notify_all();
    }
}
