//! Ramps and stopping curves, in whole ticks.

/// A value that approaches a goal at a bounded rate. Exact: it is kept as an integer of `1 / rate_hz` units, so that a
/// ramp of 12000 per second reaches 12000 at the 300th of 300 ticks and not one later.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ramp {
    rate_hz: i64,
    scaled: i64,
}

/// How fast a [`Ramp`] may move, in units per second; `None` = at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rates {
    /// Away from zero.
    pub rising: Option<u32>,
    /// Towards zero.
    pub falling: Option<u32>,
}

impl Rates {
    pub const AT_ONCE: Rates = Rates { rising: None, falling: None };

    pub fn both(rate: Option<u32>) -> Self {
        Rates { rising: rate, falling: rate }
    }
}

impl Ramp {
    /// Bound of the scaled value, far above any speed and far below overflow.
    const LARGEST: f64 = 1e17;

    pub fn new(rate_hz: u32) -> Self {
        Ramp { rate_hz: i64::from(rate_hz.max(1)), scaled: 0 }
    }

    pub fn value(&self) -> f64 {
        self.scaled as f64 / self.rate_hz as f64
    }

    pub fn is_zero(&self) -> bool {
        self.scaled == 0
    }

    pub fn set(&mut self, value: f64) {
        self.scaled = self.scaled_from(value);
    }

    /// One tick towards `goal`. A reversal falls to zero and rises beyond it within the same tick where the rates allow.
    pub fn approach(&mut self, goal: f64, rates: Rates) {
        let goal = self.scaled_from(goal);
        let turning_point = if goal.signum() * self.scaled.signum() > 0 { goal } else { 0 };
        let to_fall = (self.scaled.abs() - turning_point.abs()).max(0);
        let mut tick_left = Share::WHOLE;
        if to_fall > 0 {
            match rates.falling.map(i64::from) {
                Some(rate) if rate < to_fall => {
                    self.scaled -= self.scaled.signum() * rate;
                    return;
                }
                Some(rate) => tick_left = Share { part: rate - to_fall, whole: rate },
                None => {}
            }
            self.scaled = turning_point;
        }
        let to_rise = goal - self.scaled;
        self.scaled += match rates.rising {
            Some(rate) => to_rise.signum() * to_rise.abs().min(tick_left.of(i64::from(rate))),
            None => to_rise,
        };
    }

    /// Takes the value down to at most `magnitude`, whatever its sign.
    pub fn limit_magnitude(&mut self, magnitude: f64) {
        let limit = self.scaled_from(magnitude.max(0.0));
        self.scaled = self.scaled.clamp(-limit, limit);
    }

    fn scaled_from(&self, value: f64) -> i64 {
        (value * self.rate_hz as f64).round().clamp(-Self::LARGEST, Self::LARGEST) as i64
    }
}

/// A part of a tick.
struct Share {
    part: i64,
    whole: i64,
}

impl Share {
    const WHOLE: Share = Share { part: 1, whole: 1 };

    fn of(&self, rate: i64) -> i64 {
        i64::try_from(i128::from(rate) * i128::from(self.part) / i128::from(self.whole)).unwrap_or(rate)
    }
}

/// Highest speed from which a stop within `distance` is possible when the speed falls by `deceleration * tick_s` at each
/// tick, in units per second. `None` = any deceleration; then the speed that covers the distance in one tick.
pub(crate) fn stopping_speed(distance: f64, deceleration: Option<f64>, tick_s: f64) -> f64 {
    let distance = distance.max(0.0);
    let one_tick = distance / tick_s;
    match deceleration {
        Some(rate) if rate > 0.0 => {
            let step = rate * tick_s;
            one_tick.min(step * ((0.25 + 2.0 * distance / (step * tick_s)).sqrt() - 0.5))
        }
        _ => one_tick,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks_until(ramp: &mut Ramp, goal: f64, rates: Rates) -> u32 {
        (1..100_000)
            .find(|_| {
                ramp.approach(goal, rates);
                ramp.value() == goal
            })
            .unwrap()
    }

    #[test]
    fn a_ramp_ends_at_the_exact_tick_at_any_rate() {
        for (rate_hz, acceleration, goal, ticks) in [
            (300, 12_000, 12_000.0, 300),
            (625, 12_000, 12_000.0, 625),
            (300, 24_000, 12_000.0, 150),
            (300, 7, 7.0, 300),
            (300, 10_000, -1.0, 1),
        ] {
            let mut ramp = Ramp::new(rate_hz);
            assert_eq!(
                ticks_until(&mut ramp, goal, Rates::both(Some(acceleration))),
                ticks,
                "{acceleration}"
            );
        }
    }

    #[test]
    fn a_reversal_takes_as_long_as_its_whole_span() {
        let mut ramp = Ramp::new(300);
        ramp.set(32_767.0);
        // 65534 units at 655359 per second: 29.99 ticks.
        assert_eq!(ticks_until(&mut ramp, -32_767.0, Rates::both(Some(655_359))), 30);
    }

    #[test]
    fn rising_and_falling_have_their_own_rates() {
        let rates = Rates { rising: Some(1_000), falling: Some(2_000) };
        let mut ramp = Ramp::new(100);
        ramp.set(-1_000.0);
        // Half a second down to zero, one second up.
        assert_eq!(ticks_until(&mut ramp, 1_000.0, rates), 150);
    }

    #[test]
    fn no_rate_is_at_once_and_a_rate_of_zero_is_never() {
        let mut ramp = Ramp::new(300);
        ramp.approach(5_000.0, Rates::AT_ONCE);
        assert_eq!(ramp.value(), 5_000.0);
        ramp.approach(-5_000.0, Rates::both(Some(0)));
        assert_eq!(ramp.value(), 5_000.0);
    }

    #[test]
    fn following_the_stopping_speed_lands_on_the_spot() {
        let tick_s = 1.0 / 300.0;
        for (distance, deceleration) in
            [(6_000.0, 12_000.0), (1.0, 10.0), (100_000.0, 3_000.0), (37.0, 500_000.0)]
        {
            let (mut left, mut speed, mut ticks) = (distance, f64::INFINITY, 0);
            while left > 1e-6 && ticks < 100_000 {
                let next = stopping_speed(left, Some(deceleration), tick_s);
                assert!(
                    speed.is_infinite()
                        || next <= speed && speed - next <= 1.125 * deceleration * tick_s + 1e-6
                );
                speed = next;
                left -= speed * tick_s;
                ticks += 1;
            }
            assert!(left.abs() < 1e-6, "{distance} at {deceleration}: {left} left");
            let ideal_s = (2.0 * distance / deceleration).sqrt();
            assert!((f64::from(ticks) * tick_s - ideal_s).abs() < 0.1 * ideal_s + 2.0 * tick_s);
        }
    }
}
