//! MotorVator V3 in the window: its facts, the state of its screens, and the screens.

pub mod model;
pub mod screens;

pub use model::family::Motorvator;
