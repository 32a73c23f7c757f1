//! What a motor controller drives and stands in, whatever its family: motors, gears, loads, encoders, the supply and the board's
//! temperature; the world around it, faults, the pace of its line, and the server that puts a simulated machine on a port.
//!
//! Everything but [`server`] is in SI units and advances by the step it is told; there is no clock, no IO and no firmware. What a
//! person can do to the machine while it runs (load, faults, switches) stands in [`world`].
//!
//! Each stretch of motion is linear between two events (a shaft that sticks, teeth that meet, a travel stop), so each step uses
//! the exact solution of the linear equations over the step, and only friction and the events are treated step by step. That
//! makes the step stable for any winding, inertia or spring, and cheap enough for two axes at many hundred times real time.

mod axis;
mod board;
pub mod bridge;
mod encoder;
pub mod faults;
mod friction;
mod linear;
pub mod machine;
mod noise;
pub mod pacing;
mod params;
pub mod presets;
mod rigid;
pub mod server;
mod supply;
mod travel;
mod two_mass;
pub mod world;

pub use axis::{Axis, AxisPower, AxisTruth};
pub use board::{Board, BoardParams};
pub use encoder::{ABSOLUTE_FULL_SCALE_VOLTS, ABSOLUTE_MAX_COUNTS, EncoderReading};
pub use params::{
    AxisParams, CouplingParams, CurrentSensorParams, Datasheet, EncoderKind, EncoderParams, FrictionParams,
    GearParams, LoadParams, MotorParams, ParamsError, ShaftSide, StopKind, TravelParams,
};
pub use supply::{BrakeResistorParams, ClampDrive, Supply, SupplyParams};

/// Longest step of the plant in seconds. A control tick is cut into equal steps no longer than this: ten at 300 Hz, five at
/// 625 Hz. Electrical and mechanical motion is exact at any step; this one is set by how finely friction, teeth and stops are
/// to be followed.
pub const MAX_STEP_S: f64 = 1.0 / 3000.0;

/// Whether a step is so nearly as long as another that the solution for one serves for both: times are kept in whole nanoseconds,
/// so ticks of one rate differ by that much.
fn same_step(a_s: f64, b_s: f64) -> bool {
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
