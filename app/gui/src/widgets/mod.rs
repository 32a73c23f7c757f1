//! Widgets of our own: each draws one thing and knows nothing of controllers.

pub mod arm_switch;
pub mod heading;
pub mod indicator;
pub mod jog;
pub mod label;
pub mod numeric;
pub mod readout;
pub mod setpoint;
pub mod steps;
pub mod stop;
pub mod text_field;
