//! A transport with everything that makes exchanges over it dependable.

use super::error::{ExchangeError, Tries};
use super::given_up::GivenUp;
use super::request::{Judgement, Outgoing, RETRIES, Span};
use super::statistics::{Counters, LinkStatistics};
use super::trace::{Trace, Traffic};
use super::turnaround::{LONGEST, Lateness, Turnaround};
use super::watch::Watch;
use crate::capability::{CapabilityBook, KeepsCapabilities};
use crate::clock::Clock;
use crate::device::StopBytes;
use crate::transport::{SecondWay, Transport};
use std::io;
use std::sync::Arc;
use std::time::Duration;

/// How long the line must be quiet after a fault before it is used again: the gap and some for the clocks of both ends.
pub const RECOVERY: Duration = Duration::from_millis(12);
/// Noise that never ends is not waited out for longer than this.
const RECOVERY_LIMIT: Duration = Duration::from_millis(500);
/// A wait that ends so much too late tells of a computer under load, which delays replies as well: they get that time.
const STOLEN: Duration = Duration::from_millis(10);
/// A wait that ends so much too late counts as this computer's where it is asked whose a delay was: a quiet one is 0.1 ms late.
const LATE_WAKE: Duration = Duration::from_millis(2);
/// No reply gets much more than this for that reason.
const STOLEN_MOST: Duration = Duration::from_millis(300);
/// Work of a controller beside which its reply still tells how late the line is: registers are read within it, a whole EEPROM is not.
const SHORT_WORK: Duration = Duration::from_millis(60);
/// More than this a wait is not doubled: it ends at [`LONGEST`] anyway.
const MOST_DOUBLINGS: u32 = 10;
/// Of what is heard without a request that it answers, no more is kept: the longest reply, thrice.
const MOST_HEARD: usize = 2048;
/// Waiting for bytes is cut into slices of this, so that a Stop is seen in time.
const SLICE: Duration = Duration::from_millis(1);

/// A transport with everything that makes exchanges over it dependable.
pub struct Exchange {
    transport: Box<dyn Transport>,
    clock: Arc<dyn Clock>,
    pub(super) counters: Counters,
    trace: Trace,
    pub(super) received: Vec<u8>,
    /// Something may still be on its way that answers nothing any more.
    pub(super) unsettled: bool,
    /// Requests whose replies were given up and may still come, long after the line was quiet once.
    pub(super) given_up: GivenUp,
    /// When the request of the present attempt went out, if it did.
    sent_at: Option<Duration>,
    pub(super) last_reply_at: Duration,
    /// Time that every reply may take beyond what the link and its request need.
    patience: Duration,
    /// What the replies so far tell of this line.
    turnaround: Turnaround,
    /// Whether addresses are asked at which nobody may be.
    is_scanning: bool,
    /// Time of the present request in which this thread had no processor: no fault of the line.
    stolen: Duration,
    /// The same of all waits since it was last asked for.
    stolen_in_all: Duration,
    /// What the units of this line are known to answer.
    capabilities: CapabilityBook,
    /// Counts in place of the transport's own while a search is on.
    latency: Option<Duration>,
}

impl Exchange {
    /// Exchanges over `transport`, timed by `clock`.
    #[must_use]
    pub fn new(transport: Box<dyn Transport>, clock: Arc<dyn Clock>) -> Self {
        let now = clock.now();
        Self {
            transport,
            clock,
            counters: Counters::new(now),
            trace: Trace::default(),
            received: Vec::new(),
            unsettled: false,
            given_up: GivenUp::default(),
            sent_at: None,
            last_reply_at: now,
            patience: Duration::ZERO,
            turnaround: Turnaround::default(),
            is_scanning: false,
            stolen: Duration::ZERO,
            stolen_in_all: Duration::ZERO,
            capabilities: CapabilityBook::default(),
            latency: None,
        }
    }

    /// The same, with what earlier sessions have learned of firmware.
    #[must_use]
    pub fn with_capabilities(mut self, keeper: Option<Arc<dyn KeepsCapabilities>>) -> Self {
        self.capabilities = CapabilityBook::new(keeper);
        self
    }

    /// What the units of this line are known to answer.
    pub fn capabilities(&mut self) -> &mut CapabilityBook {
        &mut self.capabilities
    }

