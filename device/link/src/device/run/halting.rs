//! Stopping motors: the bytes first, whatever is under way; then the line is settled and each unit is asked to confirm.

use super::reading::SILENCE_LIMIT;
use super::state::{DeviceLoop, Phase};
use super::stop_again::StopAgain;
use crate::device::controller::Line;
use crate::device::event::{DisarmReason, Event};
use crate::device::stop::{StopBytes, StopReport, UnitStop};
use crate::exchange::{ExchangeError, Interruption};
use crate::failure::Failure;
use crate::messages::{ActMessage, CauseMessage, RemedyMessage};
use crate::settings::SettingsImage;
use brushwork_values::Message;
use std::time::Duration;

/// A stop that was not confirmed is repeated this often.
const STOP_AGAIN_INTERVAL: Duration = Duration::from_millis(100);
/// On a bus of several units one that does not confirm is given up after this long.
const GIVE_UP_AFTER: Duration = Duration::from_secs(3);

/// When a stop was asked for and when its bytes had been written.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    pub requested_at: Duration,
    pub written_at: Duration,
}

impl DeviceLoop {
    /// Stops motors for `reason`, disarms, and tells what became of it. Stop goes to every unit of the link and ends
    /// scripts; any other reason stops what this program has set in motion.
    pub(super) fn halt(&mut self, reason: DisarmReason) {
        self.halt_and_confirm(reason);
    }

    /// The same; returns whether every unit confirmed.
    pub(super) fn halt_and_confirm(&mut self, reason: DisarmReason) -> bool {
        match self.write_stop(&reason) {
            Ok(written) => self.finish_halt(reason, written),
            Err(error) => {
                self.lose(&error);
                false
            }
        }
    }

    /// Writes the stop bytes at once, without waiting for a reply in flight. All stops asked for so far are served by it.
    pub(super) fn write_stop(&mut self, reason: &DisarmReason) -> Result<Written, ExchangeError> {
        let stops = self.signals.stops();
        let now = self.clock.now();
        let requested_at = if self.guard.stop_waits() { self.signals.stopped_at() } else { now };
        let mut bytes = self.stop_bytes(reason);
        if *reason == DisarmReason::Stop {
            // Another program may mean more units than this one has looked for.
            let asked = self.signals.outside_addresses().into_iter();
            bytes = asked.map(|asked| self.family.stop_bytes(asked)).fold(bytes, StopBytes::with);
        }
        let written_at = if bytes.is_empty() { now } else { self.exchange.write_stop(&bytes)? };
        self.guard.stop_served(stops);
        Ok(Written { requested_at, written_at })
    }

    /// Disarms, settles the line, and asks for confirmation.
    pub(super) fn finish_halt(&mut self, reason: DisarmReason, written: Written) -> bool {
        let concerned = self.concerned(&reason);
        let everything = reason == DisarmReason::Stop;
        let all_scripts = everything;
        let from_outside = everything && !self.signals.outside_addresses().is_empty();
        self.disarm(if from_outside { DisarmReason::StopFromOutside } else { reason });
        self.restart_sweep();
        self.guard.set_only_stop(true);
        let mut units = Vec::new();
        for index in concerned {
            match self.confirm(index, all_scripts) {
                Ok(unit) => units.push(unit),
                Err(error) => {
                    self.guard.set_only_stop(false);
                    self.lose(&error);
                    return false;
                }
            }
        }
        if everything {
            self.look_for_other_drivers(&mut units);
        }
        self.guard.set_only_stop(false);
        let report = StopReport {
            requested_at: written.requested_at,
            written_at: written.written_at,
            ended_at: self.clock.now(),
            units,
            from_outside,
        };
        let confirmed = report.confirmed();
        // Before the units are known nobody can tell what became of it; it is served once more then.
        if everything && self.phase == Phase::Running {
            let units = || self.units.iter().map(|unit| unit.controller.identity().clone()).collect();
            self.signals.answer_outside(self.guard.stops_served(), || (units(), report.clone()));
        }
        self.outbox.send(Event::Stopped(report));
        confirmed
    }

    /// Which units a halt concerns, the selected one first.
    fn concerned(&self, reason: &DisarmReason) -> Vec<usize> {
        let everything = *reason == DisarmReason::Stop;
        let selected = self.selected;
        let others = (0..self.units.len()).filter(|index| *index != selected);
        let all = std::iter::once(selected).chain(others).filter(|index| *index < self.units.len());
        let armed = self.armed.is_some();
        all.filter(|index| everything || self.units[*index].moved || armed && self.is_together(*index))
            .collect()
    }

    pub(super) fn stop_bytes(&self, reason: &DisarmReason) -> StopBytes {
        if self.phase == Phase::Connecting {
            return self.family.stop_bytes(self.options.addresses);
        }
        if *reason == DisarmReason::Stop && self.units.len() > 1 {
            let units: Vec<_> = self.units.iter().map(|unit| unit.controller.identity()).collect();
            if let Some(bytes) = self.family.stop_all_bytes(&units) {
                return bytes;
            }
        }
        let scripts = |index: usize| *reason == DisarmReason::Stop || self.units[index].script_started;
        let concerned = self.concerned(reason).into_iter();
        let bytes = concerned.map(|index| self.units[index].controller.stop_bytes(scripts(index)));
        bytes.reduce(StopBytes::with).unwrap_or_default()
    }

    fn disarm(&mut self, reason: DisarmReason) {
        self.guard.motion_ends();
        self.guard.set_armed(false, self.signals.disarms());
        if self.armed.take().is_some() {
            self.disarmed_by = Some(reason.clone());
            self.outbox.send(Event::Disarmed(reason));
            self.outbox.wake_window();
        }
    }

