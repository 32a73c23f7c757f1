//! What the controller sees of a position: quadrature counts, or an absolute reading of 0 to 4095.

use super::noise::Noise;
use super::params::{EncoderKind, EncoderParams};

/// Highest reading of an absolute encoder (MCP manual 2.4.9, command 16).
pub const ABSOLUTE_MAX_COUNTS: i64 = 4095;
/// Voltage that reads as [`ABSOLUTE_MAX_COUNTS`] (MCP manual 2.4.9, command 16).
pub const ABSOLUTE_FULL_SCALE_VOLTS: f64 = 5.1;

/// One reading of an encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EncoderReading {
    /// What kind of encoder gave it.
    pub kind: EncoderKind,
    /// Quadrature: counts since power up of the plant, without bound. Absolute: 0 to 4095.
    pub counts: i64,
    /// False where there is no signal at all: a lost pulse encoder. A lost quadrature encoder just stops counting and a lost
    /// analog one reads 0 (assumed: the pin is pulled down), so neither can be told from a still shaft by one reading.
    pub present: bool,
}

impl EncoderReading {
    /// The voltage an analog encoder puts on its pin for this reading.
    pub fn volts(&self) -> f64 {
        self.counts.clamp(0, ABSOLUTE_MAX_COUNTS) as f64 / ABSOLUTE_MAX_COUNTS as f64
            * ABSOLUTE_FULL_SCALE_VOLTS
    }
}

/// The encoder of one axis, with its faults.
#[derive(Clone, Debug)]
pub struct Encoder {
    params: EncoderParams,
    noise: Noise,
    pub faults: EncoderFaults,
    /// Counts given out, which differ from the ideal ones by what reversing and losing the signal did.
    counted: i64,
    ideal: i64,
}

/// What is wrong with an encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderFaults {
    pub reversed: bool,
    pub lost: bool,
    pub noise_counts: f64,
}

impl Encoder {
    pub fn new(params: EncoderParams, seed: u64, stream: u64) -> Self {
        let start = quadrature_counts(&params, 0.0);
        Self {
            params,
            noise: Noise::new(seed, stream),
            faults: EncoderFaults::default(),
            counted: start,
            ideal: start,
        }
    }

    /// Changes the faults from this position on.
    pub fn set_faults(&mut self, faults: EncoderFaults, turns: f64) {
        self.count(turns);
        self.faults = faults;
    }

    /// Reads the encoder with its shaft at `turns` from the start.
    pub fn read(&mut self, turns: f64) -> EncoderReading {
        let deviation = self.faults.noise_counts.hypot(self.params.noise_counts);
        let noise = if deviation > 0.0 { self.noise.normal() * deviation } else { 0.0 };
        self.read_with(turns, noise)
    }

    /// The same without noise.
    pub fn read_quietly(&mut self, turns: f64) -> EncoderReading {
        self.read_with(turns, 0.0)
    }

    fn read_with(&mut self, turns: f64, noise: f64) -> EncoderReading {
        let kind = self.params.kind;
        let lost = self.faults.lost;
        match kind {
            EncoderKind::Quadrature => {
                self.count(turns);
                let jitter = if lost { 0 } else { noise.round() as i64 };
                EncoderReading { kind, counts: self.counted + jitter, present: true }
            }
            EncoderKind::Analog | EncoderKind::Pulse if lost => {
                EncoderReading { kind, counts: 0, present: kind == EncoderKind::Analog }
            }
            EncoderKind::Analog | EncoderKind::Pulse => {
                EncoderReading { kind, counts: self.absolute(turns, noise), present: true }
            }
        }
    }

    fn count(&mut self, turns: f64) {
        let ideal = quadrature_counts(&self.params, turns);
        let moved = ideal - self.ideal;
        self.ideal = ideal;
        if !self.faults.lost {
            self.counted += if self.faults.reversed { -moved } else { moved };
        }
    }

    fn absolute(&self, turns: f64, noise: f64) -> i64 {
        let full = (ABSOLUTE_MAX_COUNTS + 1) as f64;
        let counts = self.params.start_counts + turns * self.params.counts_per_turn + noise;
        let seen = if self.params.wraps { counts.rem_euclid(full) } else { counts };
        let seen = (seen.floor() as i64).clamp(0, ABSOLUTE_MAX_COUNTS);
        if self.faults.reversed { ABSOLUTE_MAX_COUNTS - seen } else { seen }
    }
}

/// The edges passed; the start stands midway between two of them, so that a shaft at rest there does not flicker.
fn quadrature_counts(params: &EncoderParams, turns: f64) -> i64 {
    (params.start_counts + turns * params.counts_per_turn + 0.5).floor() as i64
}
