//! Motors for an MCP or RoboClaw: eight kinds of machines, and four with absolute encoders.

use crate::population::{FirmwareDraw, Kind, KindRow, Specimen, draw_of, drawn, row};
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::motion::{ControlLaw, VelocityEstimate};
use brushwork_mcp_sim::settings::Settings;
use brushwork_plant::EncoderKind;
use brushwork_values::Motor;

/// A plant under packet serial. Its unit is the law of the firmware.
pub type PacketSpecimen = Specimen<ControlLaw>;

const KINDS: [KindRow; 8] = [
    row(Kind::Gearmotor, 12.0, (8e3, 13e3), (30.0, 90.0), 64.0, 6.0, 30.0, 0.2, 0.0, (0.0, 0.0)),
    row(Kind::RoverWheel, 12.0, (2e3, 9e3), (60.0, 250.0), 1632.0, 12.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::RobotBase, 24.0, (20e3, 80e3), (120.0, 600.0), 4096.0, 40.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::CorelessServo, 12.0, (100e3, 300e3), (6.0, 20.0), 2000.0, 4.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::LinearActuator, 12.0, (400.0, 1500.0), (15.0, 50.0), 48.0, 8.0, 20.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::Flywheel, 24.0, (10e3, 60e3), (700.0, 2500.0), 2048.0, 30.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::Steering, 12.0, (1.5e3, 5e3), (40.0, 150.0), 4096.0, 10.0, 50.0, 1.0, 1.0, (3e-4, 2e-3)),
    row(Kind::ArmJoint, 24.0, (10e3, 50e3), (30.0, 120.0), 8192.0, 15.0, 20.0, 1.0, 0.5, (1e-4, 1e-3)),
];

/// Machines with absolute encoders (MCP manual 2.4.3), 4096 counts a turn of the output but for the actuator's.
const ABSOLUTE_KINDS: [KindRow; 4] = [
    row(Kind::PotActuator, 24.0, (400.0, 1_200.0), (15.0, 60.0), 100.0, 6.0, 20.0, 0.0, 1.0, (0.0, 0.0)),
    row(Kind::PotSteering, 12.0, (1.5e3, 6e3), (40.0, 150.0), 4096.0, 10.0, 50.0, 0.0, 1.0, (0.0, 0.0)),
    row(Kind::PulseJoint, 24.0, (2e3, 9e3), (30.0, 120.0), 4096.0, 12.0, 60.0, 0.0, 1.0, (0.0, 0.0)),
    row(Kind::Turntable, 12.0, (4e3, 12e3), (60.0, 200.0), 4096.0, 8.0, 30.0, 0.0, 1.0, (0.0, 0.0)),
];
/// Noise of their readings, counts, and where they stand at first.
const ABSOLUTE_NOISE_COUNTS: (f64, f64) = (0.2, 0.8);
const ABSOLUTE_START_COUNTS: (f64, f64) = (1_200.0, 2_900.0);

impl PacketSpecimen {
    /// The controller with this motor on channel 1 and a small one on channel 2.
    #[must_use]
    pub fn controller_config(&self) -> ControllerConfig {
        let base = ControllerConfig::default();
        let mut config = ControllerConfig { world: self.world(&base.world), law: self.unit, ..base };
        config.settings = Some(self.settings(&config));
        config
    }

    /// Factory settings but for the current limit, the battery's lower limit and the travel.
    fn settings(&self, config: &ControllerConfig) -> Settings {
        let fresh = Controller::new(config.clone()).map(|unit| unit.settings());
        let mut settings = fresh.expect("every drawn figure is in its range");
        let motion = &mut settings.motors[Motor::M1.index()].motion;
        motion.max_current_raw = (self.current_limit_amps * 100.0) as u32;
        motion.position_min_counts = -2_000_000_000;
        motion.position_max_counts = 2_000_000_000;
        settings.battery.main_min_tenths = (self.volts() * 7.0) as u16;
        settings
    }
}

/// The law of the firmware that was drawn.
fn law_of((filter_s, extra_tick): FirmwareDraw) -> ControlLaw {
    let velocity_estimate = if filter_s > 0.0 {
        VelocityEstimate::LowPass { time_constant_s: filter_s }
    } else {
        VelocityEstimate::LastTick
    };
    ControlLaw { velocity_estimate, output_delay_ticks: u8::from(extra_tick), ..ControlLaw::default() }
}

/// Plant `number` of a seed, whatever the size of the population.
#[must_use]
pub fn specimen(seed: u64, number: usize) -> PacketSpecimen {
    drawn(&mut draw_of(seed, number, 0), &KINDS, number, law_of)
}

/// Plant `number` of the population with absolute encoders of a seed.
#[must_use]
pub fn absolute_specimen(seed: u64, number: usize) -> PacketSpecimen {
    let mut draw = draw_of(seed, number, 0xAB50_107E);
    let mut specimen = drawn(&mut draw, &ABSOLUTE_KINDS, number, law_of);
    let is_voltage = matches!(specimen.kind, Kind::PotActuator | Kind::PotSteering);
    let encoder = &mut specimen.axis.encoder;
    encoder.kind = if is_voltage { EncoderKind::Analog } else { EncoderKind::Pulse };
    encoder.noise_counts = draw.log(ABSOLUTE_NOISE_COUNTS);
    encoder.start_counts = draw.between(ABSOLUTE_START_COUNTS).floor() + 0.5;
    encoder.wraps = specimen.kind == Kind::Turntable;
    specimen
}
