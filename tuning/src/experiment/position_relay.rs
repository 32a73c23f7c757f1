//! The relay of Astrom and Hagglund about a set position: full duty of the relay one way below it and the other way above it, so that the axis goes to and
//! fro in a limit cycle. It keeps to where the axis stands, so that it can be run in a travel.
//!
//! A load makes the two halves of the cycle unequal. What the relay gives is shifted by the mean duty that the load takes, until they are equal: the
//! describing function is that of a symmetrical relay (Astrom and Hagglund, "Advanced PID Control", ISA 2006, section 8.3).

use super::Probe;
use super::limit_cycle::{Figure, LIMIT_CYCLE, figure, groups, is_steady, mean_and_doubt};
use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

thresholds! {
    /// The relay about a position: its duties, hysteresis, bias and time.
    pub(crate) POSITION_RELAY: Thresholds {
        /// Half the height of the relay above the duty that the motor starts at, as a share of full.
        above_start: f64 = 0.22,
        /// Factor of that in a travel where the cycle came too near to an end.
        lowered: f64 = 0.6,
        /// The least that is then tried, as a share of full.
        least_above: f64 = 0.06,
        /// How far the axis may go from the set position, as a share of the width.
        most_reach: f64 = 0.4,
        /// How many polls at rest the noise of the count is taken from.
        noise_polls: usize = 20,
        /// Noise that the rounding of a count alone makes, as a standard deviation in counts.
        rounded_counts: f64 = 0.289,
        /// Hysteresis, in standard deviations of the count's noise.
        hysteresis: f64 = 3.0,
        /// Cycles in which the duty that a load takes is learned.
        biased_cycles: usize = 5,
        /// Share of a cycle's mean duty that is taken over.
        bias_share: f64 = 0.7,
        /// Longest relay, in seconds.
        longest_s: f64 = 40.0,
        /// Least amplitude, as a multiple of the hysteresis.
        least_amplitude: f64 = 2.0,
    }
}

/// What a relay about a position read off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PositionRelayRun {
    /// When its record begins, s.
    pub from_s: f64,
    /// Duties that it switched between in the end.
    pub duties: (f64, f64),
    /// The position that it switches about, counts from the start of the run.
    pub set_counts: f64,
    /// Standard deviation of the count at rest.
    pub noise_counts: f64,
    /// How far the position goes beyond the set one before it switches, counts.
    pub hysteresis_counts: f64,
    /// Cycles that the figures are of.
    pub cycles: usize,
    /// Period of the limit cycle, s.
    pub period_s: Figure,
    /// Amplitude of the position's first harmonic, counts.
    pub amplitude_counts: Figure,
    /// The motor's response at that frequency: counts over duty.
    pub response: Figure,
    /// By how much the position lags there, from the duty's stamp to the count's, degrees.
    pub lag_deg: Figure,
    /// Highest speed seen, counts/s.
    pub top_speed: f64,
}

impl PositionRelayRun {
    /// Gain that would keep the limit cycle without the delay of this program's relay: duty per count, with half of its interval.
    #[must_use]
    pub fn cycle_gain(&self) -> Figure {
        (1.0 / self.response.0, self.response.1 / self.response.0.powi(2))
    }
}

/// Runs it about where the axis is now, inside `width` counts where there is one. The motor is at rest when it returns.
pub fn run_position_relay<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    width: Option<f64>,
) -> Result<PositionRelayRun, Cause> {
    guard.monitor.start_duty = probe.start_duty;
    guard.monitor.stall_amps = probe.stall_amps;
    guard.monitor.drive_limit = guard.drive_limit(probe.stall_amps);
    let mut above = POSITION_RELAY.above_start;
    loop {
        let half = (probe.start_duty + above).min(guard.options.max_duty);
        match oscillate(guard, half, width) {
            // A quick motor comes too far between two polls: with less duty it does not.
            Err(Cause::TravelLimit) if above * POSITION_RELAY.lowered >= POSITION_RELAY.least_above => {
                guard.come_to_rest()?;
                above *= POSITION_RELAY.lowered;
            }
            other => return other,
        }
    }
}

