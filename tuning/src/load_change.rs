//! What change of its load a loop stands: inertia, friction and a steady load are changed on the identified model, and the gains stay.
//!
//! The model's time constant is `J R / (kt ke)`: it goes with the inertia J, and the gain does not. A lighter load makes a velocity loop quicker until
//! its lag makes it oscillate; a heavier one takes phase from a loop with an integral. Springs and play are not in the model: where a load hangs on
//! one, these figures hold for what the motor feels of it.

use crate::design::Task;
use crate::forecast::{course, frequency_response, usual_step};
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, PlantModel};
use crate::report::{Report, Verdict};
use crate::score::horizon_s;
use crate::stability::StabilityMargins;
use crate::thresholds::thresholds;
use crate::trajectory::Trajectory;
use serde::Serialize;

/// Multiples of the inertia that are looked at one by one.
const INERTIAS: [f64; 9] = [0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0];
/// Multiples of the dry friction.
const FRICTIONS: [f64; 3] = [0.0, 2.0, 4.0];
/// Steady loads against the step, as duties: the load step of all forecasts, and twice that.
const LOADS_DUTY: [f64; 2] = [crate::score::LOAD_STEP_DUTY, 2.0 * crate::score::LOAD_STEP_DUTY];
thresholds! {
    /// Which change of inertia a loop counts as standing, and how it is looked for.
    pub LOAD_CHANGE: Thresholds {
        /// Highest maximum sensitivity (Ms) of a loop that stands a change (Astrom and Murray, "Feedback Systems", 2nd edition, section 10.3: 1.2 to 2 are reasonable).
        most_ms: f64 = 2.0,
        /// Ratio from one inertia to the next when the limits of the inertia are looked for.
        ratio: f64 = std::f64::consts::SQRT_2,
        /// Most such steps to either side: from an eighth to 8 times the inertia.
        steps: usize = 6,
        /// How often the last of these steps is then halved.
        halvings: usize = 10,
    }
}

/// A change of the load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Inertia of all that turns, rotor included, over that of the run.
    pub inertia: f64,
    /// Dry friction over that of the run.
    pub friction: f64,
    /// A steady load against the step, as duty.
    pub load_duty: f64,
}

impl Change {
    const NONE: Self = Self { inertia: 1.0, friction: 1.0, load_duty: 0.0 };

    fn of(self, plant: &PlantModel) -> PlantModel {
        PlantModel {
            tau_s: self.inertia * plant.tau_s,
            coulomb_duty: self.friction * plant.coulomb_duty,
            load_duty: plant.load_duty + self.load_duty,
            ..*plant
        }
    }

    /// In a few words.
    #[must_use]
    pub fn name(&self) -> String {
        if self.friction != 1.0 {
            format!("friction x {}", self.friction)
        } else if self.load_duty != 0.0 {
            format!("load {:.0} % duty", 100.0 * self.load_duty)
        } else {
            format!("inertia x {}", self.inertia)
        }
    }
}

/// What the loop does after a change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Changed {
    /// The change.
    pub change: Change,
    /// Whether the loop is stable; the other figures mean nothing where it is not.
    pub is_stable: bool,
    /// Maximum sensitivity.
    pub ms: f64,
    /// Phase margin, degrees; `None` where the open loop never falls to gain 1.
    pub phase_deg: Option<f64>,
    /// Overshoot of the step that the unchanged loop is judged by, over the step.
    pub overshoot: f64,
    /// Time until that step stays within 5 % (velocity) or 2 % (position), s; `None` if it does not in the time that is looked at.
    pub settling_s: Option<f64>,
}

impl Changed {
    /// Change, Ms, phase margin, overshoot, settling, as [`HEADS`] names them.
    #[must_use]
    pub fn cells(&self) -> [String; 5] {
        if !self.is_stable {
            return [self.change.name(), "unstable".into(), String::new(), String::new(), String::new()];
        }
        [
            self.change.name(),
            format!("{:.2}", self.ms),
            self.phase_deg.map_or_else(|| "none".into(), |deg| format!("{deg:.0} deg")),
            format!("{:.0} %", 100.0 * self.overshoot),
            self.settling_s.map_or_else(|| "never".into(), |s| format!("{:.0} ms", 1e3 * s)),
        ]
    }
}

/// Heads of the columns of [`Changed::cells`].
pub const HEADS: [&str; 5] = ["load change", "Ms", "phase margin", "overshoot", "settling"];

