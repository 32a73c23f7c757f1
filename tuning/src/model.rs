//! The model of an axis that identification fills and design uses, and the law the controller is taken to follow.

pub use crate::gains::{Gains, Pid};
use crate::motion_mind::{MotionMindLaw, SUM_BOUNDS_S, rounded};
use serde::{Deserialize, Serialize};

/// Share of the damping that is viscous friction, not back-EMF. Only a current limit tells them apart; small in every motor, so one
/// middle value does for all.
const VISCOUS_SHARE: f64 = 0.025;

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
    pub fn total_s(&self, law: &LoopLaw) -> f64 {
        self.filter_s + self.delay_ticks * law.tick_s()
    }
}

/// The firmware's law, as far as the tuner must know it.
///
/// Assumed, since none of it is public: `duty = (feed_forward v + P e + I sum(e) + D diff(e)) / QPPS`. The law probe checks it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopLaw {
    /// Loop rate, Hz.
    pub rate_hz: u32,
    /// Whether I and D count per tick; otherwise per second.
    pub per_tick: bool,
    /// Wire value of a position gain of 1.
    pub position_scale: f64,
    /// Whether the setpoint's share of QPPS is added to the duty.
    pub feed_forward: bool,
    /// The law of a Motion Mind instead: one loop on the position, its output a duty.
    #[serde(default)]
    pub motion_mind: Option<MotionMindLaw>,
}

impl Default for LoopLaw {
    /// Assumed: 300 Hz, gains per tick, position gains x 1024, with feed-forward.
    fn default() -> Self {
        Self { rate_hz: 300, per_tick: true, position_scale: 1024.0, feed_forward: true, motion_mind: None }
    }
}

impl LoopLaw {
    /// Length of a tick, s.
    #[must_use]
    pub fn tick_s(&self) -> f64 {
        1.0 / f64::from(self.rate_hz)
    }

    /// Seconds that one unit of the integral or derivative stands for.
    #[must_use]
    pub fn gain_step(&self) -> f64 {
        if self.per_tick { 1.0 } else { self.tick_s() }
    }

    /// The bounds that a position integral may be given where it needs `wanted`, counts x s.
    #[must_use]
    pub fn sum_bounds(&self, wanted: f64) -> Vec<f64> {
        if self.motion_mind.is_some() { SUM_BOUNDS_S.to_vec() } else { vec![wanted] }
    }

    /// Gains as the registers can hold them. Those of packet serial are so fine that it makes no difference.
    #[must_use]
    pub fn rounded(&self, gains: &Gains, qpps: f64) -> Gains {
        match self.motion_mind {
            Some(_) => rounded(gains, qpps),
            None => *gains,
        }
    }
}

/// State of a [`PlantModel`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Counts/s.
    pub speed: f64,
    /// Counts.
    pub position: f64,
}

impl PlantModel {
    /// Moves on by `dt` at a constant duty. Exact but for the current limit, which is taken as it is at the start.
    pub fn step(&self, motion: &mut Motion, duty: f64, dt: f64) {
        let sag = self.sag * duty * duty;
        let net = duty * (1.0 - sag) - self.load_duty;
        let (gain, tau_s) = (self.gain_counts_per_s / (1.0 - sag), self.tau_s / (1.0 - sag));
        let mut left = dt;
        // At most: slow down to zero, then turn round or stay.
        for _ in 0..2 {
            let direction = if motion.speed != 0.0 { motion.speed.signum() } else { net.signum() };
            if motion.speed == 0.0 && net.abs() <= self.coulomb_duty {
                return;
            }
            let eaten = VISCOUS_SHARE * motion.speed / self.gain_counts_per_s;
            let push = duty * (1.0 - sag) - motion.speed / gain + eaten;
            if let Some(limit) = self.push_limit(duty, motion.speed)
                && push.abs() > limit
            {
                // The winding gives a constant torque: a slope, not an approach.
                let net = limit * push.signum() - eaten - self.load_duty - self.coulomb_duty * direction;
                match self.slide(motion, self.gain_counts_per_s * net / self.tau_s, left) {
                    Some(used) => left -= used,
                    None => return,
                }
                continue;
            }
            let goal = gain * (net - self.coulomb_duty * direction);
            let decay = (-left / tau_s).exp();
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
        let drive = self.drive_limit?;
        let brake = self.brake_limit.unwrap_or(drive);
        let emf = speed / self.gain_counts_per_s;
        Some(if (duty - emf) * speed >= 0.0 {
            drive
        } else if duty * speed >= 0.0 {
            brake
        } else {
            brake.min(emf.abs().max(drive))
        })
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
