//! What is asked of the loop, one request after the other.

use super::state::{Armed, DeviceLoop};
use super::sweep::Plan;
use crate::device::controller::ArmCheck;
use crate::device::drive::{ArmScope, Drive};
use crate::device::event::{DisarmReason, Event};
use crate::device::handle::Envelope;
use crate::device::request::Request;
use crate::device::signals::MOTION_LIFE;
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::messages::{ActMessage, CauseMessage, GuardMessage, RemedyMessage};
use brushwork_values::{Message, Motor, Value};
use std::time::Duration;

/// How far requests are looked ahead to find one that replaces an earlier one.
const LOOK_AHEAD: usize = 64;

impl DeviceLoop {
    /// The next request. Of duties and speeds that follow each other only the last is worth sending.
    pub(super) fn next_request(&mut self) -> Option<Envelope> {
        while self.waiting.len() < LOOK_AHEAD {
            let Ok(envelope) = self.inbox.try_recv() else { break };
            self.waiting.push_back(envelope);
        }
        let mut envelope = self.waiting.pop_front()?;
        while let (Request::Drive(drive), Some(next)) = (&envelope.request, self.waiting.front())
            && let Request::Drive(later) = &next.request
            && drive.is_replaced_by(later)
            && let Some(later) = self.waiting.pop_front()
        {
            envelope = later;
        }
        Some(envelope)
    }

    /// Does what is asked.
    pub(super) fn handle(&mut self, envelope: Envelope) {
        let Envelope { request, asked_at, .. } = envelope;
        let overtaken = envelope.stops != self.signals.stops();
        match request {
            Request::Select(address) => self.select(address),
            Request::Join(addresses) => self.join(&addresses),
            Request::Poll(rate) => {
                self.poll = rate;
                self.restart_sweep();
            }
            Request::ReadSignals(on) => self.reads_signals = on,
            Request::SetStream(stream) => {
                self.stream = Some(stream);
                self.tell_selection();
            }
            Request::LearnAnew => self.learn_anew(asked_at),
            Request::Trace(on) => self.exchange.switch_trace(on),
            Request::Arm(scope) => self.arm(scope, overtaken, envelope.disarms),
            Request::Drive(drive) => self.drive(drive, asked_at, overtaken),
            Request::SetEncoder { motor, counts } => {
                self.simple(ActMessage::SetEncoder, asked_at, |unit, line| {
                    unit.set_encoder(line, motor, counts)
                });
            }
            Request::ZeroEncoders => {
                self.simple(ActMessage::ZeroEncoders, asked_at, |unit, line| unit.zero_encoders(line));
            }
            Request::ResetEStop => {
                self.simple(ActMessage::ResetEStop, asked_at, |unit, line| unit.reset_estop(line));
            }
            Request::StartScript => self.start_script(asked_at, overtaken),
            Request::StopScript => self.stop_script(asked_at),
            Request::StartProgram(_) => self.start_program(asked_at, overtaken),
            Request::EnterLoader(_) => self.enter_loader(asked_at, overtaken),
            Request::Transact { id, command, values } => {
                self.transact(id, command, values, asked_at, overtaken);
            }
            Request::Raw { id, bytes } => self.raw(id, &bytes, asked_at, overtaken),
            Request::Job(job) => self.run_job(job, asked_at, overtaken),
            // The handle turns these into signals, which are seen before any request.
            Request::Disarm => self.signals.disarm(),
            Request::Disconnect => self.signals.close(),
        }
    }

    fn learn_anew(&mut self, asked_at: Duration) {
        if self.armed.is_some() {
            let on = self.name_of(self.selected);
            let (came_back, remedy) = (CauseMessage::MotorsArmed, RemedyMessage::DisarmFirst);
            let failure = Failure::new(ActMessage::LearnAnew, on, came_back, remedy);
            return self.outbox.send(Event::Failure(failure));
        }
        let Some(unit) = self.units.get(self.selected) else { return };
        self.exchange.capabilities().forget(unit.controller.identity().address);
        self.simple(ActMessage::LearnAnew, asked_at, |unit, line| unit.look_again(line));
        if let Some(unit) = self.units.get_mut(self.selected) {
            unit.plan = Plan::new(unit.controller.poll_list());
        }
        self.restart_sweep();
        self.tell_capabilities();
    }

    fn select(&mut self, address: u8) {
        let Some(index) = self.unit_at(address) else { return };
        if index != self.selected || !self.joined.is_empty() {
            if self.armed.is_some() {
                self.halt(DisarmReason::Selection);
            }
            self.selected = index;
            self.joined.clear();
            self.restart_sweep();
        }
        self.tell_selection();
    }

