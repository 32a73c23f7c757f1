//! For this crate's tests: a transport in virtual time whose far end is a function.
//!
//! The far end sees each write with its time and returns chunks of bytes with the times at which they arrive. Reading
//! turns the clock on to the next chunk or to the time-out, whichever comes first, and hooks can act at given times.

pub mod unit;

use brushwork_link::clock::{Clock, VirtualClock};
use brushwork_link::transport::{SecondWay, Transport, TransportError};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Milliseconds, for short test lines.
pub fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

/// What the far end does with a write: delays after which bytes come back.
pub type Answers = Vec<(Duration, Vec<u8>)>;
type FarEnd = Box<dyn FnMut(&[u8], Duration) -> Answers + Send>;
type Hook = Box<dyn FnOnce() + Send>;
/// A write and when it was made.
pub type Written = (Duration, Vec<u8>);

/// The test's view of the wire.
#[derive(Clone, Default)]
pub struct Wiretap {
    writes: Arc<Mutex<Vec<Written>>>,
    hooks: Arc<Mutex<Vec<(Duration, Hook)>>>,
    unplugged: Arc<Mutex<bool>>,
}

impl Wiretap {
    /// All writes so far, with their times.
    pub fn writes(&self) -> Vec<Written> {
        self.writes.lock().unwrap().clone()
    }

    /// Does something at a given time, while somebody reads.
    pub fn at(&self, time: Duration, hook: impl FnOnce() + Send + 'static) {
        self.hooks.lock().unwrap().push((time, Box::new(hook)));
    }

    /// Pulls the plug.
    pub fn unplug(&self) {
        *self.unplugged.lock().unwrap() = true;
    }

    /// When the next hook is due.
    pub fn next_hook(&self) -> Option<Duration> {
        self.hooks.lock().unwrap().iter().map(|(time, _)| *time).min()
    }

    /// Runs what is due. The lock is free while a hook runs, so that it may set further ones.
    pub fn run_hooks(&self, now: Duration) {
        loop {
            let mut hooks = self.hooks.lock().unwrap();
            let Some(index) = hooks.iter().position(|(time, _)| *time <= now) else { return };
            let (_, hook) = hooks.remove(index);
            drop(hooks);
            hook();
        }
    }
}

/// A transport over a function.
pub struct ScriptedTransport {
    clock: VirtualClock,
    far_end: FarEnd,
    arriving: VecDeque<(Duration, Vec<u8>)>,
    tap: Wiretap,
    byte_time: Option<Duration>,
}

impl ScriptedTransport {
    /// A transport whose far end is `far_end`, and the test's view of it.
    pub fn new(
        clock: &VirtualClock,
        far_end: impl FnMut(&[u8], Duration) -> Answers + Send + 'static,
    ) -> (Box<Self>, Wiretap) {
        let tap = Wiretap::default();
        let transport = Self {
            clock: clock.clone(),
            far_end: Box::new(far_end),
            arriving: VecDeque::new(),
            tap: tap.clone(),
            byte_time: None,
        };
        (Box::new(transport), tap)
    }

    /// The same at a baud rate.
    pub fn with_byte_time(mut self: Box<Self>, byte_time: Duration) -> Box<Self> {
        self.byte_time = Some(byte_time);
        self
    }

    fn check_plug(&self) -> Result<(), TransportError> {
        if *self.tap.unplugged.lock().unwrap() {
            return Err(TransportError::Gone { detail: "unplugged".to_owned() });
        }
        Ok(())
    }

    /// Moves to `until`, stopping at each hook on the way.
    fn pass(&self, until: Duration) {
        while let Some(hook) = self.tap.next_hook().filter(|hook| *hook <= until) {
            self.clock.advance_to(hook);
            self.tap.run_hooks(self.clock.now());
        }
        self.clock.advance_to(until);
    }
}

impl Transport for ScriptedTransport {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.check_plug()?;
        let now = self.clock.now();
        self.tap.writes.lock().unwrap().push((now, bytes.to_vec()));
        for (delay, chunk) in (self.far_end)(bytes, now) {
            self.arriving.push_back((now + delay, chunk));
        }
        self.arriving.make_contiguous().sort_by_key(|(time, _)| *time);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        let until = self.clock.now() + timeout;
        match self.arriving.front() {
            Some((time, _)) if *time <= until => {
                let time = *time;
                self.pass(time);
                self.check_plug()?;
                let (_, chunk) = self.arriving.pop_front().expect("it was there");
                buffer[..chunk.len()].copy_from_slice(&chunk);
                Ok(chunk.len())
            }
            _ => {
                self.pass(until);
                self.check_plug()?;
                Ok(0)
            }
        }
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.check_plug()?;
        let now = self.clock.now();
        let mut count = 0;
        while self.arriving.front().is_some_and(|(time, _)| *time <= now) {
            count += self.arriving.pop_front().map_or(0, |(_, chunk)| chunk.len());
        }
        Ok(count)
    }

    fn describe(&self) -> String {
        "/dev/test".to_owned()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.byte_time
    }

    fn latency(&self) -> Duration {
        ms(50)
    }

    fn second_way(&self) -> std::io::Result<SecondWay> {
        Ok(SecondWay::Open(std::process::Stdio::null()))
    }
}

/// A far end that answers the expected requests in order and panics at any other.
pub fn script(steps: Vec<(Vec<u8>, Answers)>) -> impl FnMut(&[u8], Duration) -> Answers + Send {
    let mut steps: VecDeque<_> = steps.into();
    move |bytes, _| {
        let (expected, answers) = steps.pop_front().unwrap_or_else(|| panic!("unexpected {bytes:02X?}"));
        assert_eq!(bytes, expected, "expected {expected:02X?}, got {bytes:02X?}");
        answers
    }
}

/// Bytes followed by their CRC.
pub fn with_crc(bytes: &[u8]) -> Vec<u8> {
    let crc = brushwork_mcp_wire::crc::crc16_xmodem(bytes);
    [bytes, &crc.to_be_bytes()].concat()
}

/// The reply to the read `request` with this data: data and CRC over both.
pub fn reply_to(request: &[u8], data: &[u8]) -> Vec<u8> {
    let whole = with_crc(&[request, data].concat());
    whole[request.len()..].to_vec()
}
