//! What a machine by itself tells of where it stands, and why.

use super::reason::{Reason, Wait};
use crate::op::Op;
use crate::vm::{Machine, State};

/// Whether it ended or faulted.
pub fn is_over(state: &State) -> bool {
    matches!(state, State::Ended | State::Faulted(_))
}

/// What it waits for.
pub fn waits(machine: &Machine) -> Option<Wait> {
    match machine.state() {
        State::Pausing { until } => {
            let op = machine.program().ops.get(machine.at().saturating_sub(1) as usize);
            let until = *until;
            Some(match op {
                Some(Op::Pause) => Wait::Pause { until },
                Some(Op::Wait(_)) => Wait::Ticks { until },
                Some(_) | None => Wait::Busy { until },
            })
        }
        State::Listening { stream } => Some(Wait::Gets { stream: *stream }),
        State::Ready | State::Ended | State::Faulted(_) => None,
    }
}

/// The line a script stands on. One that waits in PAUSE has that behind it already.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn line_of(machine: &Machine, reason: &Reason) -> u32 {
    match reason {
        Reason::Waiting(Wait::Pause { .. } | Wait::Ticks { .. } | Wait::Busy { .. })
        | Reason::Asked(Some(Wait::Pause { .. } | Wait::Ticks { .. } | Wait::Busy { .. })) => {
            machine.line_behind()
        }
        _ => machine.line(),
    }
}

/// What the machine alone tells.
pub fn reason_of(machine: &Machine, known: &Reason) -> Reason {
    match machine.state() {
        _ if matches!(known, Reason::Stopped(_)) => known.clone(),
        State::Ended => Reason::Ended,
        State::Faulted(fault) => Reason::Faulted(fault.clone()),
        State::Ready | State::Pausing { .. } | State::Listening { .. } => {
            waits(machine).map_or(Reason::Running, Reason::Waiting)
        }
    }
}
