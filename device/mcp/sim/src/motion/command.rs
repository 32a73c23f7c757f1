//! What a channel can be told to do, and what it is told about the world at each tick.

/// A command to one channel. A command for both motors is given to each of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionCommand {
    /// Duty (commands 0 to 13, 32 to 34, 52 to 54, signal inputs); a current setpoint in torque mode.
    Duty {
        /// -32767 to 32767 = -100 % to 100 %; -32768 counts as -32767.
        duty_raw: i16,
        /// Duty acceleration, 32768 = 100 %/s, above 655359 counts as 655359; `None` = the default acceleration and
        /// deceleration of 68 and 69.
        acceleration_raw: Option<u32>,
    },
    /// Speed (commands 35 to 40, 50).
    Speed {
        /// Signed speed, counts/s.
        speed_counts_per_s: i32,
        /// Acceleration and deceleration, counts/s^2; `None` and `Some(0)` = as fast as possible.
        acceleration: Option<u32>,
    },
    /// Speed over a distance (commands 41 to 46, 51). Buffered.
    Distance(DistanceMove, Buffering),
    /// Move to a position and hold it (commands 65 to 67, 119 to 127). Buffered.
    Position(PositionMove, Buffering),
    /// Relay test around the present speed or position (commands 84 to 87).
    Relay(RelayCommand),
    /// Run at a duty until the home switch or the time-out (commands 105 to 107).
    Home {
        /// -32767 to 32767 = -100 % to 100 %.
        duty_raw: i16,
        /// Time-out in 1/300 s.
        timeout_300ths: u32,
    },
    /// Duty 0 at the highest deceleration, buffer emptied ("Safe Stop", MCP manual 1.9.8).
    SafeStop,
    /// Open the bridge at once, buffer emptied ("Off", MCP manual 1.9.8).
    Coast,
}

/// A move over a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DistanceMove {
    /// Signed speed, counts/s; the sign is the direction.
    pub speed_counts_per_s: i32,
    /// Acceleration and deceleration, counts/s^2; `None` and `Some(0)` = no ramp.
    pub acceleration: Option<u32>,
    /// Distance, counts.
    pub distance_counts: u32,
}

/// A move to a position. What is `None` comes from the channel's defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionMove {
    /// Acceleration, counts/s^2; 0 = no ramp.
    pub acceleration: Option<u32>,
    /// Speed, counts/s.
    pub speed_counts_per_s: Option<u32>,
    /// Deceleration, counts/s^2; 0 = no ramp.
    pub deceleration: Option<u32>,
    /// Where to.
    pub target: PositionTarget,
}

/// Where a position move goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionTarget {
    /// Encoder counts.
    Counts(i32),
    /// -32767 to 32767 = position minimum to maximum (commands 125 to 127).
    Percent(i16),
}

/// The buffer argument of a buffered command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffering {
    /// 0: queue behind what is executing, or start at once if no buffered command is.
    Queue,
    /// 1: stop the running command, empty the queue, execute at once.
    Immediate,
}

impl Buffering {
    /// From the wire. Assumed: any value but 0 counts as 1.
    #[must_use]
    pub fn from_wire(flag: u8) -> Self {
        if flag == 0 { Buffering::Queue } else { Buffering::Immediate }
    }
}

/// A relay test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RelayCommand {
    /// What is made to oscillate.
    pub on: RelayOn,
    /// Amplitude of the relay. Assumed: duty, 32767 = 100 %.
    pub amplitude_raw: u32,
    /// Hysteresis in the unit of what oscillates; 0 in generations 1 and 2, which do not send one.
    pub hysteresis: u32,
}

/// What a relay test makes oscillate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelayOn {
    /// Speed, counts/s (commands 84, 85).
    Speed,
    /// Position, counts (commands 86, 87).
    Position,
}

/// What became of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Outcome {
    /// It runs now.
    Started,
    /// It waits in the buffer.
    Queued,
    /// Nothing changed.
    Refused(Refusal),
}

/// Why a command changed nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// 64 buffered commands are held already.
    BufferFull,
    /// Position minimum and maximum are both 0. The motor is stopped rather than moved.
    NoPositionRange,
    /// An input holds the motor stopped or off, or the bridge is overridden.
    Held,
}

/// Reading of the channel's encoder input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncoderInput {
    /// Quadrature counts since power up, never wrapped.
    Quadrature(i64),
    /// Absolute encoder (0 to 4095) or any other signal taken as one.
    Absolute(i32),
}

/// What a channel measures at each tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The encoder input.
    pub encoder: EncoderInput,
    /// Motor current, A, positive for forward torque.
    pub current_amps: f64,
    /// Main battery at the bridge, V.
    pub bus_volts: f64,
}

/// What inputs and protection impose on a channel at each tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Safe stop action: stopped at the highest deceleration; commands are refused while it lasts (MCP manual 1.9.8).
    pub safe_stop: bool,
    /// Off action: coasting; commands are refused while it lasts.
    pub off: bool,
    /// Reverse action: duty and speed commands run the other way, through their ramps. Assumed: distance and
    /// position moves are left alone, since their end would never come.
    pub reverse: bool,
    /// Forward limit: stopped at the highest deceleration, backward allowed.
    pub forward_limit: bool,
    /// Backward limit: stopped at the highest deceleration, forward allowed.
    pub backward_limit: bool,
    /// What protection makes of the bridge.
    pub bridge: BridgeOverride,
    /// Share of the current limits that temperature leaves, 0 to 1.
    pub current_limit_share: f64,
}

impl Conditions {
    /// Whether a limit is in the way of a signed duty or speed.
    pub(crate) fn bars(&self, signed: f64) -> bool {
        self.forward_limit && signed > 0.0 || self.backward_limit && signed < 0.0
    }
}

impl Default for Conditions {
    fn default() -> Self {
        Conditions {
            safe_stop: false,
            off: false,
            reverse: false,
            forward_limit: false,
            backward_limit: false,
            bridge: BridgeOverride::None,
            current_limit_share: 1.0,
        }
    }
}

/// What protection makes of the bridge. A running command waits and goes on afterwards from zero output; whoever
/// wants it gone (a latched error, an E-stop) gives [`MotionCommand::SafeStop`] too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BridgeOverride {
    /// Nothing: the channel drives.
    None,
    /// Motor leads shorted (E-stop, main battery high).
    Brake,
    /// Bridge open (main battery low, over-temperature).
    Freewheel,
}
