//! What reaches the device thread without waiting in its queue: Stop, renewal, disarm, close.
//!
//! All of it is atomic, so that a window, a signal handler and a frozen queue make no difference. [`Guard`] is the
//! thread's own view of it: what may break into an exchange at a given moment.

use super::identity::Identity;
use super::options::Addresses;
use super::stop::StopReport;
use crate::clock::{Clock, nanoseconds};
use crate::exchange::{Interruption, Watch};
use crate::guardian::LineGuard;
use crossbeam_channel::{Receiver, Sender, bounded};
use std::cell::{Cell, RefCell};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long a motion command lives unless the window renews it.
pub const MOTION_LIFE: Duration = Duration::from_millis(250);

/// Stands for "no motion command is in effect".
const AT_REST: u64 = u64::MAX;

/// The flags of one link, shared by its handle and its thread.
pub struct Signals {
    clock: Arc<dyn Clock>,
    stops: AtomicU64,
    stopped_at: AtomicU64,
    renewed_at: AtomicU64,
    /// Since when a motion command may be in effect, in nanoseconds; [`AT_REST`] while none is.
    motion_since: AtomicU64,
    disarms: AtomicU64,
    closing: AtomicBool,
    wake: Sender<()>,
    /// Who stops the motors when this program dies.
    guard: Mutex<Option<Box<dyn LineGuard>>>,
    /// Stops that another program has asked for, until they are answered; none any more when the link has ended.
    from_outside: Mutex<Option<Vec<OutsideStop>>>,
}

/// A stop that another program has asked for.
struct OutsideStop {
    addresses: Addresses,
    answer: Sender<OutsideAnswer>,
}

/// What another program is told of a stop that it has asked for: who is known on the line, and what became of the stop.
pub type OutsideAnswer = (Vec<Identity>, StopReport);

/// Other programs that may wait for their answers at the same time.
const OUTSIDE_STOPS: usize = 16;

impl Signals {
    /// Flags at rest, and the channel that wakes an idle thread.
    pub fn new(clock: Arc<dyn Clock>) -> (Arc<Self>, Receiver<()>) {
        let (wake, woken) = bounded(1);
        let signals = Self {
            clock,
            stops: AtomicU64::new(0),
            stopped_at: AtomicU64::new(0),
            renewed_at: AtomicU64::new(0),
            motion_since: AtomicU64::new(AT_REST),
            disarms: AtomicU64::new(0),
            closing: AtomicBool::new(false),
            wake,
            guard: Mutex::default(),
            from_outside: Mutex::new(Some(Vec::new())),
        };
        (Arc::new(signals), woken)
    }

    /// Asks for a stop.
    pub fn stop(&self) {
        self.stopped_at.store(nanoseconds(self.clock.now()), Ordering::SeqCst);
        self.stops.fetch_add(1, Ordering::SeqCst);
        self.wake();
    }

    /// Asks for a stop in the name of another program, to these units beside those of the link. Its answer comes once the stop is served; the
    /// channel is closed without one where the link has ended.
    pub fn stop_from_outside(&self, addresses: Addresses) -> Receiver<OutsideAnswer> {
        let (answer, told) = bounded(1);
        let mut waiting = self.from_outside.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(waiting) = waiting.as_mut() {
            waiting.truncate(OUTSIDE_STOPS - 1);
            waiting.push(OutsideStop { addresses, answer });
            // Under the lock: whoever answers sees the stop and who waits for it together.
            self.stop();
        }
        told
    }

    /// To whom a stop is to be written in the name of other programs that wait for one, a set each.
    pub fn outside_addresses(&self) -> Vec<Addresses> {
        let waiting = self.from_outside.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.iter().flatten().map(|stop| stop.addresses).collect()
    }

    /// Answers all who wait, unless a later stop waits to be served. `stops` were served by this one.
    pub fn answer_outside(&self, stops: u64, answer: impl Fn() -> OutsideAnswer) {
        let mut waiting = self.from_outside.lock().unwrap_or_else(PoisonError::into_inner);
        if self.stops() == stops {
            for stop in waiting.iter_mut().flat_map(std::mem::take) {
                // It may have gone away.
                let _ = stop.answer.try_send(answer());
            }
        }
    }

