//! A current limit that is not a bound of the current, but a bound of the duty that follows it: in each loop the bound moves by the
//! difference, down and up again.

/// How a controller limits the duty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DutyLimit {
    /// The highest current, in steps of the controller's; 0 = not limited.
    pub current_steps: f64,
    /// Steps of a full duty. The bound moves by one for each step that the current is beside its limit.
    pub full_duty_steps: f64,
    /// Loops in a second.
    pub loops_per_s: f64,
}

/// The limiter of a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limiter {
    /// Highest current over the stall current at full duty.
    pub limit: f64,
    /// Duty that the bound moves by in a loop for each stall current that is missing or too much.
    pub gain: f64,
    /// Loops in a second.
    loops_per_s: f64,
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
    /// `limit` is the highest current over the stall current at full duty. `None` where there is none.
    pub(crate) fn new(duty: DutyLimit, limit: Option<f64>) -> Option<Self> {
        let limit = limit.filter(|limit| duty.current_steps > 0.0 && *limit > 0.0)?;
        let gain = duty.current_steps / limit / duty.full_duty_steps;
        Some(Self { limit, gain, loops_per_s: duty.loops_per_s })
    }

    /// The longest step in which the bound need not be looked at, s.
    pub(crate) fn step_s(&self) -> f64 {
        0.5 / self.loops_per_s
    }

    /// The duty that is left of one.
    pub(crate) fn left(state: &LimiterState, duty: f64) -> f64 {
        duty.clamp(-state.bound, state.bound)
    }

    /// A current over the stall current flowed for so long, s.
    pub(crate) fn see(&self, state: &mut LimiterState, current: f64, seconds: f64) {
        state.drawn.0 += current.abs() * seconds;
        state.drawn.1 += seconds;
        if state.drawn.1 >= 0.999 / self.loops_per_s {
            let mean = state.drawn.0 / state.drawn.1;
            state.bound = (state.bound + self.gain * (self.limit - mean)).clamp(0.0, 1.0);
            state.drawn = (0.0, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(current_steps: f64) -> DutyLimit {
        DutyLimit { current_steps, full_duty_steps: 1023.0, loops_per_s: 200.0 }
    }

    #[test]
    fn a_standing_motor_comes_to_its_limit_and_a_free_one_gets_its_duty_back() {
        // 6 A at a standstill, 3 A allowed.
        let limiter = Limiter::new(of(150.0), Some(0.5)).unwrap();
        let mut state = LimiterState::default();
        for _ in 0..100 {
            let duty = Limiter::left(&state, 1.0);
            limiter.see(&mut state, duty, limiter.step_s());
        }
        assert!((state.bound - 0.5).abs() < 1e-3, "{state:?}");
        for _ in 0..100 {
            limiter.see(&mut state, 0.1, limiter.step_s());
        }
        assert_eq!(state.bound, 1.0);
        assert_eq!(Limiter::new(of(0.0), Some(0.5)), None);
    }
}
