//! The window's and the command line's end of a device thread. Nothing here waits.

use super::event::Event;
use super::job::{Job, JobTicket};
use super::options::Addresses;
use super::request::{Request, RequestRefused};
use super::signals::{OutsideAnswer, Signals};
use crossbeam_channel::{Receiver, Sender, TrySendError};
use std::any::Any;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What calls the window when there are new events.
pub(super) type Waker = Arc<Mutex<Option<Box<dyn Fn() + Send>>>>;

/// How long dropping a handle waits for the thread to stop the motors.
const CLOSE_LIMIT: Duration = Duration::from_secs(2);

/// A request with what was true when it was made.
#[derive(Debug)]
pub(super) struct Envelope {
    /// The request.
    pub request: Request,
    /// When it was made.
    pub asked_at: Duration,
    /// How many stops had been asked for until then.
    pub stops: u64,
    /// How often disarming had been asked for until then.
    pub disarms: u64,
}

/// What has to live as long as a link is open.
pub type Kept = Box<dyn Any + Send + Sync>;

/// A device thread's handle. Dropping it closes the link: motors that this program set in motion are stopped first.
pub struct DeviceHandle {
    requests: Sender<Envelope>,
    events: Receiver<Event>,
    signals: Arc<Signals>,
    waker: Waker,
    ended: Option<Receiver<()>>,
    kept: Option<Kept>,
}

impl DeviceHandle {
    pub(super) fn new(
        requests: Sender<Envelope>,
        events: Receiver<Event>,
        signals: Arc<Signals>,
        waker: Waker,
    ) -> Self {
        Self { requests, events, signals, waker, ended: None, kept: None }
    }

    /// The channel that ends with the thread; without it nobody is waited for.
    pub(super) fn set_ended(&mut self, ended: Receiver<()>) {
        self.ended = Some(ended);
    }

    /// Queues a request. Disarm and disconnect are not queued but seen at once.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn request(&self, request: Request) -> Result<(), RequestRefused> {
        match request {
            Request::Disarm => self.signals.disarm(),
            Request::Disconnect => self.signals.close(),
            request => return self.queue(request),
        }
        Ok(())
    }

    /// Queues a job; what it gives comes by the ticket.
    pub fn start<T: Send + 'static>(&self, job: Job<T>) -> Result<JobTicket<T>, RequestRefused> {
        let (job, ticket) = job.queued();
        self.request(Request::Job(job)).map(|()| ticket)
    }

    /// Stops all motors of the link: seen by the thread within milliseconds, whatever it is doing.
    pub fn stop_all(&self) {
        self.signals.stop();
    }

    /// Lets motion live on for [`MOTION_LIFE`](super::MOTION_LIFE) from now. The window calls this with each frame that it
    /// knows to be alive, a command line with each turn of its loop.
    pub fn renew(&self) {
        self.signals.renew();
    }

    /// A handle for stopping and renewing alone, for signal handlers and other threads.
    #[must_use]
    pub fn stopper(&self) -> Stopper {
        Stopper { signals: self.signals.clone() }
    }

    /// Keeps something until the link is closed.
    pub fn keep(&mut self, kept: Kept) {
        self.kept = Some(kept);
    }

    /// The events, to be drained at least once per frame.
    #[must_use]
    pub fn events(&self) -> &Receiver<Event> {
        &self.events
    }

    /// What the thread calls when there are new events: a request to repaint. It must be quick.
    pub fn set_waker(&self, waker: Box<dyn Fn() + Send>) {
        // A poisoned lock means that an earlier waker panicked; the new one takes its place.
        *self.waker.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(waker);
    }

    /// Time by the link's clock, which also dates its events.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.signals.clock().now()
    }

    fn queue(&self, request: Request) -> Result<(), RequestRefused> {
        let envelope = Envelope {
            request,
            asked_at: self.now(),
            stops: self.signals.stops(),
            disarms: self.signals.disarms(),
        };
        match self.requests.try_send(envelope) {
            Ok(()) => {
                self.signals.wake();
                Ok(())
            }
            Err(TrySendError::Full(_)) => Err(RequestRefused::Busy { waiting: self.requests.len() }),
            Err(TrySendError::Disconnected(_)) => Err(RequestRefused::Closed),
        }
    }
}

impl Drop for DeviceHandle {
    fn drop(&mut self) {
        self.signals.close();
        if let Some(ended) = &self.ended {
            // Ends early with an error when the thread is gone, which is what is waited for.
            let _ = ended.recv_timeout(CLOSE_LIMIT);
        }
    }
}

/// Stops and renews a link from anywhere; a clone of part of its handle.
#[derive(Clone)]
pub struct Stopper {
    signals: Arc<Signals>,
}

impl Stopper {
    /// As [`DeviceHandle::stop_all`].
    pub fn stop_all(&self) {
        self.signals.stop();
    }

    /// Stops all motors of the link, and those of further units on its line, in the name of another program. What became of it comes by the
    /// channel, which is closed without a word where the link ends before.
    #[must_use]
    pub fn stop_from_outside(&self, addresses: Addresses) -> Receiver<OutsideAnswer> {
        self.signals.stop_from_outside(addresses)
    }

    /// As [`DeviceHandle::renew`].
    pub fn renew(&self) {
        self.signals.renew();
    }
}
