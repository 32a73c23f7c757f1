//! What a result may reach at most to be accepted.

use brushwork_tuning::tune::Method;

/// Highest true sensitivity and duty noise that are accepted.
pub const MOST_MS: f64 = 2.0;
/// Highest true sensitivity of gains that are given without a warning.
pub const PROMISED_MS: f64 = 1.8;

/// Highest overshoot that is accepted.
#[must_use]
pub fn most_overshoot(method: Method) -> f64 {
    if method == Method::Velocity { 0.25 } else { 0.10 }
}
