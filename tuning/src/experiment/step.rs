//! The textbook step: from rest to a duty below the chosen one, up to as much above it, and back. It gives speed per duty and time constant about
//! that duty, and never drives the motor at more.

use super::Probe;
use super::free::{rise_s, settle_at, tau_bounds};
use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// The step about a set duty: its height, and what is believed of it.
    pub(crate) STEP: Thresholds {
        /// Half the height of the step at the most, as a share of full duty.
        half_height: f64 = 0.15,
        /// How far the lower duty of the step is above the starting one at the least, as a share of full.
        above_start: f64 = 0.06,
        /// Half the height of the step at the least, as a share of full duty: below it the friction and not the motor would be measured.
        least_half: f64 = 0.04,
        /// Half of the 95 % interval of the gain, as a share of it, beyond which the step tells nothing: the rules go with it one to one.
        widest: f64 = 0.10,
    }
}

/// What a step read off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRun {
    /// When its record begins, s.
    pub from_s: f64,
    /// Duties before and after it.
    pub duties: (f64, f64),
    /// Speeds that they settle at, counts/s.
    pub speeds: (f64, f64),
    /// Speed per duty, counts/s, and half of its 95 % interval.
    pub gain_counts_per_s: (f64, f64),
    /// Time constant, s: of the way up and of the way down.
    pub taus_s: (f64, f64),
}

/// Two duties about `duty` that a motor turns at, within the highest allowed: the lower and the upper.
pub(super) fn about<L: Law>(
    guard: &ExperimentGuard<'_, L>,
    probe: &Probe,
    duty: f64,
    half: f64,
) -> Result<(f64, f64), Cause> {
    let (least, most) = (probe.start_duty + STEP.above_start, guard.options.max_duty);
    let half = half.min(0.5 * (most - least));
    if half < STEP.least_half {
        return Err(Cause::NoRoomForStep);
    }
    let middle = duty.clamp(least + half, most - half);
    Ok((middle - half, middle + half))
}

/// Runs it about a duty, and the lower duty the other way too for gains of moves `both_ways`: what turns one way only does not tell a load from
/// friction. The motor is braked when it returns.
pub fn run_step<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    duty: f64,
    both_ways: bool,
) -> Result<StepRun, Cause> {
    guard.monitor.start_duty = probe.start_duty;
    guard.monitor.stall_amps = probe.stall_amps;
    guard.monitor.drive_limit = guard.drive_limit(probe.stall_amps);
    let duties = about(guard, probe, duty, STEP.half_height)?;
    let from_s = guard.now_s();
    let below = settle_at(guard, duties.0)?;
    let rise = rise_s(guard, from_s, below.speed);
    guard.monitor.stopping_s = below.tau_s.min(rise);
    guard.monitor.tau_bounds_s = Some(tau_bounds(below.tau_s, rise));
    let above = settle_at(guard, duties.1)?;
    let again = settle_at(guard, duties.0)?;
    if both_ways {
        settle_at(guard, -duties.0)?;
    }
    guard.duty(0.0)?;
    guard.poll_for((3.0 * below.tau_s).clamp(0.06, 0.5), false)?;
    let (height, before) = (duties.1 - duties.0, 0.5 * (below.speed + again.speed));
    let gain = (above.speed - before) / height;
    // Of a mean of two, and of one.
    let doubt = (above.interval * above.speed)
        .hypot(0.5 * (below.interval * below.speed).hypot(again.interval * again.speed));
    if gain <= 0.0 || doubt > STEP.widest * gain * height {
        return Err(Cause::StepUnclear);
    }
    Ok(StepRun {
        from_s,
        duties,
        speeds: (before, above.speed),
        gain_counts_per_s: (gain, doubt / height),
        taus_s: (above.tau_s, again.tau_s),
    })
}
