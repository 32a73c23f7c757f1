//! The loop of the device thread: one step at a time, so that a test can drive it in virtual time.
//!
//! Each step does the most urgent thing that is due: what breaks in (Stop, dead-man, disarm, close), then a request, then
//! one reading of the sweep. Read [`DeviceLoop::step`] first; requests, readings, halts and jobs stand in a file each.

mod guarding;
mod halting;
mod jobs;
mod loader;
mod reading;
mod requests;
mod state;
mod stop_again;
mod sweep;
mod thread;

pub use state::{DeviceLoop, Step};
pub use thread::DeviceThread;

use super::controller::{Controller, Described, DiscoverError, Line, Search};
use super::drive::ArmScope;
use super::event::{DisarmReason, Event};
use super::family::AnyFamily;
use super::handle::DeviceHandle;
use super::options::DeviceOptions;
use super::outbox::Outbox;
use super::signals::{Guard, Signals};
use crate::clock::Clock;
use crate::exchange::Permit;
use crate::exchange::{Exchange, ExchangeError, Interruption, Watch};
use crate::failure::Failure;
use crate::messages::{ActMessage, RemedyMessage};
use crate::transport::Transport;
use brushwork_values::Message;
use crossbeam_channel::{Receiver, bounded};
use state::{Phase, Unit};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use sweep::Sweep;

/// How often the link's figures are told.
const STATISTICS_INTERVAL: Duration = Duration::from_millis(500);
/// No reply is longer.
const LONGEST_REPLY: usize = 4096;
/// How soon a full event channel is tried again.
const FLUSH_INTERVAL: Duration = Duration::from_millis(5);

impl DeviceLoop {
    /// A loop over `transport` for the family that the options name, or that is found, and the handle that speaks to it. Nothing is sent before
    /// the first step.
    #[must_use]
    pub fn new(
        transport: Box<dyn Transport>,
        clock: Arc<dyn Clock>,
        options: DeviceOptions,
    ) -> (Self, DeviceHandle) {
        let family = Box::new(AnyFamily::new(options.family));
        Self::with_family(transport, clock, options, family).0
    }

    /// The same for any family.
    #[must_use]
    pub fn for_family(
        transport: Box<dyn Transport>,
        clock: Arc<dyn Clock>,
        options: DeviceOptions,
        family: Box<dyn Search>,
    ) -> (Self, DeviceHandle) {
        Self::with_family(transport, clock, options, family).0
    }

    /// The same for any family, with the channel that wakes an idle thread.
    fn with_family(
        transport: Box<dyn Transport>,
        clock: Arc<dyn Clock>,
        options: DeviceOptions,
        family: Box<dyn Search>,
    ) -> ((Self, DeviceHandle), Receiver<()>) {
        let (signals, woken) = Signals::new(clock.clone());
        let (requests, inbox) = bounded(options.request_capacity.max(1));
        let (events, for_window) = bounded(options.event_capacity.max(1));
        let waker = Arc::new(Mutex::new(None));
        let now = clock.now();
        let handle = DeviceHandle::new(requests, for_window, signals.clone(), waker.clone());
        let device_loop = Self {
            exchange: Exchange::new(transport, clock.clone()).with_capabilities(options.capabilities.clone()),
            guard: Guard::new(signals.clone()),
            outbox: Outbox::new(events, waker),
            waiting: VecDeque::new(),
            stream: options.stream,
            poll: options.poll,
            reads_signals: false,
            units: Vec::new(),
            selected: 0,
            joined: Vec::new(),
            armed: None,
            disarmed_by: None,
            held: Vec::new(),
            sweep: Sweep::new(now),
            statistics_at: now + STATISTICS_INTERVAL,
            phase: Phase::Connecting,
            stopped_while_connecting: false,
            last_sent: Vec::new(),
            last_received: Vec::new(),
            clock,
            signals,
            inbox,
            family,
            options,
        };
        ((device_loop, handle), woken)
    }

    /// Does the most urgent thing that is due.
    pub fn step(&mut self) -> Step {
        let step = match self.phase {
            Phase::Connecting => self.connect(),
            Phase::Running => self.run_once(),
            Phase::Ended => Step::Ended,
        };
        self.keep_house();
        step
    }

