//! How fast bits travel on the CAN bus.

use brushwork_canopen::Frame;
use std::time::Duration;

/// Bit rate that the adapter is set to: the default of the controllers (MCP manual 1.9.4).
pub(super) const ADAPTER_RATE_BPS: u32 = 250_000;

/// How long a frame takes on the bus.
pub(super) fn on_the_bus(frame: &Frame) -> Duration {
    Duration::from_secs(1) * frame.bits() / ADAPTER_RATE_BPS
}
