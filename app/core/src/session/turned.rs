//! A simulated machine and the device loop that speaks to it, both turned by whoever has the time: neither has a thread or looks at a clock.
//! A web page has no threads.
//!
//! Machine and client share a time, which goes on by what [`TurnedLink::turn`] is given. A job that takes longer than that either
//! gives way in its middle, by a [`Pause`], or goes on at once and leaves the time ahead.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_canopen::bus::Monitor;
use brushwork_family::{Simulator, Started};
use brushwork_link::device::{Addresses, DeviceHandle, DeviceLoop, DeviceOptions, Step, Stopper};
use brushwork_link::driver::{CanLine, can_line};
use brushwork_link::transport::{Stream, Transport, TransportError};
use brushwork_link::{Clock, FamilyChoice, HiddenSettings, UnitAddress, VirtualClock};
use brushwork_plant::faults::Faulty;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::pacing::Paced;
use brushwork_plant::server::Pace;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;

use super::line::SimulatedLine;
use super::simulation::{SimulationError, make};
use super::{SessionError, can_addresses};

/// Lets others work while a job waits, and says how much time may pass until it is to be called again.
pub type Pause = fn() -> Duration;

/// Events that may wait for a window which is not drawn in the middle of a job.
pub(super) const EVENTS: usize = 65_536;
/// So far ahead of what the page has handed out, motion is let live on: no window can be drawn then, so that it does not hang. Less than
/// motion lives by itself, and more than an exchange takes, so that a page which is not drawn lets motors stop.
const RENEWED_AHEAD: Duration = Duration::from_millis(50);
/// How often then.
const RENEWED_EVERY: Duration = Duration::from_millis(25);
/// The least that time goes on where something is due at once.
const INSTANT: Duration = Duration::from_micros(1);
/// At full speed a machine is so much faster than its client.
const FULL_SPEED: u32 = 50;
/// At full speed so much of its time is run before it is asked whether it still wants that.
const STRIDE: Duration = Duration::from_millis(1);

/// One or more simulated controllers on one line, and the worlds around them.
pub struct Turned {
    text: String,
    addresses: Vec<UnitAddress>,
    nodes: Vec<NodeId>,
    can_form: Option<Form>,
    stream: Stream,
    simulator: &'static dyn Simulator,
    time: Time,
    machine: Mutex<Served>,
    /// Numbers the clients; the newest has the line.
    clients: AtomicU64,
    is_open: AtomicBool,
    /// The last look at a script that was asked for.
    script: Mutex<Option<View>>,
}

/// The machine, and how its time stands to that of its client.
struct Served {
    stack: Paced<Faulty<SimulatedLine>>,
    index: StreamIndex,
    /// The machine's time when the client's was `since`.
    from: Duration,
    since: Duration,
    pace: Pace,
}

/// The time that a machine and its client share, and how far it may go now. Clones are the same.
#[derive(Clone)]
struct Time {
    clock: VirtualClock,
    limit: Arc<Mutex<Duration>>,
    pause: Option<Pause>,
    /// Lets motion live on where nobody else can.
    client: Arc<Mutex<Option<Stopper>>>,
}

impl Time {
    fn advance_to(&self, time: Duration) {
        loop {
            let limit = *self.limit.lock().unwrap_or_else(PoisonError::into_inner);
            self.clock.advance_to(time.min(limit));
            if self.clock.now() >= time {
                return;
            }
            match self.pause {
                Some(pause) => self.allow(pause()),
                None => self.go_ahead(limit, time),
            }
        }
    }

    /// Goes on beyond what was allowed.
    fn go_ahead(&self, limit: Duration, time: Duration) {
        let client = self.client.lock().unwrap_or_else(PoisonError::into_inner);
        while self.clock.now() < time {
            self.clock.advance_to(time.min(self.clock.now() + RENEWED_EVERY));
            if let Some(client) = client.as_ref().filter(|_| self.clock.now() > limit + RENEWED_AHEAD) {
                client.renew();
            }
        }
    }

