//! Reading the signals: a sweep of the selected unit's fast ones with one slow one in turn, and one look at one of the
//! other units of the bus: its status, and one of its signals in turn.

use super::state::DeviceLoop;
use super::sweep::SUSPENSION;
use crate::device::channel::{Channel, Sample};
use crate::device::controller::PollItem;
use crate::device::event::{DisarmReason, Event};
use crate::device::poll_rate::PollRate;
use crate::device::status::StatusReport;
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::messages::{ActMessage, RemedyMessage};
use std::time::Duration;

/// A status that does not change is told this often.
const STATUS_INTERVAL: Duration = Duration::from_secs(1);
/// A link on which nothing has answered for so long is lost.
pub const SILENCE_LIMIT: Duration = Duration::from_secs(2);
/// How often signals are read while something is armed, if not more often.
const ARMED_INTERVAL: Duration = Duration::from_millis(100);

impl DeviceLoop {
    /// Whether a reading is due.
    pub(super) fn is_reading_due(&self, now: Duration) -> bool {
        !self.sweep.items.is_empty() || self.next_reading_at().is_some_and(|at| now >= at)
    }

    /// When the next sweep begins.
    pub(super) fn next_reading_at(&self) -> Option<Duration> {
        self.interval().map(|_| self.sweep.next_at)
    }

    /// Reads one item.
    pub(super) fn read_one(&mut self) {
        let now = self.clock.now();
        if self.sweep.items.is_empty() {
            self.begin_sweep(now);
        }
        let Some((index, item)) = self.sweep.items.pop_front() else { return self.end_sweep() };
        let mut sample = std::mem::replace(&mut self.sweep.sample, Sample::new(0));
        let address = self.units[index].controller.identity().address;
        let of_it = self.sweep.other.take().filter(|other| other.address == address);
        let mut other = of_it.unwrap_or_else(|| Sample::new(address));
        let into = if index == self.selected { &mut sample } else { &mut other };
        let read = self.act_on(index, now, |controller, line| controller.poll(line, item, into));
        self.sweep.sample = sample;
        match read {
            Ok(status) => {
                self.sweep.failures_in_a_row = 0;
                self.units[index].plan.answered(item);
                if self.sweep.items.front().is_some_and(|(next, _)| *next == index) {
                    self.sweep.other = Some(other);
                } else if !other.is_empty() {
                    self.set_setpoints(index, &mut other);
                    // A graph counts the samples of the selected unit alone, so that this one has no number.
                    self.outbox.send(Event::Sample(Box::new(other)));
                }
                if let Some(status) = status {
                    self.take_status(index, status);
                }
            }
            Err(error) => self.reading_failed(index, item, &error),
        }
        if self.sweep.items.is_empty() {
            self.end_sweep();
        }
    }

    fn begin_sweep(&mut self, now: Duration) {
        let Some(unit) = self.units.get_mut(self.selected) else { return };
        self.sweep.sample = Sample::new(unit.controller.identity().address);
        self.sweep.begun_at = now;
        let (selected, with_signals) = (self.selected, self.reads_signals);
        self.sweep.items.extend(unit.plan.sweep(now, with_signals).into_iter().map(|item| (selected, item)));
        for index in self.joined.clone() {
            let items = self.units[index].plan.sweep(now, false);
            self.sweep.items.extend(items.into_iter().map(|item| (index, item)));
        }
        let others = self.look_at_another(now);
        self.sweep.items.extend(others);
    }

    /// The status of the next of the other units, and one more of its signals in turn while nothing is armed.
    fn look_at_another(&mut self, now: Duration) -> Vec<(usize, PollItem)> {
        if self.units.len() < 2 {
            return Vec::new();
        }
        self.sweep.other_unit = (self.sweep.other_unit + 1) % self.units.len();
        let index = self.sweep.other_unit;
        if self.is_together(index) {
            return Vec::new();
        }
        let plan = &mut self.units[index].plan;
        let status = plan.list.status.filter(|item| plan.works(*item, now));
        let in_turn = if self.armed.is_none() { plan.next_in_turn(now) } else { None };
        status.into_iter().chain(in_turn).map(|item| (index, item)).collect()
    }

