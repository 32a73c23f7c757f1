//! The trapezoid in time of a move from rest to rest, as DV and DA make it (SuprMotr manual, commands DV, DA, MA).

/// The trajectory of a move.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Profile {
    /// Counts from end to end, with their sign.
    distance: f64,
    acceleration: f64,
    /// The highest speed that it comes to, counts/s.
    cruise: f64,
    /// How long it gathers speed, and when it is over, s.
    ramp_s: f64,
    ends_s: f64,
}

impl Profile {
    /// Counts from end to end, with their sign, at so many counts/s at the most and counts/s^2.
    pub(super) fn new(distance: f64, velocity: f64, acceleration: f64) -> Self {
        let way = distance.abs();
        let cruise = velocity.min((acceleration * way).sqrt());
        let ramp_s = cruise / acceleration;
        Self { distance, acceleration, cruise, ramp_s, ends_s: way / cruise + ramp_s }
    }

    /// How far it is after a time, counts.
    pub(super) fn at(&self, elapsed_s: f64) -> f64 {
        let &Self { distance, acceleration, cruise, ramp_s, ends_s } = self;
        if cruise <= 0.0 {
            return 0.0;
        }
        let way = distance.abs();
        let gone = if elapsed_s >= ends_s {
            way
        } else if elapsed_s > ends_s - ramp_s {
            way - 0.5 * acceleration * (ends_s - elapsed_s).powi(2)
        } else if elapsed_s > ramp_s {
            cruise * (elapsed_s - 0.5 * ramp_s)
        } else {
            0.5 * acceleration * elapsed_s.max(0.0).powi(2)
        };
        gone.copysign(distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 5000 counts at 20,000 counts/s and 200,000 counts/s^2: 0.1 s and 1000 counts up, as much down, 3000 counts in 0.15 s between.
    #[test]
    fn a_long_move_is_a_trapezoid_and_a_short_one_a_triangle() {
        let long = Profile::new(-5_000.0, 20_000.0, 200_000.0);
        for (at_s, counts) in
            [(0.0, 0.0), (0.05, 250.0), (0.1, 1_000.0), (0.175, 2_500.0), (0.3, 4_750.0), (0.4, 5_000.0)]
        {
            assert!((long.at(at_s) + counts).abs() < 1e-6, "{at_s} s: {}", long.at(at_s));
        }
        let short = Profile::new(500.0, 20_000.0, 200_000.0);
        assert!((short.at(0.05) - 250.0).abs() < 1e-6 && (short.at(0.0999) - 500.0).abs() < 0.01);
    }
}
