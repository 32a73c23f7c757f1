//! A velocity PID with feed-forward, alone or under a position PID: the loop of many controllers, in simulation.

use crate::gains::Gains;
use crate::law::{Facts, Law, Seen, Windup};
use crate::model::Lag;
use crate::setpoint::Setpoint;

/// Filters tried, s, and delays tried, ticks.
const FILTERS_S: [f64; 9] = [0.0, 0.002, 0.004, 0.006, 0.008, 0.010, 0.013, 0.017, 0.022];
const DELAYS: [f64; 6] = [0.0, 0.5, 1.0, 1.5, 2.0, 3.0];

/// Properties of such a loop at 300 Hz or more: a lag of an extra tick and a filter of one, of three at the most.
pub const CASCADE: Facts = Facts {
    has_duty: true,
    has_cascade: true,
    can_be_probed: false,
    writes_at_rest: false,
    keeps_travel: false,
    longest_move_counts: f64::INFINITY,
    speed_step: 1.0,
    usual_lag: Lag { filter_s: 0.004, delay_ticks: 1.0 },
    longest_lag: Lag { filter_s: 0.010, delay_ticks: 1.0 },
    filters_s: &FILTERS_S,
    delays_ticks: &DELAYS,
    rates_hz: &[],
    // Half a tick at the usual 300 Hz.
    unmodelled_s: 0.5 / 300.0,
    integral_times: (30.0, 0.65),
};

/// How a loop of this kind computes.
#[derive(Clone, Copy, Debug)]
pub struct Manner {
    /// How much of the setpoint over QPPS is added to the duty.
    pub feed_forward: f64,
    /// Length of a tick, s.
    pub tick_s: f64,
    /// Whether the derivative of a position sees the filtered speed of the velocity loop.
    pub filters_derivative: bool,
    /// What the integral of the speed does while the duty is cut.
    pub windup: Windup,
}

impl Manner {
    /// That of a law.
    #[must_use]
    pub fn of<L: Law>(law: &L) -> Self {
        let (feed_forward, tick_s) = (law.feed_forward(), law.tick_s());
        let filters_derivative = law.derivative_filter().is_some();
        Self { feed_forward, tick_s, filters_derivative, windup: law.windup() }
    }
}

/// The state of the loop.
#[derive(Clone, Copy, Debug)]
pub struct Cascade {
    integral: f64,
    last_error: f64,
    position_integral: f64,
    last_position_error: Option<f64>,
    last_target: f64,
}

impl Default for Cascade {
    fn default() -> Self {
        Self {
            integral: 0.0,
            last_error: 0.0,
            position_integral: 0.0,
            last_position_error: None,
            last_target: f64::NAN,
        }
    }
}

impl Cascade {
    /// The steady state of a speed: `duty` is what it takes.
    #[must_use]
    pub fn steady((gains, qpps): (&Gains, f64), feed_forward: f64, speed: f64, duty: f64) -> Self {
        let forward = feed_forward * speed;
        let i = gains.velocity.i;
        let integral = if i > 0.0 { (duty * qpps - forward) / i } else { 0.0 };
        Self { integral, ..Self::default() }
    }

    /// One tick: the duty.
    pub fn tick(&mut self, gains: (&Gains, f64), manner: Manner, setpoint: Setpoint, seen: &Seen<'_>) -> f64 {
        match setpoint {
            Setpoint::Speed(speed) => self.velocity(gains, manner, speed, seen),
            Setpoint::Position(position, bound) => self.position(gains, manner, (position, bound), seen),
        }
    }

    fn velocity(
        &mut self,
        (gains, qpps): (&Gains, f64),
        Manner { feed_forward, tick_s, windup, .. }: Manner,
        setpoint: f64,
        seen: &Seen<'_>,
    ) -> f64 {
        let gains = gains.velocity;
        let error = setpoint - seen.speed;
        let slope = if gains.d == 0.0 { 0.0 } else { (error - self.last_error) / tick_s };
        self.last_error = error;
        self.integral += error * tick_s;
        let forward = feed_forward * setpoint;
        let wanted = (forward + gains.p * error + gains.i * self.integral + gains.d * slope) / qpps;
        if windup == Windup::Held {
            if wanted.abs() > 1.0 && wanted * error >= 0.0 {
                self.integral -= error * tick_s;
            }
            return wanted.clamp(-1.0, 1.0);
        }
        let (lowest, highest) = seen.duty_bounds();
        let duty = wanted.clamp(lowest, highest);
        if duty != wanted && gains.i > 0.0 {
            let share = if gains.p > 0.0 { (gains.i * tick_s / gains.p).min(1.0) } else { 1.0 };
            self.integral += share * (duty - wanted) * qpps / gains.i;
        }
        duty
    }

    fn position(
        &mut self,
        (all, qpps): (&Gains, f64),
        manner: Manner,
        (target, bound): (f64, f64),
        seen: &Seen<'_>,
    ) -> f64 {
        let Some(gains) = all.position else { return 0.0 };
        if target != self.last_target {
            self.last_position_error = None;
            self.last_target = target;
        }
        let error = target - seen.count;
        let by_counts = |before: f64| (error - before) / manner.tick_s;
        let slope = if manner.filters_derivative {
            -seen.speed
        } else {
            self.last_position_error.map_or(0.0, by_counts)
        };
        self.last_position_error = Some(error);
        let acting = if error.abs() <= all.deadzone_counts { 0.0 } else { error };
        let most = all.max_integral;
        self.position_integral = (self.position_integral + acting * manner.tick_s).clamp(-most, most);
        let wanted = gains.p * acting + gains.i * self.position_integral + gains.d * slope;
        let speed = wanted.clamp(-bound, bound);
        let v = all.velocity;
        if v.p == 0.0 && v.i == 0.0 && v.d == 0.0 {
            return (speed / qpps).clamp(-1.0, 1.0);
        }
        self.velocity((all, qpps), manner, speed, seen)
    }
}