    /// Whether the firmware of the unit at an address is known to lack something.
    #[must_use]
    pub fn lacks(&self, address: u8, number: u8) -> bool {
        self.capabilities.lacks(address, number)
    }

    /// Requests that were sent again since the link was opened.
    #[must_use]
    pub fn retries(&self) -> u64 {
        self.counters.totals.retries
    }

    /// How long, since this was last asked, waits and replies had to wait for a processor.
    pub fn take_stolen(&mut self) -> Duration {
        std::mem::take(&mut self.stolen_in_all)
    }

    /// Takes note of a wait that was to end at `wanted`, and tells by how much it was late.
    fn woke(&mut self, wanted: Duration) -> Duration {
        let late = self.clock.now().saturating_sub(wanted);
        if late >= LATE_WAKE {
            self.stolen_in_all += late;
        }
        late
    }

    /// Lets every reply take so much longer: a computer under load, or a controller that is just starting.
    pub fn set_patience(&mut self, patience: Duration) {
        self.patience = patience;
    }

    /// Sends a request and waits for its reply; sends it again after a fault as often as it may.
    ///
    /// `judge` sees all bytes received so far and decides when the reply is complete.
    pub fn exchange(
        &mut self,
        request: &Outgoing<'_>,
        watch: &dyn Watch,
        judge: &mut dyn FnMut(&[u8]) -> Judgement,
    ) -> Result<Span, ExchangeError> {
        let mut tries = 0;
        let mut first_at = None;
        self.stolen = Duration::ZERO;
        loop {
            tries += 1;
            let error = match self.attempt(request, watch, judge, Tries(tries)) {
                Ok(span) => {
                    self.learn(request, span, first_at.unwrap_or(span.requested_at));
                    return Ok(span);
                }
                Err(error) => error,
            };
            first_at = first_at.or(self.sent_at);
            let final_word = error.is_link_lost() || error.interruption().is_some();
            if request.once && self.sent_at.is_some() {
                return Err(ExchangeError::MayHaveRun { cause: Box::new(error) });
            }
            if final_word || request.once || tries > request.retries {
                return Err(error);
            }
            self.counters.totals.retries += 1;
        }
    }

    /// Writes bytes at once, whatever else is going on, and expects nothing. The line is unsettled afterwards.
    pub fn write_now(&mut self, bytes: &[u8]) -> Result<Duration, ExchangeError> {
        self.unsettled = true;
        self.write(bytes)?;
        Ok(self.clock.now())
    }

    /// Writes the bytes of a stop at once, with the silence between its frames that the controllers need.
    pub fn write_stop(&mut self, stop: &StopBytes) -> Result<Duration, ExchangeError> {
        let mut written_at = self.clock.now();
        let mut before = 0;
        for bytes in stop.writes() {
            if before > 0 {
                let on_the_wire = self.transport.byte_time().unwrap_or_default().saturating_mul(before);
                self.clock.sleep(on_the_wire + stop.gap);
            }
            written_at = self.write_now(&bytes)?;
            before = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        }
        Ok(written_at)
    }

    /// Sends a request once and waits for its reply for no longer than `patience` beyond the time on the wire: is anybody there?
    /// Somebody who is slower than that is not heard.
    pub fn exchange_within(
        &mut self,
        bytes: &[u8],
        reply_length: usize,
        patience: Duration,
        watch: &dyn Watch,
        judge: &mut dyn FnMut(&[u8]) -> Judgement,
    ) -> Result<Span, ExchangeError> {
        self.latency = Some(Duration::ZERO);
        let request = Outgoing { bytes, reply_length, patience, retries: 0, once: false };
        let span = self.exchange(&request, watch, judge);
        self.latency = None;
        span
    }

    /// Waits until the line has been quiet for [`RECOVERY`], throwing away what comes; where replies are late, until what was given up has had
    /// its time.
    pub fn settle(&mut self, watch: &dyn Watch) -> Result<(), ExchangeError> {
        if self.has_late_replies() {
            self.drain(self.longest_turnaround(), watch)
        } else {
            self.wait_for_silence(RECOVERY, watch)
        }
    }

    /// Whether replies that nobody waits for are on their way on a line that is late: they would be taken for those of the next request.
    fn has_late_replies(&self) -> bool {
        !self.is_scanning && self.is_late() && self.may_hear_late_replies()
    }