/// Multiples of the inertia between which something holds; `None` where it holds as far as was looked, an eighth or 8 times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct InertiaRange {
    /// The lowest.
    pub low: Option<f64>,
    /// The highest.
    pub high: Option<f64>,
}

impl InertiaRange {
    /// Walks from the unchanged inertia to either side.
    fn where_it_holds(holds: impl Fn(f64) -> bool) -> Self {
        Self { low: edge(&holds, LOAD_CHANGE.ratio.recip()), high: edge(&holds, LOAD_CHANGE.ratio) }
    }

    fn contains(&self, inertia: f64) -> bool {
        self.low.is_none_or(|low| inertia >= low) && self.high.is_none_or(|high| inertia <= high)
    }

    /// In words.
    #[must_use]
    pub fn text(&self) -> String {
        let most = LOAD_CHANGE.ratio.powi(LOAD_CHANGE.steps as i32);
        let times = |value: f64| {
            let digits = if value < 1.0 { 2 } else { 1 };
            format!("{value:.digits$}")
        };
        match (self.low, self.high) {
            (Some(low), Some(high)) => format!("{} to {} times", times(low), times(high)),
            (Some(low), None) => format!("{} to over {most:.0} times", times(low)),
            (None, Some(high)) => format!("under {} to {} times", times(most.recip()), times(high)),
            (None, None) => format!("under {} to over {most:.0} times", times(most.recip())),
        }
    }
}

/// The largest steady load that a loop still makes up for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HeldLoad {
    /// At which speed: the top one of the run's [`Trajectory`], counts/s.
    pub speed_counts_per_s: f64,
    /// The load, as duty.
    pub duty: f64,
    /// The same over the torque that full duty gives at a standstill, a current limit aside.
    pub share_of_stall: f64,
    /// How far the loop stays behind under it, counts/s or counts; 0 where an integral makes up for it.
    pub offset: f64,
}

/// What change of its load a loop stands.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadChange {
    /// Changes one by one: inertia, friction, load.
    pub changed: Vec<Changed>,
    /// Where the loop stays stable.
    pub stable: InertiaRange,
    /// Where its sensitivity stays up to `most_ms`; `None` where it is above that already.
    pub calm: Option<InertiaRange>,
    /// The largest steady load; `None` where the motor has nothing to spare.
    pub held: Option<HeldLoad>,
}

impl LoadChange {
    /// What `gains` stand on the model of `task`; `None` where the loop is not stable as it is.
    #[must_use]
    pub fn of<L: Law>(task: &Task<L>, gains: &Gains) -> Option<Self> {
        let stable = stable_range(task, gains)?;
        let ms = |inertia: f64| loop_with(task, inertia).margins(gains, task.qpps).ms;
        let is_calm = |inertia: f64| stable.contains(inertia) && ms(inertia) <= LOAD_CHANGE.most_ms;
        let changed = changes(task, gains).map(|change| changed(task, gains, change, &stable)).collect();
        Some(Self {
            changed,
            calm: is_calm(1.0).then(|| InertiaRange::where_it_holds(is_calm)),
            held: held(task, gains),
            stable,
        })
    }

    /// What the gains of a run stand; `None` where it was refused.
    #[must_use]
    pub fn of_run<L: Law>(report: &Report<L>) -> Option<Self> {
        let (task, design) = (report.task?, report.design?);
        (report.verdict != Verdict::Refused).then(|| Self::of(&task, &design.gains)).flatten()
    }

    /// Name, value with its unit, and what it means, a row each.
    #[must_use]
    pub fn rows(&self) -> Vec<(&'static str, String, String)> {
        let calm = self.calm.map_or_else(|| "nowhere".to_owned(), |calm| calm.text());
        let mut rows = vec![
            (
                "inertia, Ms up to 2",
                calm,
                "how the load may change, rotor included, for Ms to stay there".to_owned(),
            ),
            ("inertia, stable", self.stable.text(), "beyond, the loop oscillates on the model".to_owned()),
        ];
        if let Some(held) = self.held {
            let stall = 100.0 * held.share_of_stall;
            let behind =
                if held.offset == 0.0 { String::new() } else { format!(", {:.0} behind", held.offset) };
            rows.push((
                "steady load held",
                format!("{:.0} % duty", 100.0 * held.duty),
                format!(
                    "{stall:.0} % of the stall torque, at {:.0} counts/s{behind}",
                    held.speed_counts_per_s
                ),
            ));
        }
        rows
    }
}

