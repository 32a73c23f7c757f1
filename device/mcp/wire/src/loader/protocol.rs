//! The bytes, times and sizes that both ends of an update know.

use crate::models::Family;
use std::time::Duration;

/// What the host says first. The device erases its flash memory upon it.
pub const GREETING: u8 = 0x01;
/// What the device answers to the greeting and to each page.
pub const READY: u8 = 0xAA;
/// What the host says at the end; the unit restarts.
pub const RESET: u8 = 0x04;
/// Bytes of a page.
pub const PAGE_BYTES: usize = 256;
/// How long the answer to the greeting may take (public clients, 2015-2020).
pub const ERASE_LIMIT: Duration = Duration::from_secs(10);
/// What the USB name of a unit in its loader contains: "MCP266ASTULDR" (public clients, 2015-2020).
pub const USB_NAME_PART: &str = "ULDR";

/// Sizes of images that are known to go into the controllers of a family, in bytes (public clients, 2015-2020).
#[must_use]
pub const fn image_sizes(family: Family) -> &'static [usize] {
    match family {
        Family::Mcp => &[0xF_0000],
        Family::RoboClaw => &[0x8000, 0x1_0000],
    }
}
