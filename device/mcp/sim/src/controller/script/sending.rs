//! How long bytes take that a script sends.

use super::streams::STREAMS;
use brushwork_plant::machine::StreamIndex;
use std::time::Duration;

/// Bytes that a serial port holds back before PUTS has to wait. Assumed.
const SEND_BUFFER_BYTES: u32 = 64;
/// Bits of a byte on a serial line.
const BITS_PER_BYTE: u32 = 10;

/// When the last byte of each slow stream will be out.
#[derive(Clone, Debug, Default)]
pub struct SendTimes([Duration; STREAMS + 1]);

impl SendTimes {
    /// Puts a byte behind those that are on their way, and tells how long the script waits for room.
    pub fn send(&mut self, port: StreamIndex, rate_bps: u32, now: Duration) -> Duration {
        let byte_time = Duration::from_secs(1) * BITS_PER_BYTE / rate_bps.max(1);
        let done_at = &mut self.0[port.index()];
        *done_at = (*done_at).max(now) + byte_time;
        done_at.saturating_sub(now).saturating_sub(byte_time * SEND_BUFFER_BYTES)
    }
}
