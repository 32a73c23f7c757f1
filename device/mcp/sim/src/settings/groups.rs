//! The settings in RAM, raw as on the wire, group by group.

use crate::motion::MotionSettings;

/// Pins and outputs a model has, as far as the layout of its settings depends on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Number of input pins (signals), the count of commands 144 and 147.
    pub signals: usize,
    /// Number of DOUT pins, the count of command 138.
    pub outputs: usize,
}

/// Every setting of one controller that survives a power cycle once it is saved (MCP manual 2.3 and 2.4).
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Address, mixing, time-outs and the like.
    pub unit: UnitSettings,
    /// Voltage limits and reading offsets.
    pub battery: BatterySettings,
    /// One set per motor channel.
    pub motors: [MotorRegisters; 2],
    /// One per DOUT pin.
    pub outputs: Vec<OutputSettings>,
    /// Signal type of priority levels 1 to 3 (command 139): 0 disabled, 1 serial, 2 pulse, 3 analog.
    pub priority: [u8; 3],
    /// One per input pin.
    pub signals: Vec<SignalSettings>,
    /// USB, UART0 (RS-232), UART1, UART2, UART3 (command 145).
    pub streams: [StreamSettings; 5],
    /// What only the RoboClaw words 74 to 77, 98 to 107 and 117 carry.
    pub roboclaw: RoboclawSettings,
}

/// Settings of the unit as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitSettings {
    /// Packet serial address, 0x80 to 0x87 (command 141).
    pub address: u8,
    /// Control mixing of the two channels for signal inputs (command 141).
    pub mixed: u8,
    /// Serial time-out of commands 14 and 15 in 0.1 s, 0 = off.
    pub serial_timeout_tenths: u8,
    /// E-stop reset lock (command 201), raw.
    pub estop_lock: u8,
    /// Script autorun delay in ms, below 100 = off (command 246).
    pub script_autorun_ms: u32,
    /// CANopen node id, 1 to 127 (command 150).
    pub can_node_id: u8,
    /// RoboClaw configuration word (command 98).
    pub config_word: u16,
    /// Serial number (command 96), at most 36 characters.
    pub serial_number: String,
    /// Both bridges drive one motor (MCP manual 1.8). Has no public wire form.
    pub bridged: bool,
    /// Bit rate of the CAN port. Has no public wire form.
    pub can_rate_bps: u32,
    /// Bit rate of the I2C master. Has no public wire form.
    pub i2c_rate_bps: u32,
}

/// Voltage limits, all in 0.1 V.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BatterySettings {
    /// Main battery minimum (command 57).
    pub main_min_tenths: u16,
    /// Main battery maximum (command 57).
    pub main_max_tenths: u16,
    /// Automatic offset of generation 4's command 57.
    pub main_auto_offset_tenths: u8,
    /// Logic battery minimum (command 58).
    pub logic_min_tenths: u16,
    /// Logic battery maximum (command 58).
    pub logic_max_tenths: u16,
    /// Offset added to the main battery reading (command 115).
    pub main_offset_tenths: i8,
    /// Offset added to the logic battery reading (command 115).
    pub logic_offset_tenths: i8,
}

/// Settings of one motor channel, raw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MotorRegisters {
    /// What the control loops read: gains, ramps, limits.
    pub motion: MotionSettings,
    /// 0 locked antiphase, 1 sign magnitude (command 148).
    pub pwm_mode: u8,
    /// Encoder input of this motor (command 92).
    pub encoder_mode: u8,
    /// Homing duty (commands 105 and 106 in generations 2 and 3).
    pub homing_duty_raw: u16,
    /// Homing time-out in 1/300 s (commands 105 and 106).
    pub homing_timeout_ticks: u32,
}

/// Settings of one DOUT pin.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OutputSettings {
    /// What triggers the pin (command 137), 0 = nothing.
    pub action: u8,
    /// The pin is on when its action is not active. Has no public wire form.
    pub inverted: bool,
}

/// Settings of one input pin (command 143).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SignalSettings {
    /// 0 none, 1 analog, 2 pulse, 3 encoder, 4 packet serial.
    pub kind: u8,
    /// 0 position, 1 percent, 2 average speed, 3 speed.
    pub mode: u8,
    /// 0 none, 1 motor 1, 2 motor 2, 3 both.
    pub target: u8,
    /// Action at or below `min`, raw as the generation codes it.
    pub min_action: u16,
    /// Action at or above `max`, raw as the generation codes it.
    pub max_action: u16,
    /// Low-pass filter: running average of 2^n samples at 10 kHz, 0 = off.
    pub low_pass: u8,
    /// Time in ms without a signal until it counts as idle.
    pub timeout_ms: u32,
    /// Encoder value that a load home action sets.
    pub load_home: i32,
    /// Lowest input value.
    pub min: i32,
    /// Highest input value.
    pub max: i32,
    /// Middle input value, the zero of the position.
    pub center: i32,
    /// Range on either side of the center that counts as zero.
    pub deadband: u32,
    /// Power exponent x 65536, -8 to 8.
    pub power_exp_raw: i32,
    /// Output at the low end, -32767 = full.
    pub min_output: i32,
    /// Output at the high end, 32767 = full.
    pub max_output: i32,
    /// Offset away from zero of every non-zero position.
    pub power_min: u32,
    /// Potentiometer word of generations 3 and 4: stored and returned, its meaning is not public.
    pub potentiometer: u32,
    /// The pin is read as a digital level (0 or 4095). Has no public wire form; a type sent with 143 clears it.
    pub digital: bool,
}

/// Settings of one serial stream (command 145).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StreamSettings {
    /// 0 MCL, 1 packet serial, 2 disabled.
    pub kind: u8,
    /// Bit rate; without meaning on USB.
    pub rate_bps: u32,
    /// Time in ms without a byte until the stream counts as inactive, 0 = never.
    pub timeout_ms: u32,
    /// Open-drain output so that several units share one wire (MCP manual 1.9.7). Has no public wire form.
    pub multi_unit: bool,
}

/// One control input of commands 76 and 77.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ControlInput {
    /// Reverse dead band.
    pub reverse_deadband: u8,
    /// Forward dead band.
    pub forward_deadband: u8,
    /// Reverse limit.
    pub reverse_limit: u16,
    /// Forward limit.
    pub forward_limit: u16,
    /// Center of the range.
    pub center: u16,
    /// Low end of the range.
    pub min: u16,
    /// High end of the range.
    pub max: u16,
}

/// Settings that only RoboClaw commands carry: stored and returned.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RoboclawSettings {
    /// Functions of S3, S4, S5, D1, D2 (command 74).
    pub pin_functions: [u8; 5],
    /// Inputs S1 and S2 (command 76).
    pub inputs: [ControlInput; 2],
    /// Modes of CTRL1 and CTRL2 (command 100 in generations 2 and 3).
    pub control_modes: [u8; 2],
    /// Duties of CTRL1 and CTRL2 (commands 102 and 103 in generations 2 and 3).
    pub control_duties: [u16; 2],
    /// Four limits of command 117.
    pub control_limits: [u16; 4],
}
