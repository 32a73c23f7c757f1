//! CANopen as far as a motor controller and the one who configures it need it (CiA 301), and the adapters that carry it over a serial
//! port. Bytes in, values out, and back: no IO, no clock, and no family of controllers.
//!
//! Start at [`Frame`]; [`adapter`] turns frames into bytes of a serial port and back; [`sdo`] reads and writes objects, on both
//! sides; [`nmt`] has states and heartbeats, [`bus`] what was heard of them. Which objects a controller has is its family's to say. Left out: PDOs, SYNC and TIME,
//! which no source describes for these controllers, SDO block transfer, node guarding and LSS.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod adapter;
pub mod bus;
mod emcy;
mod frame;
pub mod nmt;
mod node;
pub mod sdo;

pub use emcy::Emergency;
pub use frame::{CanId, Frame};
pub use node::{Function, NodeId};
