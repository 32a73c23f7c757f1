//! Running a job: the wire it gets, what breaks into it, and the motors stopped on every way out, a panic included.

use super::state::{DeviceLoop, Phase};
use crate::capability::CapabilityMap;
use crate::device::Facts;
use crate::device::channel::Sample;
use crate::device::drive::Drive;
use crate::device::event::{DisarmReason, Event};
use crate::device::inquiry::{Heard, Inquiry};
use crate::device::job::{JobEnding, JobId, JobReport, QueuedJob};
use crate::device::job_context::JobHost;
use crate::exchange::{ExchangeError, Interruption, Lateness, Reply, Watch};
use crate::failure::Failure;
use crate::messages::{CauseMessage, RemedyMessage};
use crate::transport::TransportError;
use crate::unit::{FirmwareGeneration, UnitAddress};
use crate::wire::{HiddenSettings, Wire};
use brushwork_values::{Value, Values};
use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::time::Duration;

/// How much longer than usual the last try of a job's command waits for its reply.
const PATIENCE: Duration = Duration::from_millis(250);
/// A unit that answered this recently is there.
const ALIVE: Duration = Duration::from_secs(1);

/// The device thread as one job sees it.
struct Host<'a> {
    core: &'a mut DeviceLoop,
    job: JobId,
    asked_at: Duration,
    was_armed: bool,
    polling: bool,
    /// What broke in; from then on every call fails with it.
    broken_by: Option<Interruption>,
    /// The stop that was written when it broke in, to be confirmed when the job has returned.
    stop: Option<super::halting::Written>,
}

impl DeviceLoop {
    pub(super) fn run_job(&mut self, mut job: QueuedJob, asked_at: Duration, overtaken: bool) {
        let (id, name) = (job.id, job.name.clone());
        if let Some(failure) = self.job_refusal(&job, overtaken) {
            let ending = JobEnding::Failed(failure);
            let report = JobReport { id, name, ran_for: Duration::ZERO, ending, motors_stopped: None };
            return self.outbox.send(Event::JobEnded(report));
        }
        let begun_at = self.clock.now();
        let was_moving = self.guard.is_moving();
        self.guard.set_job(begun_at + job.time_limit, job.cancelled.clone());
        self.outbox.send(Event::JobStarted { id, name: name.clone() });
        let mut host = Host {
            was_armed: self.armed.is_some(),
            core: self,
            job: id,
            asked_at,
            polling: true,
            broken_by: None,
            stop: None,
        };
        let result = panic::catch_unwind(AssertUnwindSafe(|| (job.run)(&mut host)));
        let (broken_by, stop) = (host.broken_by, host.stop);
        self.guard.job_ended();
        let ending = ending(result, broken_by);
        let has_moved = job.moves_motors || self.guard.is_moving() && !was_moving || stop.is_some();
        let must_stop = has_moved || self.armed.is_some() && matches!(ending, JobEnding::Panicked(_));
        // Dropping a job can panic too; motors come first.
        let motors_stopped = must_stop.then(|| self.stop_after_job(broken_by, stop));
        let _ = panic::catch_unwind(AssertUnwindSafe(|| drop(job)));
        self.restart_sweep();
        let ran_for = self.clock.now().saturating_sub(begun_at);
        self.outbox.send(Event::JobEnded(JobReport { id, name, ran_for, ending, motors_stopped }));
    }

    /// Stops the motors, or confirms the stop that was written when something broke in. Whether all units confirmed.
    fn stop_after_job(
        &mut self,
        broken_by: Option<Interruption>,
        stop: Option<super::halting::Written>,
    ) -> bool {
        if self.phase == Phase::Ended {
            return false;
        }
        let reason = reason_of(broken_by);
        match stop {
            Some(written) => self.finish_halt(reason, written),
            None => self.halt_and_confirm(reason),
        }
    }

    fn job_refusal(&self, job: &QueuedJob, overtaken: bool) -> Option<Failure> {
        let refuse = |came_back: CauseMessage, remedy: RemedyMessage| {
            Some(Failure::new(job.name.clone(), self.name_of(self.selected), came_back, remedy))
        };
        if !job.moves_motors {
            return None;
        }
        if overtaken {
            return refuse(CauseMessage::StoppedSince, RemedyMessage::StartWhenReady);
        }
        if !self.permit().motion {
            // Whoever has just armed is told what undid it.
            return match self.disarmed_by.as_ref().and_then(DisarmReason::trouble) {
                Some(why) => refuse(CauseMessage::ArmedNoLonger { why }, RemedyMessage::ArmWhenReady),
                None => refuse(CauseMessage::NotArmed, RemedyMessage::ArmFirst),
            };
        }
        None
    }
}