    /// The link has ended, and nobody is answered any more.
    pub fn end_outside(&self) {
        *self.from_outside.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Renews motion. What has died is not revived: after a pause of the whole program (it was halted, the computer slept)
    /// the thread still finds the motion dead, whichever of the two wakes first.
    pub fn renew(&self) {
        let now = self.clock.now();
        if self.motion_dies_at().is_none_or(|dies_at| now < dies_at) {
            self.renewed_at.fetch_max(nanoseconds(now), Ordering::SeqCst);
        }
        self.with_guard(|guard| guard.lives());
    }

    /// Has a guard from now on.
    pub fn set_guard(&self, guard: Option<Box<dyn LineGuard>>) {
        *self.guard.lock().unwrap_or_else(PoisonError::into_inner) = guard;
    }

    /// Whether there is a guard that lives.
    pub fn is_guarded(&self) -> bool {
        self.guard.lock().unwrap_or_else(PoisonError::into_inner).as_deref().is_some_and(LineGuard::is_there)
    }

    /// Tells the guard something, if there is one.
    pub fn with_guard(&self, tell: impl FnOnce(&dyn LineGuard)) {
        if let Some(guard) = self.guard.lock().unwrap_or_else(PoisonError::into_inner).as_deref() {
            tell(guard);
        }
    }

    /// When the motion dies unless it is renewed; none while nothing moves.
    fn motion_dies_at(&self) -> Option<Duration> {
        let since = self.motion_since.load(Ordering::SeqCst);
        let renewed_at = self.renewed_at.load(Ordering::SeqCst);
        (since != AT_REST).then(|| Duration::from_nanos(since.max(renewed_at)) + MOTION_LIFE)
    }

    /// Asks for disarming.
    pub fn disarm(&self) {
        self.disarms.fetch_add(1, Ordering::SeqCst);
        self.wake();
    }

    /// Asks the thread to close the link.
    pub fn close(&self) {
        self.closing.store(true, Ordering::SeqCst);
        self.wake();
    }

    /// Wakes the thread when it is idle. A full channel means that it will wake anyway.
    pub fn wake(&self) {
        let _ = self.wake.try_send(());
    }

    /// How many stops have been asked for.
    pub fn stops(&self) -> u64 {
        self.stops.load(Ordering::SeqCst)
    }

    /// How often disarming was asked for.
    pub fn disarms(&self) -> u64 {
        self.disarms.load(Ordering::SeqCst)
    }

    /// When the last stop was asked for.
    pub fn stopped_at(&self) -> Duration {
        Duration::from_nanos(self.stopped_at.load(Ordering::SeqCst))
    }

    /// The clock that stamps them.
    pub fn clock(&self) -> &Arc<dyn Clock> {
        &self.clock
    }
}

/// The device thread's view of the signals.
pub struct Guard {
    signals: Arc<Signals>,
    stops_served: Cell<u64>,
    disarms_served: Cell<u64>,
    armed: Cell<bool>,
    job_until: Cell<Option<Duration>>,
    job_cancelled: RefCell<Arc<AtomicBool>>,
    only_stop: Cell<bool>,
}

impl Guard {
    /// A guard that has served everything asked for so far.
    pub fn new(signals: Arc<Signals>) -> Self {
        Self {
            stops_served: Cell::new(0),
            disarms_served: Cell::new(0),
            armed: Cell::new(false),
            job_until: Cell::new(None),
            job_cancelled: RefCell::default(),
            only_stop: Cell::new(false),
            signals,
        }
    }

    /// Takes note of a motion command that is about to be written, asked for at `asked_at`.
    pub fn motion_begins(&self, asked_at: Duration) {
        let since = self.signals.motion_since.load(Ordering::SeqCst);
        let asked_at = nanoseconds(asked_at);
        if since == AT_REST {
            self.signals.with_guard(|guard| guard.moving(true));
        }
        let since = if since == AT_REST { asked_at } else { since.max(asked_at) };
        self.signals.motion_since.store(since, Ordering::SeqCst);
    }

    /// Whether a motion command may be in effect.
    pub fn is_moving(&self) -> bool {
        self.signals.motion_since.load(Ordering::SeqCst) != AT_REST
    }

    /// The motors were stopped.
    pub fn motion_ends(&self) {
        if self.signals.motion_since.swap(AT_REST, Ordering::SeqCst) != AT_REST {
            self.signals.with_guard(|guard| guard.moving(false));
        }
    }

    /// When the motion dies unless it is renewed.
    pub fn motion_dies_at(&self) -> Option<Duration> {
        self.signals.motion_dies_at()
    }

    /// Something was armed or disarmed by a request before which disarming had been asked for `disarms` times.
    pub fn set_armed(&self, armed: bool, disarms: u64) {
        self.armed.set(armed);
        self.disarms_served.set(disarms);
    }

    /// The stop asked for has been served.
    pub fn stop_served(&self, stops: u64) {
        self.stops_served.set(stops);
    }

    /// Begins a job that must end by `until`, or when its flag says that it was cancelled.
    pub fn set_job(&self, until: Duration, cancelled: Arc<AtomicBool>) {
        self.job_until.set(Some(until));
        self.job_cancelled.replace(cancelled);
    }

    /// The job has ended.
    pub fn job_ended(&self) {
        self.job_until.set(None);
    }

    /// While set, only a new Stop breaks in: the motors are being stopped.
    pub fn set_only_stop(&self, only_stop: bool) {
        self.only_stop.set(only_stop);
    }

    /// How many stops have been served.
    pub fn stops_served(&self) -> u64 {
        self.stops_served.get()
    }

    /// Whether a stop waits to be served.
    pub fn stop_waits(&self) -> bool {
        self.signals.stops() != self.stops_served.get()
    }

