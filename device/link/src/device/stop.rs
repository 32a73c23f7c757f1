//! What became of a stop.

use crate::failure::Failure;
use std::time::Duration;

/// The bytes of a stop, to be written without waiting for anything.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StopBytes {
    /// What may be written at one go; the first of them matters most.
    pub frames: Vec<Vec<u8>>,
    /// Silence between two of them, where the family's controllers need one.
    pub gap: Duration,
}

impl StopBytes {
    /// Bytes that may all be written at one go.
    #[must_use]
    pub fn at_once(bytes: Vec<u8>) -> Self {
        Self { frames: vec![bytes], gap: Duration::ZERO }
    }

    /// These, then those.
    #[must_use]
    pub fn then(mut self, later: Self) -> Self {
        self.gap = self.gap.max(later.gap);
        self.frames.extend(later.frames);
        if self.gap.is_zero() {
            self.frames = vec![self.frames.concat()];
        }
        self
    }

    /// All the bytes, without the silence.
    #[must_use]
    pub fn concat(&self) -> Vec<u8> {
        self.frames.concat()
    }

    /// Whether there is nothing to write.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames.iter().all(Vec::is_empty)
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
    pub still_driven_by: Vec<String>,
    /// What went wrong.
    pub failures: Vec<Failure>,
}

impl StopReport {
    /// Time from the request to the bytes on the wire.
    #[must_use]
    pub fn latency(&self) -> Duration {
        self.written_at.saturating_sub(self.requested_at)
    }

    /// Whether every unit confirmed.
    #[must_use]
    pub fn confirmed(&self) -> bool {
        self.units.iter().all(|unit| unit.confirmed)
    }
}
