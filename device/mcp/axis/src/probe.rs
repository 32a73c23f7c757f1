//! The law of the controller's loop, read off the duty it gives at a standstill.
//!
//! Below the duty that moves the motor, the error of a speed command is the command itself. With one gain at a time the duty that is read
//! back (command 48) then says what that gain is multiplied with: whether the setpoint's share of QPPS is added, the scale of P, how
//! fast I sums up, the scale of the position gains. The motor stays where it is, so this needs no travel.

use crate::registers::{McpLaw, McpWrite, PositionRegisters, VELOCITY_SCALE, VelocityRegisters};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::{ExperimentGuard, Point};
use brushwork_tuning::law::Law;
use serde::{Deserialize, Serialize};

/// QPPS while probing: so high that the command is large beside whatever the motor still creeps.
const QPPS: f64 = 10_000_000.0;
/// Share of the starting duty that is given, and its bounds.
const DUTY_SHARE: f64 = 0.35;
const DUTY: (f64, f64) = (0.006, 0.03);
/// How long a duty is read, and how long an integral is watched, s.
const READ_S: f64 = 0.05;
const SUM_S: f64 = 0.16;
/// Integral gains tried: the first suits sums over ticks, the second sums over seconds. What each should give at 300 ticks a second
/// or one second is over half of the duty itself.
const INTEGRALS: [f64; 2] = [0.012, 3.6];
/// Counts of the position error.
const ERROR_COUNTS: f64 = 60.0;
/// Loop rates, Hz, and position scales that are known.
const RATES_HZ: [u32; 2] = [300, 625];
const SCALES: [f64; 2] = [1024.0, 2048.0];
/// How far a finding may be from what is known.
const TOLERANCE: f64 = 0.06;

/// What was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LawFindings {
    /// Share of the setpoint over QPPS that is added to the duty.
    pub feed_forward: f64,
    /// What a P register of 65536 multiplies the error with.
    pub proportional: f64,
    /// How often in a second an I register of 65536 adds the error to the sum.
    pub sums_per_s: f64,
    /// Wire value of a position gain of 1; `None` where it was not asked for, or the position loop gave no duty.
    pub position_scale: Option<f64>,
}

impl LawFindings {
    /// The law that gives these findings, with what was not looked at taken from `usual`; `None` when no known law does.
    #[must_use]
    pub fn law(&self, usual: &McpLaw, position: bool) -> Option<McpLaw> {
        let feed_forward = self.known_feed_forward()?;
        if !self.is_proportional_known() {
            return None;
        }
        let (rate_hz, per_tick) = match self.known_timing()? {
            Timing::PerTick { rate_hz } => (rate_hz, true),
            Timing::PerSecond => (usual.rate_hz, false),
        };
        let position_scale = match self.position_scale {
            Some(_) => self.known_position_scale()?,
            None if position => return None,
            None => usual.position_scale,
        };
        Some(McpLaw { rate_hz, per_tick, position_scale, feed_forward })
    }

    /// Whether the setpoint's share of QPPS is added; `None` where it is neither whole nor nothing.
    #[must_use]
    pub fn known_feed_forward(&self) -> Option<bool> {
        match self.feed_forward {
            share if near(share, 1.0) => Some(true),
            share if share.abs() < TOLERANCE => Some(false),
            _ => None,
        }
    }

    /// Whether a P register of 65536 is a gain of 1.
    #[must_use]
    pub fn is_proportional_known(&self) -> bool {
        near(self.proportional, 1.0)
    }

    /// What I sums over; `None` where no known rate fits.
    #[must_use]
    pub fn known_timing(&self) -> Option<Timing> {
        let rate = RATES_HZ.into_iter().find(|rate| near(self.sums_per_s, f64::from(*rate)));
        let per_second = near(self.sums_per_s, 1.0).then_some(Timing::PerSecond);
        rate.map(|rate_hz| Timing::PerTick { rate_hz }).or(per_second)
    }

