//! How many bytes of a value fit into a frame.

/// Bytes that fit into one frame without segments.
pub const EXPEDITED_BYTES: usize = 4;
/// Bytes of a segment.
pub const SEGMENT_BYTES: usize = 7;
