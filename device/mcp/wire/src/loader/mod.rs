//! The firmware loader that command 255 enters: raw bytes instead of packets (public clients, 2015-2020).
//!
//! The host says 0x01, the device answers 0xAA when it has erased its flash memory; then the image goes over in pages of 256
//! bytes, 0xAA after each; at the end 0x04 restarts the unit. There is no checksum, no page number and no way to begin a page
//! anew: a byte that is lost leaves the two ends out of step until the unit is switched off and on. No image is published, and
//! neither is what a unit checks of one.

mod image;
mod protocol;
mod simulated;
mod transfer;

pub use image::{Image, ImageError};
pub use protocol::{ERASE_LIMIT, GREETING, PAGE_BYTES, READY, RESET, USB_NAME_PART, image_sizes};
pub use simulated::{MarkError, SimulatedImage};
pub use transfer::{Advance, Stage, Transfer};
