//! When a command did its work, as nearly as the bytes of its exchange tell.

use brushwork_tuning::axis::Exchange;
use std::time::Duration;

/// How long after a command its report leaves, s. Assumed: the manual says nothing.
const REPLY_DELAY_S: f64 = 0.001;

/// When a command did its work, from when it was sent and its report complete: its bytes had to come first, and what nobody can place is shared out
/// evenly. `up` are the bytes up to the last of the command, `down` those of the report.
#[must_use]
pub fn worked_at(
    (sent, received): (Duration, Duration),
    (up, down): (usize, usize),
    byte_time: Duration,
) -> Exchange {
    let per_byte_s = byte_time.as_secs_f64();
    let (up_s, down_s) = (up as f64 * per_byte_s, down as f64 * per_byte_s);
    let unknown_s = (received.saturating_sub(sent).as_secs_f64() - up_s - down_s - REPLY_DELAY_S).max(0.0);
    let at = sent + Duration::from_secs_f64(up_s + 0.5 * unknown_s);
    Exchange { sent: at, received: at }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three characters up and nineteen down at 9600 baud and a report 1 ms later are 23.9 ms; 4 ms more are two on either side.
    #[test]
    fn a_position_is_of_when_its_character_had_come() {
        let byte_time = Duration::from_secs_f64(10.0 / 9_600.0);
        let at = worked_at((Duration::ZERO, Duration::from_micros(27_917)), (3, 19), byte_time);
        assert!((at.middle_s() - 0.005_125).abs() < 1e-5, "{}", at.middle_s());
    }
}
