//! What the manual does not say. Each of these is a guess that hardware may correct.

use std::time::Duration;

/// Assumed: the loop turns, inputs are read and a line goes on so often.
pub const TICK: Duration = Duration::from_millis(1);
/// Assumed: P x error reaches the full drive here, I and D are weighed against it as in the LM629 of the maker's sister boards.
pub const FULL_DRIVE: i64 = 32_768;
/// Assumed: the sum of errors counts as so much less, as in the LM629.
pub const INTEGRAL_DIVISOR: i64 = 256;
/// Assumed: the bridge has so many steps each way. TQ tells the drive and SQ limits it in them; DL limits the integral term in them.
pub const DRIVE_STEPS: i64 = 255;
/// Assumed: commands of a line that are done in one tick, unless one of them waits.
pub const COMMANDS_PER_TICK: u32 = 15;
/// Assumed: a report leaves this long after its command.
pub const REPLY_DELAY: Duration = Duration::from_millis(1);
/// Assumed: from power-up or RT until the board hears and drives.
pub const BOOT_TIME: Duration = Duration::from_millis(100);
/// Assumed: TV tells the mean of so many ticks.
pub const TICKS_IN_VELOCITY: usize = 10;
/// Assumed: macros call macros so deep, one for each macro there is and one for the line; a call at the end of a line takes that line's place.
pub const MOST_NESTED: usize = 16;
/// Assumed: bytes that the commands of all macros may take, at [`BYTES_PER_COMMAND`].
pub const MACRO_STORAGE: usize = 2_048;
/// Assumed: a code and a number of 32 bits.
pub const BYTES_PER_COMMAND: usize = 5;
/// Assumed: what an unconnected input reads. Analog input 2 has a pull-up of 10 kilo-ohms (SuprMotr manual, J2).
pub const OPEN_VOLTS: f64 = 0.0;
/// Assumed: a channel is on from here.
pub const ON_VOLTS: f64 = 2.5;
/// What VE tells. Assumed: nobody knows the text.
pub const VERSION: &str = "DIVA Automation SuprMotr V9, simulated";
/// What CS tells. Assumed: nobody knows the sum.
pub const CHECKSUM: i64 = 0x5A3C;
