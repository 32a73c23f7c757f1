//! The closed loop tick by tick: the model as plant, the law as controller. Saturation, friction, rounding of counts, the current
//! limit and wind-up are in it; a twin of the axis for predictions.

use crate::model::{Gains, Lag, LoopLaw, Motion, PlantModel};
use crate::motion_mind::{Limiter, LimiterState, PositionLoop};
use crate::score::{LOAD_STEP_DUTY, Score, VELOCITY_STEP, horizon_s, position_step};
pub use crate::setpoint::Setpoint;

/// A loop in simulation.
#[derive(Clone, Debug)]
pub struct TickLoop {
    /// The motor.
    pub plant: PlantModel,
    law: LoopLaw,
    lag: Lag,
    gains: Gains,
    qpps: f64,
    /// Where it is.
    pub motion: Motion,
    last_count: f64,
    filtered: f64,
    integral: f64,
    last_error: f64,
    position_integral: f64,
    last_position_error: Option<f64>,
    last_target: f64,
    position_loop: PositionLoop,
    limit: LimiterState,
    queue: [f64; 9],
    smooth: bool,
    /// The duty given in the last tick.
    pub duty: f64,
}

impl TickLoop {
    /// A loop at rest.
    #[must_use]
    pub fn new(plant: PlantModel, law: LoopLaw, lag: Lag, gains: Gains, qpps: f64) -> Self {
        Self {
            plant,
            law,
            lag,
            gains,
            qpps,
            motion: Motion::default(),
            last_count: 0.0,
            filtered: 0.0,
            integral: 0.0,
            last_error: 0.0,
            position_integral: 0.0,
            last_position_error: None,
            last_target: f64::NAN,
            position_loop: PositionLoop::default(),
            limit: LimiterState::default(),
            queue: [0.0; 9],
            smooth: false,
            duty: 0.0,
        }
    }

    /// The same loop with an encoder of endless resolution: what a rounded one does on average.
    #[must_use]
    pub fn smooth(self) -> Self {
        Self { smooth: true, ..self }
    }

    /// Puts a velocity loop into the steady state of a speed.
    pub fn start_steady(&mut self, speed: f64) {
        self.motion = Motion { speed, position: 0.0 };
        self.last_count = (-speed * self.law.tick_s()).floor();
        self.filtered = speed;
        let plant = &self.plant;
        let duty = speed / plant.gain_counts_per_s + plant.coulomb_duty * speed.signum() + plant.load_duty;
        let forward = if self.law.feed_forward { speed } else { 0.0 };
        if self.gains.velocity.i > 0.0 {
            self.integral = (duty * self.qpps - forward) / self.gains.velocity.i;
        }
        if let Some(law) = self.law.motion_mind {
            self.position_loop =
                PositionLoop::steady(law, &self.gains, self.qpps, self.law.tick_s(), speed, duty);
        }
        self.queue = [duty; 9];
        self.duty = duty;
    }

    /// One tick: measures, computes, moves on. Returns the duty that the bridge held.
    pub fn tick(&mut self, setpoint: Setpoint, load_duty: f64) -> f64 {
        let tick_s = self.law.tick_s();
        let count = if self.smooth { self.motion.position } else { self.motion.position.floor() };
        let share = tick_s / (self.lag.filter_s + tick_s);
        self.filtered += share * ((count - self.last_count) / tick_s - self.filtered);
        self.last_count = count;
        let duty = match (self.law.motion_mind, setpoint) {
            (Some(law), _) => {
                let gains = (&self.gains, self.qpps, tick_s);
                let duty = self.position_loop.turn(law, gains, setpoint, count, self.smooth);
                self.position_loop.note_bound(self.limit.bound);
                Limiter::left(&self.limit, duty)
            }
            (None, Setpoint::Speed(speed)) => self.velocity(speed),
            (None, Setpoint::Position(position, bound)) => self.position(position, bound, count),
        };
        self.queue.rotate_right(1);
        self.queue[0] = duty;
        let whole = (self.lag.delay_ticks.floor() as usize).min(7);
        let part = self.lag.delay_ticks - whole as f64;
        self.duty = self.queue[whole] * (1.0 - part) + self.queue[whole + 1] * part;
        let mut plant = self.plant;
        plant.load_duty += load_duty;
        if let Some(law) = self.law.motion_mind {
            self.step_limited(law.amps_limit, &plant);
        } else if plant.drive_limit.is_some() {
            for _ in 0..2 {
                plant.step(&mut self.motion, self.duty, 0.5 * tick_s);
            }
        } else {
            plant.step(&mut self.motion, self.duty, tick_s);
        }
        self.duty
    }

    /// A tick under a limiter that follows the current with the duty.
    fn step_limited(&mut self, amps_limit: u16, plant: &PlantModel) {
        let tick_s = self.law.tick_s();
        let before = self.motion.speed;
        PlantModel { drive_limit: None, ..*plant }.step(&mut self.motion, self.duty, tick_s);
        if let Some(limiter) = Limiter::new(amps_limit, plant.drive_limit) {
            let emf = 0.5 * (before + self.motion.speed) / plant.gain_counts_per_s;
            limiter.see(&mut self.limit, self.duty - emf, tick_s);
        }
    }

