//! What no page of the maker says of the board, in one place.

use std::time::Duration;

/// What an instruction of a program takes: 50,000 a second, as an interpreter on a small controller runs them. Assumed.
pub const INSTRUCTION_TIME: Duration = Duration::from_micros(20);

/// What a byte takes on the line: 10 bits. Assumed, as the rate is, see `brushwork_motorvator_wire::BITS_PER_SECOND`.
#[must_use]
pub fn byte_time(bits_per_second: u32) -> Duration {
    let rate = u64::from(bits_per_second.max(1));
    Duration::from_nanos((10_000_000_000 + rate / 2) / rate)
}

/// Parts of a second that the waits of ConfigStepper count, those of GetClock. Assumed: "how long to wait" has no unit.
pub const STEP_TICKS_PER_SECOND: u32 = 1024;

/// By how much a wait between two steps is shorter than the one before it while a stepper gets faster, and longer while it gets slower.
/// Assumed: "the MotorVator will handle the acceleration and deceleration".
pub const WAIT_CHANGE: u32 = 1;

/// Waits of a stepper that was not configured, at the highest and at the lowest speed. Assumed.
pub const WAITS: (u32, u32) = (10, 20);

/// The number by which `G` starts a program; a downloaded program is number 99 (maker's other pages).
pub const PROGRAM_NUMBER: u8 = 99;

/// An on/off input is on below this: its switch leads to ground. Assumed.
pub const ON_BELOW_VOLTS: f64 = 0.8;

/// The voltage at which an analog input reads 255. Assumed.
pub const ANALOG_FULL_VOLTS: f64 = 5.0;

/// What `H` shows. Assumed but for the version.
pub const HELP: &str = "MotorVator AWOS 2.32 (simulated by Brushwork)\r\nG runs the program, I and triplets give it data, H shows this\r\n";

/// What the board says of a program that it cannot go on with, before the cause (maker's other pages).
pub const UNKNOWN_INSTRUCTION: &str = "Unknown Instruction";
