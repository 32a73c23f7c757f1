//! What became of a stop.

use crate::failure::Failure;
use brushwork_values::Message;
use std::time::Duration;

/// The bytes of a stop, to be written without waiting for anything.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StopBytes {
    /// The frames that take the drive off the motors, one or more for each unit.
    pub first: Vec<Vec<u8>>,
    /// What sees to it that nothing brings the drive back. A unit may fall silent at one that its neighbour alone knows, so
    /// these go out after the first frames of all units.
    pub after: Vec<Vec<u8>>,
    /// Silence between two frames, where the family's controllers need one; without it all are written at one go.
    pub gap: Duration,
}

impl StopBytes {
    /// Frames that take the drive off and need nothing after them.
    #[must_use]
    pub fn at_once(first: Vec<Vec<u8>>) -> Self {
        Self { first, ..Self::default() }
    }

    /// These and those of others.
    #[must_use]
    pub fn with(mut self, others: Self) -> Self {
        self.first.extend(others.first);
        self.after.extend(others.after);
        Self { gap: self.gap.max(others.gap), ..self }
    }

    /// What is written at one go each, in order.
    #[must_use]
    pub fn writes(&self) -> Vec<Vec<u8>> {
        if self.gap.is_zero() && !self.is_empty() {
            vec![self.concat()]
        } else {
            self.frames().cloned().collect()
        }
    }

    /// All the bytes in order, without the silence.
    #[must_use]
    pub fn concat(&self) -> Vec<u8> {
        self.frames().flatten().copied().collect()
    }

    /// Whether there is nothing to write.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames().all(Vec::is_empty)
    }

    fn frames(&self) -> impl Iterator<Item = &Vec<u8>> {
        self.first.iter().chain(&self.after)
    }
}

/// A stop, from the key to the controllers' answers.
#[derive(Clone, Debug, PartialEq)]
pub struct StopReport {
    /// When it was asked for.
    pub requested_at: Duration,
    /// When its bytes had been handed to the port, before any answer was waited for.
    pub written_at: Duration,
    /// When the last controller had answered or had been given up.
    pub ended_at: Duration,
    /// One for each unit of the link.
    pub units: Vec<UnitStop>,
    /// Whether another program has asked for it.
    pub from_outside: bool,
}

/// What one unit made of it.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitStop {
    /// Its address.
    pub address: u8,
    /// Whether it confirmed duty 0 on its motors.
    pub confirmed: bool,
    /// Whether it confirmed the end of its script; `None` where that was not asked.
    pub script_ended: Option<bool>,
    /// Whether its motion buffers are empty by its own account; `None` if it does not tell.
    pub buffers_empty: Option<bool>,
    /// What can still drive a motor now: input pins and scripts, each as a sentence.
    pub still_driven_by: Vec<Message>,
    /// Whether its loop was left without output, since it did not hold the motor still: the motor is not held.
    pub loop_left_off: bool,
    /// What went wrong.
    pub failures: Vec<Failure>,
}

impl UnitStop {
    /// A stop of which nothing is known yet.
    #[must_use]
    pub const fn new(address: u8) -> Self {
        Self {
            address,
            confirmed: false,
            script_ended: None,
            buffers_empty: None,
            still_driven_by: Vec::new(),
            loop_left_off: false,
            failures: Vec::new(),
        }
    }
}

impl StopReport {
    /// Time from the request to the bytes on the wire.
    #[must_use]
    pub fn latency(&self) -> Duration {
        self.written_at.saturating_sub(self.requested_at)
    }

    /// Whether a loop was left without output.
    #[must_use]
    pub fn left_a_loop_off(&self) -> bool {
        self.units.iter().any(|unit| unit.loop_left_off)
    }

    /// Whether every unit confirmed.
    #[must_use]
    pub fn confirmed(&self) -> bool {
        self.units.iter().all(|unit| unit.confirmed)
    }
}
