//! What the integral of a velocity loop does while its duty is cut.
//!
//! Two ways are common (Astrom and Hagglund, "PID Controllers: Theory, Design, and Tuning", 2nd edition, section 3.5): the integral follows what is left of the duty, or it stands still. A start from rest asks for more
//! duty than there is, and the duty that is read back in the meantime, and as long as the integral takes to forget it, is another one under each.

use crate::cause::Cause;
use crate::closed_loop_record::{ClosedLoopRecord, StartMisfit, Stretch, noise};
use crate::design::Task;
use crate::experiment::rest;
use crate::experiment_guard::ExperimentGuard;
use crate::lag::LagFit;
use crate::law::{Law, Windup};
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, Pid, PlantModel};
use crate::thresholds::thresholds;
use crate::ticks::TickLoop;

thresholds! {
    /// How the two are told apart, and when a start is made for it.
    WINDUP: Thresholds {
        /// Highest misfit of the duties of a start, as a mean of squares over variances, at which a law is believed: on 515 starts of the bench, of another make and of a foreign
        /// controller the better of both laws has 0.1 to 3 in the median of each, and up to 40 where something else was wrong.
        most_misfit: f64 = 4.0,
        /// How much worse the other law has to be, as a factor of the misfit. Of 294 starts of own motors whose current is not limited 92 are told apart, none wrongly.
        apart: f64 = 1.5,
        /// The same of a motor whose current is limited, for an integral that follows the duty and for one that is held: tracking loops whose current limit lets the current past it for a
        /// while look as if they held it. Of 635 starts of own ones 162 are told apart, three wrongly; with 1.5 for both 237, 32 of them wrongly.
        apart_limited: (f64, f64) = (2.0, 4.0),
        /// How much worse it has to be at least: three standard deviations.
        surely: f64 = 9.0,
        /// Time constant of the motor up to which one more start is made where the first did not ask for much more than full duty, in seconds: of a slower one it takes seconds, and its loops ask
        /// for that at the first already.
        quick_s: f64 = 0.3,
        /// The duty that it asks for, as a multiple of full: at the least, and at the most, where the gains make that of the highest speed.
        asked: (f64, f64) = (1.3, 1.8),
        /// A first start that asked for more than this was such a one already.
        asked_before: f64 = 1.4,
        /// Highest maximum sensitivity (Ms) of the gains of that start, with the longest lag that is still likely: a loop whose careful gains ask for less than that takes as much more of the
        /// proportional part for it as it takes. Of 14 coreless motors of the foreign controller (seeds 811 to 817) seven made no start otherwise.
        most_ms: f64 = 1.6,
        /// The highest speed that it goes to, as a share of full speed.
        most_speed: f64 = 0.95,
        /// How long it is watched: at the least, in seconds, since the integral of a careful loop forgets within a tenth or two, and in time constants of the motor, half of one of which the
        /// duty is full.
        watched: (f64, f64) = (0.2, 2.0),
    }
}

