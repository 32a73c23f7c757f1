//! The thread that turns the loop in real time.

use super::state::{DeviceLoop, Step};
use crate::clock::Clock;
use crate::device::controller::Search;
use crate::device::event::{DisarmReason, Event};
use crate::device::family::AnyFamily;
use crate::device::handle::DeviceHandle;
use crate::device::options::DeviceOptions;
use crate::failure::Failure;
use crate::messages::{ActMessage, CauseMessage, RemedyMessage};
use crate::transport::Transport;
use crate::work::receive_within;
use crossbeam_channel::{Receiver, bounded};
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;

/// Starts device threads.
pub struct DeviceThread;

impl DeviceThread {
    /// Starts a thread that owns `transport` and speaks to the controllers on it, of the family that the options name or of
    /// the one that is found. It fails only when the
    /// system gives no thread.
    pub fn spawn(
        transport: Box<dyn Transport>,
        clock: Arc<dyn Clock>,
        options: DeviceOptions,
    ) -> io::Result<DeviceHandle> {
        let family = Box::new(AnyFamily::new(options.family));
        Self::spawn_family(transport, clock, options, family)
    }

    /// The same for any protocol family.
    pub fn spawn_family(
        transport: Box<dyn Transport>,
        clock: Arc<dyn Clock>,
        options: DeviceOptions,
        family: Box<dyn Search>,
    ) -> io::Result<DeviceHandle> {
        let name = format!("device {}", transport.describe());
        let ((device_loop, mut handle), woken) =
            DeviceLoop::with_family(transport, clock.clone(), options, family);
        let (running, ended) = bounded(1);
        handle.set_ended(ended);
        std::thread::Builder::new().name(name).spawn(move || {
            turn(device_loop, clock.as_ref(), &woken);
            drop(running);
        })?;
        Ok(handle)
    }
}

/// Turns the loop until it ends. A panic in it is a bug; the motors are stopped all the same.
fn turn(mut device_loop: DeviceLoop, clock: &dyn Clock, woken: &Receiver<()>) {
    let turned = panic::catch_unwind(AssertUnwindSafe(|| {
        loop {
            match device_loop.step() {
                Step::Again => {}
                // Woken early or not, the next step finds out what is due.
                Step::IdleUntil(until) => {
                    let left = until.saturating_sub(clock.now());
                    clock.rest_until(until);
                    let _ = receive_within(woken, left);
                }
                Step::Ended => return,
            }
        }
    }));
    if turned.is_err() {
        let _ = panic::catch_unwind(AssertUnwindSafe(|| device_loop.bail_out()));
    }
    device_loop.deliver_last_events();
}

impl DeviceLoop {
    /// The last act after a bug in the loop itself.
    fn bail_out(&mut self) {
        let stopped = self.write_stop(&DisarmReason::Stop).is_ok();
        let came_back = if stopped { CauseMessage::ThreadFailed } else { CauseMessage::ThreadFailedMoving };
        let port = self.exchange.port();
        self.end(Event::Lost(Failure::new(ActMessage::GoOn, port, came_back, RemedyMessage::ReportBug)));
    }

    /// Gives a window that is slow at the end a moment to take the reason.
    fn deliver_last_events(&mut self) {
        for _ in 0..100 {
            self.outbox.flush();
            self.outbox.wake_window();
            if !self.outbox.is_waiting() {
                return;
            }
            self.clock.sleep(std::time::Duration::from_millis(10));
        }
    }
}
