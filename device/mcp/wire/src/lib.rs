//! Pure codecs of the MCP and RoboClaw controllers: packet serial, CANopen, the firmware loader and script images; bytes in, values
//! out, and back.
//!
//! Units stand in names (`_counts`, `_volts`, `_amps`). A value as it lies on the wire is called *raw*; the factor that turns it into a
//! physical one stands in [`packet_serial::scale`] and nowhere else. Start at [`packet_serial`].
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

pub mod canopen;
pub mod codes;
pub mod crc;
pub mod loader;
pub mod models;
pub mod packet_serial;
pub mod roboclaw;
pub mod script_image;
