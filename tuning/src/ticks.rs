//! The closed loop tick by tick: the model as plant, the law as controller. Saturation, friction, rounding of counts, the current
//! limit and wind-up are in it; a twin of the axis for predictions.

use crate::duty_limiter::{DutyLimit, Limiter, LimiterState};
use crate::law::{Law, Seen};
use crate::model::{Decay, Gains, Lag, Motion, PlantModel};
use crate::score::{LOAD_STEP_DUTY, Score, VELOCITY_STEP, horizon_s, position_step};
pub use crate::setpoint::Setpoint;

/// Duties under way: two ticks more than the longest delay at the highest rate.
const QUEUE: usize = 17;

/// A loop in simulation.
#[derive(Clone, Debug)]
pub struct TickLoop<L: Law> {
    /// The motor.
    pub plant: PlantModel,
    law: L,
    gains: Gains,
    qpps: f64,
    tick_s: f64,
    /// What the filter lets through of a change in a tick, as a share.
    share: f64,
    /// Where it is.
    pub motion: Motion,
    last_count: f64,
    filtered: f64,
    state: L::Loop,
    limit: LimiterState,
    /// The duties of the last ticks, as a ring, and where the newest is.
    queue: [f64; QUEUE],
    newest: usize,
    /// The delay as whole ticks and what is left of one.
    delay: (usize, f64),
    decay: Decay,
    winding_decay: Decay,
    /// Time constant of the winding, s, where it is told from the delay.
    pub winding_s: f64,
    /// What the winding makes of the duty.
    torque_duty: f64,
    smooth: bool,
    /// The duty given in the last tick.
    pub duty: f64,
}

impl<L: Law> TickLoop<L> {
    /// A loop at rest.
    #[must_use]
    pub fn new(plant: PlantModel, law: L, lag: Lag, gains: Gains, qpps: f64) -> Self {
        let whole = (lag.delay_ticks.floor() as usize).min(QUEUE - 2);
        let tick_s = law.tick_s();
        Self {
            plant,
            law,
            gains,
            qpps,
            tick_s,
            share: tick_s / (lag.filter_s + tick_s),
            motion: Motion::default(),
            last_count: 0.0,
            filtered: 0.0,
            state: L::Loop::default(),
            limit: LimiterState::default(),
            queue: [0.0; QUEUE],
            newest: 0,
            delay: (whole, lag.delay_ticks - whole as f64),
            decay: Decay::default(),
            winding_decay: Decay::default(),
            winding_s: 0.0,
            torque_duty: 0.0,
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
        self.last_count = (-speed * self.tick_s).floor();
        self.filtered = speed;
        let plant = &self.plant;
        let duty = speed / plant.gain_counts_per_s + plant.coulomb_duty * speed.signum() + plant.load_duty;
        self.state = self.law.steady((&self.gains, self.qpps), speed, duty);
        self.queue = [duty; QUEUE];
        self.torque_duty = duty;
        self.duty = duty;
    }

    /// One tick: measures, computes, moves on. Returns the duty that the bridge held.
    pub fn tick(&mut self, setpoint: Setpoint, load_duty: f64) -> f64 {
        let tick_s = self.tick_s;
        let count = if self.smooth { self.motion.position } else { self.motion.position.floor() };
        self.filtered += self.share * ((count - self.last_count) / tick_s - self.filtered);
        self.last_count = count;
        let seen = Seen {
            plant: &self.plant,
            motion: &self.motion,
            count,
            speed: self.filtered,
            most_duty: self.limit.bound,
            is_smooth: self.smooth,
        };
        let duty = self.law.tick(&mut self.state, (&self.gains, self.qpps), setpoint, &seen);
        self.newest = (self.newest + QUEUE - 1) % QUEUE;
        self.queue[self.newest] = duty;
        let (whole, part) = self.delay;
        let ago = |ticks: usize| self.queue[(self.newest + ticks) % QUEUE];
        self.duty = ago(whole) * (1.0 - part) + ago(whole + 1) * part;
        let mut plant = self.plant;
        plant.load_duty += load_duty;
        let acting = self.through_winding();
        if let Some(limit) = self.law.duty_limit() {
            self.step_limited(limit, &plant, acting);
        } else if plant.drive_limit.is_some() {
            for _ in 0..2 {
                plant.step_on(&mut self.motion, acting, 0.5 * tick_s, &mut self.decay);
            }
        } else {
            plant.step_on(&mut self.motion, acting, tick_s, &mut self.decay);
        }
        self.duty
    }

    /// The mean over a tick of what the winding lets act.
    fn through_winding(&mut self) -> f64 {
        let tick_s = self.tick_s;
        if self.winding_s <= 0.01 * tick_s {
            return self.duty;
        }
        let decay = self.winding_decay.of(-tick_s / self.winding_s);
        let before = self.torque_duty - self.duty;
        self.torque_duty = self.duty + before * decay;
        self.duty + before * (1.0 - decay) * self.winding_s / tick_s
    }

    /// A tick under a limiter that follows the current with the duty.
    fn step_limited(&mut self, limit: DutyLimit, plant: &PlantModel, acting: f64) {
        let tick_s = self.tick_s;
        let before = self.motion.speed;
        let free = PlantModel { drive_limit: None, ..*plant };
        free.step_on(&mut self.motion, acting, tick_s, &mut self.decay);
        if let Some(limiter) = Limiter::new(limit, plant.drive_limit) {
            let emf = 0.5 * (before + self.motion.speed) / plant.gain_counts_per_s;
            limiter.see(&mut self.limit, acting - emf, tick_s);
        }
    }
}

/// What the time-weighted errors of a test may still cost: a search gives up a candidate as soon as it is certain to be dearer than what it has.
struct Budget {
    /// The most that the weighted sum may be.
    most: f64,
    /// The sum so far.
    spent: f64,
}

impl Budget {
    /// Of a [`Score::cost`] in a test of so many ticks and of a step.
    fn of(cost: f64, ticks: usize, tick_s: f64, step: f64) -> Self {
        let horizon_s = ticks as f64 * tick_s;
        // What rounding makes of the sum is no reason to give up.
        Self { most: 1.000_001 * cost * step.abs() * horizon_s * horizon_s / tick_s, spent: 0.0 }
    }