/// The relay with duties of one size.
fn oscillate<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    half: f64,
    width: Option<f64>,
) -> Result<PositionRelayRun, Cause> {
    let (set_counts, noise_counts) = at_rest(guard)?;
    let hysteresis_counts = POSITION_RELAY.hysteresis * noise_counts;
    let from_s = guard.now_s();
    let reach = width.map_or(f64::INFINITY, |width| POSITION_RELAY.most_reach * width);
    let mut relay = Relay { set_counts, hysteresis_counts, half, bias: 0.0, reach, top_speed: 0.0 };
    let ups = relay.switch(guard)?;
    guard.come_to_rest()?;
    let kept = ups.get(POSITION_RELAY.biased_cycles + LIMIT_CYCLE.first_cycles..).unwrap_or_default();
    let groups = groups(guard, kept)?;
    let omega = TAU / figure(&groups, |group| group.period_s).0;
    let run = PositionRelayRun {
        from_s,
        duties: (relay.bias - half, relay.bias + half),
        set_counts,
        noise_counts,
        hysteresis_counts,
        cycles: LIMIT_CYCLE.cycles,
        period_s: figure(&groups, |group| group.period_s),
        amplitude_counts: figure(&groups, |group| group.speed.norm() / omega),
        response: figure(&groups, |group| group.speed.norm() / group.duty.norm() / omega),
        lag_deg: figure(&groups, |group| 90.0 - (group.speed / group.duty).arg().to_degrees()),
        top_speed: relay.top_speed,
    };
    let is_clear = run.amplitude_counts.0 > POSITION_RELAY.least_amplitude * hysteresis_counts;
    if is_steady(run.period_s) && is_clear { Ok(run) } else { Err(Cause::NoLimitCycle) }
}

/// Where the axis stands, and the noise of its count there.
pub(super) fn at_rest<L: Law>(guard: &mut ExperimentGuard<'_, L>) -> Result<(f64, f64), Cause> {
    let mut counts = Vec::new();
    while counts.len() < POSITION_RELAY.noise_polls {
        counts.extend(guard.poll(false)?.map(|point| point.counts));
    }
    let (mean, _) = mean_and_doubt(&counts);
    let square = counts.iter().map(|count| (count - mean).powi(2)).sum::<f64>() / counts.len() as f64;
    Ok((mean, square.sqrt().max(POSITION_RELAY.rounded_counts)))
}

struct Relay {
    set_counts: f64,
    hysteresis_counts: f64,
    half: f64,
    bias: f64,
    reach: f64,
    top_speed: f64,
}

impl Relay {
    /// Switches until there are enough cycles; gives when it switched up.
    fn switch<L: Law>(&mut self, guard: &mut ExperimentGuard<'_, L>) -> Result<Vec<f64>, Cause> {
        let begin_s = guard.now_s();
        let mut is_up = true;
        let mut ups = Vec::new();
        let mut switched_s = self.give(guard, is_up)?;
        let mut up_s = 0.0;
        while ups.len() <= POSITION_RELAY.biased_cycles + LIMIT_CYCLE.first_cycles + LIMIT_CYCLE.cycles {
            if guard.now_s() - begin_s > POSITION_RELAY.longest_s {
                return Err(Cause::NoLimitCycle);
            }
            let Some(point) = guard.poll(false)? else { continue };
            let off = point.counts - self.set_counts;
            let speed = guard.recent_speed(2).unwrap_or(0.0).abs();
            self.top_speed = self.top_speed.max(speed);
            guard.monitor.full_speed = guard.monitor.full_speed.max(speed);
            if off.abs() > self.reach {
                return Err(Cause::TravelLimit);
            }
            let crosses = if is_up { off > self.hysteresis_counts } else { off < -self.hysteresis_counts };
            if !crosses {
                continue;
            }
            is_up = !is_up;
            if is_up && !ups.is_empty() && ups.len() <= POSITION_RELAY.biased_cycles {
                // The mean duty of a cycle is what the load takes.
                let down_s = point.t - switched_s;
                let mean = self.half * (up_s - down_s) / (up_s + down_s).max(f64::MIN_POSITIVE);
                let most = guard.options.max_duty - self.half;
                self.bias = (self.bias + POSITION_RELAY.bias_share * mean).clamp(-most, most);
            }
            let now_s = self.give(guard, is_up)?;
            if is_up {
                ups.push(now_s);
            } else {
                up_s = now_s - switched_s;
            }
            switched_s = now_s;
        }
        Ok(ups)
    }

    /// Gives one of the two duties, and when.
    fn give<L: Law>(&self, guard: &mut ExperimentGuard<'_, L>, is_up: bool) -> Result<f64, Cause> {
        guard.duty(self.bias + if is_up { self.half } else { -self.half })?;
        Ok(guard.drives.last().map_or(0.0, |drive| drive.t))
    }
}
