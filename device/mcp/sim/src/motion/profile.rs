//! The trapezoidal profile of a position move.

use super::ramp::stopping_speed;

/// A point that moves to a target with bounded speed, acceleration and deceleration, one step per tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Profile {
    limits: ProfileLimits,
    target: f64,
    position: f64,
    speed: f64,
}

/// Bounds of a [`Profile`]; a ramp of `None` is no bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ProfileLimits {
    /// counts/s, not negative.
    pub speed: f64,
    /// counts/s^2.
    pub acceleration: Option<f64>,
    /// counts/s^2.
    pub deceleration: Option<f64>,
}

impl Profile {
    /// Starts at `position` with the speed the axis has; a speed away from the target is braked first.
    pub fn new(limits: ProfileLimits, target: f64, position: f64, speed: f64) -> Self {
        Profile { limits, target, position, speed }
    }

    pub fn target(&self) -> f64 {
        self.target
    }

    /// Where the point is, counts.
    pub fn position(&self) -> f64 {
        self.position
    }

    /// Its speed over the last tick, counts/s.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Whether the point has come to rest on the target.
    pub fn is_done(&self) -> bool {
        self.position == self.target && self.speed == 0.0
    }

    pub fn step(&mut self, tick_s: f64) {
        let left = self.target - self.position;
        let direction = if left < 0.0 { -1.0 } else { 1.0 };
        let towards = self.next_speed(left.abs(), self.speed * direction, tick_s);
        self.speed = towards * direction;
        self.position += self.speed * tick_s;
        if (self.target - self.position).abs() < 1e-6 {
            self.position = self.target;
            self.speed = 0.0;
        }
    }

    /// Next speed towards the target, given the present one towards it.
    fn next_speed(&self, left: f64, towards: f64, tick_s: f64) -> f64 {
        let step = |rate: Option<f64>| rate.map_or(f64::INFINITY, |rate| rate * tick_s);
        if towards < 0.0 {
            return (towards + step(self.limits.deceleration)).min(0.0);
        }
        let cruise = self.limits.speed.max(towards - step(self.limits.deceleration));
        let stop = stopping_speed(left, self.limits.deceleration, tick_s);
        // A stop much steeper than the deceleration is no option: the point overshoots and comes back. The last step
        // of a stopping curve is up to an eighth steeper than the others.
        let brake = step(self.limits.deceleration);
        let stop = if towards - stop > 1.25 * brake { towards - brake } else { stop };
        (towards + step(self.limits.acceleration)).min(cruise).min(stop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_S: f64 = 1.0 / 300.0;

    fn limits(speed: f64, acceleration: Option<f64>, deceleration: Option<f64>) -> ProfileLimits {
        ProfileLimits { speed, acceleration, deceleration }
    }

    /// Seconds until at rest on the target, and the top speed on the way.
    fn run(mut profile: Profile) -> (f64, f64) {
        let mut top: f64 = 0.0;
        for tick in 1..1_000_000 {
            profile.step(TICK_S);
            top = top.max(profile.speed().abs());
            if profile.is_done() {
                return (f64::from(tick) * TICK_S, top);
            }
        }
        panic!("never done: {profile:?}");
    }

    #[test]
    fn a_long_move_is_a_trapezoid() {
        // 0.5 s up, 0.25 s down; 12000 counts/s in between: 0.5 + 0.25 + (20000 - 3000 - 1500) / 12000 = 2.0417 s.
        let profile = Profile::new(limits(12_000.0, Some(24_000.0), Some(48_000.0)), 20_000.0, 0.0, 0.0);
        let (seconds, top) = run(profile);
        assert_eq!(top, 12_000.0);
        assert!((seconds - 2.041_666).abs() < 2.0 * TICK_S, "{seconds}");
    }

    #[test]
    fn a_short_move_is_a_triangle() {
        // Peak sqrt(a d) = sqrt(24000 * 1500) = 6000, 2 * 6000 / 24000 = 0.5 s, backwards.
        let profile = Profile::new(limits(12_000.0, Some(24_000.0), Some(24_000.0)), -1_500.0, 0.0, 0.0);
        let (seconds, top) = run(profile);
        assert!((seconds - 0.5).abs() < 2.0 * TICK_S, "{seconds}");
        assert!((top - 6_000.0).abs() < 24_000.0 * TICK_S, "{top}");
    }

    #[test]
    fn a_move_without_ramps_takes_distance_over_speed() {
        // The manual's example: 1000 counts at 1000 counts/s "should take 1 second".
        let (seconds, top) = run(Profile::new(limits(1_000.0, None, None), 1_000.0, 0.0, 0.0));
        assert_eq!(top, 1_000.0);
        assert!((seconds - 1.0).abs() < 1.5 * TICK_S, "{seconds}");
    }

    #[test]
    fn a_start_in_the_wrong_direction_or_too_fast_comes_back() {
        let away = Profile::new(limits(2_000.0, Some(8_000.0), Some(8_000.0)), 1_000.0, 0.0, -2_000.0);
        let (seconds, _) = run(away);
        // 0.25 s and 250 counts to stop, then 1250 counts in a trapezoid: 0.25 + 0.25 + 750 / 2000 + 0.25.
        assert!((seconds - 1.125).abs() < 4.0 * TICK_S, "{seconds}");
        let too_fast = Profile::new(limits(2_000.0, Some(8_000.0), Some(8_000.0)), 100.0, 0.0, 2_000.0);
        let (seconds, _) = run(too_fast);
        // 250 counts to stop, 150 back in a triangle of 2 sqrt(150 / 8000).
        assert!((seconds - 0.25 - 0.274).abs() < 6.0 * TICK_S, "{seconds}");
    }
}
