//! What half a board can tell, in order: what the library says that it has told the motors.

use brushwork_link::device::Channel;

/// All of them.
pub const CHANNELS: &[Channel] =
    &[Channel::M1_SETPOINT, Channel::M1_PWM, Channel::M2_SETPOINT, Channel::M2_PWM];
