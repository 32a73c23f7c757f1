//! The velocity and position controllers.

use super::settings::Gains;
use super::{AntiWindup, ControlLaw, DerivativeOf};

/// Velocity PID with QPPS feed-forward.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct VelocityPid {
    integral: f64,
    derivative: Derivative,
}

/// One tick's question to a [`VelocityPid`].
pub(crate) struct VelocityStep {
    /// Setpoint, counts/s.
    pub setpoint: f64,
    /// Measurement, counts/s.
    pub measured: f64,
    pub gains: Gains,
    /// Speed at full duty, counts/s.
    pub qpps: u32,
    /// Duty the output may take, lowest and highest.
    pub bounds: (f64, f64),
}

impl VelocityPid {
    pub fn reset(&mut self) {
        *self = VelocityPid::default();
    }

    /// The duty of this tick, within the bounds. 0 without a QPPS, since everything is a share of it.
    pub fn step(&mut self, step: &VelocityStep, law: &ControlLaw) -> f64 {
        if step.qpps == 0 {
            self.reset();
            return 0.0;
        }
        let qpps = f64::from(step.qpps);
        let error = step.setpoint - step.measured;
        let slope = self.derivative.step(error, step.measured, law);
        let added = error * law.gain_step();
        self.integral += added;
        let feed_forward = if law.feed_forward { step.setpoint } else { 0.0 };
        let wanted =
            (feed_forward + step.gains.p * error + step.gains.i * self.integral + step.gains.d * slope)
                / qpps;
        let duty = wanted.clamp(step.bounds.0, step.bounds.1);
        self.unwind((duty - wanted) * qpps, added, &step.gains, law);
        duty
    }

    /// `excess` is what saturation took from the output, counts/s; 0 without saturation.
    fn unwind(&mut self, excess: f64, added: f64, gains: &Gains, law: &ControlLaw) {
        if excess == 0.0 {
            return;
        }
        match law.anti_windup {
            AntiWindup::None => {}
            AntiWindup::Hold => {
                if excess * added < 0.0 {
                    self.integral -= added;
                }
            }
            AntiWindup::BackCalculation if gains.i > 0.0 => {
                // Tracking time P / I: in lasting saturation the integral settles where it alone, with the
                // feed-forward, gives the bound, so that the output leaves it as soon as the error turns.
                let share = if gains.p > 0.0 { (gains.i * law.gain_step() / gains.p).min(1.0) } else { 1.0 };
                self.integral += share * excess / gains.i;
            }
            AntiWindup::BackCalculation => self.integral = 0.0,
        }
    }
}

/// Position PID; its output is a speed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PositionPid {
    integral: f64,
    derivative: Derivative,
}

impl PositionPid {
    pub fn reset(&mut self) {
        *self = PositionPid::default();
    }

    /// A new setpoint: its step is no slope.
    pub fn restart_derivative(&mut self) {
        self.derivative = Derivative::default();
    }

    /// The speed of this tick, counts/s, unlimited. `error` and `measured` in counts.
    ///
    /// Assumed: within the dead zone the error counts as 0 for P and I; D goes on damping.
    pub fn step(
        &mut self,
        error: f64,
        measured: f64,
        gains: &Gains,
        bounds: PositionBounds,
        law: &ControlLaw,
    ) -> f64 {
        let slope = self.derivative.step(error, measured, law);
        let acting = if error.abs() <= bounds.deadzone { 0.0 } else { error };
        self.integral =
            (self.integral + acting * law.gain_step()).clamp(-bounds.max_integral, bounds.max_integral);
        gains.p * acting + gains.i * self.integral + gains.d * slope
    }
}

/// Dead zone and integral bound of the position loop, counts (times the gain unit for the integral).
#[derive(Clone, Copy, Debug)]
pub(crate) struct PositionBounds {
    pub deadzone: f64,
    pub max_integral: f64,
}

/// Slope of what the law differentiates, filtered.
#[derive(Clone, Copy, Debug, Default)]
struct Derivative {
    previous: Option<f64>,
    filtered: f64,
}

