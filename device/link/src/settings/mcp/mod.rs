//! The settings of the MCP and RoboClaw controllers: the one table that everything else reads.
//!
//! Each file holds the lines of one part of it, in screen order. A line names the commands and fields that
//! carry the setting by their names in the protocol table, so the order of fields on the wire never matters
//! here. Lines that differ between firmware generations have several forms; a setting without a public wire
//! form has a reason instead.

mod motor;
mod pins;
mod ports;
mod roboclaw;
mod unit;

use brushwork_mcp_wire::packet_serial::{Generation, scale};

use super::kind::Coding;
use super::template::{Limits, Template};

/// Every line of the table, in screen order.
pub(super) fn templates() -> impl Iterator<Item = &'static Template> {
    [unit::ROWS, motor::ROWS, pins::ROWS, ports::ROWS, roboclaw::ROWS].into_iter().flatten()
}

/// Commands that set something in the controller and carry no setting of this table, and why.
pub(super) static NOT_SETTINGS: &[(u8, &str)] = &[
    (2, "old form of 57, minimum only"),
    (3, "old form of 57, maximum only"),
    (26, "old form of 58, minimum only"),
    (27, "old form of 58, maximum only"),
    (96, "a label of the owner's, as text"),
    (102, "the level of an output, not a setting of it"),
    (103, "the level of an output, not a setting of it"),
    (200, "acts at once and keeps nothing"),
    (253, "memory for the user's script, not for settings"),
];

const GEN1: Generation = Generation::Gen1;
const GEN2: Generation = Generation::Gen2;
const GEN3: Generation = Generation::Gen3;
const GEN4: Generation = Generation::Gen4;

const VOLTS: Coding = Coding::PerUnit(steps_of(scale::VOLTAGE_VOLTS));
const AMPS: Coding = Coding::PerUnit(steps_of(scale::CURRENT_AMPS));
const DECISECONDS: Coding = Coding::PerUnit(steps_of(scale::DECISECOND_S));
const VELOCITY_GAIN: Coding = Coding::PerUnit(scale::VELOCITY_GAIN);
const POSITION_GAIN: Coding = Coding::PerUnit(scale::POSITION_GAIN);
const DUTY_ACCEL: Coding = Coding::PerUnit(scale::DUTY_ACCEL_RAW_PER_SECOND / 100.0);

const U32_STEPS: Limits = Limits::Steps(0, 0xFFFF_FFFF);
const I32_STEPS: Limits = Limits::Steps(-0x8000_0000, 0x7FFF_FFFF);
const U8_STEPS: Limits = Limits::Steps(0, 0xFF);

/// Whole steps per unit of a scale such as 0.1 V per count, free of the rounding in its reciprocal.
const fn steps_of(unit_per_step: f64) -> f64 {
    (1.0 / unit_per_step).round()
}
