//! The model of an axis that identification fills and design uses.

pub use crate::gains::{Gains, Pid};
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// What the model of a motor takes for granted.
    MODEL: Thresholds {
        /// Share of the damping that is viscous friction, not back-EMF. Only a current limit tells them apart; small in every motor, so one
        /// middle value does for all.
        viscous_share: f64 = 0.025,
        /// How far an exponent may be from the one before for five terms of its series to be exact: the next one is below 1e-16.
        near_exponent: f64 = 5e-3,
    }
}

/// A first-order motor with dry friction.
///
/// `tau dv/dt = K clip(u - load - v/K, +-drive_limit) - K coulomb sign(v)`; at rest it stays while friction holds `u - load`. The
/// battery sags by `sag u (u - v/K)`, which makes gain and time constant somewhat larger at a high duty; that is exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantModel {
    /// Speed per duty, counts/s, friction aside.
    pub gain_counts_per_s: f64,
    /// Time constant of the speed, s.
    pub tau_s: f64,
    /// Duty that dry friction eats.
    pub coulomb_duty: f64,
    /// Duty that a constant load eats, positive when it pulls towards lower counts.
    pub load_duty: f64,
    /// Duty beyond the back-EMF that the current limit leaves; `None` where it never acted.
    pub drive_limit: Option<f64>,
    /// The same while the motor brakes; `None` where nothing else is known than `drive_limit`.
    #[serde(default)]
    pub brake_limit: Option<f64>,
    /// Share of the battery voltage that the stall current at full duty takes away.
    pub sag: f64,
}

impl PlantModel {
    /// Steady speed at a duty, counts/s.
    #[must_use]
    pub fn steady_speed(&self, duty: f64) -> f64 {
        let sag = self.sag * duty * duty;
        let net = duty * (1.0 - sag) - self.load_duty;
        self.gain_counts_per_s * (net.abs() - self.coulomb_duty).max(0.0) * net.signum() / (1.0 - sag)
    }
}

/// What the loop loses between the motion and the duty, beyond the hold and the count difference of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lag {
    /// First-order filter on the speed, s.
    pub filter_s: f64,
    /// Ticks between computing a duty and giving it; may be a fraction, standing for other small lags.
    pub delay_ticks: f64,
}

impl Lag {
    /// All of it, s.
    #[must_use]
    pub fn total_s(&self, tick_s: f64) -> f64 {
        self.filter_s + self.delay_ticks * tick_s
    }

    /// As long, with so much of it a filter on the speed: the rest is a delay, which a loop on the position meets too.
    #[must_use]
    pub fn with_filter(&self, filter_s: f64, tick_s: f64) -> Self {
        let total_s = self.total_s(tick_s);
        let filter_s = filter_s.min(total_s);
        Self { filter_s, delay_ticks: (total_s - filter_s) / tick_s }
    }
}

/// The filter of the speed that the derivative of a position sees, by its mean delay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DerivativeFilter {
    /// As it was measured, s.
    pub likely_s: f64,
    /// The least that is still likely, s.
    pub least_s: f64,
}

impl DerivativeFilter {
    /// Nothing told whether it sees a filtered speed: what the loop loses may all be a delay.
    pub const UNKNOWN: Self = Self { likely_s: 0.0, least_s: 0.0 };
}

/// State of a [`PlantModel`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Counts/s.
    pub speed: f64,
    /// Counts.
    pub position: f64,
}

/// An exponential and what it was asked for before: a loop asks for that of the same step again and again, or of one that a sagging supply makes a little longer. Worked out each time
/// it was a seventh of the time of all tests of the bench.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decay {
    exponent: f64,
    value: f64,
}

impl Default for Decay {
    fn default() -> Self {
        Self { exponent: 0.0, value: 1.0 }
    }
}

