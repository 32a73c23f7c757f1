//! How much the controller takes in at once.

/// Bytes that the controller's receive buffer holds (Motion Mind manual 5.1).
pub const RECEIVE_BUFFER: usize = 50;
