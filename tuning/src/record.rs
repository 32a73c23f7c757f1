//! The raw record of a run: every call to the axis with its answer, and the axis that plays one back.
//!
//! All values are whole numbers of the wire, so a record survives a file unchanged, and a tuner that is fed from it makes the
//! same decisions and the same gains to the last bit.

use crate::axis::{Axis, AxisError, Exchange, Sample, TestedLoop, Want};
use crate::law::Law;
use crate::setup::{LoopAxis, Setup};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// One call and its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", bound = "")]
pub enum Entry<L: Law> {
    /// The time was asked for.
    Now(Duration),
    /// A wait ended.
    Waited(Result<(), AxisError>),
    /// A poll.
    Sampled(Result<Sample, AxisError>),
    /// A duty.
    Duty(i16, Result<Exchange, AxisError>),
    /// A speed.
    Speed(i32, Result<Exchange, AxisError>),
    /// A position and its speed.
    Position(i32, u32, Result<Exchange, AxisError>),
    /// The setup.
    Setup(Result<Setup<L>, AxisError>),
    /// Inductance and resistance written.
    Winding([u32; 2], Result<(), AxisError>),
    /// Highest currents written.
    CurrentLimits(u32, i32, Result<(), AxisError>),
    /// Raw speed.
    RawSpeed(Result<i32, AxisError>),
    /// Stream time-out set.
    Timeout(u32, Result<(), AxisError>),
    /// Travel given.
    Travel((i64, i64), Result<(), AxisError>),
    /// The controller's own relay test begun.
    OwnTestStarted(TestedLoop, [u32; 2], Result<(Exchange, u32), AxisError>),
    /// What it found.
    OwnTest(Result<[u32; 2], AxisError>),
    /// Time that this computer took of the last calls; not noted where it took none.
    Stolen(Duration),
    /// Registers of a loop written, under the law's own names.
    #[serde(untagged)]
    Registers(L::Note),
}

/// Writes down what passes between a tuner and an axis.
pub struct Recorder<'a, L: Law> {
    axis: &'a mut dyn LoopAxis<L>,
    look: &'a mut dyn FnMut(&Entry<L>),
    entries: Vec<Entry<L>>,
}

impl<'a, L: Law> Recorder<'a, L> {
    /// Listens to `axis`, and shows each entry to `look`.
    pub fn new(axis: &'a mut dyn LoopAxis<L>, look: &'a mut dyn FnMut(&Entry<L>)) -> Self {
        Self { axis, look, entries: Vec::new() }
    }

    fn note(&mut self, entry: Entry<L>) {
        (self.look)(&entry);
        self.entries.push(entry);
    }

    /// What passed so far.
    #[must_use]
    pub fn into_entries(self) -> Vec<Entry<L>> {
        self.entries
    }
}

impl<L: Law> Axis for Recorder<'_, L> {
    fn now(&mut self) -> Duration {
        let now = self.axis.now();
        self.note(Entry::Now(now));
        now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        let answer = self.axis.wait_until(time);
        self.note(Entry::Waited(answer.clone()));
        answer
    }

    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        let answer = self.axis.sample(want);
        self.note(Entry::Sampled(answer.clone()));
        answer
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        let answer = self.axis.drive_duty(duty_raw);
        self.note(Entry::Duty(duty_raw, answer.clone()));
        answer
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        let answer = self.axis.command_speed(counts_per_s);
        self.note(Entry::Speed(counts_per_s, answer.clone()));
        answer
    }

    fn command_position(&mut self, counts: i32, speed: u32) -> Result<Exchange, AxisError> {
        let answer = self.axis.command_position(counts, speed);
        self.note(Entry::Position(counts, speed, answer.clone()));
        answer
    }

    fn write_winding(&mut self, raw: [u32; 2]) -> Result<(), AxisError> {
        let answer = self.axis.write_winding(raw);
        self.note(Entry::Winding(raw, answer.clone()));
        answer
    }

    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError> {
        let answer = self.axis.write_current_limits(max_raw, min_raw);
        self.note(Entry::CurrentLimits(max_raw, min_raw, answer.clone()));
        answer
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        let answer = self.axis.raw_speed();
        self.note(Entry::RawSpeed(answer.clone()));
        answer
    }

    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError> {
        let answer = self.axis.set_stream_timeout(milliseconds);
        self.note(Entry::Timeout(milliseconds, answer.clone()));
        answer
    }

    fn start_own_test(
        &mut self,
        tested: TestedLoop,
        height_raw: u32,
        hysteresis: u32,
    ) -> Result<(Exchange, u32), AxisError> {
        let answer = self.axis.start_own_test(tested, height_raw, hysteresis);
        self.note(Entry::OwnTestStarted(tested, [height_raw, hysteresis], answer.clone()));
        answer
    }

    fn read_own_test(&mut self) -> Result<[u32; 2], AxisError> {
        let answer = self.axis.read_own_test();
        self.note(Entry::OwnTest(answer.clone()));
        answer
    }

    fn set_travel(&mut self, counts: (i64, i64)) -> Result<(), AxisError> {
        let answer = self.axis.set_travel(counts);
        self.note(Entry::Travel(counts, answer.clone()));
        answer
    }

    fn stolen(&mut self) -> Duration {
        let stolen = self.axis.stolen();
        if !stolen.is_zero() {
            self.note(Entry::Stolen(stolen));
        }
        stolen
    }

    fn progress(&mut self, text: &str) {
        self.axis.progress(text);
    }
}