impl Host<'_> {
    /// Whether the job may go on. Something that breaks in is acted on here, before the job hears of it.
    fn check(&mut self) -> Result<(), ExchangeError> {
        if let Some(cause) = self.broken_by {
            if self.core.guard.stop_waits() {
                self.break_in(Interruption::Stop);
            }
            return Err(ExchangeError::Interrupted { cause });
        }
        if self.core.phase == Phase::Ended {
            return Err(link_lost());
        }
        if self.was_armed && self.core.armed.is_none() {
            return Err(self.break_in(Interruption::Disarm));
        }
        match self.core.guard.interruption(self.core.clock.now()) {
            Some(cause) => Err(self.break_in(cause)),
            None => Ok(()),
        }
    }

    /// Takes note of what broke in. Motors that may be moving are stopped now, not when the job returns.
    fn break_in(&mut self, cause: Interruption) -> ExchangeError {
        self.broken_by = Some(cause);
        if cause == Interruption::Stop || self.core.guard.is_moving() {
            match self.core.write_stop(&reason_of(Some(cause))) {
                Ok(written) => self.stop = Some(written),
                Err(error) => self.core.lose(&error),
            }
            self.core.guard.motion_ends();
        }
        ExchangeError::Interrupted { cause }
    }

    /// Whether a reply may yet come if it is waited for: nothing came although the unit has just answered others, as
    /// on a computer under load. Not while motors may be moved: then a silence has to be seen soon.
    fn may_be_late(&self, reply: &Result<Reply, ExchangeError>) -> bool {
        let is_alive = self.core.clock.now() < self.core.exchange.last_reply_at() + ALIVE;
        let is_at_rest = self.core.armed.is_none() && !self.core.guard.is_moving();
        matches!(reply, Err(ExchangeError::TimedOut { .. })) && is_alive && is_at_rest
    }

    fn ask_patiently(&mut self, command: u8, values: Vec<Value>) -> Result<Reply, ExchangeError> {
        self.core.exchange.set_patience(PATIENCE);
        let reply = self.core.act(self.asked_at, |unit, line| {
            line.set_retries(0);
            unit.transact(line, command, values)
        });
        self.core.exchange.set_patience(Duration::ZERO);
        reply
    }

    /// Reads a signal between two exchanges of the job, so that the window lives on.
    fn read_between(&mut self) -> Result<(), ExchangeError> {
        if self.polling && self.core.is_reading_due(self.core.clock.now()) {
            self.core.read_one();
            return self.check();
        }
        Ok(())
    }

    /// Disarms before a command that may change what arming was based on; the job itself goes on.
    fn stop_before(&mut self, command: u8) -> Result<(), ExchangeError> {
        let stopped = self.core.stop_before(command);
        if self.core.phase == Phase::Ended {
            return Err(link_lost());
        }
        self.was_armed &= self.core.armed.is_some();
        stopped.and_then(|()| self.check())
    }

    /// Turns an interruption of an exchange into one of the job.
    fn settle<T>(&mut self, result: Result<T, ExchangeError>) -> Result<T, ExchangeError> {
        self.core.keep_house();
        if let Err(error) = &result {
            if error.is_link_lost() {
                self.core.lose(error);
            } else if let Some(cause) = error.interruption()
                && self.broken_by.is_none()
            {
                self.break_in(cause);
            }
        }
        result
    }
}

impl Wire for Host<'_> {
    fn transact_values(&mut self, command: u8, values: Vec<Value>) -> Result<Values, ExchangeError> {
        self.reply(command, values).map(|reply| reply.values)
    }

    fn address(&self) -> UnitAddress {
        self.identity().unit_address()
    }

    fn generation(&self) -> FirmwareGeneration {
        self.identity().generation
    }

    fn is_simulated(&self) -> bool {
        self.core.options.simulated
    }

    fn now(&self) -> Duration {
        self.core.clock.now()
    }

    fn sleep(&mut self, time: Duration) -> Result<(), ExchangeError> {
        self.check()?;
        self.core.keep_house();
        let slept = self.core.exchange.wait(time, &self.core.guard);
        self.settle(slept)
    }

    fn port(&self) -> String {
        self.core.exchange.port()
    }

    fn set_address(&mut self, address: UnitAddress) -> bool {
        self.core.readdress(address.get())
    }

    fn hidden_settings(&self) -> Option<&dyn HiddenSettings> {
        self.core.options.hidden.as_deref()
    }

    fn lacks(&self, number: u8) -> bool {
        self.core.exchange.lacks(self.identity().address, number)
    }

    fn report_progress(&mut self, done: usize, of: usize, what: &str) {
        let fraction = if of == 0 { None } else { Some(done as f32 / of as f32) };
        self.progress(fraction, what);
    }

    fn set_quiet(&mut self, quiet: bool) {
        self.polling = !quiet;
    }
}

