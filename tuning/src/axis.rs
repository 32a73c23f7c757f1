//! What the tuner sees of one motor axis: drive it, sample it, read and write its gains, wait. Nothing else.
//!
//! Only what the wire carries stands here, at the wire's resolution: whole counts, 0.1 V, 10 mA, duty of 32767. Whoever
//! implements [`Axis`] puts it over a device thread or over a simulated machine in virtual time. Plant truth has no way in.

use crate::motion_mind::{MotionMindRegisters, MotionMindSetup};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Duty of 100 % on the wire (MCP manual, command 32).
pub const FULL_DUTY_RAW: i16 = 32_767;
/// Volts per unit of a voltage on the wire (MCP manual, command 24).
pub const VOLTS_PER_RAW: f64 = 0.1;
/// Amperes per unit of a current on the wire (MCP manual, command 49).
pub const AMPS_PER_RAW: f64 = 0.01;
/// When a request left and when its reply came.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Exchange {
    /// The request's last byte left.
    pub sent: Duration,
    /// The reply was complete.
    pub received: Duration,
}

impl Exchange {
    /// The middle of the exchange in seconds: the best guess of when the controller acted.
    #[must_use]
    pub fn middle_s(&self) -> f64 {
        0.5 * (self.sent.as_secs_f64() + self.received.as_secs_f64())
    }
}

/// What a poll should fetch besides counts and status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Want {
    /// Duty (command 48).
    pub duty: bool,
    /// Current (command 49).
    pub current: bool,
    /// Main battery (command 24).
    pub volts: bool,
}

/// What the status word says (command 90), its bits distinguished by whoever knows the firmware generation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Status {
    /// The current limit of this motor holds its power back.
    pub over_current: bool,
    /// The main battery is low; the motors freewheel.
    pub battery_low: bool,
    /// Emergency stop, over-temperature, high battery, driver fault: the controller does not drive.
    pub fault: bool,
    /// The word as it came.
    pub raw: u32,
}

/// One poll.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sample {
    /// When the counts were asked for and came.
    pub counts_at: Exchange,
    /// Counts of both motors (command 78), wrapping.
    pub counts: [i32; 2],
    /// What the status word says (command 90).
    pub status: Status,
    /// Duty of this motor and when it was read, 32767 = 100 %.
    pub duty_raw: Option<(Exchange, i16)>,
    /// Current of this motor, 10 mA.
    pub current_raw: Option<i16>,
    /// Main battery, 0.1 V.
    pub volts_raw: Option<u16>,
}

/// Registers of the velocity loop as they travel (commands 28, 55): gains x 65536, QPPS in counts/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct VelocityRegisters {
    /// Proportional.
    pub p: u32,
    /// Integral.
    pub i: u32,
    /// Derivative.
    pub d: u32,
    /// Speed at full duty, counts/s.
    pub qpps: u32,
}

/// Registers of the position loop as they travel (commands 61, 63).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PositionRegisters {
    /// Proportional.
    pub p: u32,
    /// Integral.
    pub i: u32,
    /// Derivative.
    pub d: u32,
    /// Bound of the integral.
    pub max_i: u32,
    /// Errors up to this many counts are none.
    pub deadzone: u32,
    /// Lowest position, counts.
    pub min: i32,
    /// Highest position, counts.
    pub max: i32,
}

/// What the encoder is, as the controller's settings and the user tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EncoderClass {
    /// Counts without bound.
    #[default]
    Quadrature,
    /// 0 to 4095, ends there (MCP manual 2.4.3).
    Absolute,
    /// 0 to 4095 and on from 4095 to 0.
    AbsoluteWrapping,
}

