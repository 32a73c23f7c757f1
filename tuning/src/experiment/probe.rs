//! The wiring probe: a slow duty ramp that finds a wrong sign, a dead encoder, an open motor or a locked shaft before any loop is
//! closed, and the duty at which the motor starts.

use crate::axis::EncoderClass;
use crate::cause::Cause;
use crate::current_silence::SILENCE;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// The first motion: duties raised from zero until the encoder moves.
    PROBE: Thresholds {
        /// Time at rest first, in seconds.
        rest_s: f64 = 0.12,
        /// How long a motor that still turns is waited for, in seconds: as long as at the end of a run.
        longest_stand_s: f64 = 3.0,
        /// Readings at rest from which the noise of a current is told. Of six readings one set in 25 says less than half of the noise, of twenty 3 in 10,000
        /// (chi-square).
        noise_readings: usize = 20,
        /// Longest time for these readings, in seconds.
        longest_noise_s: f64 = 1.0,
        /// First duty of the ramp, as a share of full.
        first_duty: f64 = 0.04,
        /// Step of the ramp, as a share of full duty.
        duty_step: f64 = 0.02,
        /// Highest duty of the ramp, as a share of full.
        last_duty: f64 = 0.40,
        /// Time for each step of the ramp, in seconds.
        step_s: f64 = 0.06,
        /// Time between two polls, in seconds, above which the motor is waited for until it stands again. With 50 ms between them (a line of 16 ms) two deviations held the friction
        /// of 5 of 13 foreign motors, and the gain of 7, since it had got to some percent of its speed; waited for at 10 ms, a motor that sticks makes the friction 0.2 to 0.7 %
        /// too large.
        slow_s: f64 = 0.025,
        /// How long the motor, which was moved a little, is waited for until it stands, in seconds: as long as it is sped up at the most.
        longest_stop_s: f64 = 0.5,
        /// A motor stands that makes no more counts than this.
        still_counts: f64 = 1.0,
        /// For so long, in seconds: 0.1 % of a full speed of 20,000 counts/s.
        still_s: f64 = 0.05,
        /// And for so many polls at the least.
        still_polls: usize = 3,
        /// Counts that are a motion.
        motion_counts: f64 = 4.0,
        /// Fewest readings at the beginning of the ramp from which the current of the resting motor is read.
        least_readings: usize = 2,
    }
}

/// What the probe found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Duty at which the motor began to move.
    pub start_duty: f64,
    /// Amperes per duty with the shaft at rest; `None` where the motor moved before any current could be read.
    pub stall_amps: Option<f64>,
    /// Main battery at rest, V; `None` where it was not read.
    pub volts: Option<f64>,
    /// Highest current, A.
    pub peak_amps: f64,
    /// Standard deviation of the counts at rest: 0 but for absolute encoders.
    #[serde(default)]
    pub noise_counts: f64,
}

/// Runs it. The motor is braked when it returns.
pub fn run_probe<L: Law>(guard: &mut ExperimentGuard<'_, L>, direction: f64) -> Result<Probe, Cause> {
    guard.duty(0.0)?;
    let rest_s = stand(guard)?;
    let standing = || guard.points.iter().filter(|point| point.t >= rest_s);
    let rest = guard.points.last().map_or(0.0, |p| p.counts);
    let noise = spread(standing().map(|p| p.counts));
    let noise_counts = deviation(standing().map(|p| p.counts));
    let volts = guard.mean_volts(0.0, f64::INFINITY);
    let at_rest: Vec<f64> = standing().filter_map(|point| point.amps).collect();
    let squares: f64 = at_rest.iter().map(|amps| amps * amps).sum();
    guard.monitor.noise_amps = (squares / at_rest.len().max(1) as f64).sqrt();
    guard.monitor.highest_rest_amps = at_rest.iter().map(|amps| amps.abs()).fold(0.0, f64::max);
    let no_current = guard.monitor.no_current_amps();
    let mut readings: Vec<(f64, f64)> = Vec::new();
    let highest = PROBE.last_duty.min(guard.options.max_duty);
    let begin = guard.now_s();
    let mut moved = None;
    let mut step = 0;
    // By the clock: slow polls make coarser steps, not a longer ramp.
    while moved.is_none() {
        let duty = PROBE.first_duty + PROBE.duty_step * f64::from(step);
        if duty > highest + 1e-9 {
            break;
        }
        guard.duty(duty * direction)?;
        let mut latest = None;
        loop {
            if let Some(point) = guard.poll(false)? {
                latest = point.amps.map(f64::abs).or(latest);
                let by = (point.counts - rest) * direction;
                if by.abs() >= PROBE.motion_counts.max(3.0 * noise) {
                    moved = Some((duty, by));
                }
            }
            let due = ((guard.now_s() - begin) / PROBE.step_s) as i32;
            if due > step || moved.is_some() {
                step = due;
                break;
            }
        }
        readings.extend(latest.map(|amps| (duty, amps)));
    }
    let peak_amps = readings.iter().map(|r| r.1).fold(0.0, f64::max);
    let steepest = steepest(&readings, no_current);
    let stall_amps = (steepest > 0.0).then_some(steepest);
    match moved {
        Some((_, by)) if by < 0.0 => Err(Cause::EncoderReversed),
        Some((start_duty, _)) => {
            guard.duty(0.0)?;
            stop(guard)?;
            Ok(Probe { start_duty, stall_amps, volts, peak_amps, noise_counts })
        }
        None => Err(nothing_moved(guard, &readings, peak_amps, steepest)?),
    }
}

