//! Motion Mind 3 in the window: its facts, the state of its screens, and the screens.

mod action;
pub mod messages;
pub mod model;
pub mod recipes;
pub mod screens;

pub use action::MindAction;
pub use model::family::MotionMind;