/// The changes that are looked at; friction and loads that leave no duty for the step are left out.
fn changes<L: Law>(task: &Task<L>, gains: &Gains) -> impl Iterator<Item = Change> {
    let plant = task.plant;
    // A position is held at rest, so that the load alone has to be carried there.
    let speed = if gains.position.is_some() { 0.0 } else { usual_step(&plant, gains).1 };
    let inertias = INERTIAS.map(|inertia| Change { inertia, ..Change::NONE });
    let frictions = FRICTIONS.map(|friction| Change { friction, ..Change::NONE });
    let loads = LOADS_DUTY.map(|load_duty| Change { load_duty, ..Change::NONE });
    let is_carried = move |change: &Change| change.of(&plant).spare_load_duty(speed) > 0.0;
    inertias.into_iter().chain(frictions.into_iter().chain(loads).filter(is_carried))
}

fn changed<L: Law>(task: &Task<L>, gains: &Gains, change: Change, stable: &InertiaRange) -> Changed {
    let other = Task { plant: change.of(&task.plant), ..*task };
    let margins = StabilityMargins::of(&frequency_response(&other, gains));
    let horizon_s = horizon_s(other.plant.tau_s.max(task.plant.tau_s));
    let score =
        course(&other, gains, usual_step(&task.plant, gains), horizon_s, change.load_duty != 0.0).score;
    Changed {
        change,
        is_stable: stable.contains(change.inertia),
        ms: margins.ms,
        phase_deg: margins.phase_deg,
        overshoot: score.overshoot,
        settling_s: (score.settling_s < horizon_s - 2.0 * task.law.tick_s()).then_some(score.settling_s),
    }
}

fn loop_with<L: Law>(task: &Task<L>, inertia: f64) -> LoopPlant {
    let plant = Change { inertia, ..Change::NONE }.of(&task.plant);
    LoopPlant::new(DiscretePlant::of(&plant, task.law.tick_s()), &task.law, task.lag)
}

/// Where the loop is stable; `None` where it is not even as it is.
fn stable_range<L: Law>(task: &Task<L>, gains: &Gains) -> Option<InertiaRange> {
    let holds = |inertia: f64| loop_with(task, inertia).exact_spectral_radius(gains, task.qpps) < 1.0;
    holds(1.0).then(|| InertiaRange::where_it_holds(holds))
}

/// The last multiple, going from 1 by `ratio`, at which something still holds.
fn edge(holds: &impl Fn(f64) -> bool, ratio: f64) -> Option<f64> {
    let mut inside = 1.0;
    let mut outside = (0..LOAD_CHANGE.steps).find_map(|_| {
        let next = inside * ratio;
        let beyond = !holds(next);
        if !beyond {
            inside = next;
        }
        beyond.then_some(next)
    })?;
    for _ in 0..LOAD_CHANGE.halvings {
        let middle = f64::sqrt(inside * outside);
        if holds(middle) { inside = middle } else { outside = middle }
    }
    Some(inside)
}

fn held<L: Law>(task: &Task<L>, gains: &Gains) -> Option<HeldLoad> {
    let speed_counts_per_s = Trajectory::of(&task.plant)?.speed_counts_per_s;
    let duty = task.plant.spare_load_duty(speed_counts_per_s);
    (duty > 0.0).then(|| HeldLoad {
        speed_counts_per_s,
        duty,
        share_of_stall: duty / (1.0 - task.plant.sag),
        offset: offset(task, gains, duty),
    })
}

