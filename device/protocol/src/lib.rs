//! Pure codecs of the motor controllers' serial protocols: bytes in, values out, and back.
//!
//! Units stand in names (`_counts`, `_volts`, `_amps`). A value as it lies on the wire is called *raw*; the factor that turns it into a
//! physical one stands in [`packet_serial::scale`] and nowhere else. Start at [`packet_serial`] or [`motion_mind`].
//!
#![doc = include_str!("../README.md")]

pub mod canopen;
pub mod codes;
pub mod crc;
pub mod loader;
pub mod models;
pub mod motion_mind;
pub mod packet_serial;
pub mod script_image;
