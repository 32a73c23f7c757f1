//! The law of the controller's loop, read off the duty it gives at a standstill.
//!
//! Below the duty that moves the motor, the error of a speed command is the command itself. With one gain at a time the duty that is read
//! back (command 48) then says what that gain is multiplied with: whether the setpoint's share of QPPS is added, the scale of P, how
//! fast I sums up, the scale of the position gains. The motor stays where it is, so this needs no travel.

use crate::derivative::{derivative_under, known_derivative_s};
use crate::probed::{Probed, QPPS, RATES_HZ, gains};
use crate::registers::{McpLaw, McpWrite, PositionRegisters, VELOCITY_SCALE};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::{ExperimentGuard, Point};
use brushwork_tuning::law::{Law, Windup};
use brushwork_tuning::law_probe::speed_step;
use brushwork_tuning::model::DerivativeFilter;
use brushwork_tuning::settle::slope;
use brushwork_tuning::tune::Method;
use serde::{Deserialize, Serialize};

/// Share of the starting duty that is given, and its bounds.
const DUTY_SHARE: f64 = 0.35;
const DUTY: (f64, f64) = (0.006, 0.03);
/// How long after its command a loop may act, how long a duty is read, and how long an integral is watched, s.
const ACTS_S: f64 = 0.012;
const READ_S: f64 = 0.05;
const SUM_S: f64 = 0.16;
/// Readings of the duty without which it is polled on, and how often at the most: where one in five replies is lost, all of 50 ms are once in a hundred times.
const ENOUGH_READINGS: usize = 2;
const MORE_POLLS: u32 = 10;
/// Integral gains tried: the first suits sums over ticks, the second sums over seconds. What each should give at 300 ticks a second
/// or one second is over half of the duty itself.
const INTEGRALS: [f64; 2] = [0.012, 3.6];
/// Counts of the position error.
const ERROR_COUNTS: f64 = 60.0;
/// What an integral should give over the duty itself where the first one tried gave too little to be read well, and what counts as nothing.
const SUMMED: f64 = 0.5;
const LEAST_SUMMED: f64 = 0.02;
/// P registers tried where the first gives too little to be read, and the smallest share of the command that is read well.
const FINER: f64 = 32.0;
const LEAST_READ: f64 = 0.02;
/// Position gains are made so many times larger, twice at the most, where they give no duty that can be read.
const LARGER: f64 = 16.0;
/// How far the motor may creep each way to tell the rate of the loop, counts, and what a travel has to have for it, in such ways.
const CREEP_COUNTS: f64 = 300.0;
const CREEPS_OF_ROOM: f64 = 8.0;
/// The same on an axis that turns freely: as far as it takes.
const FREE_COUNTS: f64 = 1e9;
/// Loop rates that are believed, Hz; sums in a second below which they are no sums over ticks; ticks that an unfiltered speed is counted over.
const BELIEVED_HZ: (f64, f64) = (50.0, 4_000.0);
const LEAST_TICKS_PER_S: f64 = 20.0;
const MOST_TICKS_COUNTED: f64 = 8.0;
/// Highest share of the setpoint that is believed.
const MOST_SHARE: f64 = 2.0;
/// Position scales that are known.
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
    /// Seconds that a position D of 1 multiplies the speed with, where the method has one and it could be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative_s: Option<f64>,
    /// How rough the duty of that D is over what differences of whole counts make it, where that could be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative_roughness: Option<f64>,
    /// The filter on the speed that this D sees, where its duty is too smooth for counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative_filter: Option<DerivativeFilter>,
    /// The step of the unfiltered speed, counts/s, where the sums do not tell the rate of the loop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_step: Option<f64>,
}

/// When the loop computes and what I sums.
struct Sums {
    rate_hz: f64,
    per_tick: bool,
    integral_scale: f64,
}

