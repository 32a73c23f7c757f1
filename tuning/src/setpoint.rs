//! What a closed loop is told to do.

/// A speed or a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setpoint {
    /// Speed, counts/s.
    Speed(f64),
    /// Position and speed bound.
    Position(f64, f64),
}