    /// The values of a half of the test, tick by tick; `None` where they cost more than is left.
    fn half<T>(
        &mut self,
        ticks: usize,
        tick_s: f64,
        mut run: impl FnMut() -> (f64, T),
    ) -> Option<Vec<(f64, T)>> {
        let mut values = Vec::with_capacity(ticks);
        for n in 0..ticks {
            let (error, more) = run();
            self.spent += (n as f64 + 0.5) * tick_s * error.abs();
            if self.spent > self.most {
                return None;
            }
            values.push((error, more));
        }
        Some(values)
    }
}

/// The velocity test on the model: the score.
#[must_use]
pub fn velocity_test<L: Law>(plant: &PlantModel, law: &L, lag: Lag, gains: &Gains, qpps: f64) -> Score {
    velocity_test_within(plant, law, lag, gains, qpps, f64::INFINITY).unwrap_or_default()
}

/// The same, given up where its cost is certain to be above `most`.
pub(crate) fn velocity_test_within<L: Law>(
    plant: &PlantModel,
    law: &L,
    lag: Lag,
    gains: &Gains,
    qpps: f64,
    most: f64,
) -> Option<Score> {
    let tick_s = law.tick_s();
    let ticks = (horizon_s(plant.tau_s) / tick_s) as usize;
    let top = plant.gain_counts_per_s;
    let (low, high) = (VELOCITY_STEP.0 * top, VELOCITY_STEP.1 * top);
    let mut twin = TickLoop::new(*plant, *law, lag, *gains, qpps);
    twin.start_steady(low);
    let mut budget = Budget::of(most, ticks, tick_s, high - low);
    let mut run = |load: f64| {
        budget.half(ticks, tick_s, || {
            twin.tick(Setpoint::Speed(high), load);
            (high - twin.motion.speed, ())
        })
    };
    let errors = |half: Vec<(f64, ())>| -> Vec<f64> { half.into_iter().map(|(error, ())| error).collect() };
    let (after_step, after_load) = (errors(run(0.0)?), errors(run(LOAD_STEP_DUTY)?));
    Some(Score::of(&after_step, &after_load, tick_s, high - low, 0.05))
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
pub(crate) fn position_test_and_end<L: Law>(
    plant: &PlantModel,
    law: &L,
    lag: Lag,
    gains: &Gains,
    qpps: f64,
) -> (Score, Residual) {
    position_test_within(plant, law, lag, gains, qpps, f64::INFINITY).unwrap_or_default()
}

/// The same, given up where its cost is certain to be above `most`.
pub(crate) fn position_test_within<L: Law>(
    plant: &PlantModel,
    law: &L,
    lag: Lag,
    gains: &Gains,
    qpps: f64,
    most: f64,
) -> Option<(Score, Residual)> {
    let tick_s = law.tick_s();
    let ticks = (horizon_s(plant.tau_s) / tick_s) as usize;
    let step = position_step(plant.gain_counts_per_s, plant.tau_s);
    let mut twin = TickLoop::new(*plant, *law, lag, *gains, qpps);
    let mut budget = Budget::of(most, ticks, tick_s, step);
    let mut run = |load: f64| -> Option<(Vec<f64>, Vec<f64>)> {
        let half = budget.half(ticks, tick_s, || {
            let duty = twin.tick(Setpoint::Position(step, qpps), load);
            (step - twin.motion.position, duty)
        })?;
        Some(half.into_iter().unzip())
    };
    let (after_step, after_load) = (run(0.0)?, run(LOAD_STEP_DUTY)?);
    let late = ticks * 7 / 10;
    let residual = Residual {
        duty: (spread(&after_step.1[late..]), spread(&after_load.1[late..])),
        range_counts: range(&after_step.0[late..]).max(range(&after_load.0[late..])),
    };
    Some((Score::of(&after_step.0, &after_load.0, tick_s, step, 0.02f64.max(3.0 / step)), residual))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Pid;
    use crate::plain_law::PlainLaw;
    use crate::score::{POSITION_OVERSHOOT, VELOCITY_OVERSHOOT};

    const PLANT: PlantModel = PlantModel {
        gain_counts_per_s: 10_000.0,
        tau_s: 0.1,
        coulomb_duty: 0.05,
        load_duty: 0.01,
        drive_limit: Some(0.5),
        brake_limit: None,
        sag: 0.02,
    };

    #[test]
    fn a_test_is_given_up_only_where_it_costs_more_than_it_may() {
        let (law, lag, qpps) = (PlainLaw::default(), Lag::default(), 9_000.0);
        let mut given_up = 0;
        for p in [0.5, 2.0, 8.0, 20.0] {
            let velocity = Gains { velocity: Pid { p, i: 20.0 * p, d: 0.0 }, ..Gains::default() };
            let position =
                Gains { position: Some(Pid { p: 4.0 * p, i: 0.0, d: 0.2 * p }), ..Gains::default() };
            let by_speed = |most| velocity_test_within(&PLANT, &law, lag, &velocity, qpps, most);
            let by_place = |most| position_test_within(&PLANT, &law, lag, &position, qpps, most);
            let (whole, (moved, end)) = (
                velocity_test(&PLANT, &law, lag, &velocity, qpps),
                by_place(f64::INFINITY).expect("no bound"),
            );
            let (cost, of_move) = (whole.cost(VELOCITY_OVERSHOOT), moved.cost(POSITION_OVERSHOOT));
            for share in [1.0, 1.1, 3.0] {
                assert_eq!(by_speed(share * cost), Some(whole), "P {p}");
                assert_eq!(by_place(share * of_move), Some((moved, end)), "P {p}");
            }
            for share in [0.9, 0.5, 0.01] {
                let is_dearer = |score: Score, most: f64| score.setpoint + score.load > most;
                assert_eq!(by_speed(share * cost).is_none(), is_dearer(whole, share * cost), "P {p}");
                assert_eq!(by_place(share * of_move).is_none(), is_dearer(moved, share * of_move), "P {p}");
                given_up += usize::from(by_speed(share * cost).is_none());
            }
        }
        assert!(given_up >= 8, "{given_up}");
    }
}
