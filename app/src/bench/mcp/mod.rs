//! What is measured of an MCP or RoboClaw: link, stop, simulator, scripts.

mod link;
mod mcl;
mod rig;
mod sim;
mod stop;

use super::Measure;
use super::arguments::BenchArg;

/// What is measured, and what measures it.
pub const MEASURES: &[Measure] = &[
    (BenchArg::Link, link::measure),
    (BenchArg::Stop, stop::measure),
    (BenchArg::Sim, |effort, _| sim::measure(effort)),
    (BenchArg::Mcl, |effort, _| mcl::measure(effort)),
];