impl<L: Law> LoopAxis<L> for Recorder<'_, L> {
    fn read_setup(&mut self) -> Result<Setup<L>, AxisError> {
        let answer = self.axis.read_setup();
        self.note(Entry::Setup(answer.clone()));
        answer
    }

    fn write(&mut self, write: L::Write) -> Result<(), AxisError> {
        let answer = self.axis.write(write);
        self.note(Entry::Registers(L::note(write, answer.clone())));
        answer
    }
}

/// An axis that answers from a record.
pub struct Player<L: Law> {
    entries: std::vec::IntoIter<Entry<L>>,
    time: Duration,
    played: usize,
    strayed_at: Option<usize>,
}

impl<L: Law> Player<L> {
    /// Plays `entries` from their start.
    #[must_use]
    pub fn new(entries: Vec<Entry<L>>) -> Self {
        Self { entries: entries.into_iter(), time: Duration::ZERO, played: 0, strayed_at: None }
    }

    /// The entry, from 0, at which the tuner asked for something else than it did when the record was made: then the record comes from
    /// another version of the program, or was changed. That of its end where the record was too short.
    #[must_use]
    pub fn strayed_at(&self) -> Option<usize> {
        self.strayed_at
    }

    fn next(&mut self) -> Option<Entry<L>> {
        let entry = self.entries.next();
        self.played += usize::from(entry.is_some());
        entry
    }

    /// The entry that was played last does not fit, or there is none.
    fn note_stray(&mut self) {
        self.strayed_at.get_or_insert(self.played.saturating_sub(1));
    }

    fn stray<T>(&mut self) -> Result<T, AxisError> {
        self.note_stray();
        self.entries = Vec::new().into_iter();
        Err(AxisError::LinkLost("the record does not go on this way".into()))
    }
}

impl<L: Law> Axis for Player<L> {
    fn now(&mut self) -> Duration {
        if let Some(Entry::Now(now)) = self.next() {
            self.time = now;
        } else {
            self.note_stray();
        }
        self.time
    }

    fn wait_until(&mut self, _time: Duration) -> Result<(), AxisError> {
        match self.next() {
            Some(Entry::Waited(answer)) => answer,
            _ => self.stray(),
        }
    }

    fn sample(&mut self, _want: Want) -> Result<Sample, AxisError> {
        match self.next() {
            Some(Entry::Sampled(answer)) => answer,
            _ => self.stray(),
        }
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        match self.next() {
            Some(Entry::Duty(was, answer)) if was == duty_raw => answer,
            _ => self.stray(),
        }
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        match self.next() {
            Some(Entry::Speed(was, answer)) if was == counts_per_s => answer,
            _ => self.stray(),
        }
    }

    fn command_position(&mut self, counts: i32, speed: u32) -> Result<Exchange, AxisError> {
        match self.next() {
            Some(Entry::Position(was, fast, answer)) if was == counts && fast == speed => answer,
            _ => self.stray(),
        }
    }

    fn write_winding(&mut self, raw: [u32; 2]) -> Result<(), AxisError> {
        match self.next() {
            Some(Entry::Winding(was, answer)) if was == raw => answer,
            _ => self.stray(),
        }
    }

    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError> {
        match self.next() {
            Some(Entry::CurrentLimits(max, min, answer)) if max == max_raw && min == min_raw => answer,
            _ => self.stray(),
        }
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        match self.next() {
            Some(Entry::RawSpeed(answer)) => answer,
            _ => self.stray(),
        }
    }

    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError> {
        match self.next() {
            Some(Entry::Timeout(was, answer)) if was == milliseconds => answer,
            _ => self.stray(),
        }
    }

    fn start_own_test(
        &mut self,
        tested: TestedLoop,
        height_raw: u32,
        hysteresis: u32,
    ) -> Result<(Exchange, u32), AxisError> {
        match self.next() {
            Some(Entry::OwnTestStarted(of, was, answer))
                if of == tested && was == [height_raw, hysteresis] =>
            {
                answer
            }
            _ => self.stray(),
        }
    }

    fn read_own_test(&mut self) -> Result<[u32; 2], AxisError> {
        match self.next() {
            Some(Entry::OwnTest(answer)) => answer,
            _ => self.stray(),
        }
    }

    fn set_travel(&mut self, counts: (i64, i64)) -> Result<(), AxisError> {
        match self.entries.next() {
            Some(Entry::Travel(was, answer)) if was == counts => answer,
            _ => self.stray(),
        }
    }

    fn stolen(&mut self) -> Duration {
        let Some(Entry::Stolen(stolen)) = self.entries.as_slice().first() else { return Duration::ZERO };
        let stolen = *stolen;
        self.next();
        stolen
    }
}

impl<L: Law> LoopAxis<L> for Player<L> {
    fn read_setup(&mut self) -> Result<Setup<L>, AxisError> {
        match self.next() {
            Some(Entry::Setup(answer)) => answer,
            _ => self.stray(),
        }
    }

    fn write(&mut self, write: L::Write) -> Result<(), AxisError> {
        match self.next() {
            Some(Entry::Registers(note)) => match L::noted(&note) {
                (was, answer) if was == write => answer,
                _ => self.stray(),
            },
            _ => self.stray(),
        }
    }
}