    /// The wire value of a position gain of 1; `None` where it was not found, or none that is known fits.
    #[must_use]
    pub fn known_position_scale(&self) -> Option<f64> {
        let found = self.position_scale?;
        SCALES.into_iter().find(|scale| near(found, *scale))
    }
}

/// What an integral sums over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// Over the ticks of the loop.
    PerTick {
        /// How many of them there are in a second.
        rate_hz: u32,
    },
    /// Over seconds.
    PerSecond,
}

fn near(found: f64, known: f64) -> bool {
    (found / known - 1.0).abs() < TOLERANCE
}

/// Looks at the loops of a motor that stands; `start_duty` is the duty that moves it, `held_limits` are the position limits, of a run that
/// tunes the position. `None` where the controller reports no duty.
///
/// # Errors
/// Says why the run ends.
pub fn probe_law<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    write: &dyn Fn(McpWrite) -> L::Write,
    start_duty: f64,
    held_limits: Option<(i32, i32)>,
) -> Result<Option<LawFindings>, Cause> {
    let guard = &mut Probed { guard, write };
    let duty = (DUTY_SHARE * start_duty).clamp(DUTY.0, DUTY.1);
    let speed = (duty * QPPS).round();
    let Some(feed) = duty_under(guard, speed, gains(0.0, 0.0))? else { return Ok(None) };
    let feed_forward = feed * QPPS / speed;
    let Some(with_p) = duty_under(guard, speed, gains(1.0, 0.0))? else { return Ok(None) };
    let proportional = (with_p - feed) * QPPS / speed;
    let mut sums_per_s = 0.0;
    for integral in INTEGRALS {
        let share = growth_under(guard, speed, gains(0.0, integral))?;
        sums_per_s = share * QPPS / integral;
        if share * speed * SUM_S > 0.15 * duty {
            break;
        }
    }
    let position_scale = match held_limits {
        Some(limits) => scale_under(guard, duty, limits)?,
        None => None,
    };
    guard.set(gains(0.0, 0.0))?;
    Ok(Some(LawFindings { feed_forward, proportional, sums_per_s, position_scale }))
}

/// The motor with its loops as this law writes them.
struct Probed<'p, 'g, L: Law> {
    guard: &'p mut ExperimentGuard<'g, L>,
    write: &'p dyn Fn(McpWrite) -> L::Write,
}

impl<L: Law> Probed<'_, '_, L> {
    fn set(&mut self, registers: McpWrite) -> Result<(), Cause> {
        self.guard.write((self.write)(registers))
    }
}

impl<'g, L: Law> std::ops::Deref for Probed<'_, 'g, L> {
    type Target = ExperimentGuard<'g, L>;

    fn deref(&self) -> &Self::Target {
        self.guard
    }
}

impl<L: Law> std::ops::DerefMut for Probed<'_, '_, L> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.guard
    }
}

fn gains(p: f64, i: f64) -> McpWrite {
    let (p, i) = ((p * VELOCITY_SCALE) as u32, (i * VELOCITY_SCALE).round() as u32);
    McpWrite::Velocity(VelocityRegisters { p, i, d: 0, qpps: QPPS as u32 })
}

/// The middle of the duties under a speed command.
fn duty_under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    speed: f64,
    registers: McpWrite,
) -> Result<Option<f64>, Cause> {
    let points = under(guard, speed, registers, READ_S)?;
    let mut duties: Vec<f64> = points.iter().filter_map(|p| p.duty).map(|duty| duty.1).collect();
    duties.sort_by(f64::total_cmp);
    Ok(duties.get(duties.len() / 2).copied())
}

