//! Figures of the board that programs know.

/// Ticks of the main clock in a second (manual, GetClock(), Wait).
pub const TICKS_PER_SECOND: u32 = 128;

/// Bytes that Transmit sends and Receive stores (manual, Receive and Transmit).
pub const FRAME_BYTES: u32 = 8;

/// The letters of a direction, as they are written (manual, SetMotor).
pub const DIRECTIONS: [u8; 2] = *b"FB";
