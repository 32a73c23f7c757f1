//! What a run asks of a law whose figures can be read off the machine, and a run that does nothing else.

use crate::cause::Cause;
use crate::experiment::{Probe, run_probe};
use crate::experiment_guard::{ExperimentGuard, GuardOptions};
use crate::law::Law;
use crate::request::Method;
use crate::setup::LoopAxis;
use crate::thresholds::thresholds;

/// A law that a run can find out, where [`Facts::can_be_probed`](crate::law::Facts) says so.
pub trait LawProbe: Law {
    /// Reads off a motor that stands what of the law gains of `method` need; `start_duty` is the duty that moves it, `write` makes writes of this law
    /// those of the run. `None` where the controller reports no duty.
    fn probe<J: Law>(
        _guard: &mut ExperimentGuard<'_, J>,
        _held: &Self::Held,
        _write: &dyn Fn(Self::Write) -> J::Write,
        _start_duty: f64,
        _method: Method,
    ) -> Result<Option<Self::Findings>, Cause> {
        Ok(None)
    }
}

thresholds! {
    /// How the controller's law is read off its duties at rest.
    LAW_PROBE: Thresholds {
        /// Duty above the starting one at which the unfiltered speed is read, as a share of full.
        reading_duty: f64 = 0.02,
        /// How long the motor turns each way for that, in seconds.
        reading_s: f64 = 0.5,
        /// How long a motor that does not move by a count is driven for that, in seconds.
        unmoved_s: f64 = 0.35,
        /// How far the motor turns each way for that, in counts.
        reading_counts: f64 = 300.0,
        /// Readings that are enough, each way.
        enough_readings: usize = 40,
        /// Fewest readings from which a step is told that all of them are multiples of.
        least_readings: usize = 6,
        /// How far a reading may be from a multiple of the step, in counts per second: they are rounded.
        rounding: f64 = 1.01,
        /// Readings nearer to each other than this are one and the same, in counts per second.
        least_step: f64 = 20.0,
        /// Most steps that the smallest reading may be.
        most_steps: i32 = 8,
    }
}

/// What [`find_law`] found.
#[derive(Clone, Debug, PartialEq)]
pub struct LawFound<L: Law> {
    /// The wiring probe.
    pub probe: Probe,
    /// What the law probe found; `None` where the controller reports no duty, or its law is not found out so.
    pub findings: Option<L::Findings>,
    /// The step of the unfiltered speed, counts/s: one count in the time that it is counted over. `None` where the readings have none.
    pub speed_step: Option<f64>,
}

/// Finds out the law of an axis and the step of its unfiltered speed, with as little motion as that takes: the wiring probe, half a second
/// of creeping forward and as much back. The motor stands and the old gains are in force when it returns.
///
/// # Errors
/// Why nothing is known.
pub fn find_law<L: LawProbe>(
    axis: &mut dyn LoopAxis<L>,
    options: GuardOptions,
) -> Result<LawFound<L>, Cause> {
    let mut guard = ExperimentGuard::new(axis, options)?;
    let found = look(&mut guard).map_err(|cause| guard.concluded(cause));
    guard.finish(false);
    found
}

fn look<L: LawProbe>(guard: &mut ExperimentGuard<'_, L>) -> Result<LawFound<L>, Cause> {
    guard.progress("Checking the wiring with a little duty");
    let probe = run_probe(guard, 1.0)?;
    guard.progress("Reading the unfiltered speed while the motor creeps");
    let speed_step = speed_step(guard, probe.start_duty, LAW_PROBE.reading_counts)?;
    guard.progress("Finding out the law of the loop");
    let held = guard.setup.held;
    let findings = match guard.facts.can_be_probed {
        true => L::probe(guard, &held, &|write| write, probe.start_duty, Method::Pd)?,
        false => None,
    };
    Ok(LawFound { probe, findings, speed_step })
}

/// Lets the motor creep to and fro, `counts` each way at the most, and gives the step of its unfiltered speed, counts/s: one count in the
/// time that it is counted over. `None` where the readings have none, or there were too few.
///
/// # Errors
/// Why the run ends.
pub fn speed_step<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    start_duty: f64,
    counts: f64,
) -> Result<Option<f64>, Cause> {
    let mut speeds = Vec::new();
    for direction in [1.0, -1.0] {
        creep(guard, direction * (start_duty + LAW_PROBE.reading_duty), counts, &mut speeds)?;
        guard.come_to_rest()?;
    }
    Ok(step_of(&speeds))
}

/// Reads the unfiltered speed until there are enough readings that are not 0, or the motor has gone far enough.
fn creep<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    duty: f64,
    counts: f64,
    speeds: &mut Vec<i32>,
) -> Result<(), Cause> {
    guard.poll(false)?;
    let from = guard.points.last().map_or(0.0, |point| point.counts);
    let enough = speeds.len() + LAW_PROBE.enough_readings;
    guard.duty(duty)?;
    let began_s = guard.now_s();
    let until_s = began_s + LAW_PROBE.reading_s;
    let mut far = 0.0;
    while guard.now_s() < until_s && speeds.len() < enough {
        // A lost reply says nothing of where it is.
        far = guard.poll(false)?.map_or(far, |point| (point.counts - from).abs());
        // One that does not move tells nothing, and is not driven for longer: a loop that has it soon shows why.
        if far > counts || far < 1.0 && guard.now_s() > began_s + LAW_PROBE.unmoved_s {
            break;
        }
        speeds.extend(Some(guard.raw_speed()?).filter(|speed| *speed != 0));
    }
    guard.duty(0.0)
}

/// The largest step of which all readings are multiples.
fn step_of(speeds: &[i32]) -> Option<f64> {
    let mut sorted: Vec<f64> = speeds.iter().map(|speed| f64::from(speed.abs())).collect();
    sorted.sort_by(f64::total_cmp);
    let smallest = sorted.first().copied().filter(|_| speeds.len() >= LAW_PROBE.least_readings)?;
    // A quick motor's readings are many steps each, but one from the next may be one.
    let apart = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|apart| *apart > LAW_PROBE.least_step);
    let smallest = apart.fold(smallest, f64::min);
    (1..=LAW_PROBE.most_steps).map(|parts| smallest / f64::from(parts)).find_map(|guess| {
        // The larger readings tell it more finely.
        let mut step = guess;
        for speed in &sorted {
            let steps = (speed / step).round();
            if (speed - steps * step).abs() > LAW_PROBE.rounding + 0.02 * step {
                return None;
            }
            step = speed / steps;
        }
        Some(step)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_of_rounded_multiples_is_found() {
        assert_eq!(step_of(&[300, -600, 300, 900, -300, 1200]), Some(300.0));
        assert_eq!(step_of(&[625, 625, 1250, -625, 1875, 625]), Some(625.0));
        assert_eq!(step_of(&[600, 900, 1500, 600, 2100, 900]), Some(300.0));
        let halves = step_of(&[312, 313, 625, 938, -312, 1250]).unwrap();
        assert!((halves - 312.5).abs() < 0.1, "{halves}");
        assert_eq!(step_of(&[5400, 5700, 6000, 5700, -5400, 6300, 5700]), Some(300.0), "none is one step");
        assert_eq!(step_of(&[300, 300, 600]), None, "too few");
        assert_eq!(step_of(&[997, 1013, 1204, 1331, 871, 1483]), None);
    }
}