    /// Lets silence tell nothing of the line while addresses are asked at which nobody may be.
    pub fn set_scanning(&mut self, is_scanning: bool) {
        self.is_scanning = is_scanning;
    }

    fn wait_for_silence(&mut self, quiet: Duration, watch: &dyn Watch) -> Result<(), ExchangeError> {
        let begun_at = self.clock.now();
        let mut quiet_since = begun_at;
        let mut buffer = [0; 512];
        loop {
            let now = self.clock.now();
            self.look(watch, now)?;
            let quiet_until = quiet_since + quiet;
            if now >= quiet_until || now >= begun_at + quiet + RECOVERY_LIMIT {
                self.unsettled = false;
                return Ok(());
            }
            let slice = self.slice(watch, now, quiet_until);
            self.clock.rest_until(quiet_until);
            let count = self.transport.read(&mut buffer, slice)?;
            if count > 0 {
                quiet_since = self.clock.now();
                self.stray(&buffer[..count], quiet_since);
            }
        }
    }

    /// Whether the reply to an earlier request may still come. A reply without a checksum, such as an acknowledgement, proves nothing
    /// then: the byte may be one of that reply.
    #[must_use]
    pub fn may_hear_late_replies(&self) -> bool {
        self.given_up.may_come(self.clock.now())
    }

    /// Takes note that the reply to `request`, which carries a checksum over it, has come: controllers answer in order, so that
    /// nothing asked before can come any more.
    pub fn is_in_step(&mut self, request: &[u8]) {
        self.given_up.answered(request);
    }

    /// Whether one of them may still come although its time was over, so that the line is slower than was thought.
    #[must_use]
    pub fn is_slow_to_reply(&self) -> bool {
        self.given_up.timed_out(self.clock.now())
    }

    /// Waits until the line was quiet for `quiet`, throwing away what comes, and expects no late reply any more.
    pub fn drain(&mut self, quiet: Duration, watch: &dyn Watch) -> Result<(), ExchangeError> {
        self.wait_for_silence(quiet, watch)?;
        self.given_up.forget();
        Ok(())
    }

    /// Waits for `time`, or until something more urgent comes.
    pub fn wait(&mut self, time: Duration, watch: &dyn Watch) -> Result<(), ExchangeError> {
        let until = self.clock.now() + time;
        loop {
            let now = self.clock.now();
            self.look(watch, now)?;
            if now >= until {
                return Ok(());
            }
            let slice = self.slice(watch, now, until);
            self.clock.rest_until(until);
            self.clock.sleep(slice);
            self.woke(now + slice);
        }
    }

    /// The link's figures now.
    pub fn statistics(&mut self) -> LinkStatistics {
        self.counters.at(self.clock.now())
    }

    /// Switches the recording of traffic on or off.
    pub fn switch_trace(&mut self, on: bool) {
        self.trace.switch(on);
    }

