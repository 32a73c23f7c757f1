//! A real controller behind a serial port that a browser has opened for its page, and the device loop that speaks to it. There is no thread:
//! the browser reads and writes whenever the page gives way, and the page turns the loop.
//!
//! No second process watches over a page. In its place the browser's side of the port holds the stop, and writes it when the page is
//! hidden, closed, fails or stands still.

use std::fmt;
use std::io;
use std::sync::Arc;
use std::time::Duration;

use brushwork_canopen::bus::Monitor;
use brushwork_link::capability::KeepsCapabilities;
use brushwork_link::device::{Addresses, DeviceHandle, DeviceLoop, DeviceOptions, Step, StopBytes, Stopper};
use brushwork_link::driver::{CanLine, can_line};
use brushwork_link::family::families;
use brushwork_link::guardian::{Guardian, LineGuard};
use brushwork_link::loan::KeepsLoans;
use brushwork_link::transport::target::LineOptions;
use brushwork_link::transport::{ConnectTarget, SecondWay, Transport, TransportError, WRITE_TIMEOUT};
use brushwork_link::{Clock, FamilyChoice};

use super::turned::EVENTS;
use super::{SessionError, can_addresses};
use crate::keep::Store;

/// Bytes that may wait until the browser takes them.
const MOST_UNWRITTEN: usize = 4096;
/// How late replies may be: the adapter, the browser's own process and a page that draws in between.
const LATENCY: Duration = Duration::from_millis(100);
/// How long room for bytes is waited for at a time.
const LOOK_INTERVAL: Duration = Duration::from_millis(5);
/// Makers of chips that turn USB into a serial line, behind which any controller may be: FTDI, Prolific, WCH, Silicon Labs.
const MAKERS_OF_ADAPTERS: [u16; 4] = [0x0403, 0x067B, 0x1A86, 0x10C4];

/// How a port of the browser is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PortState {
    /// The browser is opening it.
    Opening,
    /// Bytes come and go.
    Open,
    /// It could not be opened, or is gone, for this reason.
    Gone(String),
}

/// A serial port of the browser.
pub trait BrowserPort: Send + Sync + fmt::Debug {
    /// How it is.
    fn state(&self) -> PortState;

    /// The page's time.
    fn now(&self) -> Duration;

    /// Gives way for so long, or until something comes or is over.
    fn wait(&self, time: Duration);

    /// Takes what has come.
    fn take(&self) -> Vec<u8>;

    /// Gives bytes to the browser, behind those that wait.
    fn write(&self, bytes: &[u8]);

    /// How many bytes the browser has not passed on yet.
    fn unwritten(&self) -> usize;

    /// From now on these are written, with so much silence between two, when the page cannot do it.
    fn hold(&self, writes: &[Vec<u8>], gap: Duration);

    /// Whether a motion command may be in effect: only then is a page that stands still as good as dead.
    fn moving(&self, is_moving: bool);

    /// The page lives.
    fn lives(&self);

    /// Writes what is held.
    fn stop(&self);

    /// Gives the port back, once what waits is written.
    fn close(&self);
}

/// The family to look for behind a device: the chosen one; else any behind a chip that turns USB into a serial line, or behind no USB at all. A
/// browser does not tell what a device calls itself, and a controller that waits in its firmware loader erases its program at a byte that
/// the question for another family may hold: whatever else hangs on USB is only asked what the first family asks.
#[must_use]
pub fn family_behind(chosen: FamilyChoice, maker: Option<u16>) -> FamilyChoice {
    let is_open_to_all = maker.is_none_or(|maker| MAKERS_OF_ADAPTERS.contains(&maker));
    match families().first() {
        Some(first) if chosen == FamilyChoice::AUTO && !is_open_to_all => FamilyChoice::of(*first),
        _ => chosen,
    }
}

/// The loop of a link to a real controller, turned by the page.
pub struct BrowserLink {
    device_loop: DeviceLoop,
    port: Arc<dyn BrowserPort>,
    stopper: Stopper,
    /// Whether the browser has the port again, which another link may have by now.
    is_given_back: bool,
    /// Once it has ended: so many more turns give the window time to take the reason.
    last_turns: Option<u32>,
}

/// An open link to a real controller.
pub struct Connected {
    /// What turns it.
    pub link: BrowserLink,
    /// The window's end of it.
    pub device: DeviceHandle,
    /// What is heard of the nodes, on a CAN bus.
    pub bus: Option<Monitor>,
}

impl BrowserLink {
    /// A link over an open port that `target` names; `maker` is the USB number of who made the device.
    ///
    /// # Errors
    /// No family has nodes on a CAN bus.
    pub fn open(
        port: Arc<dyn BrowserPort>,
        target: &ConnectTarget,
        addresses: Addresses,
        maker: Option<u16>,
    ) -> Result<Connected, SessionError> {
        let (path, baud, line) = named(target);
        let store = Arc::new(Store::of_user());
        let options = DeviceOptions {
            family: family_behind(target.family(), maker),
            stream: target.stream(),
            capabilities: Some(store.clone() as Arc<dyn KeepsCapabilities>),
            loans: Some(store as Arc<dyn KeepsLoans>),
            guardian: Some(Arc::new(Held(port.clone()))),
            in_page: true,
            event_capacity: EVENTS,
            ..DeviceOptions::default()
        };
        let transport = Box::new(BrowserLine {
            port: port.clone(),
            path,
            byte_time: Duration::from_secs(10) / baud.max(1),
            latency: line.latency.unwrap_or(LATENCY),
            unread: Vec::new(),
        });
        let clock: Arc<dyn Clock> = Arc::new(PortClock(port.clone()));
        let ((device_loop, device), bus) = match target {
            ConnectTarget::Can { node, form, .. } => {
                let addresses = node.map_or(addresses, |node| Addresses::Only(node.get()));
                let options = DeviceOptions { addresses: can_addresses(addresses), ..options };
                let CanLine { transport, search, monitor } =
                    can_line(transport, &clock, *form).ok_or(SessionError::NoNodes)?;
                (DeviceLoop::for_family(transport, clock, options, search), Some(monitor))
            }
            ConnectTarget::Serial { .. } | ConnectTarget::Tcp { .. } | ConnectTarget::Sim(_) => {
                (DeviceLoop::new(transport, clock, DeviceOptions { addresses, ..options }), None)
            }
        };
        let link =
            Self { device_loop, port, stopper: device.stopper(), is_given_back: false, last_turns: None };
        Ok(Connected { link, device, bus })
    }

