//! The simulated MCP by its bytes, its motion and its scripts.

mod manual_scripts;
mod motion;
mod motion_wire;
mod served;
mod speed;
