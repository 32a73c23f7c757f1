//! The time that a machine in this program shares with its client: the wall clock, less the time in which the system let one of them
//! wait for a processor.
//!
//! Each says until when it will be at rest. Where one is overdue, time stands still for both until it is back, so that a busy computer
//! stretches what they do and changes none of it. One that stays away is not waited for for ever: it is taken for hung, and what the
//! controller does then, such as its own time-out, goes on.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// How far time goes beyond the moment at which one of them is due: a thread that is woken in 0.1 ms and does a little is in time.
const SLACK: Duration = Duration::from_millis(1);
/// How long time stands still at the most. Work of the tuner between two stages is shorter.
const LONGEST_HOLD: Duration = Duration::from_secs(2);
/// Nobody waits for whoever rests until then.
const FOR_EVER: Duration = Duration::MAX;
/// The shortest sleep while time stands still.
const SHORT_SLEEP: Duration = Duration::from_micros(200);

/// The time of a served machine and of its client.
#[derive(Clone, Debug)]
pub struct SharedTime(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    epoch: Instant,
    /// What of the wall clock was left out.
    skipped: Duration,
    /// Until when the machine's thread rests.
    machine_due: Duration,
    client: Option<Client>,
    /// Numbers the clients.
    clients: u64,
    held_since: Option<Instant>,
}

/// The client that takes part.
#[derive(Debug)]
struct Client {
    number: u64,
    /// The thread that has its line; nobody else's look at the time counts as its own.
    thread: Option<ThreadId>,
    due: Duration,
    /// Whether bytes wake it.
    listens: bool,
}

impl State {
    /// The time now. Without a client it is the wall clock.
    fn now(&mut self) -> Duration {
        let now = self.epoch.elapsed().saturating_sub(self.skipped);
        let Some(client) = &mut self.client else { return now };
        let latest = self.machine_due.min(client.due).saturating_add(SLACK);
        if now <= latest {
            self.held_since = None;
            return now;
        }
        self.skipped += now - latest;
        if self.held_since.get_or_insert_with(Instant::now).elapsed() > LONGEST_HOLD {
            self.held_since = None;
            for due in [&mut self.machine_due, &mut client.due] {
                if due.saturating_add(SLACK) <= latest {
                    *due = FOR_EVER;
                }
            }
        }
        latest
    }

    /// The client, where this is its thread.
    fn own_client(&mut self) -> Option<&mut Client> {
        self.client.as_mut().filter(|client| client.thread == Some(thread::current().id()))
    }
}

impl SharedTime {
    /// A time that begins now.
    pub(super) fn new() -> Self {
        Self(Arc::new(Mutex::new(State {
            epoch: Instant::now(),
            skipped: Duration::ZERO,
            machine_due: FOR_EVER,
            client: None,
            clients: 0,
            held_since: None,
        })))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The machine's thread looks: until it rests it is due.
    pub(super) fn machine_looks(&self) -> Duration {
        let mut state = self.state();
        let now = state.now();
        state.machine_due = now;
        now
    }

    /// The machine's thread has nothing to do for so long, unless bytes come; `None` for ever: it may come later than it meant to.
    pub(super) fn machine_rests(&self, time: Option<Duration>) {
        let mut state = self.state();
        let now = state.now();
        state.machine_due = time.map_or(FOR_EVER, |time| now.saturating_add(time));
    }

    /// Whether there is a client.
    pub(super) fn is_shared(&self) -> bool {
        self.state().client.is_some()
    }

    /// The machine has answered, which wakes a client that listens.
    pub(super) fn machine_answers(&self) {
        let mut state = self.state();
        let now = state.now();
        if let Some(client) = state.client.as_mut().filter(|client| client.listens) {
            client.due = client.due.min(now);
        }
    }

    /// Takes part as the machine's client, in place of the one before.
    #[must_use]
    pub fn join(&self) -> ClientTime {
        let mut state = self.state();
        state.clients += 1;
        let number = state.clients;
        state.client = Some(Client { number, thread: None, due: FOR_EVER, listens: false });
        ClientTime { shared: self.clone(), number }
    }
}

/// A client's part in the time of its machine.
#[derive(Clone, Debug)]
pub struct ClientTime {
    shared: SharedTime,
    number: u64,
}

impl ClientTime {
    /// The time now. On the thread that has the line this is a sign of life.
    #[must_use]
    pub fn now(&self) -> Duration {
        let mut state = self.shared.state();
        let now = state.now();
        if let Some(client) = state.own_client() {
            (client.due, client.listens) = (now, false);
        }
        now
    }