impl Decay {
    /// `exp(exponent)`.
    #[inline]
    pub(crate) fn of(&mut self, exponent: f64) -> f64 {
        if exponent == self.exponent {
            return self.value;
        }
        let off = exponent - self.exponent;
        if off.abs() > MODEL.near_exponent {
            *self = Self { exponent, value: exponent.exp() };
            return self.value;
        }
        // Products: divisions would take as long as the exponential.
        let (third, fifth) = (const { 1.0 / 3.0 }, const { 1.0 / 5.0 });
        let series = off * (1.0 + 0.5 * off * (1.0 + third * off * (1.0 + 0.25 * off * (1.0 + fifth * off))));
        self.value + self.value * series
    }
}

impl PlantModel {
    /// Moves on by `dt` at a constant duty. Exact but for the current limit, which is taken as it is at the start.
    pub fn step(&self, motion: &mut Motion, duty: f64, dt: f64) {
        self.step_on(motion, duty, dt, &mut Decay::default());
    }

    /// The same, with the exponential of the step before.
    #[inline]
    pub(crate) fn step_on(&self, motion: &mut Motion, duty: f64, dt: f64, decay_of: &mut Decay) {
        if !self.glide(motion, duty, dt, decay_of) {
            self.step_with_events(motion, duty, dt, decay_of);
        }
    }

    /// A step in which the motor turns on and no limit of the current acts, as nearly all of them are. Whether it was one; nothing has changed otherwise.
    #[inline]
    fn glide(&self, motion: &mut Motion, duty: f64, dt: f64, decay_of: &mut Decay) -> bool {
        let speed = motion.speed;
        let sag = self.sag * duty * duty;
        let kept = 1.0 - sag;
        if let Some(drive) = self.drive_limit {
            let emf = speed / self.gain_counts_per_s;
            let push = (duty - emf) * kept + MODEL.viscous_share * emf;
            if push.abs() > self.brake_limit.map_or(drive, |brake| brake.min(drive)) {
                return false;
            }
        }
        let stretched = if sag == 0.0 { 1.0 } else { kept.recip() };
        let tau_s = self.tau_s * stretched;
        let net = duty * kept - self.load_duty - self.coulomb_duty.copysign(speed);
        let goal = self.gain_counts_per_s * stretched * net;
        let decay = decay_of.of(-dt / self.tau_s * kept);
        let ahead = speed - goal;
        let end = goal + ahead * decay;
        let turns_on = end * speed > 0.0;
        if turns_on {
            motion.position += goal * dt + ahead * tau_s * (1.0 - decay);
            motion.speed = end;
        }
        turns_on
    }

    /// A step of any kind.
    fn step_with_events(&self, motion: &mut Motion, duty: f64, dt: f64, decay_of: &mut Decay) {
        let sag = self.sag * duty * duty;
        let net = duty * (1.0 - sag) - self.load_duty;
        let (gain, tau_s) = if sag == 0.0 {
            (self.gain_counts_per_s, self.tau_s)
        } else {
            (self.gain_counts_per_s / (1.0 - sag), self.tau_s / (1.0 - sag))
        };
        let mut left = dt;
        // At most: slow down to zero, then turn round or stay.
        for _ in 0..2 {
            let direction = if motion.speed != 0.0 { motion.speed.signum() } else { net.signum() };
            if motion.speed == 0.0 && net.abs() <= self.coulomb_duty {
                return;
            }
            if let Some(limit) = self.push_limit(duty, motion.speed) {
                let eaten = MODEL.viscous_share * motion.speed / self.gain_counts_per_s;
                let push = duty * (1.0 - sag) - motion.speed / gain + eaten;
                if push.abs() > limit {
                    // The winding gives a constant torque: a slope, not an approach.
                    let net = limit * push.signum() - eaten - self.load_duty - self.coulomb_duty * direction;
                    match self.slide(motion, self.gain_counts_per_s * net / self.tau_s, left) {
                        Some(used) => left -= used,
                        None => return,
                    }
                    continue;
                }
            }
            let goal = gain * (net - self.coulomb_duty * direction);
            let decay = decay_of.of(-left / tau_s);
            let end = goal + (motion.speed - goal) * decay;
            if motion.speed == 0.0 || end * motion.speed > 0.0 {
                motion.position += goal * left + (motion.speed - goal) * tau_s * (1.0 - decay);
                motion.speed = end;
                return;
            }
            let stop_s = (tau_s * ((motion.speed - goal) / -goal).ln()).clamp(0.0, left);
            let decay = (-stop_s / tau_s).exp();
            motion.position += goal * stop_s + (motion.speed - goal) * tau_s * (1.0 - decay);
            motion.speed = 0.0;
            left -= stop_s;
        }
    }

