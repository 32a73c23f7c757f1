//! Asks a position axis for its backlash where a design needs it.

use crate::cause::Cause;
use crate::design::Task;
use crate::experiment::{Probe, measure_backlash, rest};
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::report::Report;
use crate::request::Request;

/// Measures the backlash of a position axis by little pushes: before an integral is designed, and where a loop hunts.
pub(crate) fn with_backlash<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    task: Task<L>,
    probe: &Probe,
    report: &mut Report<L>,
) -> Result<Task<L>, Cause> {
    if !request.verify {
        return Ok(task);
    }
    guard.progress("Looking for backlash at reversals");
    guard.duty(0.0)?;
    rest(guard, task.plant.tau_s, task.qpps)?;
    report.backlash = measure_backlash(guard, probe, &task.plant)?;
    Ok(Task { backlash_counts: report.backlash.map_or(0.0, |backlash| backlash.counts), ..task })
}