    fn join(&mut self, addresses: &[u8]) {
        let Some(found) = addresses.iter().map(|address| self.unit_at(*address)).collect::<Option<Vec<_>>>()
        else {
            return;
        };
        if self.armed.is_some() {
            self.halt(DisarmReason::Selection);
        }
        let selected = self.selected;
        self.joined.clear();
        for index in found.into_iter().filter(|index| *index != selected) {
            if !self.joined.contains(&index) {
                self.joined.push(index);
            }
        }
        self.restart_sweep();
    }

    /// The unit at an address; that there is none is told.
    fn unit_at(&mut self, address: u8) -> Option<usize> {
        let found = self.units.iter().position(|unit| unit.controller.identity().address == address);
        if found.is_none() {
            let family = self.units.first().map(|unit| unit.controller.identity().family);
            let place = family.map_or_else(|| address.to_string(), |family| family.address_text(address));
            let failure = Failure::new(
                ActMessage::Select { place },
                self.exchange.port(),
                CauseMessage::NoSuchUnit,
                RemedyMessage::ConnectAnew,
            );
            self.outbox.send(Event::Failure(failure));
        }
        found
    }

    /// Arms when the controller itself would stop the motors if this program died; of several that move together each of them.
    fn arm(&mut self, scope: ArmScope, overtaken: bool, disarms: u64) {
        if let Some(armed) = self.armed.filter(|armed| armed.scope == scope && !overtaken) {
            return self.tell_armed(armed, Vec::new());
        }
        if self.armed.is_some() && !self.halt_and_confirm(DisarmReason::ScopeChange) {
            return self.refuse(scope, CauseMessage::NotStopped, RemedyMessage::PressStop);
        }
        if overtaken {
            return self.refuse(scope, CauseMessage::StoppedSince, RemedyMessage::ArmWhenReady);
        }
        let without_timeout = self.unstopped_by_themselves();
        if !without_timeout.is_empty() {
            return self.refuse_in_page(scope, without_timeout);
        }
        let stream = self.stream;
        let now = self.clock.now();
        let mut all = ArmCheck::default();
        for index in self.together() {
            let checked = self.act_on(index, now, |unit, line| {
                let mut check = unit.check_arming(line, stream)?;
                if check.reasons.is_empty() {
                    check.warnings.extend(unit.other_drivers(line)?);
                }
                Ok(check)
            });
            match checked {
                Ok(check) => all = all.with(check),
                Err(error) if error.is_link_lost() => return self.lose(&error),
                Err(error) => {
                    let on = self.name_of(index);
                    all.reasons.push(Failure::new(
                        ActMessage::Arm { scope },
                        on,
                        error.message(),
                        error.remedy(),
                    ));
                    break;
                }
            }
        }
        match all {
            check if check.reasons.is_empty() => self.enter_armed(scope, check, disarms),
            ArmCheck { reasons, .. } => self.outbox.send(Event::ArmRefused { scope, reasons }),
        }
    }

    /// The units to be armed that would go on when the tab of this page is closed. They are not even asked: asking switches the motor of some on.
    fn unstopped_by_themselves(&self) -> Vec<usize> {
        let units = self.together().filter(|index| !self.units[*index].controller.has_timeout());
        units.filter(|_| self.options.in_page).collect()
    }

    fn refuse_in_page(&mut self, scope: ArmScope, units: Vec<usize>) {
        let (cause, remedy) = (CauseMessage::NoTimeoutForPage, RemedyMessage::DriveByProgram);
        let refused = |index| {
            Failure::new(ActMessage::Arm { scope }, self.name_of(index), cause.clone(), remedy.clone())
        };
        let reasons = units.into_iter().map(refused).collect();
        self.outbox.send(Event::ArmRefused { scope, reasons });
    }

    fn enter_armed(&mut self, scope: ArmScope, check: ArmCheck, disarms: u64) {
        let ArmCheck { controller_timeout, mut warnings, .. } = check;
        if self.options.in_page {
            let Some(timeout) = controller_timeout else {
                return self.refuse_in_page(scope, self.together().collect());
            };
            warnings.push(GuardMessage::InPage { timeout_ms: timeout.as_millis() }.into());
        }
        let armed = Armed { scope, controller_timeout };
        warnings.extend(self.have_guard());
        for index in self.together() {
            let lends = self.units[index].controller.lends();
            warnings.extend(self.lend(index, &lends));
            // Whoever drives from now on may not have heard how it stands.
            self.units[index].plan.status_told_at = None;
        }
        self.armed = Some(armed);
        self.disarmed_by = None;
        self.tend_guard();
        self.guard.set_armed(true, disarms);
        self.restart_sweep();
        self.tell_armed(armed, warnings);
    }

