//! Position loops: PD and PID that act on the duty directly, and P over the velocity loop (PIV).

use super::search::{Candidate, Loops, ascend, better, finish};
use super::task::{Design, Goal, Task};
use crate::law::{Law, other_windup};
use crate::model::{Gains, Lag, Pid, PlantModel};
use crate::score::{POSITION_OVERSHOOT, Score, position_step};
use crate::thresholds::thresholds;
use crate::ticks::position_test_within;

thresholds! {
    /// How the gains of a position are bounded and searched.
    POSITION: Thresholds {
        /// Overshoot beyond which the cost jumps, as a share of the step.
        overshoot_cap: f64 = 0.06,
        /// Deviation of the duty, as a share of full, beyond which a move is not over yet when it should be; the cost jumps there too.
        late_duty_cap: f64 = 0.08,
        /// Distance gone in the last third of a move or after a load beyond which it is not over yet, as a share of the step: what creeps for so long sticks and slips in
        /// the backlash of a real machine.
        late_distance_cap: f64 = 0.01,
        /// The least that this distance can be, in counts.
        late_counts_cap: f64 = 2.0,
        /// What each further such distance adds to the cost, as a share of it.
        late_distance_cost: f64 = 0.2,
        /// The most that creeping can add to the cost, as a share of it.
        late_distance_most: f64 = 0.8,
        /// Shares of the highest gain tried.
        shares: [f64; 6] = [1.0, 0.85, 0.7, 0.5, 0.35, 0.2],
        /// Derivative times tried, as shares of the time constant of the motor.
        derivative_times: [f64; 14] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5],
        /// Share of the allowed noise of the duty that a cascade gets: at rest it chatters about the edge of a count, which is more than rounding at random.
        at_rest: f64 = 0.9,
        /// How many integral times of the inner loop are tried.
        inner_times: usize = 8,
        /// Shares of the highest inner gain tried.
        inner_shares: [f64; 4] = [1.0, 0.7, 0.4, 0.2],
        /// Counts by which the dead zone is wider than the backlash of the mechanics.
        backlash_margin: f64 = 2.0,
        /// Least dead zone of an integral, which would hunt without one, in counts.
        integral_deadzone: f64 = 1.0,
        /// Share of the lag that no model has which is left to be designed for where gains are raised on the machine: with none of it 2 of 96 PD and PID loops of the
        /// bench were called tuned at a true Ms of 1.9, with all of it the cost is a seventh higher in the median.
        raised_share: f64 = 0.5,
        /// By how many of its standard deviations friction may be less and more than it was measured. Gains are judged by the mean of the three.
        friction_deviations: f64 = 2.0,
        /// How many rounds the refinement has; the step is smaller in each.
        rounds: usize = 4,
        /// How many steps coarse gains go on by at the most.
        most_steps: usize = 24,
        /// Factor by which all gains are lowered where no step around them keeps their bounds.
        softer: f64 = 0.8,
    }
}

/// How gains are refined.
struct Refinement {
    /// The gains that are moved together.
    moves: &'static [Move],
    /// The first step, relative; the root of it is the next.
    first_step: f64,
    /// How often a step that pays is taken in a row at the most.
    repeats: usize,
}

/// PD and PID: the best gains lie along a ridge, where they rise together. With single moves the cost on the model was more than a fifth above what the best of 20 others
/// reached on 30 of 200 Motion Minds (seed 7, PID), and 67.5 and 60.5 % of the PIDs of seeds 7 and 11 were good; with these 71.5 and 65.5 %.
const DIRECT: Refinement = Refinement {
    moves: &[
        Move::position(true, false, false),
        Move::position(false, false, true),
        Move::position(false, true, false),
        Move::position(true, false, true),
        Move::position(true, true, true),
    ],
    first_step: 1.3,
    repeats: 3,
};
/// PIV: searched on a grid of three gains already. Joint moves gave no better gains on 400 motors, and three accepted ones fewer of seed 7.
const CASCADE: Refinement = Refinement {
    moves: &[Move::position(true, false, false), Move::velocity(true, false), Move::velocity(false, true)],
    first_step: 1.2,
    repeats: 1,
};