/// Polls the motor at rest, and gives from when on it stands. One that still turns is waited for: its counts would pass for noise that hides the
/// first motion, and its braking for noise of the current.
fn stand<L: Law>(guard: &mut ExperimentGuard<'_, L>) -> Result<f64, Cause> {
    let first_s = guard.now_s();
    let mut from_s = first_s;
    loop {
        guard.poll_for(PROBE.rest_s, false)?;
        guard.refuse_slow_line()?;
        let counts = || guard.points.iter().filter(|point| point.t >= from_s).map(|point| point.counts);
        let turned = counts().next().zip(counts().next_back()).map_or(0.0, |(first, last)| last - first);
        // What an absolute encoder reads at rest is noise.
        let is_turning =
            guard.setup.encoder == EncoderClass::Quadrature && turned.abs() > PROBE.motion_counts;
        let now_s = guard.now_s();
        if !is_turning {
            listen(guard, from_s)?;
            return Ok(from_s);
        }
        if now_s - first_s > PROBE.longest_stand_s {
            return Ok(from_s);
        }
        from_s = now_s;
    }
}

/// Polls until the motor that was just moved stands again, on a slow line, whose polls see its first motion late. What is identified next begins at rest, and a model cannot
/// know how fast the motor was.
fn stop<L: Law>(guard: &mut ExperimentGuard<'_, L>) -> Result<(), Cause> {
    let latest = guard.points.len().saturating_sub(2);
    let is_slow = guard.points[latest..].windows(2).any(|pair| pair[1].t - pair[0].t > PROBE.slow_s);
    // Without a ramp of its own the duty goes up in steps, from rest each time.
    if !is_slow || guard.monitor.is_abrupt {
        return Ok(());
    }
    let until_s = guard.now_s() + PROBE.longest_stop_s;
    let mut from_s = guard.now_s();
    while guard.now_s() < until_s {
        guard.poll(false)?;
        let seen = || guard.points.iter().filter(|point| point.t >= from_s);
        let (Some(first), Some(last)) = (seen().next(), seen().next_back()) else { continue };
        if (last.counts - first.counts).abs() > PROBE.still_counts {
            from_s = last.t;
        } else if last.t - first.t >= PROBE.still_s && seen().count() >= PROBE.still_polls {
            break;
        }
    }
    Ok(())
}

/// Reads on while the motor stands, where its current is noisy.
fn listen<L: Law>(guard: &mut ExperimentGuard<'_, L>, rest_s: f64) -> Result<(), Cause> {
    let until_s = guard.now_s() + PROBE.longest_noise_s;
    loop {
        let amps = || guard.points.iter().filter(|point| point.t >= rest_s).filter_map(|point| point.amps);
        let is_noisy = amps().any(|amps| amps.abs() > SILENCE.no_current_amps);
        if !is_noisy || amps().count() >= PROBE.noise_readings || guard.now_s() > until_s {
            return Ok(());
        }
        guard.poll(false)?;
    }
}

/// Distinguishes an open motor, a locked shaft and a dead encoder by the current.
fn nothing_moved<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    readings: &[(f64, f64)],
    peak_amps: f64,
    steepest: f64,
) -> Result<Cause, Cause> {
    if readings.is_empty() {
        return Ok(Cause::NothingCounted);
    }
    if peak_amps <= guard.monitor.no_current_amps() {
        return Ok(Cause::MotorOpen);
    }
    let (last_duty, last_amps) = readings.last().copied().unwrap_or((PROBE.last_duty, peak_amps));
    if last_amps < 0.7 * steepest * last_duty {
        return Ok(Cause::EncoderDead);
    }
    // A heavy motor has hardly begun to turn. Braked, it gives a current; a locked one does not.
    guard.duty(0.0)?;
    let from = guard.now_s() + 0.03;
    guard.poll_for(0.09, false)?;
    let braking =
        guard.points.iter().filter(|p| p.t > from).filter_map(|p| p.amps).map(f64::abs).fold(0.0, f64::max);
    let turns = braking > (2.0 * guard.monitor.no_current_amps()).max(0.03 * steepest * last_duty);
    Ok(if turns { Cause::EncoderDead } else { Cause::ShaftLocked })
}

/// The steepest current per duty, A: that of the motor at rest. Where the sensor is noisy, a single reading at a small duty would be too high by half: then it is
/// the steepest line through the first readings, two of them or more, each as it lies a standard deviation below what was fitted.
fn steepest(readings: &[(f64, f64)], no_current: f64) -> f64 {
    let single = readings.iter().filter(|r| r.1 > 2.0 * no_current).map(|r| r.1 / r.0).fold(0.0, f64::max);
    if no_current <= SILENCE.no_current_amps || readings.len() < PROBE.least_readings {
        return single;
    }
    let (mut duties, mut products) = (0.0, 0.0);
    let mut best: Option<(f64, f64)> = None;
    for (n, (duty, amps)) in readings.iter().enumerate() {
        (duties, products) = (duties + duty * duty, products + duty * amps);
        let (slope, noise) = (products / duties, no_current / SILENCE.noises / duties.sqrt());
        let is_surer = best.is_none_or(|known| slope - noise > known.0 - known.1);
        if n + 1 >= PROBE.least_readings && is_surer && slope > 2.0 * noise {
            best = Some((slope, noise));
        }
    }
    best.map_or(0.0, |known| known.0)
}

fn deviation(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / n;
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt()
}

fn spread(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if high > low { high - low } else { 0.0 }
}
