//! Ready-made axes: the files of `assets/presets`, built into the program.
//!
//! A preset holds an axis, the supply it is meant for, and the figures a data sheet would state for it, which a test measures
//! on the simulated axis.

use crate::plant::{AxisParams, SupplyParams};
use crate::world::{Wiring, WorldParams};
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Name of the preset that drives both channels of a controller when none is named.
pub const DEFAULT_PRESET: &str = "small-gearmotor";

/// One ready-made axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    /// Name in command lines: lower case with hyphens, the same as the file's.
    pub name: String,
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

/// No preset has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no preset \"{name}\": take one of {known}")]
pub struct UnknownPreset {
    /// What was asked for.
    pub name: String,
    /// All names, separated by commas.
    pub known: String,
}

static PRESETS: LazyLock<Vec<Preset>> = LazyLock::new(|| {
    const FILES: [&str; 8] = [
        include_str!("../../../assets/presets/small-gearmotor.json"),
        include_str!("../../../assets/presets/large-gearmotor.json"),
        include_str!("../../../assets/presets/direct-drive.json"),
        include_str!("../../../assets/presets/linear-actuator.json"),
        include_str!("../../../assets/presets/flywheel.json"),
        include_str!("../../../assets/presets/coarse-encoder.json"),
        include_str!("../../../assets/presets/steering.json"),
        include_str!("../../../assets/presets/arm-joint.json"),
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

/// The preset of this name, whatever its case.
pub fn preset(name: &str) -> Result<&'static Preset, UnknownPreset> {
    presets().iter().find(|preset| preset.name.eq_ignore_ascii_case(name)).ok_or_else(|| UnknownPreset {
        name: name.to_owned(),
        known: presets().iter().map(|preset| preset.name.as_str()).collect::<Vec<_>>().join(", "),
    })
}

/// A world with one preset on each channel, on the supply of the first, with nothing wired to its `pins` input pins.
pub fn world_of(first: &Preset, second: &Preset, pins: usize) -> WorldParams {
    WorldParams {
        axes: [first.axis.clone(), second.axis.clone()],
        supply: first.supply,
        board: crate::plant::BoardParams::default(),
        wiring: Wiring::default(),
        pins,
    }
}