    /// Whether the link is to be closed.
    pub fn is_closing(&self) -> bool {
        self.signals.closing.load(Ordering::SeqCst)
    }

    fn disarm_waits(&self) -> bool {
        self.armed.get() && self.signals.disarms() != self.disarms_served.get()
    }

    fn job_ends(&self, now: Duration) -> Option<Interruption> {
        let until = self.job_until.get()?;
        if self.job_cancelled.borrow().load(Ordering::SeqCst) {
            return Some(Interruption::Cancelled);
        }
        (now >= until).then_some(Interruption::TimeLimit)
    }
}

impl Watch for Guard {
    fn interruption(&self, now: Duration) -> Option<Interruption> {
        self.signals.with_guard(|guard| guard.lives());
        if self.stop_waits() {
            return Some(Interruption::Stop);
        }
        if self.only_stop.get() {
            return None;
        }
        if self.motion_dies_at().is_some_and(|dies_at| now >= dies_at) {
            return Some(Interruption::DeadMan);
        }
        if self.is_closing() {
            return Some(Interruption::Closing);
        }
        if self.disarm_waits() {
            return Some(Interruption::Disarm);
        }
        self.job_ends(now)
    }

    fn next(&self) -> Option<Duration> {
        if self.only_stop.get() {
            return None;
        }
        [self.motion_dies_at(), self.job_until.get()].into_iter().flatten().min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::VirtualClock;

    fn guard() -> (VirtualClock, Arc<Signals>, Guard) {
        let clock = VirtualClock::new();
        let (signals, _) = Signals::new(Arc::new(clock.clone()));
        let guard = Guard::new(signals.clone());
        (clock, signals, guard)
    }

    #[test]
    fn stop_comes_before_everything_else() {
        let (clock, signals, guard) = guard();
        guard.set_armed(true, 0);
        guard.set_job(Duration::ZERO, Arc::default());
        signals.close();
        signals.disarm();
        signals.stop();
        assert_eq!(guard.interruption(clock.now()), Some(Interruption::Stop));
        guard.stop_served(signals.stops());
        assert_eq!(guard.interruption(clock.now()), Some(Interruption::Closing));
    }

    #[test]
    fn motion_lives_exactly_its_life_beyond_the_last_renewal() {
        let (clock, signals, guard) = guard();
        let ms = Duration::from_millis;
        guard.motion_begins(ms(0));
        clock.advance_to(ms(100));
        signals.renew();
        assert_eq!(guard.next(), Some(ms(350)));
        assert_eq!(guard.interruption(ms(349)), None);
        assert_eq!(guard.interruption(ms(350)), Some(Interruption::DeadMan));
        guard.motion_ends();
        assert_eq!(guard.interruption(ms(350)), None);
    }

    #[test]
    fn a_motion_that_has_died_is_not_revived_by_a_late_renewal() {
        let (clock, signals, guard) = guard();
        let ms = Duration::from_millis;
        guard.motion_begins(ms(0));
        clock.advance_to(ms(1500));
        signals.renew();
        assert_eq!(guard.interruption(clock.now()), Some(Interruption::DeadMan));
        guard.motion_ends();
        guard.motion_begins(clock.now());
        clock.advance(ms(100));
        signals.renew();
        assert_eq!(guard.next(), Some(ms(1850)), "the next motion is renewed as ever");
    }

    #[test]
    fn a_disarm_asked_for_before_arming_does_not_disarm() {
        let (clock, signals, guard) = guard();
        signals.disarm();
        guard.set_armed(true, signals.disarms());
        assert_eq!(guard.interruption(clock.now()), None);
        signals.disarm();
        assert_eq!(guard.interruption(clock.now()), Some(Interruption::Disarm));
    }

    #[test]
    fn a_job_ends_by_its_limit_or_by_a_cancel_of_its_own() {
        let (_, _, guard) = guard();
        let ms = Duration::from_millis;
        let [earlier, cancelled] = [true, false].map(|is| Arc::new(AtomicBool::new(is)));
        guard.set_job(ms(500), earlier);
        guard.job_ended();
        guard.set_job(ms(500), cancelled.clone());
        assert_eq!(guard.interruption(ms(499)), None, "an earlier cancel was for another job");
        assert_eq!(guard.interruption(ms(500)), Some(Interruption::TimeLimit));
        cancelled.store(true, Ordering::SeqCst);
        assert_eq!(guard.interruption(ms(1)), Some(Interruption::Cancelled));
    }

    #[test]
    fn while_motors_are_being_stopped_only_a_new_stop_breaks_in() {
        let (clock, signals, guard) = guard();
        guard.motion_begins(Duration::ZERO);
        guard.set_only_stop(true);
        signals.close();
        clock.advance(Duration::from_secs(1));
        assert_eq!(guard.interruption(clock.now()), None);
        signals.stop();
        assert_eq!(guard.interruption(clock.now()), Some(Interruption::Stop));
    }
}