impl LawFindings {
    /// The law that gives these findings, with what was not looked at taken from `usual`; `None` where something could not be measured.
    /// A figure near one that is known is taken to be that one.
    #[must_use]
    pub fn law(&self, usual: &McpLaw, position: bool) -> Option<McpLaw> {
        let feed_forward = match self.known_feed_forward() {
            Some(whole) => f64::from(u8::from(whole)),
            None if self.feed_forward > 0.0 && self.feed_forward <= MOST_SHARE => self.feed_forward,
            None => return None,
        };
        if self.proportional < LEAST_READ / FINER {
            return None;
        }
        let is_usual = self.is_proportional_known();
        let velocity_scale = if is_usual { VELOCITY_SCALE } else { VELOCITY_SCALE / self.proportional };
        let Sums { rate_hz, per_tick, integral_scale } = self.sums(usual)?;
        let position_scale = match self.position_scale {
            Some(found) => self.known_position_scale().unwrap_or(found),
            None if position => return None,
            None => usual.position_scale,
        };
        let rate_hz = rate_hz.round() as u32;
        let law = McpLaw {
            rate_hz,
            per_tick,
            position_scale,
            feed_forward,
            velocity_scale,
            integral_scale,
            // Found out by the loop itself, from the usual ones.
            forward_sum: false,
            windup: Windup::Open,
            derivative_s: None,
            derivative_filter: self.derivative_filter,
        };
        let derivative_s = self.derivative_s.map(|found| known_derivative_s(found, &law));
        Some(McpLaw { derivative_s: derivative_s.filter(|found| *found != law.derivative_s()), ..law })
    }

    /// When the loop computes: by what I sums, by the step of the unfiltered speed, or by both. Gains may be scaled as P is, or I alone.
    fn sums(&self, usual: &McpLaw) -> Option<Sums> {
        let usual_hz = f64::from(usual.rate_hz);
        let is_believed = |rate: f64| rate >= BELIEVED_HZ.0 && rate <= BELIEVED_HZ.1;
        let step = self.speed_step.filter(|step| is_believed(*step));
        if self.tells_rate()
            && let Some(Timing::PerTick { rate_hz }) = self.known_timing()
        {
            return Some(Sums { rate_hz: rate_hz.into(), per_tick: true, integral_scale: VELOCITY_SCALE });
        }
        let per_second = |scale: f64| Sums {
            rate_hz: step.unwrap_or(usual_hz),
            per_tick: false,
            integral_scale: VELOCITY_SCALE / scale,
        };
        if near(self.sums_per_s, 1.0) {
            return Some(per_second(1.0));
        }
        if near(self.sums_per_s, self.proportional) {
            return Some(per_second(self.sums_per_s));
        }
        let per_tick = |rate_hz: f64| {
            let scale = self.sums_per_s / rate_hz;
            let integral_scale = if near(scale, 1.0) { VELOCITY_SCALE } else { VELOCITY_SCALE / scale };
            Sums { rate_hz, per_tick: true, integral_scale }
        };
        let guesses = [self.sums_per_s / self.proportional, self.sums_per_s];
        match step {
            // The unfiltered speed is counted over whole ticks.
            Some(step) => {
                let whole = |guess: &f64| {
                    let ticks = (guess / step).round().clamp(1.0, MOST_TICKS_COUNTED);
                    near(*guess, ticks * step).then_some(per_tick(ticks * step))
                };
                let scaled = || (self.sums_per_s > 0.0).then(|| per_tick(step));
                guesses.iter().find_map(whole).or_else(scaled)
            }
            None => guesses.into_iter().find(|rate| is_believed(*rate)).map(per_tick).or_else(|| {
                let is_slow = self.sums_per_s > LEAST_READ && self.sums_per_s < LEAST_TICKS_PER_S;
                is_slow.then(|| per_second(self.sums_per_s))
            }),
        }
    }

    /// Whether what I sums says by itself how often in a second the loop computes.
    fn tells_rate(&self) -> bool {
        self.is_proportional_known() && matches!(self.known_timing(), Some(Timing::PerTick { .. }))
    }

    /// Whether anything says it.
    #[must_use]
    pub fn is_rate_known(&self) -> bool {
        self.speed_step.is_some() || self.sums_per_s >= LEAST_TICKS_PER_S
    }