impl JobHost for Host<'_> {
    fn progress(&mut self, fraction: Option<f32>, text: &str) {
        self.core.outbox.send(Event::JobProgress { id: self.job, fraction, text: text.to_owned() });
    }

    fn interruption(&mut self) -> Option<Interruption> {
        self.check().err().and_then(|error| error.interruption())
    }

    fn transact_timed(&mut self, command: u8, values: &[i64]) -> Result<Reply, ExchangeError> {
        self.reply(command, values.iter().map(|&value| Value::Int(value)).collect())
    }

    fn drive(&mut self, drive: &Drive) -> Result<(), ExchangeError> {
        self.check()?;
        self.read_between()?;
        let sent_at = self.core.clock.now();
        let driven = self.core.act(self.asked_at, |unit, line| unit.drive(line, drive));
        if driven.is_ok() {
            self.core.note_drive(drive, sent_at);
        }
        self.settle(driven)
    }

    fn inquire(&mut self, inquiry: &Inquiry<'_>) -> Result<Heard, ExchangeError> {
        self.check()?;
        self.read_between()?;
        if self.core.armed.is_some() {
            return Err(ExchangeError::impossible(CauseMessage::ArmedMeanwhile));
        }
        let heard = self.core.act(self.asked_at, |unit, line| unit.inquire(line, inquiry));
        self.settle(heard)
    }

    fn answers(&mut self) -> CapabilityMap {
        let address = self.identity().address;
        self.core.exchange.capabilities().of(address)
    }

    fn lateness(&self) -> Option<Lateness> {
        self.core.exchange.lateness()
    }

    fn take_stolen(&mut self) -> Duration {
        self.core.exchange.take_stolen()
    }

    fn facts(&self) -> Facts {
        self.identity().facts.clone()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.core.exchange.byte_time()
    }

    fn needed_timeout(&self) -> Option<Duration> {
        self.core.exchange.needed_timeout()
    }

    fn sample(&mut self, sample: Sample) {
        self.core.send_sample(sample);
    }

    fn set_polling(&mut self, on: bool) {
        self.polling = on;
    }
}

impl Host<'_> {
    fn reply(&mut self, command: u8, values: Vec<Value>) -> Result<Reply, ExchangeError> {
        self.check()?;
        self.read_between()?;
        self.stop_before(command)?;
        let again = values.clone();
        let mut reply = self.core.act(self.asked_at, |unit, line| unit.transact(line, command, values));
        if self.may_be_late(&reply) {
            reply = self.ask_patiently(command, again);
        }
        if self.core.phase != Phase::Ended {
            self.core.after_command(command);
        }
        self.settle(reply)
    }

    fn identity(&self) -> &crate::device::identity::Identity {
        self.core.units[self.core.selected].controller.identity()
    }
}

type Outcome = Result<Result<(), Failure>, Box<dyn Any + Send>>;

/// How a job ended. What broke in counts for more than what the job made of it.
fn ending(outcome: Outcome, broken_by: Option<Interruption>) -> JobEnding {
    match (outcome, broken_by) {
        (Err(panic), _) => JobEnding::Panicked(last_word(panic.as_ref())),
        (Ok(_), Some(cause)) => JobEnding::Interrupted(cause),
        (Ok(Ok(())), None) => JobEnding::Done(()),
        (Ok(Err(failure)), None) => JobEnding::Failed(failure),
    }
}

fn last_word(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".to_owned())
}

fn reason_of(broken_by: Option<Interruption>) -> DisarmReason {
    match broken_by {
        Some(Interruption::Stop) => DisarmReason::Stop,
        Some(Interruption::DeadMan) => DisarmReason::DeadMan,
        Some(Interruption::Disarm) => DisarmReason::Asked,
        Some(Interruption::Closing) => DisarmReason::Closing,
        Some(Interruption::Cancelled | Interruption::TimeLimit) | None => DisarmReason::JobEnded,
    }
}

fn link_lost() -> ExchangeError {
    TransportError::Gone { detail: "the link was lost before".to_owned() }.into()
}
