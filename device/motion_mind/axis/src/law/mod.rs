//! The law of the Motion Mind 3 for the tuner: its loop, its registers, and what a run must know of it.
//!
//! Every 5 ms `PWM = (PTERM e + ITERM sum(e) + DTERM diff(e)) / 2^PIDSCALAR + speed x VELOCITYFF / 255`, 1023 = full duty (Motion Mind
//! manual 3.13 to 3.15). `e` is always an error of the position. Under a speed command the wanted position runs ahead by the speed in
//! each loop, so that DTERM acts on the error of the speed and PTERM on its sum: a velocity PI under other names. ITERM has no part
//! in what is designed, being an integral of the integral. There is one set of registers for both kinds of moves, and no cascade.
//!
//! NEWVELMODE (a loop on speeds alone, its output added up) is not used: each loop drops what is less than one step of the
//! duty, and adding up makes that a dead band of the speed.

mod position_law;
mod registers;
mod scale;
mod table;
mod tick;

pub use position_law::{FULL_FEED_FORWARD, FULL_PWM, LOOPS_PER_S, MotionMindLaw, SPEED_STEP_COUNTS_PER_S};
pub use registers::{
    MotionMindHeld, MotionMindNote, MotionMindPart, MotionMindProposal, MotionMindRegisters, MotionMindSetup,
    MotionMindWrite, bits,
};
pub use tick::PositionLoop;

use brushwork_tuning::axis::AxisError;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::duty_limiter::DutyLimit;
use brushwork_tuning::law::{Ending, Facts, Law, Seen, Stamps};
use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::model::{Gains, Lag};
use brushwork_tuning::open_loop_record::{Actuation, OPEN_LOOP};
use brushwork_tuning::setpoint::Setpoint;
use position_law::SUM_BOUNDS_S;

/// Steps of 10 mA in one of AMPSLIMIT.
const AMPSLIMIT_STEP: u32 = 2;
/// From the stamp of a command to its effect, with the age of a reading, s: the next loop has the whole duty, and shows the position of
/// the last one.
const OFFSET_S: f64 = 0.0052;
/// Standard deviation of the stamps of readings that came without their time, s: the position is that of the last loop, and nobody knows
/// when that was.
const UNDATED_STAMP_S: f64 = 0.0018;

/// One loop on the position. It filters nothing; assumed: what it computes it gives in the same loop; half a tick for the winding. Ticks
/// of 5 ms are longer than those that other lags were found with, and a sum that has no fine bound has to grow slowly.
static FACTS: Facts = Facts {
    has_duty: true,
    has_cascade: false,
    can_be_probed: false,
    writes_at_rest: true,
    keeps_travel: true,
    longest_move_counts: f64::INFINITY,
    speed_step: SPEED_STEP_COUNTS_PER_S,
    usual_lag: Lag { filter_s: 0.0, delay_ticks: 0.5 },
    longest_lag: Lag { filter_s: 0.0, delay_ticks: 1.5 },
    filters_s: &[0.0],
    delays_ticks: &[0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0],
    rates_hz: &[],
    unmodelled_s: 0.0005,
    integral_times: (30.0, 0.65),
};

/// AMPSLIMIT of a current, 10 mA.
fn amps_limit(max_current_raw: u32) -> u16 {
    u16::try_from(max_current_raw / AMPSLIMIT_STEP).unwrap_or(u16::MAX)
}

fn duty_limit(amps_limit: u16) -> DutyLimit {
    let (current_steps, loops_per_s) = (f64::from(amps_limit), f64::from(LOOPS_PER_S));
    DutyLimit { current_steps, full_duty_steps: FULL_PWM, loops_per_s }
}

impl Law for MotionMindLaw {
    type Held = MotionMindHeld;
    type Registers = MotionMindProposal;
    type Write = MotionMindWrite;
    type Note = MotionMindNote;
    type Findings = ();
    type Loop = PositionLoop;

    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn rate_hz(&self) -> u32 {
        LOOPS_PER_S
    }

    fn feed_forward(&self) -> f64 {
        1.0
    }

    fn duty_limit(&self) -> Option<DutyLimit> {
        Some(duty_limit(self.amps_limit))
    }

    fn tick(
        &self,
        state: &mut PositionLoop,
        (gains, qpps): (&Gains, f64),
        setpoint: Setpoint,
        seen: &Seen<'_>,
    ) -> f64 {
        let duty = state.turn(*self, (gains, qpps, self.tick_s()), setpoint, seen.count, seen.is_smooth);
        state.note_bound(seen.most_duty);
        duty.clamp(-seen.most_duty, seen.most_duty)
    }

    fn steady(&self, (gains, qpps): (&Gains, f64), speed: f64, duty: f64) -> PositionLoop {
        PositionLoop::steady(*self, gains, qpps, self.tick_s(), speed, duty)
    }

    fn rounded(&self, gains: &Gains, qpps: f64) -> Gains {
        scale::rounded(gains, qpps)
    }

    fn sum_bounds(&self, _: f64) -> Vec<f64> {
        SUM_BOUNDS_S.to_vec()
    }

