//! What a motor axis does, in figures. Knows no serial port, no window, no clock and no controller.
//!
//! Times are in seconds, signals in whatever unit the caller measures in. Here is the judging of step responses; experiments,
//! identification and design rules will stand beside it.

mod step;

pub use step::{Point, StepFigures};