    fn velocity(&mut self, setpoint: f64) -> f64 {
        let tick_s = self.law.tick_s();
        let gains = self.gains.velocity;
        let error = setpoint - self.filtered;
        let slope = (error - self.last_error) / tick_s;
        self.last_error = error;
        self.integral += error * tick_s;
        let forward = if self.law.feed_forward { setpoint } else { 0.0 };
        let wanted = (forward + gains.p * error + gains.i * self.integral + gains.d * slope) / self.qpps;
        let (lowest, highest) = self.bounds();
        let duty = wanted.clamp(lowest, highest);
        if duty != wanted && gains.i > 0.0 {
            let share = if gains.p > 0.0 { (gains.i * tick_s / gains.p).min(1.0) } else { 1.0 };
            self.integral += share * (duty - wanted) * self.qpps / gains.i;
        }
        duty
    }

    /// What the current limit leaves. Assumed: the loop knows of it and does not wind up against it.
    fn bounds(&self) -> (f64, f64) {
        let speed = self.motion.speed;
        let emf = speed / self.plant.gain_counts_per_s;
        let down = self.plant.push_limit(-1.0, speed).map_or(-1.0, |limit| emf - limit);
        let up = self.plant.push_limit(1.0, speed).map_or(1.0, |limit| emf + limit);
        (down.clamp(-1.0, 1.0), up.clamp(-1.0, 1.0))
    }

    fn position(&mut self, target: f64, bound: f64, count: f64) -> f64 {
        let tick_s = self.law.tick_s();
        let Some(gains) = self.gains.position else { return 0.0 };
        if target != self.last_target {
            self.last_position_error = None;
            self.last_target = target;
        }
        let error = target - count;
        let slope = self.last_position_error.map_or(0.0, |before| (error - before) / tick_s);
        self.last_position_error = Some(error);
        let acting = if error.abs() <= self.gains.deadzone_counts { 0.0 } else { error };
        let most = self.gains.max_integral;
        self.position_integral = (self.position_integral + acting * tick_s).clamp(-most, most);
        let wanted = gains.p * acting + gains.i * self.position_integral + gains.d * slope;
        let speed = wanted.clamp(-bound, bound);
        let v = self.gains.velocity;
        if v.p == 0.0 && v.i == 0.0 && v.d == 0.0 {
            return (speed / self.qpps).clamp(-1.0, 1.0);
        }
        self.velocity(speed)
    }
}

/// The velocity test on the model: the score and the root mean square of the last quarter's speed ripple over the step.
#[must_use]
pub fn velocity_test(plant: &PlantModel, law: &LoopLaw, lag: Lag, gains: &Gains, qpps: f64) -> Score {
    let tick_s = law.tick_s();
    let ticks = (horizon_s(plant.tau_s) / tick_s) as usize;
    let top = plant.gain_counts_per_s;
    let (low, high) = (VELOCITY_STEP.0 * top, VELOCITY_STEP.1 * top);
    let mut twin = TickLoop::new(*plant, *law, lag, *gains, qpps);
    twin.start_steady(low);
    let mut run = |load: f64| -> Vec<f64> {
        (0..ticks)
            .map(|_| {
                twin.tick(Setpoint::Speed(high), load);
                high - twin.motion.speed
            })
            .collect()
    };
    let (after_step, after_load) = (run(0.0), run(LOAD_STEP_DUTY));
    Score::of(&after_step, &after_load, tick_s, high - low, 0.05)
}

/// The position test on the model.
#[must_use]
pub fn position_test(plant: &PlantModel, law: &LoopLaw, lag: Lag, gains: &Gains, qpps: f64) -> Score {
    position_test_and_end(plant, law, lag, gains, qpps).0
}

/// What still goes on in the last third of a test, after the step or after the load, whichever is more.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Residual {
    /// Standard deviation of the duty after the step, and after the load.
    pub(crate) duty: (f64, f64),
    /// Distance from the lowest to the highest position, counts.
    pub(crate) range_counts: f64,
}

/// The position test, and what still goes on when its halves should be over.
#[must_use]
pub(crate) fn position_test_and_end(
    plant: &PlantModel,
    law: &LoopLaw,
    lag: Lag,
    gains: &Gains,
    qpps: f64,
) -> (Score, Residual) {
    let tick_s = law.tick_s();
    let ticks = (horizon_s(plant.tau_s) / tick_s) as usize;
    let step = position_step(plant.gain_counts_per_s, plant.tau_s);
    let mut twin = TickLoop::new(*plant, *law, lag, *gains, qpps);
    let mut run = |load: f64| -> (Vec<f64>, Vec<f64>) {
        (0..ticks)
            .map(|_| {
                let duty = twin.tick(Setpoint::Position(step, qpps), load);
                (step - twin.motion.position, duty)
            })
            .unzip()
    };
    let (after_step, after_load) = (run(0.0), run(LOAD_STEP_DUTY));
    let late = ticks * 7 / 10;
    let residual = Residual {
        duty: (spread(&after_step.1[late..]), spread(&after_load.1[late..])),
        range_counts: range(&after_step.0[late..]).max(range(&after_load.0[late..])),
    };
    (Score::of(&after_step.0, &after_load.0, tick_s, step, 0.02f64.max(3.0 / step)), residual)
}

/// Standard deviation.
fn spread(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// From the lowest to the highest.
fn range(values: &[f64]) -> f64 {
    let ends = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    (ends.1 - ends.0).max(0.0)
}
