//! When a command did its work, as nearly as the bytes of its exchange tell.

use brushwork_motion_mind_wire::{Command, Part, Protocol};
use brushwork_tuning::axis::Exchange;
use std::time::Duration;

/// Bits of a byte on the wire: start, eight of data, stop (Motion Mind manual 5.0).
pub const BITS_PER_BYTE: f64 = 10.0;
/// How long after a command the reply usually leaves (Motion Mind manual 5.0), in frames, in lines, and of all registers, s.
const REPLY_DELAY_S: [f64; 3] = [0.002, 0.006, 0.020];

/// When a command did its work, from when it was sent and its reply complete: its bytes had to come first, and what nobody can
/// place is shared out evenly.
#[must_use]
pub fn worked_at(
    (sent, received): (Duration, Duration),
    (request_bytes, reply_bytes): (usize, usize),
    bits_per_second: u32,
    (protocol, command): (Protocol, &Command),
) -> Exchange {
    let per_byte_s = BITS_PER_BYTE / f64::from(bits_per_second.max(1));
    let (up_s, down_s) = (request_bytes as f64 * per_byte_s, reply_bytes as f64 * per_byte_s);
    let [frame_s, line_s, all_s] = REPLY_DELAY_S;
    let delay_s = match (protocol, command) {
        (Protocol::Binary, _) => frame_s,
        (Protocol::Text, Command::ReadText(Part::All)) => all_s,
        (Protocol::Text, _) => line_s,
    };
    let unknown_s = (received.saturating_sub(sent).as_secs_f64() - up_s - down_s - delay_s).max(0.0);
    let at = sent + Duration::from_secs_f64(up_s + 0.5 * unknown_s);
    Exchange { sent: at, received: at }
}