    fn run_once(&mut self) -> Step {
        let now = self.clock.now();
        if let Some(cause) = self.guard.interruption(now) {
            self.serve(cause);
            return Step::Again;
        }
        if let Some((index, again)) = self.unconfirmed_stop() {
            // Anything else on the line would feed the controller's own time-out and keep its motors alive.
            if now < again.at {
                return Step::IdleUntil(again.at);
            }
            self.stop_again(index, again);
            return Step::Again;
        }
        if let Some(envelope) = self.next_request() {
            self.handle(envelope);
            return Step::Again;
        }
        if self.is_reading_due(now) {
            self.read_one();
            return Step::Again;
        }
        Step::IdleUntil(self.next_moment(now))
    }

    /// Does what broke in.
    fn serve(&mut self, cause: Interruption) {
        match cause {
            Interruption::Stop => self.halt(DisarmReason::Stop),
            Interruption::DeadMan => self.halt(DisarmReason::DeadMan),
            Interruption::Disarm => self.halt(DisarmReason::Asked),
            Interruption::Closing => self.close(),
            // These end jobs, and no job runs here.
            Interruption::Cancelled | Interruption::TimeLimit => {}
        }
    }

    /// Finds the units of the link and introduces them.
    fn connect(&mut self) -> Step {
        let guesses = self.options.simulated;
        let permit = Permit { guesses, ..Permit::default() };
        let asked_at = self.clock.now();
        let outbox = &mut self.outbox;
        let mut tell = |done: usize, of: usize, what: &str| {
            outbox.send(Event::Searching { done, of, what: what.to_owned() });
            outbox.wake_window();
        };
        let mut line = Line::new(&mut self.exchange, &self.guard, permit, asked_at).with_progress(&mut tell);
        match self.family.discover(&mut line, &self.options) {
            Ok(units) => self.introduce(units),
            Err(DiscoverError::NothingThere(failure)) => self.end(Event::Lost(failure)),
            Err(DiscoverError::Exchange(error)) => self.break_off_connecting(&error),
        }
        Step::Again
    }

    fn introduce(&mut self, controllers: Vec<Box<dyn Controller>>) {
        for controller in controllers {
            self.outbox.send(Event::Connected(controller.identity().clone()));
            self.units.push(Unit::new(controller));
        }
        self.phase = Phase::Running;
        self.sweep = Sweep::new(self.clock.now());
        self.tell_selection();
        self.tell_capabilities();
        if std::mem::take(&mut self.stopped_while_connecting) {
            self.halt(DisarmReason::Stop);
        }
    }

    fn break_off_connecting(&mut self, error: &ExchangeError) {
        match error.interruption() {
            Some(Interruption::Stop) => {
                self.stopped_while_connecting = true;
                self.halt(DisarmReason::Stop);
            }
            Some(_) => self.close(),
            None => self.lose(error),
        }
    }

    /// Stops what this program set in motion and closes the link.
    fn close(&mut self) {
        if self.armed.is_some() || self.units.iter().any(|unit| unit.moved) {
            self.halt(DisarmReason::Closing);
        }
        if self.phase != Phase::Ended {
            self.end(Event::Closed);
        }
    }

    /// The link is gone: says so, and why, and does nothing more.
    fn lose(&mut self, error: &ExchangeError) {
        self.lose_for(error.message());
    }

    fn lose_for(&mut self, came_back: Message) {
        let remedy = if self.guard.is_moving() || self.units.iter().any(|unit| unit.moved) {
            RemedyMessage::SeeThatTheyStand
        } else {
            RemedyMessage::CheckPowerAndCable
        };
        let failure = Failure::new(ActMessage::GoOnTalking, self.exchange.port(), came_back, remedy);
        self.end(Event::Lost(failure));
    }

    fn end(&mut self, last: Event) {
        if self.phase == Phase::Ended {
            return;
        }
        if self.armed.take().is_some() {
            self.outbox.send(Event::Disarmed(DisarmReason::LinkLost));
        }
        self.guard.set_armed(false, self.signals.disarms());
        self.guard.motion_ends();
        self.tend_guard();
        self.dismiss_guard();
        self.signals.end_outside();
        self.phase = Phase::Ended;
        self.tell_capabilities();
        self.outbox.send(last);
    }

    /// Statistics, traffic and waiting events.
    fn keep_house(&mut self) {
        self.tend_guard();
        let now = self.clock.now();
        if now >= self.statistics_at && self.phase == Phase::Running {
            self.statistics_at = now + STATISTICS_INTERVAL;
            let mut statistics = self.exchange.statistics();
            statistics.dropped_samples = self.outbox.dropped_samples();
            self.outbox.send(Event::Link(statistics));
            self.tell_capabilities();
        }
        self.tell_traffic();
        self.outbox.flush();
        self.outbox.wake_window();
    }

