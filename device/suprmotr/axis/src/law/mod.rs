//! The law of the SuprMotr V9 for the tuner: its loop, its registers, and what a run must know of it.
//!
//! In every turn `drive = DP e + DI sum(e) / 256 + DD diff(e)`, 32,768 = all of it (assumed, as in the LM629 of the maker's sister boards), `e` the
//! distance from the trajectory of DV and DA. Each gain is a byte. How often in a second it turns no manual says: a run finds that out of moves with
//! DD, which is a time in turns.

mod profile;
mod rate;
mod registers;
mod table;

pub use rate::SuprMotrLaw;
pub use registers::{
    DRIVE_STEPS, MovePace, SuprMotrHeld, SuprMotrNote, SuprMotrPart, SuprMotrProposal, SuprMotrRegisters,
    SuprMotrSetup, SuprMotrWrite,
};

use brushwork_suprmotr_wire::{Mnemonic, motion};
use brushwork_tuning::axis::AxisError;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::law::{Ending, Facts, Law, Seen};
use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::model::{Gains, Lag};
use brushwork_tuning::setpoint::Setpoint;
use profile::Profile;

/// Turns in a second that the loop may have: from a slow one to that of an LM629 (341 us) and beyond.
const RATES_HZ: [u32; 9] = [250, 354, 500, 707, 1_000, 1_414, 2_000, 2_828, 4_000];

/// Longest move, counts, at the pace of a run, which leaves the whole move to lag behind: less than the following error (SM) that boards leave
/// the factory with. Nothing tells SM.
const LONGEST_MOVE_COUNTS: f64 = 6_000.0;

/// One loop on the position. Assumed: what it computes it gives in the same turn; half a turn for the winding.
static FACTS: Facts = Facts {
    has_duty: false,
    has_cascade: false,
    can_be_probed: false,
    writes_at_rest: true,
    keeps_travel: false,
    longest_move_counts: LONGEST_MOVE_COUNTS,
    speed_step: 1.0,
    usual_lag: Lag { filter_s: 0.0, delay_ticks: 0.5 },
    longest_lag: Lag { filter_s: 0.0, delay_ticks: 1.5 },
    filters_s: &[0.0],
    delays_ticks: &[0.0, 0.5, 1.0, 1.5, 2.0, 3.0],
    rates_hz: &RATES_HZ,
    unmodelled_s: 0.0005,
    integral_times: (30.0, 0.65),
};

/// The state of the loop.
#[derive(Clone, Copy, Debug, Default)]
pub struct SuprMotrLoop {
    /// Where it is to go; `None` before the first command.
    goal: Option<f64>,
    from: f64,
    /// How it goes there, and the highest speed that this was worked out for, counts/s.
    profile: Profile,
    speed: f64,
    elapsed_s: f64,
    /// Counts x s.
    sum: f64,
    last_error: Option<f64>,
}

/// The highest of DV and DA (SuprMotr manual, Define Velocity and Define Acceleration).
#[must_use]
pub fn quickest() -> MovePace {
    let most = |mnemonic: Mnemonic| mnemonic.row().takes.map_or(0, |takes| takes.high);
    MovePace { velocity: most(Mnemonic::DV), acceleration: most(Mnemonic::DA) }
}

impl SuprMotrLoop {
    /// Where the trajectory is, a turn on.
    fn target(&mut self, setpoint: Setpoint, count: f64, tick_s: f64) -> f64 {
        let (goal, speed) = match setpoint {
            Setpoint::Position(goal, speed) => (goal, speed),
            Setpoint::Speed(_) => (self.goal.unwrap_or(count), 0.0),
        };
        let is_other = self.goal != Some(goal);
        if is_other {
            self.from = self.goal.unwrap_or(count);
            (self.goal, self.elapsed_s) = (Some(goal), 0.0);
        }
        if is_other || speed != self.speed {
            let MovePace { velocity, acceleration } = quickest();
            let velocity = speed.min(f64::from(velocity));
            self.speed = speed;
            self.profile = Profile::new(goal - self.from, velocity, f64::from(acceleration));
        }
        self.elapsed_s += tick_s;
        self.from + self.profile.at(self.elapsed_s)
    }
}

impl Law for SuprMotrLaw {
    type Held = SuprMotrHeld;
    type Registers = SuprMotrProposal;
    type Write = SuprMotrWrite;
    type Note = SuprMotrNote;
    type Findings = ();
    type Loop = SuprMotrLoop;

    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    fn at_rate(&self, rate_hz: u32) -> Self {
        Self { rate_hz }
    }

    fn feed_forward(&self) -> f64 {
        1.0
    }

    fn tick(
        &self,
        state: &mut SuprMotrLoop,
        (gains, qpps): (&Gains, f64),
        setpoint: Setpoint,
        seen: &Seen<'_>,
    ) -> f64 {
        let (tick_s, pid) = (self.tick_s(), gains.position.unwrap_or_default());
        let target = state.target(setpoint, seen.count, tick_s);
        let target = if seen.is_smooth { target } else { target.round() };
        let error = target - seen.count;
        let change = state.last_error.map_or(0.0, |last| error - last);
        state.last_error = Some(error);
        state.sum = (state.sum + error * tick_s).clamp(-gains.max_integral, gains.max_integral);
        let duty = (pid.p * error + pid.i * state.sum + pid.d * change / tick_s) / qpps;
        let steps = if seen.is_smooth { duty * DRIVE_STEPS } else { (duty * DRIVE_STEPS).trunc() };
        (steps / DRIVE_STEPS).clamp(-1.0, 1.0)
    }

