//! What a motor controller drives and stands in, whatever its family: motors, gears, loads, encoders, the supply and the board's
//! temperature; the world around it, faults, the pace of its line, and the server that puts a simulated machine on a port.
//!
//! Everything but [`server`] is in SI units and advances by the step it is told; there is no clock, no IO and no firmware. What a
//! person can do to the machine while it runs (load, faults, switches) stands in [`world`].
//!
//! Each stretch of motion is linear between two events (a shaft that sticks, teeth that meet, a travel stop), so each step uses
//! the exact solution of the linear equations over the step, and only friction and the events are treated step by step. That
//! makes the step stable for any winding, inertia or spring, and cheap enough for two axes at many hundred times real time.

#![doc = include_str!("../README.md")]
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

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
mod step;
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
pub use step::MAX_STEP_S;
pub use supply::{BrakeResistorParams, ClampDrive, Supply, SupplyParams};