impl Derivative {
    fn step(&mut self, error: f64, measured: f64, law: &ControlLaw) -> f64 {
        let signal = match law.derivative_of {
            DerivativeOf::Error => error,
            DerivativeOf::Measurement => -measured,
        };
        let slope = self.previous.map_or(0.0, |previous| (signal - previous) / law.derivative_step());
        self.previous = Some(signal);
        if law.derivative_filter_s > 0.0 {
            let share = law.tick_s() / (law.derivative_filter_s + law.tick_s());
            self.filtered += share * (slope - self.filtered);
        } else {
            self.filtered = slope;
        }
        self.filtered
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::GainTiming;

    const QPPS: u32 = 10_000;

    fn ask(setpoint: f64, measured: f64, p: f64, i: f64, d: f64) -> VelocityStep {
        VelocityStep { setpoint, measured, gains: Gains { p, i, d }, qpps: QPPS, bounds: (-1.0, 1.0) }
    }

    #[test]
    fn feed_forward_is_the_share_of_qpps() {
        let mut pid = VelocityPid::default();
        assert_eq!(pid.step(&ask(2_500.0, 0.0, 0.0, 0.0, 0.0), &ControlLaw::default()), 0.25);
        let without = ControlLaw { feed_forward: false, ..ControlLaw::default() };
        assert_eq!(pid.step(&ask(2_500.0, 0.0, 0.0, 0.0, 0.0), &without), 0.0);
    }

    #[test]
    fn integral_and_derivative_count_per_tick_or_per_second() {
        let output_of_second_tick = |gain_timing, i, d| {
            let law = ControlLaw { gain_timing, feed_forward: false, ..ControlLaw::default() };
            let mut pid = VelocityPid::default();
            pid.step(&ask(100.0, 0.0, 0.0, i, d), &law);
            pid.step(&ask(200.0, 0.0, 0.0, i, d), &law) * f64::from(QPPS)
        };
        assert!((output_of_second_tick(GainTiming::PerTick, 1.0, 0.0) - 300.0).abs() < 1e-9);
        assert!((output_of_second_tick(GainTiming::PerSecond, 1.0, 0.0) - 1.0).abs() < 1e-9);
        assert!((output_of_second_tick(GainTiming::PerTick, 0.0, 1.0) - 100.0).abs() < 1e-9);
        assert!((output_of_second_tick(GainTiming::PerSecond, 0.0, 0.1) - 3_000.0).abs() < 1e-9);
    }

    #[test]
    fn the_derivative_may_count_otherwise_than_the_integral() {
        let derivative_timing = Some(GainTiming::PerSecond);
        let law = ControlLaw { derivative_timing, feed_forward: false, ..ControlLaw::default() };
        let mut pid = VelocityPid::default();
        pid.step(&ask(100.0, 0.0, 0.0, 1.0, 0.1), &law);
        let duty = pid.step(&ask(200.0, 0.0, 0.0, 1.0, 0.1), &law);
        assert!((duty * f64::from(QPPS) - 3_300.0).abs() < 1e-9);
    }

    #[test]
    fn a_derivative_of_the_measurement_takes_no_notice_of_a_setpoint_step() {
        let second_tick = |derivative_of, measured| {
            let law = ControlLaw { derivative_of, feed_forward: false, ..ControlLaw::default() };
            let mut pid = VelocityPid::default();
            pid.step(&ask(0.0, 0.0, 0.0, 0.0, 1.0), &law);
            pid.step(&ask(300.0, measured, 0.0, 0.0, 1.0), &law) * f64::from(QPPS)
        };
        assert!((second_tick(DerivativeOf::Error, 100.0) - 200.0).abs() < 1e-9);
        assert!((second_tick(DerivativeOf::Measurement, 100.0) + 100.0).abs() < 1e-9);
    }

    #[test]
    fn a_filtered_derivative_rises_by_its_time_constant() {
        let law =
            ControlLaw { derivative_filter_s: 1.0 / 300.0, feed_forward: false, ..ControlLaw::default() };
        let mut pid = VelocityPid::default();
        pid.step(&ask(0.0, 0.0, 0.0, 0.0, 1.0), &law);
        let output = pid.step(&ask(200.0, 0.0, 0.0, 0.0, 1.0), &law) * f64::from(QPPS);
        assert!(
            (output - 100.0).abs() < 1e-9,
            "half of the step after one time constant of one tick: {output}"
        );
    }

    /// Ticks the output stays at the bound after the error has turned, following one second of saturation.
    fn ticks_to_leave_saturation(anti_windup: AntiWindup) -> u32 {
        let law = ControlLaw { anti_windup, feed_forward: false, ..ControlLaw::default() };
        let mut pid = VelocityPid::default();
        for _ in 0..300 {
            assert_eq!(pid.step(&ask(9_000.0, 0.0, 1.0, 0.5, 0.0), &law).clamp(0.9, 1.0), 1.0);
        }
        (0..100_000).find(|_| pid.step(&ask(0.0, 100.0, 1.0, 0.5, 0.0), &law) < 1.0).unwrap()
    }

    #[test]
    fn the_integral_does_not_wind_up_unless_the_law_lets_it() {
        assert_eq!(ticks_to_leave_saturation(AntiWindup::BackCalculation), 0);
        assert!(ticks_to_leave_saturation(AntiWindup::Hold) <= 1);
        assert!(ticks_to_leave_saturation(AntiWindup::None) > 1_000);
    }

    #[test]
    fn a_channel_without_qpps_gives_nothing() {
        let mut pid = VelocityPid::default();
        let step = VelocityStep { qpps: 0, ..ask(1_000.0, 0.0, 5.0, 1.0, 1.0) };
        assert_eq!(pid.step(&step, &ControlLaw::default()), 0.0);
    }

    #[test]
    fn the_position_integral_stops_at_its_bound_and_the_dead_zone_silences_p_and_i() {
        let law = ControlLaw::default();
        let bounds = PositionBounds { deadzone: 3.0, max_integral: 50.0 };
        let gains = Gains { p: 0.0, i: 2.0, d: 0.0 };
        let mut pid = PositionPid::default();
        let outputs: Vec<f64> = (0..20).map(|_| pid.step(10.0, 0.0, &gains, bounds, &law)).collect();
        assert_eq!(outputs[0], 20.0);
        assert_eq!(outputs[19], 100.0);
        let proportional = Gains { p: 4.0, i: 0.0, d: 0.0 };
        let mut pid = PositionPid::default();
        assert_eq!(pid.step(3.0, 0.0, &proportional, bounds, &law), 0.0);
        assert_eq!(pid.step(-4.0, 0.0, &proportional, bounds, &law), -16.0);
    }
}
