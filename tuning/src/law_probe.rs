//! What a run asks of a law whose figures can be read off the machine.

use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;

/// A law that a run can find out, where [`Facts::can_be_probed`](crate::law::Facts) says so.
pub trait LawProbe: Law {
    /// Reads the law off a motor that stands; `start_duty` is the duty that moves it, `write` makes writes of this law those of the run.
    /// `None` where the controller reports no duty.
    fn probe<J: Law>(
        _guard: &mut ExperimentGuard<'_, J>,
        _held: &Self::Held,
        _write: &dyn Fn(Self::Write) -> J::Write,
        _start_duty: f64,
        _is_position: bool,
    ) -> Result<Option<Self::Findings>, Cause> {
        Ok(None)
    }
}