/// What it does, by the records of the lag's measurement, and by one more start where they tell nothing, it may be made and the motor is quick. The motor is braked at the end.
pub(crate) fn windup_of<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    task: &Task<L>,
    found: &LagFit,
    (stretches, may_start): (&[Stretch], bool),
) -> Result<Windup, Cause> {
    let plant = PlantModel { tau_s: task.plant.tau_s * found.tau_scale, ..task.plant };
    let task = &Task { plant, lag: found.lag, ..*task };
    let told = |stretch: &Stretch| told_by(task, &stretch.gains, &stretch.record, noise(&stretch.record));
    let told = stretches.iter().rev().map(told).find(|told| *told != Windup::Open);
    let can_be_told = task.law.with_windup(Windup::Held).is_some() && may_start;
    if told.is_some() || !can_be_told || plant.tau_s > WINDUP.quick_s {
        return Ok(told.unwrap_or_default());
    }
    let asked = |gains: &Gains, speed: f64| (task.law.feed_forward() + gains.velocity.p) * speed / task.qpps;
    let asked_before = |stretch: &Stretch| {
        let first = stretch.record.setpoints.first();
        first.is_some_and(|first| asked(&stretch.gains, first.1) > WINDUP.asked_before)
    };
    if stretches.iter().any(asked_before) {
        return Ok(Windup::Open);
    }
    let Some(Stretch { record, gains, .. }) = stretches.last() else { return Ok(Windup::Open) };
    let steady_duty = noise(record);
    let Some((firm, louder)) = firm_enough(task, gains, found) else { return Ok(Windup::Open) };
    rest(guard, plant.tau_s, task.qpps)?;
    let registers = guard.write_gains(&task.law, &firm, task.qpps)?;
    let firm = task.law.gains(&registers, task.qpps, false);
    let share = (WINDUP.asked.1 / asked(&firm, task.qpps)).min(WINDUP.most_speed);
    let (least_s, time_constants) = WINDUP.watched;
    let from_s = guard.now_s();
    guard.poll(true)?;
    guard.speed(share * task.qpps)?;
    guard.poll_closely_for(least_s.max(time_constants * plant.tau_s))?;
    let to_s = guard.now_s();
    guard.duty(0.0)?;
    guard.write_gains(&task.law, gains, task.qpps)?;
    Ok(told_by(task, &firm, &ClosedLoopRecord::of(guard, from_s, to_s), louder * steady_duty))
}

/// Gains that ask for enough duty at the highest speed, and how much louder their duty is than that of the gains there are: these, or as much more of the proportional part.
/// `None` where such a loop would be too sensitive.
fn firm_enough<L: Law>(task: &Task<L>, gains: &Gains, found: &LagFit) -> Option<(Gains, f64)> {
    let least = WINDUP.asked.0 / WINDUP.most_speed - task.law.feed_forward();
    if gains.velocity.p >= least {
        return Some((*gains, 1.0));
    }
    let firm = Gains { velocity: Pid { p: least, ..gains.velocity }, ..*gains };
    let plant = DiscretePlant::of(&task.plant, task.law.tick_s());
    let noise = |gains: &Gains| {
        LoopPlant::new(plant.clone(), &task.law, found.lag).margins(gains, task.qpps).noise_duty
    };
    let worst = LoopPlant::new(plant.clone(), &task.law, found.worst);
    let is_calm =
        worst.spectral_radius(&firm, task.qpps) < 1.0 && worst.margins(&firm, task.qpps).ms <= WINDUP.most_ms;
    is_calm.then(|| (firm, (noise(&firm) / noise(gains).max(f64::MIN_POSITIVE)).max(1.0)))
}

