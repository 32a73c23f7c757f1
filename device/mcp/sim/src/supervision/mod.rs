//! What watches over the board: limits on voltage, current and temperature, the emergency stop, the LEDs and the digital
//! outputs that follow them. It moves nothing itself; it says what the bridges must do.

mod battery;
mod estop;
mod leds;
mod limits;
mod outputs;

pub use battery::DetectedBattery;
pub use estop::{EStop, EStopReset};
pub use leds::{LedInputs, POWER_UP_BLINK, leds};
pub use limits::{FREEWHEEL_AT_CELSIUS, Limits, Observed, Protection, WARNING_FROM_CELSIUS};
pub use outputs::{OutputInputs, output_is_on};
