//! What the tuner sees of one motor axis: drive it, sample it, read and write its gains, wait. Nothing else.
//!
//! Only what the wire carries stands here, at the wire's resolution: whole counts, 0.1 V, 10 mA, duty of 32767. Whoever
//! implements [`Axis`] puts it over a device thread or over a simulated machine in virtual time. Plant truth has no way in.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Duty of 100 %.
pub const FULL_DUTY_RAW: i16 = 32_767;
/// Volts per unit of a voltage.
pub const VOLTS_PER_RAW: f64 = 0.1;
/// Amperes per unit of a current.
pub const AMPS_PER_RAW: f64 = 0.01;
/// Counts of an absolute encoder for one turn (MCP manual 2.4.9, command 16).
pub const ABSOLUTE_COUNTS: i64 = 4096;
/// The loop that a controller's own relay test is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TestedLoop {
    /// Its relay switches on the speed.
    Velocity,
    /// Its relay switches on the position.
    Position,
}

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
    /// Duty.
    pub duty: bool,
    /// Current.
    pub current: bool,
    /// Main battery.
    pub volts: bool,
}

/// What the status word says, its bits distinguished by whoever knows the firmware generation.
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
    /// Counts of both motors, wrapping.
    pub counts: [i32; 2],
    /// What the status word says.
    pub status: Status,
    /// Duty of this motor and when it was read, 32767 = 100 %.
    pub duty_raw: Option<(Exchange, i16)>,
    /// Current of this motor, 10 mA.
    pub current_raw: Option<i16>,
    /// Main battery, 0.1 V.
    pub volts_raw: Option<u16>,
}

/// What the encoder is, as the controller's settings and the user tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EncoderClass {
    /// Counts without bound.
    #[default]
    Quadrature,
    /// 0 to 4095, ends there.
    Absolute,
    /// 0 to 4095 and on from 4095 to 0.
    AbsoluteWrapping,
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
    /// What the controller makes of this command is a guess, and this controller is a real one.
    #[error("what a controller makes of this command is a guess, which is sent to simulated ones only")]
    OnlySimulated,
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
    /// Drives at a duty with the highest acceleration, given explicitly.
    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError>;
    /// Commands a speed in counts/s without a ramp.
    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError>;
    /// Commands a position with a speed bound and no ramp, at once.
    fn command_position(&mut self, counts: i32, speed_counts_per_s: u32) -> Result<Exchange, AxisError>;
    /// Writes inductance and resistance to RAM.
    fn write_winding(&mut self, inductance_resistance_raw: [u32; 2]) -> Result<(), AxisError>;
    /// Writes the highest currents to RAM, driving and braking, 10 mA.
    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError>;
    /// Reads the unfiltered speed, counts/s.
    fn raw_speed(&mut self) -> Result<i32, AxisError>;
    /// Sets the time-out after which the controller stops by itself, ms. Firmware without it refuses.
    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError>;
    /// Has the controller's own relay test of a loop begin: from now on it adds this duty, raw, to the one of now or takes it away, as the speed or the position is
    /// so many counts/s or counts below or above the one of now. Gives the hysteresis that it takes, which may be none. It must not come twice.
    fn start_own_test(
        &mut self,
        _tested: TestedLoop,
        _height_raw: u32,
        _hysteresis: u32,
    ) -> Result<(Exchange, u32), AxisError> {
        Err(AxisError::Refused("it has no test of its own".into()))
    }
    /// What that test found: half of the oscillation, counts/s or counts, and its period, µs. Both 0 where it has found nothing yet.
    fn read_own_test(&mut self) -> Result<[u32; 2], AxisError> {
        Err(AxisError::Refused("it has no test of its own".into()))
    }
    /// Between which positions the motor is to stay, counts of the encoder. A controller that can watch that too is given them.
    fn set_travel(&mut self, _counts: (i64, i64)) -> Result<(), AxisError> {
        Ok(())
    }
    /// How long, since this was last asked, waits and replies had to wait for a processor of this computer: no time of the line's.
    fn stolen(&mut self) -> Duration {
        Duration::ZERO
    }
    /// Tells whoever waits what is going on.
    fn progress(&mut self, _text: &str) {}
}
