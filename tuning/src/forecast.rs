//! What gains do on a model: step, load step, figures, and the loop over frequency.
//!
//! Pure and quick, so that a slider or a typed gain redraws its prediction at once; nothing is sent and no motor moves.

use crate::design::Task;
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, PlantModel};
use crate::score::{LOAD_STEP_DUTY, Score, VELOCITY_STEP, horizon_s, position_step};
use crate::ticks::{Setpoint, TickLoop};

/// One point of a predicted response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reply {
    /// Time from the step, s.
    pub t: f64,
    /// Counts/s or counts.
    pub value: f64,
    /// Duty, -1 to 1.
    pub duty: f64,
}

/// What gains promise.
#[derive(Clone, Debug, PartialEq)]
pub struct Forecast {
    /// Whether the loop is stable on the model, with the likely lag and with the largest that is likely.
    pub is_stable: bool,
    /// Where the step begins and where it goes: counts/s, or counts.
    pub step: (f64, f64),
    /// The response to the step.
    pub after_step: Vec<Reply>,
    /// What a load of 15 % of the stall torque does to it, from the moment it comes.
    pub after_load: Vec<Reply>,
    /// How near it has to stay to have settled, over the step.
    pub band: f64,
    /// Overshoot over the step.
    pub overshoot: f64,
    /// Time to stay within 5 % (velocity) or 2 % (position), s; `None` if it never does in the time that is looked at.
    pub settling_s: Option<f64>,
    /// Farthest that the load drives it off, over the step.
    pub load_dip: f64,
    /// Maximum sensitivity.
    pub ms: f64,
    /// Root mean square of the duty that the rounding of counts alone causes.
    pub noise_duty: f64,
    /// The figures as the designs score them.
    pub score: Score,
}

impl Forecast {
    /// Time to stay within a share of the usual band, s; all that is looked at where it never does.
    pub(crate) fn settled_within(&self, share: f64) -> f64 {
        let (from, to) = self.step;
        let most = share * self.band * (to - from).abs();
        self.after_step.iter().rfind(|reply| (to - reply.value).abs() > most).map_or(0.0, |last| last.t)
    }
}

/// The loop at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopPoint {
    /// Hz.
    pub hz: f64,
    /// Real and imaginary part of the open loop.
    pub open: (f64, f64),
}

impl LoopPoint {
    /// Gain of the open loop, dB.
    #[must_use]
    pub fn gain_db(&self) -> f64 {
        20.0 * self.open.0.hypot(self.open.1).log10()
    }

    /// Phase of the open loop, degrees, -180 to 180.
    #[must_use]
    pub fn phase_deg(&self) -> f64 {
        self.open.1.atan2(self.open.0).to_degrees()
    }

    /// Magnitude of the sensitivity, 1 / |1 + L|.
    #[must_use]
    pub fn sensitivity(&self) -> f64 {
        (1.0 + self.open.0).hypot(self.open.1).recip()
    }
}

/// What `gains` would do.
#[must_use]
pub fn forecast<L: Law>(task: &Task<L>, gains: &Gains) -> Forecast {
    let (from, to) = usual_step(&task.plant, gains);
    let tick_s = task.law.tick_s();
    let course = course(task, gains, (from, to), horizon_s(task.plant.tau_s), false);
    let (ticks, score, step) = (course.after_step.len(), course.score, to - from);
    let Course { after_step, after_load, band, .. } = course;
    let plant = loop_of(task);
    let margins = plant.margins(gains, task.qpps);
    let worst = LoopPlant::new(DiscretePlant::of(&task.plant, tick_s), &task.law, task.worst_lag);
    Forecast {
        is_stable: plant.spectral_radius(gains, task.qpps) < 1.0
            && worst.spectral_radius(gains, task.qpps) < 1.0,
        step: (from, to),
        band,
        overshoot: score.overshoot,
        settling_s: (score.settling_s < (ticks - 1) as f64 * tick_s).then_some(score.settling_s),
        load_dip: after_load.iter().map(|reply| (to - reply.value).abs()).fold(0.0, f64::max) / step.abs(),
        ms: margins.ms,
        noise_duty: margins.noise_duty * task.noise_factor,
        score,
        after_step,
        after_load,
    }
}

/// The step by which gains are judged: from where, to where; counts/s, or counts.
pub(crate) fn usual_step(plant: &PlantModel, gains: &Gains) -> (f64, f64) {
    let top = plant.gain_counts_per_s;
    if gains.position.is_some() {
        (0.0, position_step(top, plant.tau_s))
    } else {
        (VELOCITY_STEP.0 * top, VELOCITY_STEP.1 * top)
    }
}

/// What a step and then a load make of a loop.
pub(crate) struct Course {
    after_step: Vec<Reply>,
    after_load: Vec<Reply>,
    band: f64,
    pub(crate) score: Score,
}

/// A step from one value to another, and after `horizon_s` a load for as long again; where it is `held` first, the loop has had as long at the first
/// value to make up for a load that is there already.
pub(crate) fn course<L: Law>(
    task: &Task<L>,
    gains: &Gains,
    (from, to): (f64, f64),
    horizon_s: f64,
    held: bool,
) -> Course {
    let is_position = gains.position.is_some();
    let tick_s = task.law.tick_s();
    let ticks = (horizon_s / tick_s) as usize;
    let mut twin = TickLoop::new(task.plant, task.law, task.lag, *gains, task.qpps);
    if !is_position {
        twin.start_steady(from);
    }
    let setpoint =
        |value: f64| if is_position { Setpoint::Position(value, task.qpps) } else { Setpoint::Speed(value) };
    for _ in 0..if held { ticks } else { 0 } {
        twin.tick(setpoint(from), 0.0);
    }
    let mut run = |load: f64| -> Vec<Reply> {
        let reply = |n: usize| {
            let duty = twin.tick(setpoint(to), load);
            let value = if is_position { twin.motion.position } else { twin.motion.speed };
            Reply { t: (n + 1) as f64 * tick_s, value, duty }
        };
        (0..ticks).map(reply).collect()
    };
    let (after_step, after_load) = (run(0.0), run(LOAD_STEP_DUTY));
    let step = to - from;
    let errors = |replies: &[Reply]| -> Vec<f64> { replies.iter().map(|reply| to - reply.value).collect() };
    let band = if is_position { 0.02_f64.max(3.0 / step) } else { 0.05 };
    let score = Score::of(&errors(&after_step), &errors(&after_load), tick_s, step, band);
    Course { after_step, after_load, band, score }
}

/// The open loop over frequency, up to half the firmware's loop rate.
#[must_use]
pub fn frequency_response<L: Law>(task: &Task<L>, gains: &Gains) -> Vec<LoopPoint> {
    let points = loop_of(task).open_loop(gains, task.qpps);
    points
        .into_iter()
        .map(|(omega, open)| LoopPoint { hz: omega / std::f64::consts::TAU, open: (open.re, open.im) })
        .collect()
}

fn loop_of<L: Law>(task: &Task<L>) -> LoopPlant {
    LoopPlant::new(DiscretePlant::of(&task.plant, task.law.tick_s()), &task.law, task.lag)
}
