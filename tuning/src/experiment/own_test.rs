//! The controller's own relay test, of its velocity loop about the speed of a duty, of its position loop about where the axis stands: its relay switches at every tick
//! of its loop, with no line in between, so that what it finds is the loop's own ultimate point.
//!
//! Such a test gives an amplitude and a period and nothing else. Neither the motor's gain nor its time constant follow from these, so that a model has been
//! fitted before: the gains of the test's rule are tried on it, and on the machine, like all others.

use super::Probe;
use super::free::settle_at;
use super::position_relay::{POSITION_RELAY, at_rest};
use super::step::about;
use crate::axis::TestedLoop;
use crate::cause::Cause;
use crate::experiment_guard::{ExperimentGuard, Input};
use crate::law::Law;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

thresholds! {
    /// The controller's own relay test: its amplitude, tries and time.
    OWN_TEST: Thresholds {
        /// Half the height of the relay about a speed, as a share of full duty: that of this program's own relay.
        half_height: f64 = 0.22,
        /// How often the test is asked to begin. One that may have come is called off first: a second one would begin about the duty of the first.
        tries: usize = 3,
        /// Least amplitude about a speed, in steps of the speed.
        least_amplitude: f64 = 1.2,
        /// Time between two requests for its result, in seconds.
        look_s: f64 = 0.1,
        /// How long the result may take, in seconds.
        longest_s: f64 = 15.0,
        /// Least hysteresis about a position, in counts: an encoder may stand between two counts.
        least_hysteresis_counts: f64 = 2.0,
        /// How far the axis may go from where a test of a position began, as the way of so many seconds at full speed, and so many hystereses more. With 4 ms eight of 64 runs of
        /// the bench's motors (seed 31) were ended by it, with 6 ms none, and a flywheel whose encoder is turned round is off after 0.25 s.
        reach_s: f64 = 0.006,
        /// The hystereses that are added to that.
        reach_hysteresis: f64 = 10.0,
        /// Least amplitude about a position, as a multiple of the hysteresis: what is no larger is made by the hysteresis rather than by the motor.
        least_swing: f64 = 1.5,
    }
}

/// What the controller's own relay test found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnTestRun {
    /// Duties that its relay switches between.
    pub duties: (f64, f64),
    /// The speed that it began at, counts/s.
    pub set_speed: f64,
    /// How far the speed goes beyond that before it switches, counts/s.
    pub hysteresis: f64,
    /// Half of the oscillation of the speed, counts/s.
    pub amplitude: f64,
    /// Its period, s.
    pub period_s: f64,
}

/// What the controller's own relay test of a position found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnPositionTestRun {
    /// Duties that its relay switches between.
    pub duties: (f64, f64),
    /// The position that it began at, counts from the start of the run.
    pub set_counts: f64,
    /// How far the position goes beyond that before it switches, counts.
    pub hysteresis_counts: f64,
    /// Half of the oscillation of the position, counts.
    pub amplitude_counts: f64,
    /// Its period, s.
    pub period_s: f64,
}

impl OwnTestRun {
    /// The ultimate gain, duty per counts/s.
    #[must_use]
    pub fn ultimate_gain(&self) -> f64 {
        ultimate_gain(self.duties, self.amplitude, self.hysteresis)
    }
}

impl OwnPositionTestRun {
    /// The ultimate gain, duty per count.
    #[must_use]
    pub fn ultimate_gain(&self) -> f64 {
        ultimate_gain(self.duties, self.amplitude_counts, self.hysteresis_counts)
    }
}

/// `4 d / (pi sqrt(a^2 - h^2))` of a relay of height d with hysteresis h whose cycle has the amplitude a (Astrom and Hagglund, "Advanced PID Control", ISA 2006,
/// section 8.3).
fn ultimate_gain(duties: (f64, f64), amplitude: f64, hysteresis: f64) -> f64 {
    let squared = amplitude.powi(2) - hysteresis.powi(2);
    2.0 * (duties.1 - duties.0) / (PI * squared.max(0.25 * amplitude.powi(2)).sqrt())
}

