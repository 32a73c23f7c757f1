//! Generations, scales and limits that lines of several parts of the table share.

use brushwork_mcp_wire::packet_serial::{Generation, scale};

use crate::settings::template::Limits;
use brushwork_link::settings::Coding;

pub const GEN1: Generation = Generation::Gen1;
pub const GEN2: Generation = Generation::Gen2;
pub const GEN3: Generation = Generation::Gen3;
pub const GEN4: Generation = Generation::Gen4;

pub const VOLTS: Coding = Coding::PerUnit(steps_of(scale::VOLTAGE_VOLTS));
pub const AMPS: Coding = Coding::PerUnit(steps_of(scale::CURRENT_AMPS));
pub const DECISECONDS: Coding = Coding::PerUnit(steps_of(scale::DECISECOND_S));
pub const VELOCITY_GAIN: Coding = Coding::PerUnit(scale::VELOCITY_GAIN);
pub const POSITION_GAIN: Coding = Coding::PerUnit(scale::POSITION_GAIN);
pub const DUTY_ACCEL: Coding = Coding::PerUnit(scale::DUTY_ACCEL_RAW_PER_SECOND / 100.0);

pub const U32_STEPS: Limits = Limits::Steps(0, 0xFFFF_FFFF);
pub const I32_STEPS: Limits = Limits::Steps(-0x8000_0000, 0x7FFF_FFFF);
pub const U8_STEPS: Limits = Limits::Steps(0, 0xFF);

/// Whole steps per unit of a scale such as 0.1 V per count, free of the rounding in its reciprocal.
pub const fn steps_of(unit_per_step: f64) -> f64 {
    (1.0 / unit_per_step).round()
}