    /// What the current limit leaves of `duty` less the back-EMF, at a duty and a speed; `None` without a limit.
    ///
    /// Assumed: the limit for braking holds while the bridge's voltage has the sign of the speed, the one for driving beyond it. A motor
    /// that is driven against its motion is thus braked at duty 0 as long as that alone gives more than the limit for driving.
    #[must_use]
    pub fn push_limit(&self, duty: f64, speed: f64) -> Option<f64> {
        self.push_limit_at(duty, speed / self.gain_counts_per_s)
    }

    /// The same at a back-EMF, as a share of full duty.
    #[inline]
    pub(crate) fn push_limit_at(&self, duty: f64, emf: f64) -> Option<f64> {
        let drive = self.drive_limit?;
        let brake = self.brake_limit.unwrap_or(drive);
        Some(if (duty - emf) * emf >= 0.0 {
            drive
        } else if duty * emf >= 0.0 {
            brake
        } else {
            brake.min(emf.abs().max(drive))
        })
    }

    /// The steady load, as duty, that full duty carries at a speed beside friction and the load that is there; below 0 where the motor
    /// does not reach that speed at all. Of both directions the one in which less is left.
    ///
    /// At full duty `v = K (1 - sag - load - coulomb) / (1 - sag)`; at the current limit the push is that limit, of which viscous friction
    /// takes its share.
    #[must_use]
    pub fn spare_load_duty(&self, speed: f64) -> f64 {
        let share = speed.abs() / self.gain_counts_per_s;
        let push = (1.0 - self.sag) * (1.0 - share);
        let most = self.drive_limit.map_or(push, |limit| push.min(limit - MODEL.viscous_share * share));
        most - self.coulomb_duty - self.load_duty.abs()
    }

