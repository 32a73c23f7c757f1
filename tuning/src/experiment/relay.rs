//! The relay of Astrom and Hagglund about a set speed: the duty is switched up and down as the speed crosses it, until the motor goes round in a
//! limit cycle.
//!
//! The relay is this program's, so that the cycle has the delay of the line in it. What is read off it has not: duties and counts come with
//! their times, and from both over the same cycles follows the motor's own response at that frequency (Astrom and Hagglund, "Advanced PID
//! Control", ISA 2006, section 8.3). The set speed is above what the middle duty gives, so that the cycle is not symmetrical, and its mean speed
//! over its mean duty is the gain at frequency zero.

use super::Probe;
use super::free::{rise_s, settle_at, tau_bounds};
use super::limit_cycle::{Figure, Group, LIMIT_CYCLE, figure, groups, is_steady, mean_and_doubt};
use super::step::about;
use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// The relay about a speed: its duties, hysteresis, time, and what is believed of it.
    RELAY: Thresholds {
        /// Half the height of the relay, as a share of full duty.
        half_height: f64 = 0.22,
        /// How far the set speed lies above that of the middle duty, as a share of the speed that the upper half of the relay adds.
        set_share: f64 = 0.4,
        /// How many polls at the middle duty the noise of the speed is taken from.
        noise_polls: usize = 40,
        /// Hysteresis, in standard deviations of the speed's noise: noise crosses three of them in one poll of 370.
        hysteresis: f64 = 3.0,
        /// Polls that a speed is taken over: how many such spans a time constant has, and the fewest and most polls. More make less noise, and a longer delay.
        speed_polls: (f64, f64, f64) = (6.0, 2.0, 8.0),
        /// Longest relay, in seconds.
        longest_s: f64 = 30.0,
        /// Least amplitude, as a multiple of the hysteresis.
        least_amplitude: f64 = 0.8,
        /// Half of the 95 % interval of the gain, as a share of it, beyond which the asymmetry tells nothing.
        widest_gain: f64 = 0.3,
    }
}

/// What a relay read off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelayRun {
    /// When its record begins, and when the relay took over, s.
    pub from_s: f64,
    /// When the relay took over, s.
    pub relay_s: f64,
    /// Duties that it switches between.
    pub duties: (f64, f64),
    /// Speed that the middle of them gives, and the one that it switches about, counts/s.
    pub middle_speed: f64,
    /// The speed that it switches about, counts/s.
    pub set_speed: f64,
    /// Standard deviation of the speed at a constant duty, counts/s.
    pub noise: f64,
    /// How far the speed goes beyond the set one before it switches, counts/s.
    pub hysteresis: f64,
    /// Cycles that the figures are of.
    pub cycles: usize,
    /// Period of the limit cycle, s.
    pub period_s: Figure,
    /// Amplitude of the speed's first harmonic, counts/s.
    pub amplitude: Figure,
    /// The motor's response at that frequency: speed over duty, counts/s.
    pub response: Figure,
    /// By how much it lags there, from the duty's stamp to the count's, degrees.
    pub lag_deg: Figure,
    /// Speed per duty at frequency zero, counts/s, from the asymmetry.
    pub static_gain: Figure,
}

impl RelayRun {
    /// Gain that would keep the limit cycle without the delay of this program's relay: duty per counts/s, with half of its interval.
    #[must_use]
    pub fn cycle_gain(&self) -> Figure {
        (1.0 / self.response.0, self.response.1 / self.response.0.powi(2))
    }
}