    /// Hands the sample over and sets the time of the next sweep.
    fn end_sweep(&mut self) {
        let now = self.clock.now();
        let due = self.interval().map_or(now, |interval| self.sweep.begun_at + interval);
        self.sweep.next_at = due.max(now);
        let mut sample = std::mem::replace(&mut self.sweep.sample, Sample::new(0));
        if sample.is_empty() {
            return;
        }
        sample.is_all_read = self.units[self.selected].plan.is_all_read(now);
        self.set_setpoints(self.selected, &mut sample);
        self.send_sample(sample);
    }

    /// Puts what a unit was last told beside what it measures.
    fn set_setpoints(&self, index: usize, sample: &mut Sample) {
        let (from, to) = (sample.requested_at, sample.replied_at);
        let setpoints = self.units[index].setpoints;
        for (setpoint, channel) in setpoints.into_iter().zip([Channel::M1_SETPOINT, Channel::M2_SETPOINT]) {
            if let Some(value) = setpoint {
                sample.set(channel, value, from, to);
            }
        }
    }

    /// Numbers a sample and sends it.
    pub(super) fn send_sample(&mut self, mut sample: Sample) {
        sample.sequence = self.sweep.sequence;
        self.sweep.sequence += 1;
        self.outbox.send(Event::Sample(Box::new(sample)));
    }

    /// Time between sweeps; `None` while nothing is read.
    fn interval(&self) -> Option<Duration> {
        let asked = match self.poll {
            PollRate::Off => None,
            PollRate::Every(interval) => Some(interval),
            PollRate::Fastest => Some(Duration::ZERO),
        };
        let Some(armed) = self.armed else { return asked };
        // Reading also feeds the controller's own time-out, so it must not be rarer than that.
        let longest = armed.controller_timeout.map_or(ARMED_INTERVAL, |timeout| timeout / 3);
        Some(asked.unwrap_or(ARMED_INTERVAL).min(longest))
    }

    /// Tells a status that is new, and disarms when the controller has stopped motors by itself.
    fn take_status(&mut self, index: usize, status: StatusReport) {
        let plan = &mut self.units[index].plan;
        let changed = plan.last_status.is_none_or(|last| last.word != status.word);
        let restarted = plan.last_status.is_some_and(|last| status.has_restarted_since(&last));
        plan.last_status = Some(status);
        if changed || plan.status_told_at.is_none_or(|told_at| status.at >= told_at + STATUS_INTERVAL) {
            plan.status_told_at = Some(status.at);
            self.outbox.send(Event::Status(status));
        }
        if self.armed.is_none() || !self.is_together(index) {
            return;
        }
        let faults: Vec<_> = status.faults().collect();
        if !faults.is_empty() {
            self.halt(DisarmReason::Fault(faults));
        } else if restarted {
            self.halt(DisarmReason::Restarted);
        }
    }

    fn reading_failed(&mut self, index: usize, item: PollItem, error: &ExchangeError) {
        if error.is_link_lost() {
            return self.lose(error);
        }
        if error.interruption().is_some() {
            // Served in the next step; the item is read again after that.
            return self.sweep.items.push_front((index, item));
        }
        let now = self.clock.now();
        self.sweep.failures_in_a_row += 1;
        if self.units.len() > 1 {
            // The rest of the unit waits for the next sweep, so that the others are heard in time.
            self.sweep.items.retain(|(other, _)| *other != index);
        }
        if self.armed.is_some() && self.is_together(index) {
            return self.halt(DisarmReason::NoAnswer);
        }
        let silent_since = self.exchange.last_reply_at().max(self.sweep.restarted_at);
        if self.sweep.failures_in_a_row > 1 && now >= silent_since + SILENCE_LIMIT {
            return self.lose(error);
        }
        if self.sweep.failures_in_a_row == 1 && self.units[index].plan.missed(item, now) {
            self.tell_left_out(index, item, error);
        }
    }

    fn tell_left_out(&mut self, index: usize, item: PollItem, error: &ExchangeError) {
        let seconds = SUSPENSION.as_secs();
        let failure = Failure::new(
            ActMessage::ReadItem { name: item.name },
            self.name_of(index),
            error.message(),
            RemedyMessage::LeftOut { seconds },
        );
        self.outbox.send(Event::Failure(failure));
    }

    /// Forgets the sweep under way and what it counted: after a halt, a job, a change of unit.
    pub(super) fn restart_sweep(&mut self) {
        self.sweep.abandon();
        self.sweep.failures_in_a_row = 0;
        self.sweep.restarted_at = self.clock.now();
        self.sweep.next_at = self.sweep.next_at.min(self.sweep.restarted_at);
    }
}
