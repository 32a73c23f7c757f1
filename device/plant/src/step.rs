//! How long the steps are in which motion is followed.

/// Longest step of the plant in seconds. A control tick is cut into equal steps no longer than this: ten at 300 Hz, five at
/// 625 Hz. Electrical and mechanical motion is exact at any step; this one is set by how finely friction, teeth and stops are
/// to be followed.
pub const MAX_STEP_S: f64 = 1.0 / 3000.0;

/// Whether a step is so nearly as long as another that the solution for one serves for both: times are kept in whole nanoseconds,
/// so ticks of one rate differ by that much.
pub(crate) fn same_step(a_s: f64, b_s: f64) -> bool {
    (a_s - b_s).abs() <= 1e-5 * b_s
}

/// How many equal steps of at most [`MAX_STEP_S`] cover `dt_s`, and how long each is. A stretch of no length takes no step.
pub(crate) fn substeps(dt_s: f64) -> (usize, f64) {
    if dt_s.is_nan() || dt_s <= 0.0 {
        return (0, 0.0);
    }
    let steps = (dt_s / MAX_STEP_S - 1e-6).ceil().max(1.0);
    (steps as usize, dt_s / steps)
}
