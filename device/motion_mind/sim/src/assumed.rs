//! What the manual does not say. Each of these is a guess that hardware may correct.

use std::time::Duration;

/// Assumed: an answer leaves this long after the command (the manual: typically, and within 10 ms).
pub const REPLY_DELAY: Duration = Duration::from_millis(2);
/// Assumed: the same in text (the manual: 5 to 10 ms).
pub const TEXT_REPLY_DELAY: Duration = Duration::from_millis(6);
/// Assumed: the same for the long reads 97 to 99 (the manual: up to 50 ms).
pub const LONG_TEXT_REPLY_DELAY: Duration = Duration::from_millis(20);
/// Assumed: writing one register to EEPROM takes the longest time that the manual allows; nothing is heard meanwhile.
pub const STORE_TIME: Duration = Duration::from_millis(40);
/// Assumed: from power-up or reset until the unit hears and drives, without the blinking of the light.
pub const BOOT_TIME: Duration = Duration::from_millis(20);
/// One blink of the light at power-up, of which there are MODE + 1 (Motion Mind manual 3.2). Assumed: the unit neither hears nor drives
/// meanwhile, since DISABLEBLINK is said to quicken the power-up, and a software reset does not blink.
pub const BLINK_TIME: Duration = Duration::from_millis(400);
/// Assumed: an R/C receiver sends a pulse so often (Motion Mind manual 4.3: "roughly every 20 ms").
pub const PULSE_PERIOD_LOOPS: u32 = 4;
/// Without an R/C pulse for so long the signal is bad, in loops of 5 ms (Motion Mind manual 3.2: 50 ms).
pub const PULSE_MISSING_LOOPS: u32 = 10;
/// Without motion for so long, SAVEPOS stores the position (figure 20; elsewhere the manual says ten minutes).
pub const SAVE_POSITION_AFTER: Duration = Duration::from_secs(5 * 60);
/// Good R/C pulses whose mean replaces a bad one (register chapter; elsewhere 32).
pub const PULSES_IN_MEAN: usize = 64;
/// Velocities in the mean that VELOCITY shows.
pub const VELOCITIES_IN_MEAN: usize = 64;
/// Limit of the integral sum, with SATPROT and without.
pub const INTEGRAL_LIMIT: [i64; 2] = [4_096, 120_000];
/// Degrees Celsius at which the bridge goes off and comes on again.
pub const OVER_TEMPERATURE_CELSIUS: [f64; 2] = [90.0, 80.0];
/// The firmware that the simulated unit says it has. Assumed: revision "A" of the manual counts as 10.
pub const REVISION: u8 = 10;