    /// How much louder than rounding makes it the duty of a position D was, where it was read. What a filter leaves of it is what the filter is known by.
    #[must_use]
    pub fn derivative_noise(&self) -> Option<f64> {
        let rough = self.derivative_roughness?;
        Some(if self.derivative_filter.is_some() { 1.0 } else { rough.sqrt().max(1.0) })
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

    /// What a position D multiplies the change in; `None` where it was not found, or is neither a tick nor a second.
    #[must_use]
    pub fn known_derivative(&self) -> Option<Timing> {
        let law = self.law(&McpLaw::default(), true)?;
        let known_s = known_derivative_s(self.derivative_s?, &law);
        if known_s == 1.0 {
            return Some(Timing::PerSecond);
        }
        let rates = [law.rate_hz].into_iter().chain(RATES_HZ);
        let rate_hz = rates.into_iter().find(|rate_hz| 1.0 / f64::from(*rate_hz) == known_s)?;
        Some(Timing::PerTick { rate_hz })
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

/// Looks at the loops of a motor that stands; `start_duty` is the duty that moves it, `held_limits` are the position limits. Where the sums do not tell
/// the rate of the loop, and where the method has a D, the motor creeps to and fro. `None` where the controller reports no duty.
///
/// # Errors
/// Says why the run ends.
pub fn probe_law<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    write: &dyn Fn(McpWrite) -> L::Write,
    start_duty: f64,
    held_limits: (i32, i32),
    method: Method,
) -> Result<Option<LawFindings>, Cause> {
    let guard = &mut Probed { guard, write };
    let duty = (DUTY_SHARE * start_duty).clamp(DUTY.0, DUTY.1);
    let speed = (duty * QPPS).round();
    let Some(feed) = duty_under(guard, speed, gains(0.0, 0.0))? else { return Ok(None) };
    let feed_forward = feed * QPPS / speed;
    let Some(proportional) = proportional_under(guard, speed, feed)? else { return Ok(None) };
    let mut sums_per_s = 0.0;
    let mut integral = INTEGRALS[0];
    for _ in 0..2 {
        let share = growth_under(guard, speed, gains(0.0, integral))?;
        sums_per_s = share * QPPS / integral;
        let summed = share * speed * SUM_S / duty;
        if summed > 0.15 {
            break;
        }
        integral = if summed < LEAST_SUMMED { INTEGRALS[1] } else { integral * SUMMED / summed };
    }
    let position_scale = match method {
        Method::Velocity => None,
        // Alone it acts on the duty directly.
        Method::Pd | Method::Pid => scale_under(guard, duty, (0.0, 1.0), held_limits)?,
        // Over a velocity loop it acts by what that makes of its speed, which is the same where all of a setpoint is fed forward.
        Method::Piv if near(feed_forward, 1.0) => scale_under(guard, duty, (0.0, 1.0), held_limits)?,
        Method::Piv => scale_under(guard, duty, (1.0, feed_forward + proportional), held_limits)?,
    };
    guard.set(gains(0.0, 0.0))?;
    let mut found =
        LawFindings { feed_forward, proportional, sums_per_s, position_scale, ..LawFindings::default() };
    if !found.tells_rate() {
        found.speed_step = rate_under(guard, start_duty)?;
    }
    if matches!(method, Method::Pd | Method::Pid)
        && let (Some(scale), Some(law)) = (position_scale, found.law(&McpLaw::default(), true))
    {
        let derivative = derivative_under(guard, start_duty, scale, held_limits, f64::from(law.rate_hz))?;
        found.derivative_s = derivative.as_ref().map(|derivative| derivative.seconds);
        found.derivative_roughness = derivative.as_ref().and_then(|derivative| derivative.roughness);
        found.derivative_filter = derivative.and_then(|derivative| derivative.filter);
        guard.set(gains(0.0, 0.0))?;
    }
    Ok(Some(found))
}

/// The step of the unfiltered speed, where there is room to creep.
fn rate_under<L: Law>(guard: &mut Probed<'_, '_, L>, start_duty: f64) -> Result<Option<f64>, Cause> {
    let counts = match guard.room_counts() {
        None => FREE_COUNTS,
        Some(room) if room >= CREEPS_OF_ROOM * CREEP_COUNTS => CREEP_COUNTS,
        Some(_) => return Ok(None),
    };
    guard.progress("Reading the unfiltered speed while the motor creeps");
    speed_step(guard, start_duty, counts)
}

/// What a P register of 65536 multiplies the error with; once more with another register where the first gave far too little or too much.
fn proportional_under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    speed: f64,
    feed: f64,
) -> Result<Option<f64>, Cause> {
    let mut register = 1.0;
    let mut found = 0.0;
    for _ in 0..3 {
        let Some(with_p) = duty_under(guard, speed, gains(register, 0.0))? else { return Ok(None) };
        let read = (with_p - feed) * QPPS / speed;
        found = read / register;
        if near(read, 1.0) {
            break;
        }
        register *= if read < LEAST_READ { FINER } else { 1.0 / read };
        if !(1e-3..=FINER / LEAST_READ).contains(&register) {
            break;
        }
    }
    Ok(Some(found))
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

/// The polls under a speed command.
fn under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    speed: f64,
    registers: McpWrite,
    seconds: f64,
) -> Result<Vec<Point>, Cause> {
    guard.set(registers)?;
    guard.speed(speed)?;
    read_for(guard, seconds)
}

/// Polls that have a duty after the command that was just given, which takes the drive off again. The first may come before the loop has acted; where replies are lost
/// it is polled for longer.
fn read_for<L: Law>(guard: &mut Probed<'_, '_, L>, seconds: f64) -> Result<Vec<Point>, Cause> {
    let from_s = guard.now_s() + ACTS_S;
    guard.poll_for(ACTS_S + seconds, true)?;
    let read = |guard: &Probed<'_, '_, L>| -> Vec<Point> {
        guard.points.iter().copied().filter(|p| p.duty.is_some_and(|duty| duty.0 > from_s)).collect()
    };
    for _ in 0..MORE_POLLS {
        if read(guard).len() >= ENOUGH_READINGS {
            break;
        }
        guard.poll(true)?;
    }
    guard.duty(0.0)?;
    Ok(read(guard))
}

/// The position scale, with what P of the velocity loop is and what duty a speed makes then: with none, P of the position acts on the duty directly
/// (MCP manual 2.4.7).
fn scale_under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    duty: f64,
    (velocity_p, share): (f64, f64),
    limits: (i32, i32),
) -> Result<Option<f64>, Cause> {
    let p = (1.6 * duty * QPPS * SCALES[0] / (share * ERROR_COUNTS)).round();
    for larger in [1.0, LARGER, LARGER * LARGER] {
        let found = scale_with(guard, larger * p, velocity_p, limits)?.map(|scale| scale * share);
        // With less than this the duty is too small to be read well.
        if found.is_some_and(|scale| scale < 0.5 * LARGER * larger * SCALES[0]) {
            return Ok(found);
        }
    }
    Ok(None)
}