/// How far a loop is driven off by a steady load: what the integrals do not carry is left to the proportional gains.
fn offset<L: Law>(task: &Task<L>, gains: &Gains, load_duty: f64) -> f64 {
    let velocity = gains.velocity;
    if velocity.i != 0.0 || gains.velocity_sum != 0.0 {
        return 0.0;
    }
    let Some(position) = gains.position else {
        // v = K (ff r / Q + P (r - v) / Q - load): the load alone takes K load / (1 + K P / Q).
        let gain = task.plant.gain_counts_per_s;
        return gain * load_duty / (1.0 + gain * velocity.p / task.qpps);
    };
    // Duty over the speed that the position loop asks for.
    let simple = velocity.p == 0.0 && velocity.d == 0.0;
    let forward = if simple { 1.0 } else { task.law.feed_forward() + velocity.p } / task.qpps;
    let left = load_duty - position.i * gains.max_integral * forward;
    if left <= 0.0 { 0.0 } else { left / (position.p * forward) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forecast::forecast;
    use crate::model::{Lag, Pid};
    use crate::plain_law::PlainLaw;
    use crate::proposal::design_for;
    use crate::request::Method;
    use crate::ticks::{Setpoint, TickLoop};
    use nalgebra::Complex;

    /// A motor of gain QPPS under a loop at 300 Hz.
    fn task(tau_s: f64, lag: Lag) -> Task<PlainLaw> {
        let plant = PlantModel {
            gain_counts_per_s: 30_000.0,
            tau_s,
            coulomb_duty: 0.05,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        };
        Task::new(plant, PlainLaw::default(), lag, 30_000.0)
    }

    fn velocity(p: f64, i: f64) -> Gains {
        Gains { velocity: Pid { p, i, d: 0.0 }, ..Gains::default() }
    }

    /// Sensitivity of a P loop on a speed that is an integral of the duty by `slope` a tick, and is measured as the mean of a tick:
    /// `L = slope (z + 1) / (2 z (z - 1))`.
    fn integral_ms(slope: f64) -> f64 {
        let one = Complex::new(1.0, 0.0);
        (1..20_000)
            .map(|n| Complex::from_polar(1.0, std::f64::consts::PI * f64::from(n) / 20_000.0))
            .map(|z| (one + slope * (z + one) / (2.0 * z * (z - one))).norm().recip())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_p_loop_on_a_slow_motor_is_unstable_and_has_ms_2_at_the_inertia_of_the_closed_form() {
        // The poles of `z (z - 1) + g (z + 1) / 2`, g = P T / tau, leave the unit circle at g = 2.
        let (p, tau_s) = (600.0, 5.0);
        let found = LoadChange::of(&task(tau_s, Lag::default()), &velocity(p, 0.0)).expect("it is stable");
        let slope = p / 300.0 / tau_s;
        let low = found.stable.low.expect("a light load makes it unstable");
        assert!((low / (slope / 2.0) - 1.0).abs() < 0.01, "{low}");
        assert_eq!(found.stable.high, None, "{found:?}");
        let (mut calm, mut rough) = (slope, 2.0);
        for _ in 0..50 {
            let middle = 0.5 * (calm + rough);
            if integral_ms(middle) < LOAD_CHANGE.most_ms { calm = middle } else { rough = middle }
        }
        let low = found.calm.and_then(|calm| calm.low).expect("Ms is 2 before that");
        assert!((low / (slope / calm) - 1.0).abs() < 0.01, "{low}");
        for row in found.changed.iter().filter(|row| row.ms < 3.0) {
            let wanted = integral_ms(slope / row.change.inertia);
            assert!((row.ms / wanted - 1.0).abs() < 0.01, "{row:?}: {wanted}");
        }
    }

    #[test]
    fn a_delay_of_no_half_and_a_whole_tick_limits_the_inertia_as_the_closed_form_says() {
        let low = |delay_ticks: f64| {
            let task = task(1.0, Lag { filter_s: 0.0, delay_ticks });
            LoadChange::of(&task, &velocity(150.0, 0.0))
                .and_then(|found| found.stable.low)
                .expect("it has one")
        };
        // `g (z + 1) / (2 z (z - 1))` with the delay behind it is -1 at g = 2, at 4 / 3 where half of each duty comes a tick later, and at
        // 2 tan(pi / 8) where all of it does.
        for (delay_ticks, slope) in
            [(0.0, 2.0), (0.5, 4.0 / 3.0), (1.0, 2.0 * (std::f64::consts::PI / 8.0).tan())]
        {
            let (found, wanted) = (low(delay_ticks), 150.0 / 300.0 / slope);
            assert!((found / wanted - 1.0).abs() < 0.015, "{delay_ticks}: {found} is not {wanted}");
        }
    }

    #[test]
    fn the_loop_as_it_is_has_the_figures_of_its_forecast_and_every_margin_is_an_angle() {
        for method in [Method::Velocity, Method::Pd, Method::Pid, Method::Piv] {
            let task = task(0.1, Lag { filter_s: 0.004, delay_ticks: 1.0 });
            let gains = design_for(method, &task).expect("it has a design").gains;
            let (found, shown) = (LoadChange::of(&task, &gains).expect("stable"), forecast(&task, &gains));
            let own = found.changed.iter().find(|row| row.change == Change::NONE).expect("it is a row");
            assert!(own.is_stable && (own.ms - shown.ms).abs() < 1e-9, "{method:?}: {own:?}");
            assert_eq!((own.overshoot, own.settling_s), (shown.overshoot, shown.settling_s), "{method:?}");
            for row in found.changed.iter().filter(|row| row.is_stable) {
                assert!(row.phase_deg.is_some_and(|deg| (0.0..180.0).contains(&deg)), "{method:?}: {row:?}");
            }
            let calm = found.calm.expect("a design is calm");
            assert!(calm.contains(0.6), "half the inertia was looked at by the design: {method:?} {calm:?}");
        }
    }

    #[test]
    fn the_largest_load_is_held_on_the_model_and_a_little_more_is_not() {
        // 0.85 - 0.05 = 0.8 of duty, of which 0.6 goes into the trajectory's speed: 1 - 0.6 - 0.05 is left.
        let task = task(0.1, Lag::default());
        for (gains, offset) in [(velocity(3.0, 20.0), 0.0), (velocity(3.0, 0.0), 30_000.0 * 0.35 / 4.0)] {
            let held = held(&task, &gains).expect("it has duty to spare");
            assert!((held.speed_counts_per_s - 18_000.0).abs() < 1e-6, "{held:?}");
            assert!((held.duty - 0.35).abs() < 1e-9 && (held.share_of_stall - 0.35).abs() < 1e-9);
            assert!((held.offset - offset).abs() < 1e-6, "{held:?}");
        }
        let behind = |gains: Gains, load: f64| {
            let mut twin = TickLoop::new(task.plant, task.law, task.lag, gains, task.qpps);
            twin.start_steady(18_000.0);
            (0..3_000).for_each(|_| {
                twin.tick(Setpoint::Speed(18_000.0), load);
            });
            18_000.0 - twin.motion.speed
        };
        assert!(behind(velocity(3.0, 20.0), 0.34).abs() < 60.0);
        assert!(behind(velocity(3.0, 20.0), 0.36) > 200.0);
        // Friction is not fed forward, so that a loop without an integral is behind by it besides.
        let with_friction = 30_000.0 * (0.2 + 0.05) / 4.0;
        assert!((behind(velocity(3.0, 0.0), 0.2) - with_friction).abs() < 150.0);
    }

    #[test]
    fn a_position_loop_is_driven_off_by_what_its_integral_does_not_carry() {
        let task = task(0.1, Lag::default());
        let of = |position: Pid, max_integral: f64, velocity: Pid| {
            let gains = Gains { velocity, position: Some(position), max_integral, ..Gains::default() };
            offset(&task, &gains, 0.1)
        };
        let (p, pid) = (Pid { p: 50.0, i: 0.0, d: 0.0 }, Pid { p: 50.0, i: 100.0, d: 0.0 });
        // 0.1 x 30000 counts/s over 50 per s; an integral of at most 10 counts x s gives 1000 counts/s of that.
        assert!((of(p, 0.0, Pid::default()) - 60.0).abs() < 1e-9);
        assert!((of(pid, 10.0, Pid::default()) - 40.0).abs() < 1e-9);
        assert_eq!(of(pid, 100.0, Pid::default()), 0.0);
        // Under a velocity P of 4, with all of the feed-forward, it takes a fifth; under an integral nothing.
        assert!((of(p, 0.0, Pid { p: 4.0, i: 0.0, d: 0.0 }) - 12.0).abs() < 1e-9);
        assert_eq!(of(p, 0.0, Pid { p: 4.0, i: 1.0, d: 0.0 }), 0.0);
    }

    #[test]
    fn a_current_limit_and_a_load_that_is_there_take_from_what_can_be_held() {
        let plant = task(0.1, Lag::default()).plant;
        assert!((plant.spare_load_duty(0.0) - 0.95).abs() < 1e-12);
        let pulled = PlantModel { load_duty: -0.1, sag: 0.1, ..plant };
        assert!((pulled.spare_load_duty(-15_000.0) - (0.45 - 0.05 - 0.1)).abs() < 1e-12);
        let limited = PlantModel { drive_limit: Some(0.4), ..plant };
        assert!((limited.spare_load_duty(15_000.0) - (0.4 - 0.0125 - 0.05)).abs() < 1e-12);
        assert!(plant.spare_load_duty(29_000.0) < 0.0);
    }

    #[test]
    fn a_loop_that_is_unstable_as_it_is_stands_nothing() {
        assert_eq!(LoadChange::of(&task(0.1, Lag::default()), &velocity(4_000.0, 0.0)), None);
    }

    #[test]
    fn ranges_say_where_they_end_and_where_nothing_was_found() {
        let text = |low, high| InertiaRange { low, high }.text();
        assert_eq!(text(Some(0.123), Some(6.21)), "0.12 to 6.2 times");
        assert_eq!(text(Some(0.5), None), "0.50 to over 8 times");
        assert_eq!(text(None, Some(3.0)), "under 0.12 to 3.0 times");
    }
}
