//! What a failed exchange means to the tuner.

use brushwork_link::exchange::ExchangeError;
use brushwork_tuning::axis::AxisError;

pub(super) fn told(error: &ExchangeError) -> AxisError {
    if error.interruption().is_some() {
        AxisError::Stopped
    } else if error.is_link_lost() {
        AxisError::LinkLost(error.to_string())
    } else {
        match error {
            ExchangeError::TimedOut { .. }
            | ExchangeError::BadCrc { .. }
            | ExchangeError::BadAcknowledgement { .. }
            | ExchangeError::Malformed { .. } => AxisError::NoReply,
            // Whatever the tuner commands is absolute and at once, so that it may come twice.
            ExchangeError::MayHaveRun { cause } => told(cause),
            other => AxisError::Refused(other.to_string()),
        }
    }
}