/// What the controller holds before a run: the registers that are put back, and the limits that hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setup {
    /// Velocity loop (commands 55, 56).
    pub velocity: VelocityRegisters,
    /// Position loop (commands 63, 64).
    pub position: PositionRegisters,
    /// Highest current, 10 mA (commands 135, 136); 0 = none.
    pub max_current_raw: u32,
    /// Highest braking current, 10 mA, negative (commands 135, 136); 0 = as for driving.
    #[serde(default)]
    pub min_current_raw: i32,
    /// Lowest main battery voltage that the controller accepts, 0.1 V (command 59).
    pub min_volts_raw: u16,
    /// Inductance and resistance of commands 128 to 131: both non-zero make duty a current command.
    pub inductance_resistance_raw: [u32; 2],
    /// Time-out of the stream, ms (command 145); 0 = none, `None` = not reported by this firmware.
    pub stream_timeout_ms: Option<u32>,
    /// The encoder.
    pub encoder: EncoderClass,
    /// What a Motion Mind holds instead of the two loops above.
    #[serde(default)]
    pub motion_mind: Option<MotionMindSetup>,
}

impl Setup {
    /// Whether duty is a current command: inductance and resistance are both set (MCP manual 1.2.11).
    #[must_use]
    pub fn is_torque_mode(&self) -> bool {
        self.inductance_resistance_raw.iter().all(|&raw| raw != 0)
    }
}

/// Why a call to the axis gave nothing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[non_exhaustive]
pub enum AxisError {
    /// This exchange had no reply; the next may have one.
    #[error("no reply")]
    NoReply,
    /// The reply came so long after the request that nobody can say when it was read; the next may be in time.
    #[error("the reply came too late")]
    Late,
    /// Someone stopped the run: the user, the window, the device thread.
    #[error("the run was stopped")]
    Stopped,
    /// The link is gone.
    #[error("the link is gone: {0}")]
    LinkLost(String),
    /// The controller does not take this command.
    #[error("the controller refused: {0}")]
    Refused(String),
}

/// One motor axis behind a link. Time is counted from an epoch of the implementation's.
pub trait Axis {
    /// The present time.
    fn now(&mut self) -> Duration;
    /// Waits until `time`; returns at once when it is past.
    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError>;
    /// One poll of counts and status, and what else is wanted.
    fn sample(&mut self, want: Want) -> Result<Sample, AxisError>;
    /// Drives at a duty with the highest acceleration, given explicitly (commands 52 and 53).
    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError>;
    /// Commands a speed in counts/s without a ramp (commands 35 and 36).
    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError>;
    /// Commands a position with a speed bound and no ramp, at once (commands 65 and 66).
    fn command_position(&mut self, counts: i32, speed_counts_per_s: u32) -> Result<Exchange, AxisError>;
    /// Reads what the run must know and put back.
    fn read_setup(&mut self) -> Result<Setup, AxisError>;
    /// Writes the velocity loop to RAM.
    fn write_velocity(&mut self, registers: VelocityRegisters) -> Result<(), AxisError>;
    /// Writes the position loop to RAM.
    fn write_position(&mut self, registers: PositionRegisters) -> Result<(), AxisError>;
    /// Writes inductance and resistance to RAM (commands 128, 129).
    fn write_winding(&mut self, inductance_resistance_raw: [u32; 2]) -> Result<(), AxisError>;
    /// Writes the highest currents to RAM, driving and braking, 10 mA (commands 133, 134).
    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError>;
    /// Reads the unfiltered speed, counts/s (commands 30, 31).
    fn raw_speed(&mut self) -> Result<i32, AxisError>;
    /// Sets the time-out after which the controller stops by itself, ms (command 145). Firmware without it refuses.
    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError>;
    /// Writes the registers of a Motion Mind to RAM. The motor is off until the next command.
    fn write_motion_mind(&mut self, _registers: MotionMindRegisters) -> Result<(), AxisError> {
        Err(AxisError::Refused("registers of a Motion Mind".into()))
    }
    /// Ends a run on a Motion Mind: these registers, as they are, and the position of the motor as the wanted one.
    fn end_motion_mind(&mut self, _registers: MotionMindRegisters) -> Result<(), AxisError> {
        Err(AxisError::Refused("registers of a Motion Mind".into()))
    }
    /// Between which positions the motor is to stay, counts of the encoder. A controller that can watch that too is given them.
    fn set_travel(&mut self, _counts: (i64, i64)) -> Result<(), AxisError> {
        Ok(())
    }
    /// Tells whoever waits what is going on.
    fn progress(&mut self, _text: &str) {}
}
