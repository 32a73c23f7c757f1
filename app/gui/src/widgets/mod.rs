//! Widgets of our own: each draws one thing and knows nothing of controllers.

pub mod arm_switch;
pub mod choice;
mod elided;
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
pub mod time_left;

pub use choice::choice_ui;
pub use elided::elided;
pub use heading::heading_ui;
pub use label::fixed_label_ui;
pub use numeric::Numeric;
pub use readout::{NO_VALUE, Readout};
pub use setpoint::Setpoint;
pub use text_field::text_field_ui;
pub use time_left::with_time_left;

pub use arm_switch::arm_switch_ui;
pub use text_field::keep_space;