    /// Keeping them takes the time of a file, which nobody has to spare who drives a motor.
    fn tell_capabilities(&mut self) {
        if self.armed.is_none() {
            for (address, map) in self.exchange.capabilities().take_news() {
                self.outbox.send(Event::Capabilities { address, map });
            }
        }
    }

    fn tell_traffic(&mut self) {
        for traffic in self.exchange.take_traffic() {
            let controller = self.units.get(self.selected).map(|unit| &unit.controller);
            let text = if traffic.sent {
                self.last_sent.clone_from(&traffic.bytes);
                self.last_received.clear();
                controller.map(|unit| unit.describe_traffic(&traffic.bytes, None))
            } else {
                // A reply that comes in two parts is read as one. Noise without end is not kept.
                if self.last_received.len() < LONGEST_REPLY {
                    self.last_received.extend(&traffic.bytes);
                }
                controller.map(|unit| unit.describe_traffic(&self.last_sent, Some(&self.last_received)))
            };
            let Described { text, sound } = text.unwrap_or_default();
            self.outbox.send(Event::Traffic { traffic, text, sound });
        }
    }

    /// When something is due by time alone.
    fn next_moment(&self, now: Duration) -> Duration {
        let flush_at = self.outbox.is_waiting().then(|| now + FLUSH_INTERVAL);
        [Some(self.statistics_at), self.next_reading_at(), self.guard.next(), flush_at]
            .into_iter()
            .flatten()
            .min()
            .unwrap_or(self.statistics_at)
    }

    /// What may go out now.
    fn permit(&self) -> Permit {
        let scope = self.armed.map(|armed| armed.scope);
        Permit {
            motion: scope.is_some_and(ArmScope::allows_motion),
            script: scope.is_some_and(ArmScope::allows_scripts),
            guesses: self.options.simulated,
            loader: false,
        }
    }

    /// The units that move together, the selected one first.
    fn together(&self) -> impl Iterator<Item = usize> + use<> {
        std::iter::once(self.selected).chain(self.joined.clone())
    }

    fn is_together(&self, index: usize) -> bool {
        index == self.selected || self.joined.contains(&index)
    }

    /// Lets the selected unit do something that was asked for at `asked_at`.
    fn act<T>(
        &mut self,
        asked_at: Duration,
        act: impl FnOnce(&mut dyn Controller, &mut Line<'_>) -> Result<T, ExchangeError>,
    ) -> Result<T, ExchangeError> {
        self.act_on(self.selected, asked_at, act)
    }

    fn act_on<T>(
        &mut self,
        index: usize,
        asked_at: Duration,
        act: impl FnOnce(&mut dyn Controller, &mut Line<'_>) -> Result<T, ExchangeError>,
    ) -> Result<T, ExchangeError> {
        let permit = self.permit();
        let was_moving = self.guard.is_moving();
        let unit = &mut self.units[index];
        let mut line = Line::new(&mut self.exchange, &self.guard, permit, asked_at);
        let done = act(unit.controller.as_mut(), &mut line);
        unit.moved |= line.has_moved() || self.guard.is_moving() && !was_moving;
        done
    }

    /// Tells a failure of an act, unless something broke in that is served anyway. A lost link ends the loop.
    fn tell(&mut self, tried: ActMessage, error: &ExchangeError) {
        self.tell_of(self.selected, tried, error);
    }

    fn tell_of(&mut self, index: usize, tried: ActMessage, error: &ExchangeError) {
        if error.is_link_lost() {
            self.lose(error);
        } else if error.interruption().is_none() {
            let failure = error.failure(tried, self.name_of(index));
            self.outbox.send(Event::Failure(failure));
        }
    }

    /// A unit and its port, for sentences.
    fn name_of(&self, index: usize) -> String {
        let port = self.exchange.port();
        match self.units.get(index) {
            Some(unit) => format!("{} at {port}", unit.controller.identity().place()),
            None => port,
        }
    }

    fn tell_selection(&mut self) {
        if let Some(unit) = self.units.get(self.selected) {
            let address = unit.controller.identity().address;
            self.outbox.send(Event::Selected { address, stream: self.stream });
        }
    }
}