/// The same with a P register.
fn scale_with<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    p: f64,
    velocity_p: f64,
    (min, max): (i32, i32),
) -> Result<Option<f64>, Cause> {
    let (min, max) = if min < max { (min, max) } else { (i32::MIN / 2, i32::MAX / 2) };
    guard.set(gains(velocity_p, 0.0))?;
    let registers = PositionRegisters { p: p as u32, min, max, ..PositionRegisters::default() };
    guard.set(McpWrite::PositionLoop(registers))?;
    guard.poll(false)?;
    let here = guard.points.last().map_or(0.0, |p| p.counts);
    // Away from the upper limit, which would shorten the error.
    let room = f64::from(max) - (guard.origin_counts() as f64 + here);
    let direction = if room < 2.0 * ERROR_COUNTS { -1.0 } else { 1.0 };
    let target = here + direction * ERROR_COUNTS;
    guard.position(target, QPPS as u32)?;
    let seen = read_for(guard, READ_S)?;
    let ratios = (0..seen.len()).filter_map(|n| {
        let (point, around) = (seen[n], &seen[n.saturating_sub(1)..(n + 2).min(seen.len())]);
        let (t, read) = point.duty?;
        // A motor that still creeps goes on between the reading of its count and that of its duty.
        let count = point.counts + slope(around).unwrap_or(0.0) * (t - point.t);
        let (error, read) = (direction * (target - count), direction * read);
        (read > 1e-4 && error > 0.0).then(|| p * error / (read * QPPS))
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
            ..LawFindings::default()
        };
        assert_eq!(found.law(&usual, true), Some(usual));
        let other =
            LawFindings { feed_forward: 0.01, sums_per_s: 615.0, position_scale: Some(2_000.0), ..found };
        let law = McpLaw { rate_hz: 625, position_scale: 2048.0, feed_forward: 0.0, ..usual };
        assert_eq!(other.law(&usual, true), Some(law));
        let seconds = LawFindings { sums_per_s: 1.02, position_scale: None, ..found };
        assert_eq!(seconds.law(&usual, false), Some(McpLaw { per_tick: false, ..usual }));
        assert_eq!(seconds.law(&usual, true), None, "the position loop gave no duty");
        for unknown in [
            LawFindings { feed_forward: -0.5, ..found },
            LawFindings { proportional: 0.0, ..found },
            LawFindings { sums_per_s: 0.0, ..found },
        ] {
            assert_eq!(unknown.law(&usual, true), None, "{unknown:?}");
        }
    }

    #[test]
    fn a_filtered_derivative_is_as_loud_as_its_filter_leaves_it_and_another_as_loud_as_it_was() {
        let of = |roughness: Option<f64>, filter: Option<DerivativeFilter>| {
            let found = LawFindings {
                derivative_roughness: roughness,
                derivative_filter: filter,
                ..LawFindings::default()
            };
            found.derivative_noise()
        };
        assert_eq!(of(Some(0.05), Some(DerivativeFilter { likely_s: 0.01, least_s: 0.008 })), Some(1.0));
        assert_eq!(of(Some(0.8), None), Some(1.0));
        assert_eq!(of(Some(4.0), None), Some(2.0), "a variance");
        assert_eq!(of(None, None), None);
    }

    #[test]
    fn what_was_measured_is_the_law_also_where_no_firmware_is_known_to_have_it() {
        let usual = McpLaw::default();
        let found = LawFindings {
            feed_forward: 1.0,
            proportional: 1.0,
            sums_per_s: 300.0,
            position_scale: Some(1024.0),
            ..LawFindings::default()
        };
        let law = |findings: LawFindings| findings.law(&usual, true).expect("all of it was measured");
        assert_eq!(law(LawFindings { feed_forward: 0.5, ..found }), McpLaw { feed_forward: 0.5, ..usual });
        let scaled = law(LawFindings { position_scale: Some(65_536.0), ..found });
        assert_eq!(scaled.position_scale, 65_536.0);
        // Rates: by the sums alone, or with the step of the speed, which is counted over one tick or two.
        for step in [None, Some(450.0), Some(225.0)] {
            let law = law(LawFindings { sums_per_s: 450.0, speed_step: step, ..found });
            assert_eq!(law, McpLaw { rate_hz: 450, ..usual }, "{step:?}");
        }
        // Over seconds: the step of the speed alone tells the rate.
        for (step, rate_hz, is_known) in [(None, 300, false), (Some(1_000.0), 1_000, true)] {
            let seconds = LawFindings { sums_per_s: 1.0, speed_step: step, ..found };
            assert_eq!(law(seconds), McpLaw { rate_hz, per_tick: false, ..usual });
            assert_eq!(seconds.is_rate_known(), is_known);
        }
        // P four times as strong, with I as it is and with I as strong, over ticks and over seconds.
        let four = LawFindings { proportional: 4.0, speed_step: Some(500.0), ..found };
        let scale = VELOCITY_SCALE / 4.0;
        let cases = [(500.0, true, 1.0), (2_000.0, true, 4.0), (4.0, false, 4.0), (1.0, false, 1.0)];
        for (sums_per_s, per_tick, integral) in cases {
            let expected = McpLaw {
                rate_hz: 500,
                per_tick,
                velocity_scale: scale,
                integral_scale: VELOCITY_SCALE / integral,
                ..usual
            };
            assert_eq!(law(LawFindings { sums_per_s, ..four }), expected, "{sums_per_s}");
        }
    }

    #[test]
    fn a_law_in_a_file_reads_back_and_the_usual_one_is_as_earlier_versions_wrote_it() {
        let text = serde_json::to_string(&McpLaw::default()).unwrap();
        assert_eq!(text, r#"{"rate_hz":300,"per_tick":true,"position_scale":1024.0,"feed_forward":true}"#);
        let odd = McpLaw { feed_forward: 0.5, velocity_scale: 16_384.0, ..McpLaw::default() };
        for law in [McpLaw::default(), odd, McpLaw { feed_forward: 0.0, ..odd }] {
            let text = serde_json::to_string(&law).unwrap();
            assert_eq!(serde_json::from_str::<McpLaw>(&text).unwrap(), law, "{text}");
        }
    }
}