/// `v = P e + D de/dt`, duty = v / QPPS: the simple PD system.
#[must_use]
pub fn design_pd<L: Law>(task: &Task<L>) -> Option<Design> {
    let task = &direct(task);
    let loops = Loops::new(task);
    let base = Gains { deadzone_counts: deadzone(task), ..Gains::default() };
    let best = search_pd(&loops, task, base)?;
    let best = stepped(&loops, task, refine(&loops, task, best, &DIRECT), false)?;
    finish(&loops, task, Some(best).filter(|best| loops.stable(task, &best.gains)))
}

/// The PD with an integral that carries friction and load, bounded by what they need.
#[must_use]
pub fn design_pid<L: Law>(task: &Task<L>) -> Option<Design> {
    let task = &direct(task);
    let loops = Loops::new(task);
    let base = Gains { deadzone_counts: deadzone(task).max(POSITION.integral_deadzone), ..Gains::default() };
    // The integral takes phase: the PD below it is kept a little softer. Where friction and load are small none is needed.
    let inner = Task { goal: Goal { ms: 1.0 + 0.8 * (task.goal.ms - 1.0), ..task.goal }, ..*task };
    let plain = search_pd(&loops, task, base);
    let softer = search_pd(&loops, &inner, base).and_then(|best| with_integral(&loops, task, best));
    let best = [plain, softer]
        .into_iter()
        .flatten()
        .map(|best| refine(&loops, task, best, &DIRECT))
        .min_by(|one, other| one.cost.total_cmp(&other.cost))?;
    let best = stepped(&loops, task, best, true)?;
    finish(&loops, task, Some(best).filter(|best| loops.stable(task, &best.gains)))
}

/// A PD with the integral that suits it best, or as it is.
fn with_integral<L: Law>(loops: &Loops, task: &Task<L>, plain: Candidate) -> Option<Candidate> {
    let (base, proportional) = (plain.gains, plain.gains.position?);
    let mut best = Some(plain);
    // A sum that has no fine bound has to grow slowly.
    let (longest, ratio) = task.law.facts().integral_times;
    for time_s in (0..12).map(|n| longest * task.plant.tau_s.max(0.03) * ratio.powi(n)) {
        for share in [1.0, 0.8, 0.6] {
            let p = proportional.p * share;
            let pid = Pid { p, i: p / time_s, d: proportional.d * share };
            for max_integral in sum_bounds(task, &pid) {
                let gains = Gains { position: Some(pid), max_integral, ..base };
                if loops.within(task, &gains).is_some() && loops.stable(task, &gains) {
                    best = better(best, |most| candidate(task, gains, most));
                }
            }
        }
    }
    best
}

/// The bounds that the integral may be given: what friction and the load step eat, half as much again.
fn sum_bounds<L: Law>(task: &Task<L>, pid: &Pid) -> Vec<f64> {
    let eaten = 1.5 * (task.plant.coulomb_duty + task.plant.load_duty.abs() + crate::score::LOAD_STEP_DUTY);
    task.law.sum_bounds(eaten * task.qpps / pid.i)
}

/// The gains of a loop that acts on the duty directly, with the dead zone and the bound that its integral needs.
pub(crate) fn direct_gains<L: Law>(task: &Task<L>, pid: Pid) -> Gains {
    let gains = Gains { position: Some(pid), deadzone_counts: deadzone(task), ..Gains::default() };
    if pid.i <= 0.0 {
        return gains;
    }
    let max_integral = sum_bounds(task, &pid).first().copied().unwrap_or_default();
    Gains { max_integral, deadzone_counts: gains.deadzone_counts.max(POSITION.integral_deadzone), ..gains }
}

/// The best of the steps around gains that registers round, going on from step to step as long as that pays; the same where they are fine. `None`
/// where all of them break a bound.
fn stepped<L: Law>(loops: &Loops, task: &Task<L>, best: Candidate, has_integral: bool) -> Option<Candidate> {
    if task.law.steps_around(&best.gains, task.qpps).is_empty() {
        return Some(best);
    }
    let is_allowed = |gains: &Gains| {
        let has_any = gains.position.is_some_and(|position| position.i != 0.0);
        (has_integral || !has_any) && loops.within(task, gains).is_some() && loops.stable(task, gains)
    };
    let mut found = candidate(task, best.gains, f64::INFINITY).filter(|rounded| is_allowed(&rounded.gains));
    let mut at = best.gains;
    for _ in 0..POSITION.most_steps {
        let before = found.as_ref().map_or(f64::INFINITY, |best| best.cost);
        for gains in task.law.steps_around(&at, task.qpps) {
            if is_allowed(&gains) {
                found = better(found, |most| candidate(task, gains, most));
            }
        }
        match &found {
            Some(best) if best.cost < before => at = best.gains,
            Some(_) => break,
            // Softer all over, as long as there is something to make softer.
            None => {
                let position = at.position?;
                let softer = |gain: f64| POSITION.softer * gain;
                let pid = Pid { p: softer(position.p), i: softer(position.i), d: softer(position.d) };
                at = Gains { position: Some(pid), ..at };
            }
        }
    }
    found
}