/// What a start tells, of a loop whose duty has that standard deviation at a steady speed.
fn told_by<L: Law>(task: &Task<L>, gains: &Gains, start: &ClosedLoopRecord, steady_duty: f64) -> Windup {
    let misfit = |windup: Windup| -> Option<StartMisfit> {
        let law = task.law.with_windup(windup)?;
        let twin = TickLoop::new(task.plant, law, task.lag, *gains, task.qpps).smooth();
        start.start_misfit(twin, &law, steady_duty)
    };
    let (Some(tracked), Some(held)) = (misfit(Windup::Tracked), misfit(Windup::Held)) else {
        return Windup::Open;
    };
    let (best, other, found) = if tracked.squares < held.squares {
        (tracked, held, Windup::Tracked)
    } else {
        (held, tracked, Windup::Held)
    };
    let mean = best.squares / best.readings as f64;
    // A limit of more current than full duty makes of a motor at rest is none to a start.
    let apart = match task.plant.drive_limit.filter(|limit| *limit < 1.0) {
        None => WINDUP.apart,
        Some(_) if found == Windup::Tracked => WINDUP.apart_limited.0,
        Some(_) => WINDUP.apart_limited.1,
    };
    let is_told = mean <= WINDUP.most_misfit
        && other.squares > apart * best.squares
        && other.squares - best.squares > WINDUP.surely * mean.max(1.0);
    if is_told { found } else { Windup::Open }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Lag;
    use crate::plain_law::PlainLaw;
    use crate::setpoint::Setpoint;

    const QPPS: f64 = 40_000.0;

    fn gains(p: f64) -> Gains {
        Gains { velocity: Pid { p, i: 20.0, d: 0.0 }, ..Gains::default() }
    }

    fn task(drive_limit: Option<f64>) -> Task<PlainLaw> {
        let lag = Lag { filter_s: 0.004, delay_ticks: 1.0 };
        let plant = PlantModel {
            gain_counts_per_s: QPPS,
            tau_s: 0.12,
            coulomb_duty: 0.05,
            load_duty: 0.0,
            drive_limit,
            brake_limit: drive_limit,
            sag: 0.0,
        };
        Task::new(plant, PlainLaw::default(), lag, QPPS)
    }

    /// A start to 45 % of full speed, polled every fourth tick.
    fn start(task: &Task<PlainLaw>, gains: &Gains, windup: Windup) -> ClosedLoopRecord {
        let law = PlainLaw { windup, ..task.law };
        let mut twin = TickLoop::new(task.plant, law, task.lag, *gains, QPPS);
        let speed = 0.45 * QPPS;
        let mut record = ClosedLoopRecord { setpoints: vec![(0.01, speed)], ..ClosedLoopRecord::default() };
        for tick in 0..240 {
            let t = f64::from(tick) * law.tick_s();
            let position = twin.motion.position;
            if t >= 0.01 {
                twin.tick(Setpoint::Speed(speed), 0.0);
            }
            if tick % 4 == 0 {
                record.counts.push((t + 0.5 * law.tick_s(), position.floor()));
                record.duties.push((t + 0.5 * law.tick_s(), twin.duty));
            }
        }
        record
    }

    #[test]
    fn what_the_integral_does_shows_where_a_start_asks_for_more_than_there_is() {
        for drive_limit in [None, Some(0.6)] {
            let task = task(drive_limit);
            for windup in [Windup::Tracked, Windup::Held] {
                let record = start(&task, &gains(3.0), windup);
                assert_eq!(told_by(&task, &gains(3.0), &record, noise(&record)), windup, "{drive_limit:?}");
            }
        }
    }

    #[test]
    fn a_start_that_asks_for_less_and_one_that_neither_explains_tell_nothing() {
        let task = task(None);
        let record = start(&task, &gains(0.3), Windup::Held);
        assert_eq!(told_by(&task, &gains(0.3), &record, noise(&record)), Windup::Open);
        let other = start(&task, &gains(1.5), Windup::Held);
        assert_eq!(told_by(&task, &gains(6.0), &other, noise(&record)), Windup::Open);
    }

    #[test]
    fn careful_gains_get_as_much_more_of_the_proportional_part_as_a_start_takes_where_the_lag_bears_it() {
        let quick = PlantModel { tau_s: 0.008, ..task(None).plant };
        let found = |longest_ms: f64| {
            let lag = Lag { filter_s: 0.0, delay_ticks: 0.3 };
            let worst = Lag { delay_ticks: 0.3 * longest_ms, ..lag };
            LagFit {
                lag,
                worst,
                interval_s: (0.0, worst.total_s(0.003)),
                tau_scale: 1.0,
                chi_square: 1.0,
                least_filter_s: None,
                has_other_sum: false,
                windup: Windup::Open,
                loudness: 1.0,
            }
        };
        let of = |gains: &Gains, longest_ms: f64| {
            let task = Task::new(quick, PlainLaw::default(), found(longest_ms).lag, QPPS);
            firm_enough(&task, gains, &found(longest_ms))
        };
        let careful = gains(0.12);
        let (firm, louder) = of(&careful, 2.0).expect("a loop that bears it");
        assert!((WINDUP.most_speed * (1.0 + firm.velocity.p) - WINDUP.asked.0).abs() < 1e-9, "{firm:?}");
        assert!(firm.velocity.i == careful.velocity.i && louder > 2.0, "{louder}");
        assert_eq!(of(&gains(0.5), 2.0), Some((gains(0.5), 1.0)), "they ask for enough");
        assert_eq!(of(&careful, 40.0), None, "too sensitive with such a lag");
    }
}