    fn registers(
        &self,
        held: &MotionMindHeld,
        gains: &Gains,
        qpps: f64,
        _: Option<(i64, i64)>,
    ) -> MotionMindProposal {
        let before = held.motion_mind.map(|unit| unit.registers);
        MotionMindProposal { motion_mind: before.map(|registers| registers.with(gains, qpps, *self)) }
    }

    fn gains(&self, registers: &MotionMindProposal, qpps: f64, is_position: bool) -> Gains {
        registers.motion_mind.unwrap_or_default().gains(qpps, is_position)
    }

    fn with_registers(&self, registers: &MotionMindProposal) -> Self {
        let velocity_ff = registers.motion_mind.map_or(self.velocity_ff, |registers| registers.velocity_ff);
        Self { velocity_ff, ..*self }
    }

    fn rows(&self, held: &MotionMindHeld, proposed: &MotionMindProposal) -> Vec<[String; 4]> {
        table::rows(held, proposed)
    }

    fn refuse(registers: &MotionMindProposal) -> Result<(), Cause> {
        let is_usual = registers.motion_mind.is_none_or(|registers| registers.is_usual_loop());
        if is_usual { Ok(()) } else { Err(Cause::OtherLoop) }
    }

    fn writes(registers: &MotionMindProposal, _: bool) -> Vec<MotionMindWrite> {
        registers.motion_mind.map(MotionMindWrite::Loop).into_iter().collect()
    }

    fn before(held: &MotionMindHeld) -> MotionMindProposal {
        MotionMindProposal { motion_mind: held.motion_mind.map(|unit| unit.registers) }
    }

    fn take(registers: &mut MotionMindProposal, write: &MotionMindWrite) {
        let (MotionMindWrite::Loop(written) | MotionMindWrite::End(written)) = write;
        registers.motion_mind = Some(*written);
    }

    fn step_duty(&self, registers: &MotionMindProposal) -> f64 {
        registers.motion_mind.map_or(0.0, |written| {
            let gain = f64::from(written.pterm) + f64::from(written.dterm);
            (gain / 2.0_f64.powi(i32::from(written.pidscalar)) / FULL_PWM).min(1.0)
        })
    }

    fn note(write: MotionMindWrite, answer: Result<(), AxisError>) -> MotionMindNote {
        match write {
            MotionMindWrite::Loop(registers) => MotionMindNote::MotionMind(registers, answer),
            MotionMindWrite::End(registers) => MotionMindNote::MotionMindEnd(registers, answer),
        }
    }

    fn noted(note: &MotionMindNote) -> (MotionMindWrite, Result<(), AxisError>) {
        match note {
            MotionMindNote::MotionMind(registers, answer) => {
                (MotionMindWrite::Loop(*registers), answer.clone())
            }
            MotionMindNote::MotionMindEnd(registers, answer) => {
                (MotionMindWrite::End(*registers), answer.clone())
            }
        }
    }

    fn of_unit(&self, _: &MotionMindHeld) -> Self {
        Self::default()
    }

    /// The manual says this law; what depends on the motor is the feed-forward.
    fn of_motor(&self, qpps: f64, max_current_raw: u32) -> Self {
        Self { amps_limit: amps_limit(max_current_raw), ..Self::of_qpps(qpps) }
    }

    fn ready(held: &MotionMindHeld) -> Result<(), Cause> {
        let can_be_tuned = held.motion_mind.is_none_or(|unit| unit.can_be_tuned());
        if can_be_tuned { Ok(()) } else { Err(Cause::WrongMode) }
    }

    fn fault(_: &MotionMindHeld, status_raw: u32) -> Cause {
        let is_held = status_raw & u32::from(bits::INPUTS) != 0;
        if is_held { Cause::LimitInput } else { Cause::ControllerFault }
    }

    fn actuation(held: &MotionMindHeld, max_current_raw: u32) -> Actuation {
        let is_undated = held.motion_mind.is_some_and(|unit| unit.is_undated);
        Actuation {
            slew_per_s: f64::INFINITY,
            offset_s: OFFSET_S,
            age_s: 0.0,
            duty_limit: Some(duty_limit(amps_limit(max_current_raw))),
            stamp_s: if is_undated { UNDATED_STAMP_S } else { OPEN_LOOP.stamp_s },
        }
    }

    fn stamps(held: &MotionMindHeld) -> Stamps {
        let is_undated = held.motion_mind.is_some_and(|unit| unit.is_undated);
        Stamps { open_s: if is_undated { UNDATED_STAMP_S } else { 0.0 }, are_dated: !is_undated }
    }

    fn goes_on(held: &MotionMindHeld) -> bool {
        held.motion_mind.is_some_and(|unit| !unit.registers.has(bits::DISABLEPID))
    }

    /// Open-loop duties use the gain registers too, so that they are put back whatever the run did.
    fn ending(held: &MotionMindHeld, ending: Ending<'_, Self>) -> Vec<MotionMindWrite> {
        let kept = ending.kept.and_then(|kept| kept.motion_mind);
        let last = kept.or(held.motion_mind.map(|unit| unit.registers));
        let off = if ending.stays_off { bits::DISABLEPID } else { 0 };
        let end = |last: MotionMindRegisters| {
            MotionMindWrite::End(MotionMindRegisters { function: last.function | off, ..last })
        };
        last.map(end).into_iter().collect()
    }
}

impl LawProbe for MotionMindLaw {}
