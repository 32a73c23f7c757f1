//! MotorVator V3 in the window: its facts, the state of its screens, and the screens.

mod action;
pub mod messages;
pub mod model;
pub mod recipes;
pub mod screens;

pub use model::family::Motorvator;
