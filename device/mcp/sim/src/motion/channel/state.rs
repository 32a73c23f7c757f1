//! What a channel tells of its present work.

/// What a channel is doing, as the registers of the script language show it (MCP manual 3.2, MOTOR...).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChannelState {
    /// Duty the motor ramps towards in duty modes, 32767 = 100 % (MOTORTARGETPWM).
    pub target_duty_raw: i32,
    /// Speed setpoint of this tick, counts/s.
    pub speed_setpoint_counts_per_s: i32,
    /// Speed the motor ramps towards, counts/s (MOTORTARGETSPEED).
    pub target_speed_counts_per_s: i32,
    /// Distance left, counts (MOTORDISTANCE).
    pub distance_left_counts: u32,
    /// Position to move to, counts (MOTORTARGETPOS).
    pub target_position_counts: i32,
    /// Acceleration of the running command, counts/s^2 or raw duty per second; 0 = no ramp (MOTORACCEL).
    pub acceleration: u32,
    /// Deceleration of the running command (MOTORDECCEL).
    pub deceleration: u32,
    /// The velocity loop runs.
    pub velocity_loop: bool,
    /// The position loop runs.
    pub position_loop: bool,
    /// A distance command is executing.
    pub distance_active: bool,
    /// The channel drives: anything but coasting or duty 0.
    pub active: bool,
}