/// Runs it about the speed of a duty. The motor is braked when it returns.
pub fn run_relay<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    duty: f64,
) -> Result<RelayRun, Cause> {
    guard.monitor.start_duty = probe.start_duty;
    guard.monitor.stall_amps = probe.stall_amps;
    guard.monitor.drive_limit = guard.drive_limit(probe.stall_amps);
    let duties = about(guard, probe, duty, RELAY.half_height)?;
    let middle_duty = 0.5 * (duties.0 + duties.1);
    let from_s = guard.now_s();
    let middle = settle_at(guard, middle_duty)?;
    let rise = rise_s(guard, from_s, middle.speed);
    guard.monitor.stopping_s = middle.tau_s.min(rise);
    guard.monitor.tau_bounds_s = Some(tau_bounds(middle.tau_s, rise));
    let polls = (middle.tau_s / guard.options.poll_s / RELAY.speed_polls.0)
        .clamp(RELAY.speed_polls.1, RELAY.speed_polls.2) as usize;
    let noise = speed_noise(guard, polls)?;
    let hysteresis = RELAY.hysteresis * noise;
    // Speed per duty as far as it is known: friction takes the starting duty or less.
    let slope = middle.speed / (middle_duty - 0.5 * probe.start_duty).max(0.05);
    let set_speed = middle.speed + RELAY.set_share * slope * (duties.1 - middle_duty);
    let relay_s = guard.now_s();
    let switched_up_s = switch(guard, polls, duties, (set_speed, hysteresis))?;
    guard.duty(0.0)?;
    guard.poll_for((3.0 * middle.tau_s).clamp(0.06, 0.5), false)?;
    let kept = switched_up_s.get(LIMIT_CYCLE.first_cycles..).unwrap_or_default();
    let groups = groups(guard, kept)?;
    let figure = |of: &dyn Fn(&Group) -> f64| figure(&groups, of);
    let gain = |group: &Group| (group.mean_speed - middle.speed) / (group.mean_duty - middle_duty);
    // Each group misses what its last cycle left of the speed, which the next one has: over all of them that is left once. So the interval, which
    // is that of the mean of the groups, is on the safe side.
    let whole = Group::of(guard, kept).ok_or(Cause::NoLimitCycle)?;
    let by_groups = figure(&gain).1;
    // The speed of the middle duty is known no better than it settled.
    let off = (whole.mean_speed - middle.speed).abs().max(1e-9);
    let static_gain = (gain(&whole), by_groups.hypot(gain(&whole) * middle.interval * middle.speed / off));
    let run = RelayRun {
        from_s,
        relay_s,
        duties,
        middle_speed: middle.speed,
        set_speed,
        noise,
        hysteresis,
        cycles: LIMIT_CYCLE.cycles,
        period_s: figure(&|group| group.period_s),
        amplitude: figure(&|group| group.speed.norm()),
        response: figure(&|group| group.speed.norm() / group.duty.norm()),
        lag_deg: figure(&|group| -(group.speed / group.duty).arg().to_degrees()),
        static_gain,
    };
    if !is_steady(run.period_s) || run.amplitude.0 <= RELAY.least_amplitude * hysteresis {
        return Err(Cause::NoLimitCycle);
    }
    if run.static_gain.0 <= run.response.0 || run.static_gain.1 > RELAY.widest_gain * run.static_gain.0 {
        return Err(Cause::StepUnclear);
    }
    Ok(run)
}

/// Standard deviation of the speed between polls at the duty in force.
fn speed_noise<L: Law>(guard: &mut ExperimentGuard<'_, L>, polls: usize) -> Result<f64, Cause> {
    let mut speeds = Vec::new();
    while speeds.len() < RELAY.noise_polls {
        guard.poll(false)?;
        speeds.extend(guard.recent_speed(polls));
    }
    let (mean, _) = mean_and_doubt(&speeds);
    let square = speeds.iter().map(|speed| (speed - mean).powi(2)).sum::<f64>() / speeds.len() as f64;
    // A count more or less, where the encoder is so coarse that none was seen.
    Ok(square.sqrt().max(0.3 / (polls as f64 * guard.options.poll_s)))
}

/// Switches until there are enough cycles; gives when it switched up.
fn switch<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    polls: usize,
    duties: (f64, f64),
    (set_speed, hysteresis): (f64, f64),
) -> Result<Vec<f64>, Cause> {
    let mut ups = Vec::new();
    let begin_s = guard.now_s();
    let mut is_up = true;
    guard.duty(duties.1)?;
    while ups.len() <= LIMIT_CYCLE.first_cycles + LIMIT_CYCLE.cycles {
        if guard.now_s() - begin_s > RELAY.longest_s {
            return Err(Cause::NoLimitCycle);
        }
        if guard.poll(false)?.is_none() {
            continue;
        }
        let Some(speed) = guard.recent_speed(polls) else { continue };
        let crosses = if is_up { speed > set_speed + hysteresis } else { speed < set_speed - hysteresis };
        if crosses {
            is_up = !is_up;
            guard.duty(if is_up { duties.1 } else { duties.0 })?;
            if is_up {
                ups.extend(guard.drives.last().map(|drive| drive.t));
            }
        }
    }
    Ok(ups)
}