    fn steady(&self, _: (&Gains, f64), _: f64, _: f64) -> SuprMotrLoop {
        SuprMotrLoop::default()
    }

    fn rounded(&self, gains: &Gains, qpps: f64) -> Gains {
        SuprMotrRegisters::of(gains, qpps, self.tick_s()).gains(qpps, self.tick_s())
    }

    /// One step more or less of each gain, and of P and D together.
    fn steps_around(&self, gains: &Gains, qpps: f64) -> Vec<Gains> {
        let here = SuprMotrRegisters::of(gains, qpps, self.tick_s());
        let stepped = |gain: u8, by: i16| u8::try_from(i16::from(gain) + by).ok();
        let mut around = Vec::new();
        for by_p in [-1, 0, 1] {
            for by_d in [-8, -1, 0, 1, 8] {
                for by_i in [-1, 0, 1] {
                    let found = stepped(here.p, by_p).filter(|p| *p > 0).zip(stepped(here.d, by_d));
                    let Some(((p, d), i)) = found.zip(stepped(here.i, by_i)) else { continue };
                    let integral_limit = if i == 0 { 0 } else { here.integral_limit.max(1) };
                    around.push(SuprMotrRegisters { p, i, d, integral_limit }.gains(qpps, self.tick_s()));
                }
            }
        }
        around
    }

    fn registers(
        &self,
        _: &SuprMotrHeld,
        gains: &Gains,
        qpps: f64,
        _: Option<(i64, i64)>,
    ) -> SuprMotrProposal {
        SuprMotrProposal { suprmotr: Some(SuprMotrRegisters::of(gains, qpps, self.tick_s())) }
    }

    fn gains(&self, registers: &SuprMotrProposal, qpps: f64, _: bool) -> Gains {
        registers.suprmotr.unwrap_or_default().gains(qpps, self.tick_s())
    }

    fn rows(&self, held: &SuprMotrHeld, proposed: &SuprMotrProposal) -> Vec<[String; 4]> {
        table::rows(held, proposed)
    }

    fn writes(registers: &SuprMotrProposal, _: bool) -> Vec<SuprMotrWrite> {
        registers.suprmotr.map(SuprMotrWrite::Loop).into_iter().collect()
    }

    fn before(held: &SuprMotrHeld) -> SuprMotrProposal {
        SuprMotrProposal { suprmotr: held.suprmotr.map(|unit| unit.registers) }
    }

    fn take(registers: &mut SuprMotrProposal, write: &SuprMotrWrite) {
        registers.suprmotr = Some(match write {
            SuprMotrWrite::Loop(written) => *written,
            SuprMotrWrite::End(setup, _) => setup.registers,
        });
    }

    fn note(write: SuprMotrWrite, answer: Result<(), AxisError>) -> SuprMotrNote {
        match write {
            SuprMotrWrite::Loop(registers) => SuprMotrNote::SuprMotr(registers, answer),
            SuprMotrWrite::End(setup, is_off) => SuprMotrNote::SuprMotrEnd(setup, is_off, answer),
        }
    }

    fn noted(note: &SuprMotrNote) -> (SuprMotrWrite, Result<(), AxisError>) {
        match note {
            SuprMotrNote::SuprMotr(registers, answer) => (SuprMotrWrite::Loop(*registers), answer.clone()),
            SuprMotrNote::SuprMotrEnd(setup, is_off, answer) => {
                (SuprMotrWrite::End(*setup, *is_off), answer.clone())
            }
        }
    }

    fn fault(_: &SuprMotrHeld, status_raw: u32) -> Cause {
        // The word is the status's byte of the motion.
        let has = |bit: u8| status_raw & u32::from(bit) != 0;
        if has(motion::EXCESSIVE_ERROR) {
            Cause::FollowingError
        } else if has(motion::MOTOR_OFF) {
            Cause::ControllerFault
        } else {
            Cause::LimitSwitch
        }
    }

    /// The loop holds the motor whatever a run did.
    fn goes_on(_: &SuprMotrHeld) -> bool {
        true
    }

    /// DV and DA are the run's own in every move, so that all is put back whatever it did.
    fn ending(held: &SuprMotrHeld, ending: Ending<'_, Self>) -> Vec<SuprMotrWrite> {
        let kept = ending.kept.and_then(|kept| kept.suprmotr);
        let end = |before: SuprMotrSetup| {
            let registers = kept.unwrap_or(before.registers);
            SuprMotrWrite::End(SuprMotrSetup { registers, ..before }, ending.stays_off)
        };
        held.suprmotr.map(end).into_iter().collect()
    }
}

impl LawProbe for SuprMotrLaw {}