    /// Constant acceleration; the time used when the motion came to rest before the end.
    fn slide(&self, motion: &mut Motion, slope: f64, dt: f64) -> Option<f64> {
        let end = motion.speed + slope * dt;
        if motion.speed == 0.0 || end * motion.speed > 0.0 {
            motion.position += 0.5 * (motion.speed + end) * dt;
            motion.speed = end;
            return None;
        }
        let used = (-motion.speed / slope).clamp(0.0, dt);
        motion.position += 0.5 * motion.speed * used;
        motion.speed = 0.0;
        Some(used)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lag_with_a_known_filter_is_as_long_and_what_is_not_proven_a_filter_is_a_delay() {
        let lag = Lag { filter_s: 0.004, delay_ticks: 1.5 };
        for (filter_s, of_it_s) in [(0.0, 0.0), (0.006, 0.006), (0.020, 0.007)] {
            let split = lag.with_filter(filter_s, 0.002);
            assert!((split.total_s(0.002) - lag.total_s(0.002)).abs() < 1e-12, "{split:?}");
            assert!((split.filter_s - of_it_s).abs() < 1e-12 && split.delay_ticks >= 0.0, "{split:?}");
        }
    }

    fn plant() -> PlantModel {
        PlantModel {
            gain_counts_per_s: 10_000.0,
            tau_s: 0.1,
            coulomb_duty: 0.05,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        }
    }

    #[test]
    fn a_step_follows_the_exponential_however_it_is_cut() {
        let (mut whole, mut cut) = (Motion::default(), Motion::default());
        plant().step(&mut whole, 0.55, 0.2);
        for _ in 0..50 {
            plant().step(&mut cut, 0.55, 0.004);
        }
        assert!((whole.speed - 5_000.0 * (1.0 - (-2.0_f64).exp())).abs() < 1e-9);
        assert!((whole.speed - cut.speed).abs() < 1e-8 && (whole.position - cut.position).abs() < 1e-8);
    }

    #[test]
    fn an_exponential_near_the_one_before_is_as_exact_as_any() {
        for from in [-0.001, -0.04, -0.7, -30.0] {
            for off in [-1e-2, -5e-3, -1e-4, 0.0, 3e-7, 4.9e-3, 6e-3] {
                let mut decay = Decay::default();
                decay.of(from);
                let exact = f64::exp(from + off);
                assert!((decay.of(from + off) / exact - 1.0).abs() < 4e-16, "{from} and {off}");
            }
        }
        let mut decay = Decay::default();
        assert_eq!(
            [decay.of(f64::NEG_INFINITY), decay.of(f64::NEG_INFINITY), decay.of(0.0)],
            [0.0, 0.0, 1.0]
        );
    }

    #[test]
    fn a_step_without_events_is_the_same_by_the_way_of_all_steps() {
        let sagging = PlantModel { sag: 0.05, load_duty: 0.02, ..plant() };
        let limited = PlantModel { drive_limit: Some(0.4), brake_limit: Some(0.6), ..sagging };
        for model in [plant(), sagging, limited] {
            for n in 0..200 {
                let (speed, duty) = (80.0 * f64::from(n) - 8_000.0, (0.37 * f64::from(n)).sin());
                let [mut quick, mut all] = [Motion { speed, position: 3.0 }; 2];
                model.step(&mut quick, duty, 0.003);
                model.step_with_events(&mut all, duty, 0.003, &mut Decay::default());
                assert!((quick.speed - all.speed).abs() < 1e-9, "{speed} at {duty}: {quick:?}, {all:?}");
                assert!(
                    (quick.position - all.position).abs() < 1e-10,
                    "{speed} at {duty}: {quick:?}, {all:?}"
                );
            }
        }
    }

    #[test]
    fn friction_stops_the_motor_where_the_equation_says_and_holds_it() {
        let mut motion = Motion { speed: 5_000.0, position: 0.0 };
        plant().step(&mut motion, 0.0, 1.0);
        // v = -500 + 5500 exp(-t/tau) is zero at tau ln 11; the distance is tau (5000 - 500 ln 11).
        assert_eq!(motion.speed, 0.0);
        assert!((motion.position - 0.1 * (5_000.0 - 500.0 * 11.0_f64.ln())).abs() < 1e-9);
        plant().step(&mut motion, 0.049, 1.0);
        assert_eq!(motion.speed, 0.0);
    }

    #[test]
    fn a_reversal_passes_through_rest() {
        let mut motion = Motion { speed: 5_000.0, position: 0.0 };
        plant().step(&mut motion, -0.55, 2.0);
        assert!((motion.speed + 5_000.0).abs() < 1.0);
    }

    #[test]
    fn braking_has_a_limit_of_its_own_as_long_as_the_bridge_does_not_drive_backwards() {
        let limited = PlantModel { drive_limit: Some(0.4), brake_limit: Some(2.0), ..plant() };
        // Driving; braking by a lower duty; driven against the motion, first by the short circuit alone, then by the limit.
        let cases = [(1.0, 5_000.0, 0.4), (0.2, 9_000.0, 2.0), (-1.0, 9_000.0, 0.9), (-1.0, 2_000.0, 0.4)];
        for (duty, speed, expected) in cases {
            let limit = limited.push_limit(duty, speed).unwrap();
            assert!((limit - expected).abs() < 1e-12, "{duty} at {speed}: {limit}");
            assert_eq!(limited.push_limit(-duty, -speed), Some(limit));
        }
        assert_eq!(plant().push_limit(1.0, 0.0), None);
    }

    #[test]
    fn at_the_limit_the_speed_grows_by_what_it_leaves_after_friction() {
        let limited = PlantModel { drive_limit: Some(0.4), ..plant() };
        let mut motion = Motion::default();
        for _ in 0..10 {
            limited.step(&mut motion, 1.0, 0.001);
        }
        // K (limit - friction) / tau = 35 000 counts/s2 for 10 ms, less a little for what grows with the speed.
        assert!((motion.speed / 350.0 - 1.0).abs() < 0.01, "{}", motion.speed);
    }
}
