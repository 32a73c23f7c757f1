//! The objects under which the controllers of the MCP family offer their packet serial commands on a CANopen bus, their frames in words, and
//! the data sheet of a node.

mod describe;
mod eds;
pub mod objects;

pub use describe::describe_frame;
pub use eds::{VENDOR, data_sheet, product_of};