/// Runs it about the speed of a duty. The motor is braked when it returns.
pub fn run_own_test<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    duty: f64,
) -> Result<OwnTestRun, Cause> {
    let duties = about(guard, probe, duty, OWN_TEST.half_height)?;
    let (middle, height) = (0.5 * (duties.0 + duties.1), 0.5 * (duties.1 - duties.0));
    let settled = settle_at(guard, middle)?;
    // A count more or less in a tick of the loop is the step of its speed. An oscillation that is no larger is the rounding's, not the motor's.
    let wanted = f64::from(guard.law.rate_hz());
    let mut hysteresis = None;
    for _ in 0..OWN_TEST.tries {
        hysteresis =
            guard.start_own_test(TestedLoop::Velocity, height, wanted, Input::Speed(settled.speed))?;
        if hysteresis.is_some() {
            break;
        }
        settle_at(guard, middle)?;
    }
    let hysteresis = hysteresis.ok_or(Cause::NoOwnTest)?;
    let found = wait(guard, None)?;
    guard.duty(0.0)?;
    guard.poll_for((3.0 * settled.tau_s).clamp(0.06, 0.5), false)?;
    let (amplitude, period_s) = found.ok_or(Cause::NoLimitCycle)?;
    if amplitude < OWN_TEST.least_amplitude * wanted {
        return Err(Cause::NoLimitCycle);
    }
    Ok(OwnTestRun { duties, set_speed: settled.speed, hysteresis, amplitude, period_s })
}

/// Runs it about where the axis stands. The motor is at rest when it returns.
pub fn run_own_position_test<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
) -> Result<OwnPositionTestRun, Cause> {
    // As high as the relay of this program, and as deaf to the noise of the count.
    let height = (probe.start_duty + POSITION_RELAY.above_start).min(guard.options.max_duty);
    guard.come_to_rest()?;
    let mut begun = None;
    for _ in 0..OWN_TEST.tries {
        let (set_counts, noise_counts) = at_rest(guard)?;
        // An encoder that flickers by a count, and one whose count is all that moves, must not switch it.
        let wanted = (POSITION_RELAY.hysteresis * noise_counts).ceil().max(OWN_TEST.least_hysteresis_counts);
        let about = Input::Position(set_counts, guard.monitor.full_speed);
        let taken = guard.start_own_test(TestedLoop::Position, height, wanted, about)?;
        begun = taken.map(|hysteresis_counts| (set_counts, hysteresis_counts));
        if begun.is_some() {
            break;
        }
        guard.come_to_rest()?;
    }
    let (set_counts, hysteresis_counts) = begun.ok_or(Cause::NoOwnTest)?;
    let reach_counts =
        OWN_TEST.reach_s * guard.monitor.full_speed + OWN_TEST.reach_hysteresis * hysteresis_counts;
    let found = wait(guard, Some((set_counts, reach_counts)))
        .map_err(|cause| if cause == Cause::Stalled { Cause::CountsStopped } else { cause })?;
    guard.come_to_rest()?;
    let (amplitude_counts, period_s) = found.ok_or(Cause::NoLimitCycle)?;
    if amplitude_counts < OWN_TEST.least_swing * hysteresis_counts.max(OWN_TEST.least_hysteresis_counts) {
        return Err(Cause::NoLimitCycle);
    }
    Ok(OwnPositionTestRun {
        duties: (-height, height),
        set_counts,
        hysteresis_counts,
        amplitude_counts,
        period_s,
    })
}

/// Polls until the controller has a result; `None` where it has none in time. `within` is about which count the axis stays, and how near to it, counts.
fn wait<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    within: Option<(f64, f64)>,
) -> Result<Option<(f64, f64)>, Cause> {
    let until_s = guard.now_s() + OWN_TEST.longest_s;
    let mut looked_s = guard.now_s();
    while guard.now_s() < until_s {
        let point = guard.poll(true)?;
        let strays = |(about, reach): (f64, f64)| point.is_some_and(|at| (at.counts - about).abs() > reach);
        if within.is_some_and(strays) {
            return Err(guard.strayed());
        }
        if guard.now_s() - looked_s < OWN_TEST.look_s {
            continue;
        }
        looked_s = guard.now_s();
        if let Some(found) = guard.own_test()? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ultimate_gain_is_that_of_the_describing_function() {
        let run = OwnTestRun {
            duties: (0.3, 0.7),
            set_speed: 5_000.0,
            hysteresis: 0.0,
            amplitude: 1_000.0,
            period_s: 0.04,
        };
        assert!((run.ultimate_gain() - 0.8 / PI / 1_000.0).abs() < 1e-12);
        let wide = OwnTestRun { hysteresis: 600.0, ..run };
        assert!((wide.ultimate_gain() - 0.8 / PI / 800.0).abs() < 1e-12);
    }
}
