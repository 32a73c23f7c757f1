//! MCP and RoboClaw on the bench: motors that suit them, packet serial in virtual time, trials of their registers.

pub mod laws;
mod line;
pub mod population;
mod trial;
mod unit;

use crate::judge::Judge;
use brushwork_mcp_sim::motion::ControlLaw;

/// Its bench.
pub const JUDGE: Judge = Judge::of::<ControlLaw>("MCP and RoboClaw, packet serial");