    /// Takes the traffic recorded since the last call.
    pub fn take_traffic(&mut self) -> impl Iterator<Item = Traffic> + '_ {
        self.trace.take(self.clock.now())
    }

    /// When the last good reply was complete, or when the link was opened.
    #[must_use]
    pub fn last_reply_at(&self) -> Duration {
        self.last_reply_at
    }

    /// The clock in use.
    #[must_use]
    pub fn clock(&self) -> &Arc<dyn Clock> {
        &self.clock
    }

    /// How long a byte takes on the wire, where that is known.
    #[must_use]
    pub fn byte_time(&self) -> Option<Duration> {
        self.transport.byte_time()
    }

    /// The rate of the line, bits a second, where that is known.
    #[must_use]
    pub fn baud(&self) -> Option<u32> {
        let byte_time_s = self.byte_time()?.as_secs_f64();
        // Ten bits a byte; the cast saturates.
        (byte_time_s > 0.0).then(|| (10.0 / byte_time_s).round() as u32)
    }

    /// Changes the rate of the line; `false` where it has none that could be changed.
    ///
    /// # Errors
    /// The port refuses it.
    pub fn set_baud(&mut self, baud: u32) -> Result<bool, ExchangeError> {
        self.unsettled = true;
        Ok(self.transport.set_baud(baud)?)
    }

    /// A second way to write to the line, for another process.
    ///
    /// # Errors
    /// As [`Transport::second_way`].
    pub fn second_way(&self) -> io::Result<SecondWay> {
        self.transport.second_way()
    }

    /// The port as a person would name it.
    #[must_use]
    pub fn port(&self) -> String {
        self.transport.describe()
    }

    // -----------------------------------------------------------------------------------------

    /// One request and one wait for its reply.
    fn attempt(
        &mut self,
        request: &Outgoing<'_>,
        watch: &dyn Watch,
        judge: &mut dyn FnMut(&[u8]) -> Judgement,
        tries: Tries,
    ) -> Result<Span, ExchangeError> {
        self.received.clear();
        self.sent_at = None;
        self.look(watch, self.clock.now())?;
        if self.unsettled || self.has_late_replies() {
            self.settle(watch)?;
        }
        let discarded = self.transport.discard_input()?;
        self.count_strays(discarded, self.clock.now());
        let requested_at = self.clock.now();
        self.unsettled = true;
        self.write(request.bytes)?;
        self.sent_at = Some(requested_at);
        let replied_at = match self.receive(request, watch, judge, requested_at, tries) {
            Ok(replied_at) => replied_at,
            Err(error) => {
                let timed_out = error.interruption().is_none();
                self.given_up.note(request.bytes, request.reply_length, self.clock.now(), timed_out);
                return Err(error);
            }
        };
        self.unsettled = false;
        self.last_reply_at = replied_at;
        self.counters.replied(requested_at, replied_at);
        Ok(Span { requested_at, replied_at })
    }

    fn receive(
        &mut self,
        request: &Outgoing<'_>,
        watch: &dyn Watch,
        judge: &mut dyn FnMut(&[u8]) -> Judgement,
        requested_at: Duration,
        tries: Tries,
    ) -> Result<Duration, ExchangeError> {
        let mut buffer = [0; 1024];
        let allowance = self.allowance(request, request.bytes.len() + request.reply_length);
        let mut deadline = requested_at + allowance + self.longer_for(tries);
        let mut lost = Duration::ZERO;
        loop {
            let now = self.clock.now();
            self.look(watch, now)?;
            let slice = self.slice(watch, now, deadline);
            self.clock.rest_until(deadline);
            let count = self.transport.read(&mut buffer, slice)?;
            let late = self.woke(now + slice);
            if late >= STOLEN {
                self.stolen += late;
            }
            if count == 0 {
                // What came while this thread had no processor has been looked for by now.
                if now >= deadline {
                    // That nobody is there is what a search finds out, and no fault of the link.
                    self.counters.totals.timeouts += u64::from(!self.is_searching());
                    if !self.is_searching() && !self.is_scanning {
                        self.turnaround.timed_out();
                    }
                    let waited = now.saturating_sub(requested_at);
                    return Err(ExchangeError::TimedOut { waited, tries, heard: self.received.len() });
                }
                if late >= STOLEN && lost < STOLEN_MOST {
                    lost += late;
                    deadline += late;
                }
                continue;
            }
            let now = self.clock.now();
            self.counters.read(count);
            self.trace.record(now, false, &buffer[..count]);
            self.received.extend_from_slice(&buffer[..count]);
            match judge(&self.received) {
                Judgement::Good(used) => {
                    self.count_strays(self.received.len().saturating_sub(used), now);
                    return Ok(now);
                }
                Judgement::More(missing) => deadline = deadline.max(now + self.allowance(request, missing)),
                Judgement::Elsewhere => {}
                Judgement::Bad(fault) => {
                    self.counters.totals.crc_errors += u64::from(!self.is_searching());
                    return Err(fault.error(tries));
                }
            }
        }
    }

    /// Whether it is asked whether anybody is there.
    fn is_searching(&self) -> bool {
        self.latency.is_some()
    }

    /// How long `bytes` bytes may take: their time on the wire, the link's latency and the controller's work.
    fn allowance(&self, request: &Outgoing<'_>, bytes: usize) -> Duration {
        let bytes = u32::try_from(bytes).unwrap_or(u32::MAX);
        let on_the_wire = self.transport.byte_time().unwrap_or_default().saturating_mul(bytes);
        on_the_wire
            + self.latency.unwrap_or_else(|| self.longest_turnaround())
            + request.patience
            + self.patience
    }

    /// What is asked more often than most requests are, as a stop is, gets twice as long each time (RFC 6298, section 5.5): who has not answered by
    /// then can only be heard by waiting longer.
    fn longer_for(&self, tries: Tries) -> Duration {
        let usual = self.longest_turnaround();
        let doublings = tries.0.saturating_sub(1 + RETRIES).min(MOST_DOUBLINGS);
        (usual * 2_u32.pow(doublings)).min(LONGEST.max(usual)) - usual
    }

    /// How long this line and the controller behind it may take beyond the time of the bytes on the wire, as far as they have shown.
    #[must_use]
    pub fn longest_turnaround(&self) -> Duration {
        self.turnaround.allowance(self.transport.latency())
    }

    /// How late replies are beyond the time of their bytes on the wire; `None` before the first one.
    #[must_use]
    pub fn lateness(&self) -> Option<Lateness> {
        self.turnaround.lateness()
    }

    /// Whether replies take longer than is usual for this kind of port.
    #[must_use]
    pub fn is_late(&self) -> bool {
        self.longest_turnaround() > self.transport.latency()
    }

    /// What a controller's own time-out has to be at least on a line that is late: it outlasts a reply that is lost, the wait for what may still
    /// come, and the reply that is asked for in its place, or each loss stops the motors.
    #[must_use]
    pub fn needed_timeout(&self) -> Option<Duration> {
        self.is_late().then(|| 3 * self.longest_turnaround())
    }

    /// Learns from a reply how long the line takes beyond the controller's own work; what it works on for longer tells nothing. A reply to a request that was sent again may be
    /// that to the first (Karn's rule, RFC 6298, section 3): it counts from there unless it is as quick as others were.
    fn learn(&mut self, request: &Outgoing<'_>, span: Span, first_at: Duration) {
        if request.patience > SHORT_WORK || self.is_searching() {
            return;
        }
        let length = request.reply_length.min(self.received.len());
        let bytes = u32::try_from(request.bytes.len() + length).unwrap_or(u32::MAX);
        let on_the_wire = self.transport.byte_time().unwrap_or_default().saturating_mul(bytes);
        let known = on_the_wire + request.patience + self.stolen;
        let since = |at: Duration| span.replied_at.saturating_sub(at).saturating_sub(known);
        let is_its_own = self.turnaround.is_usual(since(span.requested_at));
        self.turnaround.learn(since(if is_its_own { span.requested_at } else { first_at }));
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), ExchangeError> {
        let at = self.clock.now();
        self.transport.write(bytes)?;
        self.counters.wrote(bytes.len());
        self.trace.record(at, true, bytes);
        Ok(())
    }

    fn stray(&mut self, bytes: &[u8], now: Duration) {
        self.counters.read(bytes.len());
        self.count_strays(bytes.len(), now);
        self.trace.record(now, false, bytes);
    }

    fn count_strays(&mut self, count: usize, now: Duration) {
        self.counters.totals.stray_bytes += count as u64;
        if self.given_up.may_come(now) {
            self.counters.totals.late_bytes += count as u64;
        }
    }

    /// Waits for more bytes until `until`, a slice at the most, and keeps them behind those at hand.
    pub(super) fn hear(&mut self, watch: &dyn Watch, until: Duration) -> Result<(), ExchangeError> {
        let now = self.clock.now();
        self.look(watch, now)?;
        let mut buffer = [0; 1024];
        let count = self.transport.read(&mut buffer, self.slice(watch, now, until))?;
        if count > 0 {
            self.counters.read(count);
            self.trace.record(self.clock.now(), false, &buffer[..count]);
            let surplus = (self.received.len() + count).saturating_sub(MOST_HEARD);
            self.received.drain(..surplus.min(self.received.len()));
            self.received.extend_from_slice(&buffer[..count]);
        }
        Ok(())
    }

    /// Lets something more urgent break in.
    fn look(&self, watch: &dyn Watch, now: Duration) -> Result<(), ExchangeError> {
        watch.interruption(now).map_or(Ok(()), |cause| Err(ExchangeError::Interrupted { cause }))
    }

    /// How long to wait now: to `until`, but no longer than a slice nor past the watch's next moment.
    fn slice(&self, watch: &dyn Watch, now: Duration, until: Duration) -> Duration {
        let until = watch.next().map_or(until, |next| until.min(next.max(now)));
        until.saturating_sub(now).min(SLICE)
    }
}