    /// From now it may go on by so much.
    fn allow(&self, time: Duration) {
        *self.limit.lock().unwrap_or_else(PoisonError::into_inner) = self.clock.now() + time;
    }
}

impl Clock for Time {
    fn now(&self) -> Duration {
        self.clock.now()
    }

    fn sleep(&self, time: Duration) {
        self.advance_to(self.now() + time);
    }
}

impl Served {
    fn machine_time(&self, now: Duration) -> Duration {
        self.from + now.saturating_sub(self.since)
    }

    fn advance(&mut self, now: Duration) {
        let to = self.machine_time(now);
        self.stack.advance(to);
        // What a script says on a stream that leads nowhere.
        for stream in StreamIndex::ALL.into_iter().filter(|stream| *stream != self.index) {
            while self.stack.take_output(stream).is_some() {}
        }
    }

    /// Lets the machine's time go on by what it hurries beyond its client's.
    fn hurry(&mut self, by: Duration) {
        let times = match self.pace {
            Pace::Times(times) => u32::from(times.get()),
            Pace::Max => FULL_SPEED,
        };
        let until = self.stack.now() + by * (times - 1);
        while self.stack.now() < until {
            if self.pace == Pace::Max && self.stack.wants_real_time() {
                self.pace = Pace::REAL;
                return;
            }
            let before = self.stack.now();
            self.stack.advance((before + STRIDE).min(until));
            self.from += self.stack.now() - before;
        }
    }

    fn hold_rts(&mut self, on: bool) {
        for unit in 0..self.stack.units() {
            self.stack.apply(unit, &WorldAction::SetRts { on });
        }
    }
}

impl Turned {
    /// Makes what the text behind `sim:` describes; its time begins at `now`.
    ///
    /// # Errors
    /// The text names something that does not exist.
    pub fn start(text: &str, now: Duration, pause: Option<Pause>) -> Result<Self, SimulationError> {
        let (simulator, started, _) = make(text)?;
        let Started { machine, addresses, nodes, can_form, index, stream, seed } = started;
        let line = SimulatedLine::new(machine);
        let stack = Paced::new(Faulty::new(line, Vec::new(), seed), false);
        let clock = VirtualClock::new();
        clock.advance_to(now);
        let from = stack.now();
        Ok(Self {
            text: text.to_owned(),
            addresses,
            nodes,
            can_form,
            stream,
            simulator,
            time: Time { clock, limit: Arc::new(Mutex::new(now)), pause, client: Arc::default() },
            machine: Mutex::new(Served { stack, index, from, since: now, pace: Pace::REAL }),
            clients: AtomicU64::new(0),
            is_open: AtomicBool::new(false),
            script: Mutex::default(),
        })
    }

    /// Whether it is what `text` describes.
    pub fn is(&self, text: &str) -> bool {
        self.text == text
    }

    /// Plugs a client in, and gives the loop that speaks for it; the one before is disconnected.
    ///
    /// # Errors
    /// The cable is unplugged, or no family has nodes on a CAN bus.
    pub fn open(self: &Arc<Self>, addresses: Addresses) -> Result<Opened, SessionError> {
        self.with(|served| {
            let plugged = served.stack.plugged();
            served.stack.clear();
            if plugged {
                served.hold_rts(true);
            }
            plugged.then_some(()).ok_or(SimulationError::Unplugged)
        })?;
        let number = self.clients.fetch_add(1, Ordering::SeqCst) + 1;
        let transport = Box::new(TurnedLine { machine: self.clone(), number, unread: Vec::new() });
        let clock: Arc<dyn Clock> = Arc::new(self.time.clone());
        let is_single = self.addresses.len() == 1;
        let hidden = (self.can_form.is_none() || is_single).then(|| self.clone() as Arc<dyn HiddenSettings>);
        let options =
            DeviceOptions { simulated: true, hidden, event_capacity: EVENTS, ..DeviceOptions::default() };
        let ((device_loop, device), bus) = match self.can_form {
            Some(form) => {
                let options = DeviceOptions { addresses: can_addresses(addresses), ..options };
                let CanLine { transport, search, monitor } =
                    can_line(transport, &clock, form).ok_or(SessionError::NoNodes)?;
                (DeviceLoop::for_family(transport, clock, options, search), Some(monitor))
            }
            None => {
                let family = FamilyChoice::of(self.simulator.family());
                let options = DeviceOptions { addresses, family, stream: Some(self.stream), ..options };
                (DeviceLoop::new(transport, clock, options), None)
            }
        };
        *self.time.client.lock().unwrap_or_else(PoisonError::into_inner) = Some(device.stopper());
        self.is_open.store(true, Ordering::SeqCst);
        let link = TurnedLink { device_loop, machine: self.clone(), number, last_turns: None };
        Ok(Opened { link, device, bus })
    }

