//! One loop of the Motion Mind after the other, for predictions: what its registers make of the positions it sees.

use super::position_law::{FULL_FEED_FORWARD, FULL_PWM, MotionMindLaw, is_protected, on_position};
use brushwork_tuning::model::Gains;
use brushwork_tuning::setpoint::Setpoint;

/// The state of the loop.
#[derive(Clone, Copy, Debug, Default)]
pub struct PositionLoop {
    /// Where a speed command wants the motor to be; `None` before the first.
    ahead: Option<f64>,
    /// Where a position command sends it; `None` before the first.
    target: Option<f64>,
    /// Sum of errors, counts x s.
    sum: f64,
    last_error: f64,
    /// Duty of the last loop, in steps, and whether it came up to its bound.
    steps: f64,
    is_saturated: bool,
}

impl PositionLoop {
    /// The steady state of a speed, with the motor at position 0 and its next loop to come: `duty` is what the speed takes.
    pub(crate) fn steady(
        law: MotionMindLaw,
        gains: &Gains,
        qpps: f64,
        tick_s: f64,
        speed: f64,
        duty: f64,
    ) -> Self {
        let pid = on_position(gains);
        let left = (duty - forward(law, speed * tick_s) / FULL_PWM) * qpps;
        let sum =
            if pid.i > 0.0 { (left / pid.i).clamp(-gains.max_integral, gains.max_integral) } else { 0.0 };
        let error = if pid.p > 0.0 { (left - pid.i * sum) / pid.p } else { 0.0 };
        Self { ahead: Some(error - speed * tick_s), last_error: error, sum, ..Self::default() }
    }

    /// What the current leaves of the duty, 0 to 1.
    pub(crate) fn note_bound(&mut self, bound: f64) {
        self.is_saturated = self.steps.abs() >= bound * FULL_PWM;
    }

    /// One loop: the duty. `is_smooth` leaves the rounding of the arithmetic out.
    pub(crate) fn turn(
        &mut self,
        law: MotionMindLaw,
        (gains, qpps, tick_s): (&Gains, f64, f64),
        setpoint: Setpoint,
        count: f64,
        is_smooth: bool,
    ) -> f64 {
        let whole = |steps: f64| if is_smooth { steps } else { steps.trunc() };
        let (error, forward) = match setpoint {
            Setpoint::Speed(speed) => {
                let ahead = self.ahead.get_or_insert(count);
                *ahead += speed * tick_s;
                (*ahead - count, forward(law, speed * tick_s))
            }
            Setpoint::Position(position, _) => {
                if self.target != Some(position) {
                    *self = Self { target: Some(position), ..Self::default() };
                }
                (position - count, 0.0)
            }
        };
        let pid = on_position(gains);
        let is_held = is_protected(gains.max_integral) && self.is_saturated;
        if !is_held {
            self.sum = (self.sum + error * tick_s).clamp(-gains.max_integral, gains.max_integral);
        }
        let slope = (error - self.last_error) / tick_s;
        self.last_error = error;
        let steps = FULL_PWM * (pid.p * error + pid.i * self.sum + pid.d * slope) / qpps;
        let steps = (whole(steps) + whole(forward)).clamp(-FULL_PWM, FULL_PWM);
        self.steps = steps;
        let rests =
            self.target.is_some() && gains.deadzone_counts > 0.0 && error.abs() <= gains.deadzone_counts;
        if rests { 0.0 } else { steps / FULL_PWM }
    }
}

/// Steps of duty that the feed-forward adds at so many counts in a loop.
fn forward(law: MotionMindLaw, counts_per_loop: f64) -> f64 {
    counts_per_loop * f64::from(law.velocity_ff) / f64::from(FULL_FEED_FORWARD)
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_tuning::model::Pid;

    const TICK_S: f64 = 0.005;

    fn law() -> MotionMindLaw {
        MotionMindLaw { velocity_ff: 255, amps_limit: 0 }
    }

    #[test]
    fn a_position_error_gives_what_the_formula_says_cut_to_whole_steps() {
        // One step of duty is one count/s at QPPS 1023: P 0.5 of 41 counts are 20.5 steps, cut to 20; no D from a standing error.
        let pid = Pid { p: 0.5, i: 0.0, d: 0.1 };
        let gains = Gains { position: Some(pid), max_integral: 600.0, ..Gains::default() };
        let mut position_loop = PositionLoop::default();
        let mut turn = |count| {
            position_loop.turn(law(), (&gains, 1023.0, TICK_S), Setpoint::Position(41.0, 0.0), count, false)
        };
        // The first loop sees the whole error come: 0.1 s over 5 ms of it, and is saturated.
        assert_eq!(turn(0.0), (20.5_f64 + 20.0 * 41.0).trunc() / 1023.0);
        assert_eq!(turn(0.0), 20.0 / 1023.0);
        // 10 counts on: 15.5 less 200.
        assert_eq!(turn(10.0), -184.0 / 1023.0);
    }

    #[test]
    fn a_speed_command_runs_ahead_and_a_steady_state_stays() {
        let gains = Gains { velocity: Pid { p: 2.0, i: 30.0, d: 0.0 }, ..Gains::default() };
        let (qpps, speed, duty) = (20_000.0, 4_000.0, 0.25);
        let mut position_loop = PositionLoop::steady(law(), &gains, qpps, TICK_S, speed, duty);
        for n in 0..20 {
            let count = f64::from(n) * speed * TICK_S;
            let got = position_loop.turn(law(), (&gains, qpps, TICK_S), Setpoint::Speed(speed), count, true);
            assert!((got - duty).abs() < 1e-9, "loop {n}: {got}");
        }
    }

    #[test]
    fn a_steady_speed_with_an_integral_stays_too_and_its_sum_carries_what_it_may() {
        let gains = Gains {
            velocity: Pid { p: 2.0, i: 30.0, d: 0.0 },
            velocity_sum: 40.0,
            max_integral: 600.0,
            ..Gains::default()
        };
        let (qpps, speed, duty) = (20_000.0, 4_000.0, 0.25);
        let mut position_loop = PositionLoop::steady(law(), &gains, qpps, TICK_S, speed, duty);
        assert!(position_loop.sum > 0.0);
        for n in 0..20 {
            let count = f64::from(n) * speed * TICK_S;
            let got = position_loop.turn(law(), (&gains, qpps, TICK_S), Setpoint::Speed(speed), count, true);
            assert!((got - duty).abs() < 1e-9, "loop {n}: {got}");
        }
    }

    #[test]
    fn with_saturation_protection_the_sum_stands_while_the_duty_is_full() {
        let sum_after = |max_integral: f64| {
            let pid = Pid { p: 1_000.0, i: 1.0, d: 0.0 };
            let gains = Gains { position: Some(pid), max_integral, ..Gains::default() };
            let mut position_loop = PositionLoop::default();
            for _ in 0..100 {
                position_loop.turn(
                    law(),
                    (&gains, 1023.0, TICK_S),
                    Setpoint::Position(500.0, 0.0),
                    0.0,
                    false,
                );
                position_loop.note_bound(1.0);
            }
            position_loop.sum
        };
        assert!((sum_after(20.48) - 2.5).abs() < 1e-9, "the first loop alone is summed");
        assert!((sum_after(600.0) - 250.0).abs() < 1e-9);
    }
}
