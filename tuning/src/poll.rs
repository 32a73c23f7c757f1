//! What polls bring of an axis, and what it was commanded between them.

/// One poll as the experiments use it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Middle of the exchange, s from the start of the run.
    pub t: f64,
    /// Counts from the start of the run.
    pub counts: f64,
    /// When the duty was read and what it was, -1 to 1.
    pub duty: Option<(f64, f64)>,
    /// Motor current, A.
    pub amps: Option<f64>,
    /// Main battery, V.
    pub volts: Option<f64>,
    /// The current limit was at work.
    pub limited: bool,
}

/// What the axis was commanded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// Duty, -1 to 1.
    Duty(f64),
    /// Speed, counts/s.
    Speed(f64),
    /// Position in counts from the start of the run, and speed bound.
    Position(f64, f64),
}

/// A command and when it took effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Middle of the exchange, s from the start of the run.
    pub t: f64,
    /// What was commanded.
    pub input: Input,
}