/// P over the velocity PI, both searched together.
#[must_use]
pub fn design_piv<L: Law>(task: &Task<L>) -> Option<Design> {
    let loops = Loops::new(task);
    let quiet = Goal { noise_duty: POSITION.at_rest * task.goal.noise_duty, ..task.goal };
    let task = &Task { goal: quiet, ..*task };
    let inner = Task { goal: Goal { ms: 1.05 * quiet.ms, ..quiet }, ..*task };
    let lag_s = task.lag.total_s(task.law.tick_s()) + 1.5 * task.law.tick_s();
    let shortest = (1.5 * lag_s).max(task.least_integral_s);
    let longest = (12.0 * task.plant.tau_s).max(40.0 * lag_s).max(1.5 * shortest);
    let mut best = None;
    for n in 0..POSITION.inner_times {
        let time_s = shortest * (longest / shortest).powf(n as f64 / (POSITION.inner_times - 1) as f64);
        let pi = |p: f64| Gains {
            velocity: Pid { p, i: p / time_s, d: 0.0 },
            deadzone_counts: deadzone(task),
            ..Gains::default()
        };
        let Some(top) = ascend(&loops, &inner, 400.0, pi) else { continue };
        for share in POSITION.inner_shares {
            let with_position =
                |p: f64| Gains { position: Some(Pid { p, i: 0.0, d: 0.0 }), ..pi(top * share) };
            let Some(highest) = ascend(&loops, task, 300.0, with_position) else { continue };
            for outer in POSITION.shares {
                best = better(best, |most| candidate(task, with_position(highest * outer), most));
            }
        }
    }
    let best = refine(&loops, task, best?, &CASCADE);
    finish(&loops, task, Some(best).filter(|best| loops.stable(task, &best.gains)))
}

fn search_pd<L: Law>(loops: &Loops, task: &Task<L>, base: Gains) -> Option<Candidate> {
    let mut best = None;
    for times in POSITION.derivative_times {
        let time_s = times * task.plant.tau_s;
        let pd = |p: f64| Gains { position: Some(Pid { p, i: 0.0, d: p * time_s }), ..base };
        let Some(highest) = ascend(loops, task, 2_000.0, pd) else { continue };
        for share in POSITION.shares {
            best = better(best, |most| candidate(task, pd(highest * share), most));
        }
    }
    best
}

/// Small steps in gains, one by one and together, as long as they pay.
fn refine<L: Law>(loops: &Loops, task: &Task<L>, mut best: Candidate, how: &Refinement) -> Candidate {
    let mut step = how.first_step;
    for _ in 0..POSITION.rounds {
        for (moved, by) in how.moves.iter().flat_map(|moved| [(*moved, step), (*moved, 1.0 / step)]) {
            // What pays once may pay again.
            for _ in 0..how.repeats {
                let Some(gains) = moved.of(&best.gains, by) else { break };
                if loops.within(task, &gains).is_none() || !loops.stable(task, &gains) {
                    break;
                }
                let Some(other) = candidate(task, gains, best.cost) else { break };
                best = other;
            }
        }
        step = step.sqrt();
    }
    best
}

/// Gains that are moved together.
#[derive(Clone, Copy)]
struct Move {
    position: (bool, bool, bool),
    velocity: (bool, bool),
}

impl Move {
    const fn position(p: bool, i: bool, d: bool) -> Self {
        Self { position: (p, i, d), velocity: (false, false) }
    }

    const fn velocity(p: bool, i: bool) -> Self {
        Self { position: (false, false, false), velocity: (p, i) }
    }