    /// Lets time pass for a machine that nobody is connected to.
    pub fn pass(&self, by: Duration) {
        if !self.is_open.load(Ordering::SeqCst) {
            self.time.clock.advance(by);
            self.with(|served| served.hurry(by));
        }
    }

    /// Does something to the world of a unit, counted from 0.
    pub fn apply(&self, unit: usize, action: &WorldAction) {
        self.with(|served| {
            served.stack.apply(unit, action);
            if !served.stack.plugged() {
                served.stack.clear();
            }
        });
    }

    /// The worlds of all units.
    pub fn views(&self) -> Vec<WorldView> {
        self.with(|served| served.stack.views())
    }

    /// Asks the debugger of a unit's script for something, and for a look at it.
    pub fn debug(&self, unit: usize, requests: Vec<Request>, wanted: &Wanted) {
        let view = self.with(|served| self.simulator.debug(machine_of(served), unit, requests, wanted));
        *self.script.lock().unwrap_or_else(PoisonError::into_inner) = view;
    }

    /// The newest look at the script that was asked for, once.
    pub fn script(&self) -> Option<View> {
        self.script.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Whether its units run programs of a language that are put into their memory past the wire.
    pub fn runs(&self, language: Language) -> bool {
        self.simulator.runs(language)
    }

    /// Puts such a program into a unit's memory and starts it.
    pub fn run_program(&self, unit: usize, program: Arc<Program>) {
        self.with(|served| self.simulator.run_program(machine_of(served), unit, program));
    }

    /// How fast the machine's time goes.
    pub fn pace(&self) -> Pace {
        self.lock().pace
    }

    /// Lets the machine's time go faster, or as its client's again.
    pub fn set_pace(&self, pace: Pace) {
        self.lock().pace = pace;
    }

    /// Which unit, counted from 0, has this number on its bus: an address, or a node id on a CAN bus.
    pub fn unit_of(&self, id: u8) -> Option<usize> {
        match self.can_form {
            Some(_) => self.nodes.iter().position(|node| node.get() == id),
            None => self.unit_at(UnitAddress::new(self.simulator.family(), id)?),
        }
    }

    fn unit_at(&self, address: UnitAddress) -> Option<usize> {
        self.addresses.iter().position(|unit| *unit == address)
    }

    fn lock(&self) -> MutexGuard<'_, Served> {
        self.machine.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does something with the machine, which is first brought to the present.
    fn with<T>(&self, act: impl FnOnce(&mut Served) -> T) -> T {
        let mut served = self.lock();
        served.advance(self.time.now());
        act(&mut served)
    }
}

fn machine_of(served: &mut Served) -> &mut dyn Machine {
    served.stack.inner_mut().inner_mut().machine_mut()
}

impl fmt::Debug for Turned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Turned").field("text", &self.text).finish_non_exhaustive()
    }
}

impl HiddenSettings for Turned {
    fn get(&self, address: UnitAddress, key: &str) -> Option<i64> {
        let unit = self.unit_at(address)?;
        self.with(|served| self.simulator.hidden(machine_of(served), unit, key))
    }

    fn set(&self, address: UnitAddress, key: &str, value: i64) -> Result<(), String> {
        let unit =
            self.unit_at(address).ok_or_else(|| format!("There is no simulated unit at {address}."))?;
        self.with(|served| self.simulator.set_hidden(machine_of(served), unit, key, value))
    }
}

