//! Stopping motors: the bytes first, whatever is under way; then the line is settled and each unit is asked to confirm.

use super::{DeviceLoop, Phase};
use crate::device::controller::Line;
use crate::device::event::{DisarmReason, Event};
use crate::device::stop::{StopReport, UnitStop};
use crate::exchange::{ExchangeError, Interruption};
use std::time::Duration;

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
        let bytes = self.stop_bytes(reason);
        let written_at = if bytes.is_empty() { now } else { self.exchange.write_now(&bytes)? };
        self.guard.stop_served(stops);
        Ok(Written { requested_at, written_at })
    }

    /// Disarms, settles the line, and asks for confirmation.
    pub(super) fn finish_halt(&mut self, reason: DisarmReason, written: Written) -> bool {
        let concerned = self.concerned(&reason);
        let everything = reason == DisarmReason::Stop;
        let all_scripts = everything;
        self.disarm(reason);
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
        };
        let confirmed = report.confirmed();
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
        all.filter(|index| everything || self.units[*index].moved || armed && *index == selected).collect()
    }

    fn stop_bytes(&self, reason: &DisarmReason) -> Vec<u8> {
        if self.phase == Phase::Connecting {
            return self.family.stop_bytes();
        }
        let scripts = |index: usize| *reason == DisarmReason::Stop || self.units[index].script_started;
        let concerned = self.concerned(reason).into_iter();
        concerned.flat_map(|index| self.units[index].controller.stop_bytes(scripts(index))).collect()
    }

    fn disarm(&mut self, reason: DisarmReason) {
        self.guard.motion_ends();
        self.guard.set_armed(false, self.signals.disarms());
        if self.armed.take().is_some() {
            self.outbox.send(Event::Disarmed(reason));
            self.outbox.wake_window();
        }
    }

    /// Asks one unit to confirm that it stands. A new Stop on the way writes the bytes again and begins anew.
    fn confirm(&mut self, index: usize, all_scripts: bool) -> Result<UnitStop, ExchangeError> {
        loop {
            match self.try_to_confirm(index, all_scripts) {
                Err(error) if error.interruption() == Some(Interruption::Stop) => {
                    self.write_stop(&DisarmReason::Stop)?;
                }
                Ok(stop) => {
                    let unit = &mut self.units[index];
                    if stop.confirmed {
                        (unit.moved, unit.script_started, unit.setpoints) = (false, false, [Some(0.0); 2]);
                    }
                    return Ok(stop);
                }
                Err(error) => return Err(error),
            }
        }
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
