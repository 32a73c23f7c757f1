//! Pure codecs of the MCP and RoboClaw controllers: packet serial, CANopen, the firmware loader and script images; bytes in, values
//! out, and back.
//!
//! A codec here knows both directions, since the simulated controllers read
//! what the client writes. There is no port, no thread and no clock in this crate: where time matters (the 10 ms
//! gap of packet serial) it comes in as a [`std::time::Duration`] since an epoch of the caller.
//!
//! Units stand in names (`_counts`, `_volts`, `_amps`). A value as it lies on the wire is called *raw*; the factor
//! that turns it into a physical one stands in [`packet_serial::scale`] and nowhere else.

pub mod canopen;
pub mod codes;
pub mod crc;
pub mod loader;
pub mod models;
pub mod packet_serial;
pub mod script_image;
