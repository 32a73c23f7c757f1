//! MCP and RoboClaw in the window: their facts, the state of their screens and panels, and the screens.

pub mod messages;
pub mod model;
pub mod recipes;
pub mod screens;
mod updating;

pub use model::family::Mcp;