/// How much the duty grows for each count that the motor stays behind the commanded speed.
fn growth_under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    speed: f64,
    registers: McpWrite,
) -> Result<f64, Cause> {
    let points = under(guard, speed, registers, SUM_S)?;
    let pairs = points.iter().filter_map(|p| p.duty.map(|(t, duty)| (speed * t - p.counts, duty)));
    let pairs: Vec<(f64, f64)> = pairs.collect();
    let n = pairs.len().max(1) as f64;
    let middle = pairs.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let spread: f64 = pairs.iter().map(|p| (p.0 - middle.0).powi(2)).sum();
    let both: f64 = pairs.iter().map(|p| (p.0 - middle.0) * (p.1 - middle.1)).sum();
    Ok(if spread > 0.0 { both / spread } else { 0.0 })
}

/// The polls under a speed command; the first may come before the loop has acted.
fn under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    speed: f64,
    registers: McpWrite,
    seconds: f64,
) -> Result<Vec<Point>, Cause> {
    guard.set(registers)?;
    guard.speed(speed)?;
    let from_s = guard.now_s() + 0.012;
    guard.poll_for(0.012 + seconds, true)?;
    guard.duty(0.0)?;
    Ok(guard.points.iter().copied().filter(|p| p.duty.is_some_and(|duty| duty.0 > from_s)).collect())
}

/// The position scale: P alone acts on the duty directly (MCP manual 2.4.7).
fn scale_under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    duty: f64,
    (min, max): (i32, i32),
) -> Result<Option<f64>, Cause> {
    let wanted = 1.6 * duty;
    let p = (wanted * QPPS * SCALES[0] / ERROR_COUNTS).round();
    let (min, max) = if min < max { (min, max) } else { (i32::MIN / 2, i32::MAX / 2) };
    guard.set(gains(0.0, 0.0))?;
    let registers = PositionRegisters { p: p as u32, min, max, ..PositionRegisters::default() };
    guard.set(McpWrite::PositionLoop(registers))?;
    guard.poll(false)?;
    let here = guard.points.last().map_or(0.0, |p| p.counts);
    // Away from the upper limit, which would shorten the error.
    let room = f64::from(max) - (guard.origin_counts() as f64 + here);
    let direction = if room < 2.0 * ERROR_COUNTS { -1.0 } else { 1.0 };
    let target = here + direction * ERROR_COUNTS;
    guard.position(target, QPPS as u32)?;
    let from_s = guard.now_s() + 0.012;
    guard.poll_for(0.012 + READ_S, true)?;
    guard.duty(0.0)?;
    let ratios = guard.points.iter().filter_map(|point| {
        let (t, read) = point.duty?;
        let (error, read) = (direction * (target - point.counts), direction * read);
        (t > from_s && read > 1e-4 && error > 0.0).then(|| p * error / (read * QPPS))
    });
    let mut ratios: Vec<f64> = ratios.collect();
    ratios.sort_by(f64::total_cmp);
    Ok(ratios.get(ratios.len() / 2).copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_are_told_apart_and_what_fits_none_is_none() {
        let usual = McpLaw::default();
        let found = LawFindings {
            feed_forward: 1.01,
            proportional: 0.99,
            sums_per_s: 303.0,
            position_scale: Some(1030.0),
        };
        assert_eq!(found.law(&usual, true), Some(usual));
        let other =
            LawFindings { feed_forward: 0.01, sums_per_s: 615.0, position_scale: Some(2_000.0), ..found };
        let law = McpLaw { rate_hz: 625, per_tick: true, position_scale: 2048.0, feed_forward: false };
        assert_eq!(other.law(&usual, true), Some(law));
        let seconds = LawFindings { sums_per_s: 1.02, position_scale: None, ..found };
        assert_eq!(seconds.law(&usual, false), Some(McpLaw { per_tick: false, ..usual }));
        assert_eq!(seconds.law(&usual, true), None, "the position loop gave no duty");
        for unknown in [
            LawFindings { feed_forward: 0.5, ..found },
            LawFindings { proportional: 16.0, ..found },
            LawFindings { sums_per_s: 150.0, ..found },
            LawFindings { position_scale: Some(65_536.0), ..found },
        ] {
            assert_eq!(unknown.law(&usual, true), None, "{unknown:?}");
        }
    }
}
