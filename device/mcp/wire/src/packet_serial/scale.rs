//! The factors between raw wire values and physical ones. Each stands here once.
//!
//! A field of the command table carries its factor as [`Field::scale`](brushwork_values::Field::scale); all of them are taken
//! from here. Source: MCP manual 2.3 and 2.4.9, public clients 2015-2025.

/// Raw duty of 100 % (MCP manual 2.4.9: ±32767).
pub const FULL_DUTY_RAW: i64 = 32_767;
/// Duty in percent per raw count.
pub const DUTY_PERCENT: f64 = 100.0 / FULL_DUTY_RAW as f64;
/// Raw duty acceleration of 100 % of duty per second (MCP manual 2.4.9, commands 52 to 54).
pub const DUTY_ACCEL_RAW_PER_SECOND: f64 = 32_768.0;
/// Duty acceleration in percent per second per raw count.
pub const DUTY_ACCEL_PERCENT_PER_S: f64 = 100.0 / DUTY_ACCEL_RAW_PER_SECOND;
/// The highest duty acceleration: from -100 % to 100 % in 100 ms (MCP manual 2.4.9).
pub const MAX_DUTY_ACCEL_RAW: i64 = 655_359;
/// Raw value of a velocity gain of 1.0 (MCP manual command 28: P 0x00010000).
pub const VELOCITY_GAIN: f64 = 65_536.0;
/// Raw value of a position gain of 1.0. All vendor libraries use 1024; the manual's script chapter uses 2048 for the
/// same gain and gives no factor for commands 61 to 64. Assumed: 1024 on the wire.
pub const POSITION_GAIN: f64 = 1_024.0;
/// Raw value of one henry or one ohm in commands 128 to 131 (MCP manual: 16777216).
pub const INDUCTANCE_RESISTANCE: f64 = 16_777_216.0;
/// Amperes per raw count (MCP manual command 49: 10 mA).
pub const CURRENT_AMPS: f64 = 0.01;
/// Volts per raw count (MCP manual command 24: tenths of a volt).
pub const VOLTAGE_VOLTS: f64 = 0.1;
/// Degrees Celsius per raw count (MCP manual command 82: tenths of a degree).
pub const TEMPERATURE_CELSIUS: f64 = 0.1;
/// Raw value of a power exponent of 1.0 (MCP manual command 143: -8*65536 to 8*65536).
pub const POWER_EXPONENT: f64 = 65_536.0;
/// Raw default speed of 100 % in commands 70 to 72 (public clients, 2018-2025).
pub const DEFAULT_SPEED_RAW: f64 = 32_768.0;
/// Raw CTRL pin duty of 100 % in commands 102 to 104 of generations 2 and 3 (public clients, 2018-2020).
pub const CTRL_DUTY_RAW: f64 = 4_096.0;
/// Seconds per raw count of a homing timeout (public clients, 2018-2025: 1/300 s).
pub const HOMING_TIMEOUT_S: f64 = 1.0 / 300.0;
/// Seconds per raw count of the serial time-out and of the PWM idle delay (public clients, 2018-2025: 0.1 s).
pub const DECISECOND_S: f64 = 0.1;
/// The voltage step of commands 2, 3, 26 and 27: minima are 6 V plus 0.2 V per count (MCP manual 2.2.12).
pub const LEGACY_MIN_VOLTS_PER_COUNT: f64 = 0.2;
/// The voltage that a raw minimum of 0 stands for in commands 2 and 26 (MCP manual 2.2.12).
pub const LEGACY_MIN_VOLTS_OFFSET: f64 = 6.0;
/// Counts per volt of the maxima in commands 3 and 27 (MCP manual 2.2.12).
pub const LEGACY_MAX_COUNTS_PER_VOLT: f64 = 5.12;
/// The key without which later firmware neither saves (94) nor restores (80) settings (public clients, 2015-2025).
pub const SETTINGS_KEY: u32 = 0xE22E_AB7A;
