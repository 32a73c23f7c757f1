//! The plainest law: a cascade whose registers are the gains themselves. For examples and tests, and to begin a law of one's own with.

use crate::axis::AxisError;
use crate::cascade::{CASCADE, Cascade, Manner};
use crate::gains::Gains;
use crate::law::{Ending, Facts, Law, Seen, Windup};
use crate::law_probe::LawProbe;
use crate::setpoint::Setpoint;
use serde::{Deserialize, Serialize};

/// The law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlainLaw {
    /// Loop rate, Hz.
    pub rate_hz: u32,
    /// Whether the setpoint's share of QPPS is added to the duty.
    pub feed_forward: bool,
    /// What its integral does while the duty is cut.
    #[serde(default)]
    pub windup: Windup,
}

impl Default for PlainLaw {
    fn default() -> Self {
        Self { rate_hz: 300, feed_forward: true, windup: Windup::Open }
    }
}

/// Its registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlainRegisters {
    /// The gains.
    pub gains: Gains,
    /// Speed at full duty, counts/s; 0 without gains.
    pub qpps: f64,
}

impl Law for PlainLaw {
    type Held = PlainRegisters;
    type Registers = PlainRegisters;
    type Write = PlainRegisters;
    type Note = (PlainRegisters, Result<(), AxisError>);
    type Findings = ();
    type Loop = Cascade;

    fn facts(&self) -> &'static Facts {
        &CASCADE
    }

    fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    fn feed_forward(&self) -> f64 {
        f64::from(u8::from(self.feed_forward))
    }

    fn windup(&self) -> Windup {
        self.windup
    }

    fn with_windup(&self, windup: Windup) -> Option<Self> {
        Some(Self { windup, ..*self })
    }

    fn tick(&self, state: &mut Cascade, gains: (&Gains, f64), setpoint: Setpoint, seen: &Seen<'_>) -> f64 {
        state.tick(gains, Manner::of(self), setpoint, seen)
    }

    fn steady(&self, gains: (&Gains, f64), speed: f64, duty: f64) -> Cascade {
        Cascade::steady(gains, self.feed_forward(), speed, duty)
    }

    fn registers(
        &self,
        _: &PlainRegisters,
        gains: &Gains,
        qpps: f64,
        _: Option<(i64, i64)>,
    ) -> PlainRegisters {
        PlainRegisters { gains: *gains, qpps }
    }

    fn gains(&self, registers: &PlainRegisters, _: f64, _: bool) -> Gains {
        registers.gains
    }

    fn writes(registers: &PlainRegisters, _: bool) -> Vec<PlainRegisters> {
        vec![*registers]
    }

    fn before(held: &PlainRegisters) -> PlainRegisters {
        *held
    }

    fn take(registers: &mut PlainRegisters, write: &PlainRegisters) {
        *registers = *write;
    }

    fn note(write: PlainRegisters, answer: Result<(), AxisError>) -> Self::Note {
        (write, answer)
    }

    fn noted(note: &Self::Note) -> (PlainRegisters, Result<(), AxisError>) {
        note.clone()
    }

    fn keeping(registers: &PlainRegisters) -> Vec<PlainRegisters> {
        vec![*registers]
    }

    fn ending(held: &PlainRegisters, ending: Ending<'_, Self>) -> Vec<PlainRegisters> {
        if ending.is_touched && ending.kept.is_none() { vec![*held] } else { Vec::new() }
    }
}

impl LawProbe for PlainLaw {}
