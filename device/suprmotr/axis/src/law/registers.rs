//! Gains as registers of a SuprMotr, and back.

use super::rate::SuprMotrLaw;
use brushwork_tuning::axis::AxisError;
use brushwork_tuning::joined::{LawPart, Part};
use brushwork_tuning::model::{Gains, Pid};
use serde::{Deserialize, Serialize};

/// P times the error reaches the full drive here. Assumed, as in the LM629 of the maker's sister boards.
pub const FULL_DRIVE: f64 = 32_768.0;
/// The sum of errors counts as so much less. Assumed, as in the LM629.
pub const INTEGRAL_DIVISOR: f64 = 256.0;
/// Steps of the drive each way, in which DL limits the integral term. Assumed.
pub const DRIVE_STEPS: f64 = 255.0;
/// The largest gain (SuprMotr manual, Define P-Term).
pub const MOST_GAIN: f64 = 255.0;

/// The gains that a run writes and puts back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SuprMotrRegisters {
    /// DP.
    pub p: u8,
    /// DI.
    pub i: u8,
    /// DD.
    pub d: u8,
    /// DL.
    pub integral_limit: u8,
}

/// How quick moves are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MovePace {
    /// DV, counts/s.
    pub velocity: i32,
    /// DA, counts/s^2.
    pub acceleration: i32,
}

/// What a SuprMotr holds before a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SuprMotrSetup {
    /// What is put back.
    pub registers: SuprMotrRegisters,
    /// What is put back of moves.
    pub pace: MovePace,
}

/// Something of this family beside the same of others: what a unit holds, what is proposed, its law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SuprMotrPart<T> {
    /// It, where the controller is a SuprMotr.
    #[serde(default = "none")]
    pub suprmotr: Option<T>,
}

impl<T> Part for SuprMotrPart<T> {
    fn is_there(&self) -> bool {
        self.suprmotr.is_some()
    }
}

impl LawPart for SuprMotrPart<SuprMotrLaw> {
    type Law = SuprMotrLaw;

    fn law(&self) -> Option<SuprMotrLaw> {
        self.suprmotr
    }

    fn of(law: SuprMotrLaw) -> Self {
        Self { suprmotr: Some(law) }
    }
}

fn none<T>() -> Option<T> {
    None
}

/// What a unit holds before a run.
pub type SuprMotrHeld = SuprMotrPart<SuprMotrSetup>;
/// What is proposed; none in a refusal.
pub type SuprMotrProposal = SuprMotrPart<SuprMotrRegisters>;

/// What goes over in one write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SuprMotrWrite {
    /// The gains of a loop that holds the motor.
    Loop(SuprMotrRegisters),
    /// The end of a run: these gains, this pace, and whether the motor is let go.
    End(SuprMotrSetup, bool),
}

/// The same with its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SuprMotrNote {
    /// Gains written.
    SuprMotr(SuprMotrRegisters, Result<(), AxisError>),
    /// The run ended with these.
    SuprMotrEnd(SuprMotrSetup, bool, Result<(), AxisError>),
}

impl SuprMotrRegisters {
    /// Gains as the board can hold them.
    #[must_use]
    pub fn of(gains: &Gains, qpps: f64, tick_s: f64) -> Self {
        let pid = gains.position.unwrap_or_default();
        let unit = FULL_DRIVE / qpps;
        // The casts saturate.
        let whole = |gain: f64| gain.round().clamp(0.0, MOST_GAIN) as u8;
        let i = whole(pid.i * unit * tick_s * INTEGRAL_DIVISOR);
        let share = pid.i * gains.max_integral / qpps;
        Self {
            p: whole(pid.p * unit).max(u8::from(pid.p > 0.0)),
            i,
            d: whole(pid.d * unit / tick_s),
            integral_limit: if i == 0 { 0 } else { (share * DRIVE_STEPS).ceil().clamp(1.0, MOST_GAIN) as u8 },
        }
    }

    /// The gains that they stand for.
    #[must_use]
    pub fn gains(&self, qpps: f64, tick_s: f64) -> Gains {
        let unit = qpps / FULL_DRIVE;
        let is_summed = self.i > 0 && self.integral_limit > 0;
        let i = if is_summed { f64::from(self.i) * unit / tick_s / INTEGRAL_DIVISOR } else { 0.0 };
        let pid = Pid { p: f64::from(self.p) * unit, i, d: f64::from(self.d) * unit * tick_s };
        let bound = f64::from(self.integral_limit) / DRIVE_STEPS * qpps;
        let max_integral = if is_summed { bound / i } else { 0.0 };
        Gains { position: Some(pid), max_integral, ..Gains::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 75 x 100 counts of 32,768 are 22.9 % of the drive; D 40 of a change of 50 counts a tick 6.1 %; I 10 of 100 counts over 256 ticks as much as P 10.
    #[test]
    fn the_gains_are_those_of_the_boards_formula_at_its_tick() {
        let registers = SuprMotrRegisters { p: 75, i: 10, d: 40, integral_limit: 51 };
        let gains = registers.gains(1.0, 0.001);
        let pid = gains.position.expect("a loop on the position");
        assert!((pid.p * 100.0 - 7_500.0 / 32_768.0).abs() < 1e-12);
        assert!((pid.d * 50.0 / 0.001 - 2_000.0 / 32_768.0).abs() < 1e-12);
        assert!((pid.i * 0.256 * 100.0 - 1_000.0 / 32_768.0).abs() < 1e-12);
        assert!((pid.i * gains.max_integral - 0.2).abs() < 1e-12, "DL 51 is a fifth of the drive");
    }

    #[test]
    fn every_set_of_registers_comes_back_from_its_gains() {
        for (p, i, d, integral_limit) in [(1, 0, 0, 0), (75, 1, 255, 1), (255, 255, 7, 255), (13, 2, 90, 38)]
        {
            let registers = SuprMotrRegisters { p, i, d, integral_limit };
            for (qpps, tick_s) in [(1.0, 0.001), (98_000.0, 0.000_341), (431.0, 0.004)] {
                let gains = registers.gains(qpps, tick_s);
                let again = SuprMotrRegisters::of(&gains, qpps, tick_s);
                assert_eq!((again.p, again.i, again.d), (p, i, d));
                assert!(again.integral_limit.abs_diff(integral_limit) <= 1, "{again:?}");
            }
        }
    }

    #[test]
    fn what_is_more_than_a_byte_is_held_and_a_gain_never_vanishes() {
        let of = |p: f64| {
            let position = Some(Pid { p, i: 0.0, d: 1.0 });
            SuprMotrRegisters::of(&Gains { position, ..Gains::default() }, 1.0, 0.001)
        };
        assert_eq!((of(1.0).p, of(1.0).d, of(1e-9).p), (255, 255, 1));
    }
}
