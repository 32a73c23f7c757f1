//! The window's state as plain data. Screens read it and ask for changes; nothing here draws or waits.

pub mod devices;
pub mod lamps;
pub mod link;
pub mod message;
pub mod pwm;
pub mod readings;
pub mod screen;