    fn tell_armed(&mut self, armed: Armed, warnings: Vec<Message>) {
        let Armed { scope, controller_timeout } = armed;
        let address = self.units[self.selected].controller.identity().address;
        self.outbox.send(Event::Armed { address, scope, controller_timeout, warnings });
    }

    fn refuse(&mut self, scope: ArmScope, came_back: impl Into<Message>, remedy: RemedyMessage) {
        let on = self.name_of(self.selected);
        let reason = Failure::new(ActMessage::Arm { scope }, on, came_back, remedy);
        self.outbox.send(Event::ArmRefused { scope, reasons: vec![reason] });
    }

    fn drive(&mut self, drive: Drive, asked_at: Duration, overtaken: bool) {
        let waited = self.clock.now().saturating_sub(asked_at);
        let refusal = if overtaken {
            Some(CauseMessage::Stopped)
        } else if waited > MOTION_LIFE {
            Some(CauseMessage::TooOld)
        } else {
            None
        };
        if let Some(came_back) = refusal {
            return self.tell_not_sent(ActMessage::Move, came_back);
        }
        let mut moved = false;
        for index in self.together() {
            let sent_at = self.clock.now();
            match self.act_on(index, asked_at, |unit, line| unit.drive(line, &drive)) {
                Ok(()) => self.note_drive_of(index, &drive, sent_at),
                Err(error) => {
                    let unsure = is_unsure(&error);
                    self.tell_of(index, ActMessage::Move, &error);
                    if unsure {
                        self.halt(DisarmReason::NoAnswer);
                    } else if moved && self.armed.is_some() && error.interruption().is_none() {
                        self.halt(DisarmReason::NotTogether);
                    }
                    return;
                }
            }
            moved = true;
        }
    }

    /// A motion command was confirmed.
    pub(super) fn note_drive(&mut self, drive: &Drive, sent_at: Duration) {
        self.note_drive_of(self.selected, drive, sent_at);
    }

    fn note_drive_of(&mut self, index: usize, drive: &Drive, sent_at: Duration) {
        let unit = &mut self.units[index];
        for motor in Motor::BOTH {
            if let Some(command) = drive.of(motor) {
                unit.setpoints[motor.index()] = Some(command.setpoint());
            }
        }
        let address = unit.controller.identity().address;
        self.outbox.send(Event::Driven { address, sent_at, drive: *drive });
    }

    fn start_script(&mut self, asked_at: Duration, overtaken: bool) {
        if overtaken {
            return self.tell_not_sent(ActMessage::StartScript, CauseMessage::Stopped);
        }
        let mut runs = false;
        for index in self.together() {
            let started = self.act_on(index, asked_at, |unit, line| unit.start_script(line));
            self.units[index].script_started |= !matches!(started, Err(ExchangeError::NotArmed { .. }));
            if let Err(error) = started {
                let unsure = is_unsure(&error);
                match error.answered() {
                    Some(answer) => self.tell_refused_start(index, answer),
                    None => self.tell_of(index, ActMessage::StartScript, &error),
                }
                if unsure {
                    self.halt(DisarmReason::NoAnswer);
                } else if runs && self.armed.is_some() && error.interruption().is_none() {
                    self.halt(DisarmReason::NotTogether);
                }
                return;
            }
            runs = true;
        }
    }

    /// Simulated controllers refuse by another byte than FF. Nobody knows what a real one says, so that it is stopped all the same.
    fn tell_refused_start(&mut self, index: usize, answer: u8) {
        let (came_back, remedy) = (CauseMessage::NoScript { answer }, RemedyMessage::DownloadFirst);
        let failure = Failure::new(ActMessage::StartScript, self.name_of(index), came_back, remedy);
        self.outbox.send(Event::Failure(failure));
    }

    /// Starts what is in the selected unit's memory, and looks anew who answers on the line. It is nothing that this program has set in motion:
    /// a stop that it does not understand would be repeated for ever.
    fn start_program(&mut self, asked_at: Duration, overtaken: bool) {
        if overtaken {
            return self.tell_not_sent(ActMessage::StartProgram, CauseMessage::Stopped);
        }
        if self.armed.is_some() && !self.halt_and_confirm(DisarmReason::SettingsChanged) {
            return;
        }
        let address = self.units[self.selected].controller.identity().address;
        let mut done = self.act(asked_at, |unit, line| unit.start_program(line));
        for index in 0..self.units.len() {
            done = done.and_then(|()| self.act_on(index, asked_at, |unit, line| unit.look_again(line)));
            self.outbox.send(Event::Connected(self.units[index].controller.identity().clone()));
        }
        match done {
            Ok(()) => self.outbox.send(Event::ProgramStarted { address }),
            Err(error) => self.tell(ActMessage::StartProgram, &error),
        }
        self.restart_sweep();
    }