/// An open link that is turned by hand.
pub struct Opened {
    /// What turns it.
    pub link: TurnedLink,
    /// The window's end of it.
    pub device: DeviceHandle,
    /// What is heard of the nodes, on a CAN bus.
    pub bus: Option<Monitor>,
}

/// The loop of a link to a machine.
pub struct TurnedLink {
    device_loop: DeviceLoop,
    machine: Arc<Turned>,
    number: u64,
    /// Once it has ended: so many more turns give the window time to take the reason.
    last_turns: Option<u32>,
}

impl TurnedLink {
    /// Lets so much time pass. Says how far beyond it the time has gone, in a job that could not give way.
    pub fn turn(&mut self, by: Duration) -> Duration {
        let time = &self.machine.time;
        let until = time.now() + by;
        time.allow(by);
        self.machine.with(|served| served.hurry(by));
        while time.now() < until {
            match self.device_loop.step() {
                Step::Again => {}
                Step::IdleUntil(at) => time.clock.advance_to(at.max(time.now() + INSTANT).min(until)),
                Step::Ended => {
                    time.clock.advance_to(until);
                    self.last_turns = Some(self.last_turns.map_or(100, |left| left.saturating_sub(1)));
                }
            }
        }
        self.machine.with(|_| ());
        // A pause has let it go on: that much was not by itself.
        let limit = *time.limit.lock().unwrap_or_else(PoisonError::into_inner);
        time.now().saturating_sub(until.max(limit))
    }

    /// Whether nothing more is said over it.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.last_turns.is_some()
    }

    /// Whether it has ended and said so.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.last_turns == Some(0)
    }
}

impl Drop for TurnedLink {
    fn drop(&mut self) {
        if self.machine.clients.load(Ordering::SeqCst) == self.number {
            self.machine.is_open.store(false, Ordering::SeqCst);
            self.machine.with(|served| {
                served.hold_rts(false);
                served.stack.clear();
            });
        }
    }
}

/// The client's end of the line.
struct TurnedLine {
    machine: Arc<Turned>,
    number: u64,
    unread: Vec<u8>,
}

impl TurnedLine {
    fn is_there(&self, served: &Served) -> Result<(), TransportError> {
        if served.stack.plugged() && self.machine.clients.load(Ordering::SeqCst) == self.number {
            Ok(())
        } else {
            Err(TransportError::Gone { detail: "the simulated controller was unplugged".to_owned() })
        }
    }

    fn wait_until(&self, deadline: Duration) -> Result<Vec<u8>, TransportError> {
        let time = &self.machine.time;
        loop {
            let now = time.now();
            // Nobody has the machine while others work.
            let next = {
                let mut served = self.machine.lock();
                served.advance(now);
                self.is_there(&served)?;
                let index = served.index;
                if let Some(bytes) = served.stack.take_output(index) {
                    return Ok(bytes);
                }
                let at = served.machine_time(now);
                served.stack.next_output_at().map(|next| now + next.saturating_sub(at).max(INSTANT))
            };
            if now >= deadline {
                return Ok(Vec::new());
            }
            time.advance_to(next.map_or(deadline, |next| next.min(deadline)));
        }
    }
}

