//! The Motion Mind 3: its loop as a law of the model, its registers, and what a run must know of it.
//!
//! Every 5 ms `PWM = (PTERM e + ITERM sum(e) + DTERM diff(e)) / 2^PIDSCALAR + speed x VELOCITYFF / 255`, 1023 = full duty (Motion Mind
//! manual 3.13 to 3.15). `e` is always an error of the position. Under a speed command the wanted position runs ahead by the speed in
//! each loop, so that DTERM acts on the error of the speed and PTERM on its sum: a velocity PI under other names. ITERM has no part
//! in what is designed, being an integral of the integral. There is one set of registers for both kinds of moves, and no cascade.
//!
//! NEWVELMODE (a loop on speeds alone, its output added up) is not used: each loop drops what is less than one step of the
//! duty, and adding up makes that a dead band of the speed.

mod limiter;
mod position_law;
mod registers;
mod scale;
mod tick;

pub(crate) use limiter::{Limiter, LimiterState};
pub(crate) use position_law::SUM_BOUNDS_S;
pub use position_law::{FULL_FEED_FORWARD, FULL_PWM, LOOPS_PER_S, MotionMindLaw, SPEED_STEP_COUNTS_PER_S};
pub use registers::{MotionMindRegisters, MotionMindSetup, bits};
pub(crate) use scale::rounded;
pub(crate) use tick::PositionLoop;

use crate::model::LoopLaw;

/// The law of the family, without feed-forward as long as the motor is not known.
#[must_use]
pub fn law() -> LoopLaw {
    let motion_mind = Some(MotionMindLaw::default());
    LoopLaw { rate_hz: LOOPS_PER_S, per_tick: true, position_scale: 1.0, feed_forward: true, motion_mind }
}