    fn stop_script(&mut self, asked_at: Duration) {
        match self.act(asked_at, |unit, line| unit.stop_script(line)) {
            Ok(()) => self.units[self.selected].script_started = false,
            Err(error) => self.tell(ActMessage::StopScript, &error),
        }
    }

    fn simple(
        &mut self,
        tried: ActMessage,
        asked_at: Duration,
        act: impl FnOnce(
            &mut dyn crate::device::controller::Controller,
            &mut crate::device::controller::Line<'_>,
        ) -> Result<(), ExchangeError>,
    ) {
        if let Err(error) = self.act(asked_at, act) {
            self.tell(tried, &error);
        }
    }

    fn transact(&mut self, id: u64, command: u8, values: Vec<Value>, asked_at: Duration, overtaken: bool) {
        let tried = ActMessage::SendCommand { command };
        let on = self.name_of(self.selected);
        if overtaken && self.units[self.selected].controller.can_move(command) {
            let failure = Failure::new(tried, on, CauseMessage::Stopped, RemedyMessage::SendWhenReady);
            return self.outbox.send(Event::Transacted { id, result: Err(failure) });
        }
        let reply = self
            .stop_before(command)
            .and_then(|()| self.act(asked_at, |unit, line| unit.transact(line, command, values)));
        self.after_command(command);
        match reply {
            Ok(reply) => self.outbox.send(Event::Transacted { id, result: Ok(reply.values) }),
            Err(error) => {
                self.outbox.send(Event::Transacted { id, result: Err(error.failure(tried, on)) });
                if error.is_link_lost() {
                    self.lose(&error);
                }
            }
        }
    }

    fn raw(&mut self, id: u64, bytes: &[u8], asked_at: Duration, overtaken: bool) {
        let tried = ActMessage::SendTyped;
        let on = self.name_of(self.selected);
        if overtaken {
            let failure = Failure::new(tried, on, CauseMessage::Stopped, RemedyMessage::SendWhenReady);
            return self.outbox.send(Event::RawReply { id, result: Err(failure) });
        }
        let undermines = self.units[self.selected].controller.raw_undermines_arming(bytes);
        let reply =
            self.stop_if(undermines).and_then(|()| self.act(asked_at, |unit, line| unit.raw(line, bytes)));
        match reply {
            Ok(bytes) => self.outbox.send(Event::RawReply { id, result: Ok(bytes) }),
            Err(error) => {
                self.outbox.send(Event::RawReply { id, result: Err(error.failure(tried, on)) });
                if error.is_link_lost() {
                    self.lose(&error);
                }
            }
        }
    }

    /// Disarms before a raw command of a window or a job that may change what arming was based on. Motors are stopped before it
    /// and not after it, since the unit may listen to another address or have no time-out by then.
    pub(super) fn stop_before(&mut self, command: u8) -> Result<(), ExchangeError> {
        let undermines = self.units[self.selected].controller.undermines_arming(command);
        self.stop_if(undermines)
    }

    fn stop_if(&mut self, undermines: bool) -> Result<(), ExchangeError> {
        if self.armed.is_none() || !undermines || self.halt_and_confirm(DisarmReason::SettingsChanged) {
            return Ok(());
        }
        Err(ExchangeError::impossible(CauseMessage::NotStopped))
    }

    /// What a raw command of a window or a job means for stopping: a script may run now.
    pub(super) fn after_command(&mut self, command: u8) {
        let permit = self.permit();
        let unit = &mut self.units[self.selected];
        unit.script_started |= permit.script && unit.controller.starts_script(command);
    }

    /// The selected unit has been given another address; the window is told as if it had just been found.
    pub(super) fn readdress(&mut self, address: u8) -> bool {
        let unit = &mut self.units[self.selected];
        let from = unit.controller.identity().address;
        if !unit.controller.set_address(address) {
            return false;
        }
        self.outbox.send(Event::Moved { from });
        self.outbox.send(Event::Connected(unit.controller.identity().clone()));
        self.tell_selection();
        true
    }

    pub(super) fn tell_not_sent(&mut self, tried: ActMessage, came_back: CauseMessage) {
        let on = self.name_of(self.selected);
        let failure = Failure::new(tried, on, came_back, RemedyMessage::AskWhenReady);
        self.outbox.send(Event::Failure(failure));
    }
}

/// Whether a command went out and nobody knows what became of it.
fn is_unsure(error: &ExchangeError) -> bool {
    let sent = matches!(
        error,
        ExchangeError::TimedOut { .. }
            | ExchangeError::BadCrc { .. }
            | ExchangeError::BadAcknowledgement { .. }
            | ExchangeError::Malformed { .. }
            | ExchangeError::NotUnderstood { .. }
            | ExchangeError::MayHaveRun { .. }
    );
    sent && !error.is_link_lost() && error.interruption().is_none()
}
