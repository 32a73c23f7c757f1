//! CANopen as far as a motor controller and the one who configures it need it (CiA 301), the adapters that carry it over a serial
//! port, and the objects under which the controllers of the MCP family offer their packet serial commands.
//!
//! Start at [`Frame`]; [`adapter`] turns frames into bytes of a serial port and back; [`sdo`] reads and writes objects, on both
//! sides; [`nmt`] has states and heartbeats; [`objects`] maps commands to objects. Left out: PDOs, SYNC and TIME, which no source
//! describes for these controllers, SDO block transfer, node guarding and LSS.

pub mod adapter;
mod describe;
mod emcy;
mod frame;
pub mod nmt;
mod node;
pub mod objects;
pub mod sdo;

pub use describe::describe_frame;
pub use emcy::Emergency;
pub use frame::{CanId, Frame};
pub use node::{Function, NodeId};
