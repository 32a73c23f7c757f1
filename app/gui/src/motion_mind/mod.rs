//! Motion Mind 3 in the window: its facts, the state of its screens, and the screens.

pub mod model;
pub mod screens;
mod wish;

pub use model::family::MotionMind;
pub use wish::MindWish;