    /// This thread has the line, and waits for so long for bytes, or as long as it has said that it rests.
    pub fn listens(&self, time: Duration) {
        let mut state = self.shared.state();
        let due = state.now().saturating_add(time);
        if let Some(client) = state.client.as_mut().filter(|client| client.number == self.number) {
            client.thread = Some(thread::current().id());
            (client.due, client.listens) = (client.due.max(due), true);
        }
    }

    /// This thread has the line and has just written to it, which wakes the machine's.
    pub fn wrote(&self) {
        let mut state = self.shared.state();
        let now = state.now();
        if let Some(client) = state.client.as_mut().filter(|client| client.number == self.number) {
            client.thread = Some(thread::current().id());
            (client.due, client.listens) = (now, false);
            state.machine_due = state.machine_due.min(now);
        }
    }

    /// Nobody looks before `until` on the thread that has the line, unless it is woken.
    pub fn rests_until(&self, until: Duration) {
        if let Some(client) = self.shared.state().own_client() {
            (client.due, client.listens) = (until, false);
        }
    }

    /// Waits for so long of this time, or is late for it where this thread has said that it rests for longer.
    pub fn sleep(&self, time: Duration) {
        let until = {
            let mut state = self.shared.state();
            let until = state.now().saturating_add(time);
            if let Some(client) = state.own_client() {
                (client.due, client.listens) = (client.due.max(until), false);
            }
            until
        };
        loop {
            let left = until.saturating_sub(self.shared.state().now());
            if left.is_zero() {
                return;
            }
            thread::sleep(left.max(SHORT_SLEEP));
        }
    }

    /// Takes no part any more.
    pub fn leave(&self) {
        self.shared.state().client.take_if(|client| client.number == self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// A client on this thread, and a machine that was just looked at.
    fn joined() -> (SharedTime, ClientTime) {
        let time = SharedTime::new();
        let client = time.join();
        client.listens(Duration::ZERO);
        time.machine_rests(Some(Duration::ZERO));
        (time, client)
    }

    #[test]
    fn time_stands_still_while_one_of_the_two_is_overdue() {
        let (time, client) = joined();
        client.rests_until(client.now() + 500 * MS);
        let begun = time.machine_looks();
        thread::sleep(30 * MS);
        assert!(time.machine_looks() <= begun + SLACK, "the machine's thread was away");
        time.machine_rests(Some(500 * MS));
        let begun = client.now();
        thread::sleep(30 * MS);
        assert!(client.now() <= begun + SLACK, "the client's was");
    }

    #[test]
    fn time_goes_on_while_both_rest_and_for_a_machine_without_a_client() {
        let (time, client) = joined();
        let begun = client.now();
        time.machine_rests(Some(500 * MS));
        client.rests_until(begun + 500 * MS);
        thread::sleep(20 * MS);
        assert!(client.now() >= begun + 20 * MS);
        client.leave();
        let begun = time.machine_looks();
        thread::sleep(20 * MS);
        assert!(time.machine_looks() >= begun + 20 * MS);
    }

    #[test]
    fn bytes_make_whoever_they_are_for_due() {
        let (time, client) = joined();
        time.machine_rests(Some(500 * MS));
        client.wrote();
        let written = client.now();
        client.listens(500 * MS);
        thread::sleep(20 * MS);
        assert!(client.now() <= written + 2 * SLACK, "the machine's thread has not read them");
        client.listens(500 * MS);
        let read = time.machine_looks();
        time.machine_answers();
        time.machine_rests(Some(500 * MS));
        thread::sleep(20 * MS);
        assert!(time.machine_looks() <= read + 2 * SLACK, "the client has not read the answer");
    }

    #[test]
    fn another_thread_that_looks_at_the_time_is_no_sign_of_life() {
        let (time, client) = joined();
        time.machine_rests(Some(500 * MS));
        let begun = client.now();
        let other = client.clone();
        let look = move || {
            thread::sleep(20 * MS);
            let first = other.now();
            thread::sleep(20 * MS);
            (first, other.now())
        };
        let seen = thread::Builder::new().name("other".to_owned()).spawn(look).expect("there are threads");
        let (first, second) = seen.join().expect("it does not panic");
        assert!(first <= begun + SLACK && second == first, "{begun:?} {first:?} {second:?}");
    }

    #[test]
    fn whoever_stays_away_is_not_waited_for_for_ever() {
        let (time, client) = joined();
        let begun = client.now();
        let until = Instant::now() + LONGEST_HOLD + 500 * MS;
        while Instant::now() < until {
            time.machine_looks();
            time.machine_rests(Some(5 * MS));
            thread::sleep(5 * MS);
        }
        assert!(time.machine_looks() > begun + 100 * MS);
    }
}
