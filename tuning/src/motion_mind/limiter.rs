//! The current limit of the Motion Mind: not a bound of the current, but a bound of the duty that follows it.
//!
//! "If the AMPS register exceeds the AMPSLIMIT value the PWMLIMIT is internally reduced based the difference between the two current
//! registers" (Motion Mind manual 3.10). Assumed: in each loop the bound moves by the difference, down and up again.

use super::position_law::{FULL_PWM, LOOPS_PER_S};

/// The limiter of a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limiter {
    /// AMPSLIMIT over the stall current at full duty.
    pub limit: f64,
    /// Duty that the bound moves by in a loop for each stall current that is missing or too much.
    pub gain: f64,
}

/// Where its bound is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LimiterState {
    /// Highest duty.
    pub bound: f64,
    /// Sum of currents over the stall current, times s, and of time in this loop, s.
    drawn: (f64, f64),
}

impl Default for LimiterState {
    fn default() -> Self {
        Self { bound: 1.0, drawn: (0.0, 0.0) }
    }
}

impl Limiter {
    /// Of AMPSLIMIT in its own steps; `limit` is the same over the stall current at full duty. `None` where there is none.
    pub(crate) fn new(amps_limit: u16, limit: Option<f64>) -> Option<Self> {
        let limit = limit.filter(|limit| amps_limit > 0 && *limit > 0.0)?;
        Some(Self { limit, gain: f64::from(amps_limit) / limit / FULL_PWM })
    }

    /// The longest step in which the bound need not be looked at, s.
    pub(crate) fn step_s() -> f64 {
        0.5 / f64::from(LOOPS_PER_S)
    }

    /// The duty that is left of one.
    pub(crate) fn left(state: &LimiterState, duty: f64) -> f64 {
        duty.clamp(-state.bound, state.bound)
    }

    /// A current over the stall current flowed for so long, s.
    pub(crate) fn see(&self, state: &mut LimiterState, current: f64, seconds: f64) {
        state.drawn.0 += current.abs() * seconds;
        state.drawn.1 += seconds;
        if state.drawn.1 >= 0.999 / f64::from(LOOPS_PER_S) {
            let mean = state.drawn.0 / state.drawn.1;
            state.bound = (state.bound + self.gain * (self.limit - mean)).clamp(0.0, 1.0);
            state.drawn = (0.0, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standing_motor_comes_to_its_limit_and_a_free_one_gets_its_duty_back() {
        // 6 A at a standstill, 3 A allowed.
        let limiter = Limiter::new(150, Some(0.5)).unwrap();
        let mut state = LimiterState::default();
        for _ in 0..100 {
            let duty = Limiter::left(&state, 1.0);
            limiter.see(&mut state, duty, Limiter::step_s());
        }
        assert!((state.bound - 0.5).abs() < 1e-3, "{state:?}");
        for _ in 0..100 {
            limiter.see(&mut state, 0.1, Limiter::step_s());
        }
        assert_eq!(state.bound, 1.0);
        assert_eq!(Limiter::new(0, Some(0.5)), None);
    }
}