    /// Gains moved by a factor; `None` where that changes nothing.
    fn of(self, gains: &Gains, by: f64) -> Option<Gains> {
        let factor = |is_moved: bool| if is_moved { by } else { 1.0 };
        let (p, i, d) = self.position;
        let Pid { p: kp, i: ki, d: kd } = gains.position?;
        let position = Pid { p: factor(p) * kp, i: factor(i) * ki, d: factor(d) * kd };
        let (vp, vi) = self.velocity;
        let velocity =
            Pid { p: factor(vp) * gains.velocity.p, i: factor(vi) * gains.velocity.i, ..gains.velocity };
        let max_integral = gains.max_integral / factor(i && ki > 0.0);
        let moved = Gains { position: Some(position), velocity, max_integral, ..*gains };
        (moved != *gains).then_some(moved)
    }
}

/// Gains that cost less than `most`.
fn candidate<L: Law>(task: &Task<L>, gains: Gains, most: f64) -> Option<Candidate> {
    let gains = task.law.rounded(&gains, task.qpps);
    let test = |plant: &PlantModel, law: &L, most: f64| {
        position_test_within(plant, law, task.lag, &gains, task.qpps, most)
    };
    let cost_of = |score: Score| score.cost(POSITION_OVERSHOOT);
    // Where friction stops a motor is a matter of chance, and what it leaves of a move is much of the cost: gains that come out well by it alone do not on the machine.
    let others = doubtful(task, &gains);
    let tests = (1 + others.len()) as f64;
    let (score, end) = test(&task.plant, &task.law, tests * most)?;
    let step = position_step(task.plant.gain_counts_per_s, task.plant.tau_s);
    let allowed = (POSITION.late_distance_cap * step).max(POSITION.late_counts_cap);
    let creeping = (POSITION.late_distance_cost * (end.range_counts / allowed - 1.0))
        .clamp(0.0, POSITION.late_distance_most);
    let raised = |cost: f64, overshoot: f64| {
        let excess = (overshoot - POSITION.overshoot_cap).max(0.0)
            + 0.5 * (end.duty.0.max(end.duty.1) - POSITION.late_duty_cap).max(0.0);
        cost / tests * (1.0 + 50.0 * excess) * (1.0 + creeping)
    };
    // What follows only adds to it.
    let mut sum = cost_of(score);
    for plant in &others {
        let left = most / raised(1.0, score.overshoot) - sum;
        sum += cost_of(test(plant, &task.law, left)?.0);
    }
    if raised(sum, score.overshoot) >= most {
        return None;
    }
    let held = other_windup(&task.law)
        .filter(|_| gains.velocity.i > 0.0)
        .and_then(|law| test(&task.plant, &law, f64::INFINITY))
        .map_or(0.0, |(held, _)| held.overshoot);
    let cost = raised(sum, score.overshoot.max(held));
    (cost < most).then_some(Candidate { gains, score, cost })
}

/// The motor with as much less and more friction as it may have; none where that is known, or where an integral of the speed overcomes it.
fn doubtful<L: Law>(task: &Task<L>, gains: &Gains) -> Vec<PlantModel> {
    let by = POSITION.friction_deviations * task.sd_coulomb_duty;
    if by <= 0.0 || gains.velocity.i > 0.0 {
        return Vec::new();
    }
    let with = |by: f64| PlantModel { coulomb_duty: (task.plant.coulomb_duty + by).max(0.0), ..task.plant };
    vec![with(-by), with(by)]
}

/// Within the backlash nothing can be held; beyond it two counts keep the rounding quiet.
pub(crate) fn deadzone<L: Law>(task: &Task<L>) -> f64 {
    if task.backlash_counts > 0.0 { (task.backlash_counts + POSITION.backlash_margin).round() } else { 0.0 }
}

/// The task of a loop that acts on the duty directly: its sensitivity is bounded with some more lag, for the winding and a springy
/// shaft, which a difference of one tick reaches where a filtered speed does not. Where gains are raised on the machine, that finds most of it.
fn direct<L: Law>(task: &Task<L>) -> Task<L> {
    let facts = task.law.facts();
    let share = if facts.has_duty { POSITION.raised_share } else { 1.0 };
    let delay_ticks = task.worst_lag.delay_ticks + share * facts.unmodelled_s / task.law.tick_s();
    Task { worst_lag: Lag { delay_ticks, ..task.worst_lag }, ..*task }
}
