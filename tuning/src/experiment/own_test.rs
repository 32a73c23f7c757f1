//! The controller's own relay test of its velocity loop, about the speed of a duty: its relay switches at every tick of its loop, with no line in between, so that
//! what it finds is the loop's own ultimate point.
//!
//! Such a test gives an amplitude and a period and nothing else. Neither the motor's gain nor its time constant follow from these, so that a model has been
//! fitted before: the gains of the test's rule are tried on it, and on the machine, like all others.

use super::Probe;
use super::free::settle_at;
use super::step::about;
use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
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

impl OwnTestRun {
    /// The ultimate gain, duty per counts/s: `4 d / (pi sqrt(a^2 - h^2))` of a relay of height d with hysteresis h whose cycle has the amplitude a (Astrom
    /// and Hagglund, "Advanced PID Control", ISA 2006, section 8.3).
    #[must_use]
    pub fn ultimate_gain(&self) -> f64 {
        let height = 0.5 * (self.duties.1 - self.duties.0);
        let squared = self.amplitude.powi(2) - self.hysteresis.powi(2);
        4.0 * height / (PI * squared.max(0.25 * self.amplitude.powi(2)).sqrt())
    }
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
        hysteresis = guard.start_own_test(height, wanted, settled.speed)?;
        if hysteresis.is_some() {
            break;
        }
        settle_at(guard, middle)?;
    }
    let hysteresis = hysteresis.ok_or(Cause::NoOwnTest)?;
    let found = wait(guard)?;
    guard.duty(0.0)?;
    guard.poll_for((3.0 * settled.tau_s).clamp(0.06, 0.5), false)?;
    let (amplitude, period_s) = found.ok_or(Cause::NoLimitCycle)?;
    if amplitude < OWN_TEST.least_amplitude * wanted {
        return Err(Cause::NoLimitCycle);
    }
    Ok(OwnTestRun { duties, set_speed: settled.speed, hysteresis, amplitude, period_s })
}

/// Polls until the controller has a result; `None` where it has none in time.
fn wait<L: Law>(guard: &mut ExperimentGuard<'_, L>) -> Result<Option<(f64, f64)>, Cause> {
    let until_s = guard.now_s() + OWN_TEST.longest_s;
    while guard.now_s() < until_s {
        guard.poll_for(OWN_TEST.look_s, true)?;
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