    /// Does what is due within the next `time`, and no more once nothing is. What waits for the controller gives way in its middle.
    pub fn turn(&mut self, time: Duration) {
        let until = self.port.now() + time;
        loop {
            match self.device_loop.step() {
                Step::Again if self.port.now() < until => {}
                Step::Again | Step::IdleUntil(_) => return,
                Step::Ended => {
                    // At once, so that the next link can have it.
                    self.give_back();
                    self.last_turns = Some(self.last_turns.map_or(100, |left| left.saturating_sub(1)));
                    return;
                }
            }
        }
    }

    /// What stops it from anywhere.
    #[must_use]
    pub fn stopper(&self) -> Stopper {
        self.stopper.clone()
    }

    /// The page's time.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.port.now()
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

    fn give_back(&mut self) {
        if !std::mem::replace(&mut self.is_given_back, true) {
            self.port.close();
        }
    }
}

impl Drop for BrowserLink {
    fn drop(&mut self) {
        self.give_back();
    }
}

/// The port that a target names, its rate, and what was said of the line.
fn named(target: &ConnectTarget) -> (String, u32, LineOptions) {
    match target {
        ConnectTarget::Serial { path, baud, line } => (path.clone(), *baud, *line),
        ConnectTarget::Can { adapter, .. } => named(adapter),
        ConnectTarget::Tcp { .. } | ConnectTarget::Sim(_) => (target.to_string(), 0, LineOptions::default()),
    }
}

/// The page's time as links take it.
struct PortClock(Arc<dyn BrowserPort>);

impl Clock for PortClock {
    fn now(&self) -> Duration {
        self.0.now()
    }

    fn sleep(&self, time: Duration) {
        let until = self.0.now() + time;
        while self.0.now() < until {
            self.0.wait(until.saturating_sub(self.0.now()));
        }
    }
}

/// The line to the controller.
struct BrowserLine {
    port: Arc<dyn BrowserPort>,
    path: String,
    byte_time: Duration,
    latency: Duration,
    unread: Vec<u8>,
}

impl BrowserLine {
    fn is_there(&self) -> Result<(), TransportError> {
        match self.port.state() {
            PortState::Gone(detail) => Err(TransportError::Gone { detail }),
            PortState::Opening | PortState::Open => Ok(()),
        }
    }
}

impl Transport for BrowserLine {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let until = self.port.now() + WRITE_TIMEOUT;
        loop {
            self.is_there()?;
            if self.port.unwritten() + bytes.len() <= MOST_UNWRITTEN {
                self.port.write(bytes);
                return Ok(());
            }
            if self.port.now() >= until {
                return Err(TransportError::WriteStuck { written: 0, length: bytes.len() });
            }
            self.port.wait(LOOK_INTERVAL);
        }
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        let until = self.port.now() + timeout;
        while self.unread.is_empty() {
            self.unread = self.port.take();
            if self.unread.is_empty() {
                // What came before the end is read first.
                self.is_there()?;
                let left = until.saturating_sub(self.port.now());
                if left.is_zero() {
                    return Ok(0);
                }
                self.port.wait(left);
            }
        }
        let count = self.unread.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.unread[..count]);
        self.unread.drain(..count);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        Ok(self.port.take().len() + std::mem::take(&mut self.unread).len())
    }

    fn describe(&self) -> String {
        self.path.clone()
    }

    fn byte_time(&self) -> Option<Duration> {
        Some(self.byte_time)
    }

    fn latency(&self) -> Duration {
        self.latency
    }

    /// The browser's side of the port, which writes what is held for it.
    fn second_way(&self) -> io::Result<SecondWay> {
        Ok(SecondWay::Later(self.path.clone()))
    }
}

/// The stop in the browser's hands.
#[derive(Clone, Debug)]
struct Held(Arc<dyn BrowserPort>);

impl Guardian for Held {
    fn start(&self, _port: &str, _line: SecondWay) -> io::Result<Box<dyn LineGuard>> {
        Ok(Box::new(HeldStop(self.0.clone())))
    }
}

#[derive(Debug)]
struct HeldStop(Arc<dyn BrowserPort>);

impl LineGuard for HeldStop {
    fn hold(&self, stop: &StopBytes) {
        self.0.hold(&stop.writes(), stop.gap);
    }

    fn release(&self) {
        self.0.hold(&[], Duration::ZERO);
    }

    fn moving(&self, moving: bool) {
        self.0.moving(moving);
    }

    fn is_there(&self) -> bool {
        true
    }

    fn lives(&self) {
        self.0.lives();
    }
}

impl Drop for HeldStop {
    fn drop(&mut self) {
        self.0.stop();
        self.0.hold(&[], Duration::ZERO);
    }
}
