//! Waits until a tried motor stands.

use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;

/// Waits until the motor, which is off, stands. What was computed since the last answer is nobody's lateness.
pub(crate) fn rest<L: Law>(guard: &mut ExperimentGuard<'_, L>, tau_s: f64, qpps: f64) -> Result<(), Cause> {
    guard.pause();
    let until = guard.now_s() + 0.1 + 6.0 * tau_s;
    while guard.now_s() < until {
        guard.poll(false)?;
        let slow = guard.recent_speed(6).is_some_and(|speed| speed.abs() < 0.004 * qpps);
        if slow {
            return Ok(());
        }
    }
    Ok(())
}
