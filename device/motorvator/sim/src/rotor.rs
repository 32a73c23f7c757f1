//! The rotor of a stepper, which follows the field that the board turns, or falls behind it: lost steps.

use serde::Serialize;

/// Waits in full steps of four to a turn of the field.
const STEPS_PER_FIELD_TURN: f64 = 4.0;
/// Length of a step of the integration; a rotor swings some ten times slower.
const STEP_S: f64 = 0.000_1;

/// What a rotor is. The figures are those of a small printer motor with its load. Assumed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RotorParams {
    /// Acceleration that the field gives at its best, at full power, in steps/s^2.
    pub pull_steps_per_s2: f64,
    /// How quickly a swing dies, in 1/s.
    pub damping_per_s: f64,
    /// What friction and load take of the acceleration, in steps/s^2; it also holds a rotor that stands.
    pub load_steps_per_s2: f64,
}

impl Default for RotorParams {
    fn default() -> Self {
        Self { pull_steps_per_s2: 60_000.0, damping_per_s: 60.0, load_steps_per_s2: 6_000.0 }
    }
}

/// A rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    params: RotorParams,
    steps: f64,
    steps_per_s: f64,
}

impl Rotor {
    /// One at rest.
    #[must_use]
    pub fn new(params: RotorParams) -> Self {
        Self { params, steps: 0.0, steps_per_s: 0.0 }
    }

    /// Where it is, in steps.
    #[must_use]
    pub fn steps(&self) -> f64 {
        self.steps
    }

    /// What it has lost against a field that has made so many steps; whole turns of the field, since it settles nowhere else.
    #[must_use]
    pub fn lost(&self, field_steps: i64) -> i64 {
        ((field_steps as f64 - self.steps) / STEPS_PER_FIELD_TURN).round() as i64
            * STEPS_PER_FIELD_TURN as i64
    }

    /// Follows a field at so many steps, with so much of full power, for a while.
    pub fn advance(&mut self, field_steps: i64, power: f64, seconds: f64) {
        let count = (seconds / STEP_S).ceil().max(1.0);
        let dt = seconds / count;
        for _ in 0..count as u32 {
            self.step(field_steps, power, dt);
        }
    }

    fn step(&mut self, field_steps: i64, power: f64, dt: f64) {
        let RotorParams { pull_steps_per_s2, damping_per_s, load_steps_per_s2 } = self.params;
        let lag = (field_steps as f64 - self.steps) / STEPS_PER_FIELD_TURN * std::f64::consts::TAU;
        let pull = power * pull_steps_per_s2 * lag.sin() - damping_per_s * self.steps_per_s;
        let before = self.steps_per_s;
        let pulled = before + pull * dt;
        // Friction acts against the motion and never beyond rest.
        let most = load_steps_per_s2 * dt;
        self.steps_per_s =
            if pulled.abs() <= most && before.abs() <= most { 0.0 } else { pulled - most * pulled.signum() };
        self.steps += self.steps_per_s * dt;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is lost in 100 steps with so much time between them.
    fn lost(wait_s: f64) -> i64 {
        let mut rotor = Rotor::new(RotorParams::default());
        for field in 1..=100 {
            rotor.advance(field, 1.0, wait_s);
        }
        rotor.advance(100, 1.0, 0.5);
        rotor.lost(100)
    }

    #[test]
    fn slow_steps_are_followed_and_quick_ones_are_lost() {
        assert_eq!(lost(0.010), 0);
        assert_ne!(lost(0.001), 0);
        assert_eq!(lost(0.001) % 4, 0);
    }

    #[test]
    fn without_power_it_stays_where_it_is_and_with_it_it_is_pulled_back() {
        let mut rotor = Rotor::new(RotorParams::default());
        rotor.advance(1, 0.0, 0.1);
        assert!(rotor.steps().abs() < 1e-12);
        rotor.advance(1, 1.0, 0.5);
        assert!((rotor.steps() - 1.0).abs() < 0.1, "{}", rotor.steps());
    }
}
