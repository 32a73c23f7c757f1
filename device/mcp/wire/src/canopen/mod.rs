//! The objects under which the controllers of the MCP family offer their packet serial commands on a CANopen bus, and their frames in words.

mod describe;
pub mod objects;

pub use describe::describe_frame;