    /// Asks one unit to confirm that it stands. A new Stop on the way writes the bytes again and begins anew.
    fn confirm(&mut self, index: usize, all_scripts: bool) -> Result<UnitStop, ExchangeError> {
        let begun_at = self.clock.now();
        loop {
            match self.try_to_confirm(index, all_scripts) {
                Err(error) if error.interruption() == Some(Interruption::Stop) => {
                    self.write_stop(&DisarmReason::Stop)?;
                }
                Ok(stop) => {
                    self.note_confirmation(index, &stop, begun_at);
                    return Ok(stop);
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// A script that this program has started has to confirm its end too, or it may drive the motors again.
    fn note_confirmation(&mut self, index: usize, stop: &UnitStop, begun_at: Duration) {
        let now = self.clock.now();
        self.note_loan(index, stop);
        let unit = &mut self.units[index];
        let script_may_run = unit.script_started && stop.script_ended != Some(true);
        if stop.confirmed && !script_may_run {
            (unit.moved, unit.script_started, unit.stop_again) = (false, false, None);
            unit.setpoints = [Some(0.0); 2];
        } else if unit.moved {
            let since = unit.stop_again.map_or(begun_at, |again| again.since);
            unit.stop_again = Some(StopAgain { at: now + STOP_AGAIN_INTERVAL, since });
        }
    }

    /// What a stop has changed and not given back is noted, and what it has given back is done with. Nothing waits for the disk but what comes
    /// after the stop.
    fn note_loan(&mut self, index: usize, stop: &UnitStop) {
        let controller = &self.units[index].controller;
        let (lent, lends) = (controller.lent(), controller.lends());
        if !lent.is_empty() {
            // That it cannot be kept was said when it was armed.
            drop(self.lend(index, &lent));
        } else if stop.confirmed
            && let Some(loans) = &self.options.loans
        {
            loans.given_back(controller.identity(), &lends);
        }
    }

    /// Notes what settings of a unit hold. Gives the sentence on why that cannot be kept.
    pub(super) fn lend(&self, index: usize, held: &SettingsImage) -> Option<Message> {
        let loans = self.options.loans.as_ref().filter(|_| !held.is_empty())?;
        loans.lend(self.units[index].controller.identity(), held).err().map(Message::error)
    }

    /// The unit whose motors may still run although they were told to stop.
    pub(super) fn unconfirmed_stop(&self) -> Option<(usize, StopAgain)> {
        self.units.iter().enumerate().find_map(|(index, unit)| Some((index, unit.stop_again?)))
    }

    /// Tries once more to stop a unit that did not confirm. Silence for too long is a lost link; on a bus, where others may
    /// answer, the unit is given up and the user told.
    pub(super) fn stop_again(&mut self, index: usize, again: StopAgain) {
        let requested_at = self.clock.now();
        let unit = &self.units[index];
        let bytes = unit.controller.stop_bytes(unit.script_started);
        self.guard.set_only_stop(true);
        let written = self.exchange.write_stop(&bytes);
        let stop = written.and_then(|written_at| Ok((written_at, self.try_to_confirm(index, false)?)));
        self.guard.set_only_stop(false);
        let (written_at, stop) = match stop {
            Ok(stop) => stop,
            // A new Stop is served in the next step.
            Err(error) if error.interruption().is_some() => return,
            Err(error) => return self.lose(&error),
        };
        self.note_confirmation(index, &stop, requested_at);
        let ended_at = self.clock.now();
        if self.units[index].stop_again.is_none() {
            let units = vec![stop];
            return self.outbox.send(Event::Stopped(StopReport {
                requested_at,
                written_at,
                ended_at,
                units,
                from_outside: false,
            }));
        }
        let silent_since = again.since.max(self.exchange.last_reply_at());
        if self.units.len() == 1 && ended_at >= silent_since + SILENCE_LIMIT {
            let answer = stop.failures.into_iter().next().map(|failure| failure.came_back);
            self.lose_for(answer.unwrap_or_else(|| CauseMessage::NoAnswer.into()));
        } else if ended_at >= again.since + GIVE_UP_AFTER {
            self.give_up_stopping(index);
        }
    }

    fn give_up_stopping(&mut self, index: usize) {
        self.units[index].stop_again = None;
        let failure = Failure::new(
            ActMessage::Stop,
            self.name_of(index),
            CauseMessage::StopUnconfirmed { seconds: GIVE_UP_AFTER.as_secs() },
            RemedyMessage::CutPower,
        );
        self.outbox.send(Event::Failure(failure));
    }

    fn try_to_confirm(&mut self, index: usize, all_scripts: bool) -> Result<UnitStop, ExchangeError> {
        let unit = &mut self.units[index];
        let mut line = Line::for_stopping(&mut self.exchange, &self.guard, self.options.simulated);
        unit.controller.confirm_stop(&mut line, all_scripts || unit.script_started)
    }

    /// Adds what can still drive the units' motors. A new Stop ends the search; it is served next.
    fn look_for_other_drivers(&mut self, stops: &mut [UnitStop]) {
        for stop in stops {
            let found = self.units.iter_mut().find(|unit| unit.controller.identity().address == stop.address);
            let Some(unit) = found.filter(|_| stop.confirmed) else { continue };
            let mut line = Line::for_stopping(&mut self.exchange, &self.guard, self.options.simulated);
            match unit.controller.other_drivers(&mut line) {
                Ok(drivers) => stop.still_driven_by.extend(drivers),
                Err(_) => return,
            }
        }
    }
}