impl Transport for TurnedLine {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let mut served = self.machine.lock();
        served.advance(self.machine.time.now());
        self.is_there(&served)?;
        let index = served.index;
        served.stack.receive(index, bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        if self.unread.is_empty() {
            self.unread = self.wait_until(self.machine.time.now() + timeout)?;
        }
        let count = self.unread.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.unread[..count]);
        self.unread.drain(..count);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let mut served = self.machine.lock();
        served.advance(self.machine.time.now());
        let index = served.index;
        let late: usize =
            std::iter::from_fn(|| served.stack.take_output(index)).map(|bytes| bytes.len()).sum();
        Ok(late + std::mem::take(&mut self.unread).len())
    }

    fn describe(&self) -> String {
        format!("sim:{}", self.machine.text)
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_family::simulator;
    use brushwork_link::device::{Event, Job, Request};
    use brushwork_link::messages::ActMessage;
    use std::sync::atomic::AtomicU32;

    const FRAME: Duration = Duration::from_millis(16);

    fn open(text: &str, pause: Option<Pause>) -> (Arc<Turned>, Opened) {
        simulator::install(&[&brushwork_mcp::McpSimulator]);
        brushwork_link::install(&[&brushwork_mcp_client::McpDriver]);
        let machine = Arc::new(Turned::start(text, Duration::from_secs(5), pause).unwrap());
        let opened = machine.open(Addresses::Scan).unwrap();
        (machine, opened)
    }

    fn turn_until(opened: &mut Opened, what: &str, mut holds: impl FnMut(&Event) -> bool) -> Duration {
        let mut ahead = Duration::ZERO;
        let mut seen = Vec::new();
        for _ in 0..2_000 {
            ahead += opened.link.turn(FRAME);
            for event in opened.device.events().try_iter() {
                if holds(&event) {
                    return ahead;
                }
                seen.push(format!("{event:?}"));
            }
        }
        panic!("waited for {what}: {seen:?}");
    }

    #[test]
    fn a_link_is_found_in_the_time_that_it_is_given_and_closed_again() {
        let (machine, mut opened) = open("mcp266", None);
        turn_until(&mut opened, "a unit", |event| matches!(event, Event::Connected(_)));
        assert!(machine.time.now() >= Duration::from_secs(5));
        turn_until(&mut opened, "a sample", |event| matches!(event, Event::Sample(_)));
        opened.device.request(Request::Disconnect).unwrap();
        turn_until(&mut opened, "the end", |event| matches!(event, Event::Closed));
        (0..200).for_each(|_| {
            opened.link.turn(FRAME);
        });
        assert!(opened.link.is_over());
    }

    static PAUSES: AtomicU32 = AtomicU32::new(0);

    fn frame() -> Duration {
        PAUSES.fetch_add(1, Ordering::SeqCst);
        FRAME
    }

    #[test]
    fn a_long_job_gives_way_by_its_pauses_or_leaves_the_time_ahead() {
        for (pause, expected_ahead) in [(None, true), (Some(frame as Pause), false)] {
            let (_machine, mut opened) = open("mcp266", pause);
            turn_until(&mut opened, "a unit", |event| matches!(event, Event::Connected(_)));
            let before = PAUSES.load(Ordering::SeqCst);
            let job = Job::new(ActMessage::GoOn, Duration::from_secs(60), |wire| {
                (0..200)
                    .try_for_each(|_| wire.sleep(Duration::from_millis(50)))
                    .map_err(|error| error.failure(ActMessage::GoOn, wire.describe()))
            });
            let _ticket = opened.device.start(job).unwrap();
            let ahead = turn_until(&mut opened, "its end", |event| matches!(event, Event::JobEnded { .. }));
            assert_eq!(ahead > Duration::from_secs(9), expected_ahead, "{ahead:?}");
            let pauses = PAUSES.load(Ordering::SeqCst) - before;
            assert_eq!(pauses > 500, !expected_ahead, "{pauses} pauses in ten seconds");
        }
    }

    #[test]
    fn an_unplugged_cable_ends_the_link_and_a_new_client_finds_the_same_machine() {
        let (machine, mut opened) = open("mcp266", None);
        turn_until(&mut opened, "a unit", |event| matches!(event, Event::Connected(_)));
        machine.apply(0, &WorldAction::Unplug { unplugged: true });
        turn_until(&mut opened, "the loss", |event| matches!(event, Event::Lost(_)));
        assert!(machine.open(Addresses::Scan).is_err(), "its cable is out");
        machine.apply(0, &WorldAction::Unplug { unplugged: false });
        let mut again = machine.open(Addresses::Scan).unwrap();
        drop(opened);
        turn_until(&mut again, "the unit", |event| matches!(event, Event::Connected(_)));
    }
}
