//! Ready-made axes: the files of `presets`, built into the program.
//!
//! A preset holds an axis, the supply it is meant for, and the figures a data sheet would state for it, which a test measures
//! on the simulated axis.

use crate::world::{CanPeer, Wiring, WorldParams};
use crate::{AxisParams, SupplyParams};
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Name of the preset that drives both channels of a controller when none is named.
pub const DEFAULT: &str = "small-gearmotor";

/// One ready-made axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    /// Name in command lines: lower case with hyphens, the same as the file's.
    pub key: String,
    /// Name in lists.
    pub title: String,
    /// One or two sentences: what it is and what is special about it.
    pub description: String,
    /// The supply it is meant for.
    pub supply: SupplyParams,
    /// What a data sheet would say.
    pub stated: StatedFigures,
    /// The axis.
    pub axis: AxisParams,
}

/// Figures of an axis at full duty on its supply without load torque, each with its lowest and highest value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatedFigures {
    /// Speed of the motor shaft in turns per minute.
    pub motor_rpm: [f64; 2],
    /// Current with the shaft locked, lead resistance left out.
    pub stall_amps: [f64; 2],
    /// Time to 63 % of the speed.
    pub time_constant_s: [f64; 2],
    /// Encoder counts per second: what QPPS should be.
    pub counts_per_second: [f64; 2],
}

static PRESETS: LazyLock<Vec<Preset>> = LazyLock::new(|| {
    const FILES: [&str; 8] = [
        include_str!("../presets/small-gearmotor.json"),
        include_str!("../presets/large-gearmotor.json"),
        include_str!("../presets/direct-drive.json"),
        include_str!("../presets/linear-actuator.json"),
        include_str!("../presets/flywheel.json"),
        include_str!("../presets/coarse-encoder.json"),
        include_str!("../presets/steering.json"),
        include_str!("../presets/arm-joint.json"),
    ];
    FILES
        .iter()
        .map(|text| serde_json::from_str(text).expect("the files are built in and a test reads each of them"))
        .collect()
});

/// All presets; the first is the default.
pub fn presets() -> &'static [Preset] {
    &PRESETS
}

/// The preset whose key is `key`, whatever its case.
pub fn lookup(key: &str) -> Option<&'static Preset> {
    presets().iter().find(|preset| preset.key.eq_ignore_ascii_case(key))
}

/// The keys of all presets, in order.
pub fn keys() -> Vec<&'static str> {
    presets().iter().map(|preset| preset.key.as_str()).collect()
}

/// A world with one preset on each channel, on the supply of the first, with nothing wired to its `pins` input pins.
pub fn world_of(first: &Preset, second: &Preset, pins: usize) -> WorldParams {
    WorldParams {
        axes: [first.axis.clone(), second.axis.clone()],
        supply: first.supply,
        board: crate::BoardParams::default(),
        wiring: Wiring::default(),
        i2c: Vec::new(),
        can_peer: CanPeer::default(),
        pins,
    }
}
