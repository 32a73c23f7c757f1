//! What the firmware measures at each tick, and how that looks in wire units.

use crate::motion::EncoderInput;
use brushwork_mcp_wire::packet_serial::scale;
use brushwork_plant::EncoderReading;
use brushwork_plant::world::{UnitFaults, World};
use brushwork_values::Motor;

/// One set of measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readings {
    /// Main battery, V.
    pub main_volts: f64,
    /// Logic battery input, V.
    pub logic_volts: f64,
    /// Board temperature at both sensors, degrees Celsius.
    pub celsius: [f64; 2],
    /// Bridge currents, A, positive from M+ to M-.
    pub amps: [f64; 2],
    /// The E-stop button.
    pub estop_pressed: bool,
    /// The buttons on the board ask for the battery to be detected.
    pub detects_battery: bool,
    /// What is wrong inside the unit.
    pub unit_faults: UnitFaults,
    /// The encoders as they are plugged in.
    pub(super) plugs: [EncoderReading; 2],
    /// What is taken as each motor's encoder.
    pub(super) encoders: [EncoderInput; 2],
}

impl Readings {
    /// Measures.
    pub(super) fn take(world: &mut World) -> Self {
        Self {
            main_volts: world.bus_volts(),
            logic_volts: world.logic_volts(),
            celsius: world.board_celsius(),
            amps: Motor::BOTH.map(|motor| world.measured_amps(motor)),
            estop_pressed: world.estop_pressed(),
            detects_battery: world.detects_battery(),
            unit_faults: world.unit_faults(),
            plugs: Motor::BOTH.map(|motor| world.encoder(motor)),
            encoders: [EncoderInput::Quadrature(0); 2],
        }
    }
}

/// A voltage in the wire's tenths, with the offset of command 115.
pub(super) fn volts_raw(volts: f64, offset_tenths: i8) -> i64 {
    ((volts / scale::VOLTAGE_VOLTS).round() as i64 + i64::from(offset_tenths)).clamp(0, i64::from(u16::MAX))
}

/// A temperature in the wire's tenths.
pub(super) fn celsius_raw(celsius: f64) -> i64 {
    ((celsius / scale::TEMPERATURE_CELSIUS).round() as i64).clamp(i64::from(i16::MIN), i64::from(i16::MAX))
}

/// A current in the wire's 10 mA.
pub(super) fn amps_raw(amps: f64) -> i64 {
    ((amps / scale::CURRENT_AMPS).round() as i64).clamp(i64::from(i16::MIN), i64::from(i16::MAX))
}
