//! The motors of the benchmark: eight kinds of machines, their figures drawn log-uniformly from the ranges of the field.

use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::motion::{ControlLaw, VelocityEstimate};
use brushwork_mcp_sim::settings::Settings;
use brushwork_plant::world::{Wiring, WorldParams};
use brushwork_plant::{
    AxisParams, BoardParams, CouplingParams, Datasheet, EncoderKind, EncoderParams, GearParams, ShaftSide,
    SupplyParams,
};
use brushwork_values::Motor;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// The kinds of machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Gearmotor with the encoder on the motor.
    Gearmotor,
    /// Wheel of a rover.
    RoverWheel,
    /// Robot base at 24 V.
    RobotBase,
    /// Coreless servo.
    CorelessServo,
    /// Linear actuator with a coarse encoder.
    LinearActuator,
    /// Flywheel.
    Flywheel,
    /// Steering with the encoder behind the play.
    Steering,
    /// Arm joint, springy and with play.
    ArmJoint,
    /// Actuator with a potentiometer over its travel.
    PotActuator,
    /// Steering with a potentiometer.
    PotSteering,
    /// Joint with a magnetic encoder that gives pulses.
    PulseJoint,
    /// Turntable with such an encoder, which goes on from 4095 to 0.
    Turntable,
}

#[derive(Clone, Copy)]
pub(crate) struct KindRow {
    kind: Kind,
    volts: f64,
    qpps: (f64, f64),
    tau_ms: (f64, f64),
    counts_per_turn: f64,
    stall_amps: f64,
    ratio: f64,
    two_mass: f64,
    load_side: f64,
    backlash_turns: (f64, f64),
}

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

#[expect(clippy::too_many_arguments, reason = "a row of the table above, in its order")]
pub(crate) const fn row(
    kind: Kind,
    volts: f64,
    qpps: (f64, f64),
    tau_ms: (f64, f64),
    counts_per_turn: f64,
    stall_amps: f64,
    ratio: f64,
    two_mass: f64,
    load_side: f64,
    backlash_turns: (f64, f64),
) -> KindRow {
    KindRow {
        kind,
        volts,
        qpps,
        tau_ms,
        counts_per_turn,
        stall_amps,
        ratio,
        two_mass,
        load_side,
        backlash_turns,
    }
}

/// The link of a plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkParams {
    /// Time between polls, s.
    pub poll_s: f64,
    /// Standard deviation of when a poll starts, s.
    pub jitter_s: f64,
    /// Mean latency of requests and of replies, s.
    pub latency_s: f64,
    /// Share of exchanges that get lost.
    pub loss: f64,
    /// Seed of its randomness.
    pub seed: u64,
}

/// One plant of the population.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Its number, from 0.
    pub number: usize,
    /// Its kind.
    pub kind: Kind,
    /// Motor, gear, load, encoder.
    pub axis: AxisParams,
    /// Supply.
    pub supply: SupplyParams,
    /// The firmware's law.
    pub law: ControlLaw,
    /// Current limit, A.
    pub current_limit_amps: f64,
    /// The link.
    pub link: LinkParams,
}

impl Specimen {
    /// The nominal battery voltage.
    #[must_use]
    pub fn volts(&self) -> f64 {
        self.supply.open_circuit_volts
    }

    /// The controller with this motor on channel 1 and a small one on channel 2.
    #[must_use]
    pub fn controller_config(&self) -> ControllerConfig {
        let base = ControllerConfig::default();
        let world = WorldParams {
            axes: [self.axis.clone(), base.world.axes[1].clone()],
            supply: self.supply,
            board: BoardParams::default(),
            wiring: Wiring::default(),
            ..base.world.clone()
        };
        let mut config = ControllerConfig { world, law: self.law, ..base };
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

    /// The load torque that a duty of `share` at a standstill balances, at the output shaft.
    #[must_use]
    pub fn load_torque(&self, share: f64) -> f64 {
        let motor = &self.axis.motor;
        share
            * self.axis.stall_amps(self.volts())
            * motor.torque_constant_newton_metres_per_amp
            * self.axis.gear.ratio
    }
}

/// The population of a seed: `n` plants, the kinds in turn.
#[must_use]
pub fn population(seed: u64, n: usize) -> Vec<Specimen> {
    (0..n).map(|number| specimen(seed, number)).collect()
}

/// Plant `number` of a seed, whatever the size of the population.
#[must_use]
pub fn specimen(seed: u64, number: usize) -> Specimen {
    drawn(&KINDS, seed, number)
}

/// Plant `number` of a seed, its kind and ranges from `kinds`.
pub(crate) fn drawn(kinds: &[KindRow], seed: u64, number: usize) -> Specimen {
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed.wrapping_mul(1_000_003).wrapping_add(number as u64)));
    made(&mut draw, &kinds[number % kinds.len()], number)
}

/// Machines with absolute encoders, a population of its own: `n` plants, the kinds in turn.
#[must_use]
pub fn absolute_population(seed: u64, n: usize) -> Vec<Specimen> {
    (0..n).map(|number| absolute_specimen(seed, number)).collect()
}

/// Plant `number` of the absolute population of a seed.
#[must_use]
pub fn absolute_specimen(seed: u64, number: usize) -> Specimen {
    let stream = seed.wrapping_mul(1_000_003).wrapping_add(number as u64) ^ 0xAB50_107E;
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(stream));
    let row = &ABSOLUTE_KINDS[number % ABSOLUTE_KINDS.len()];
    let mut specimen = made(&mut draw, row, number);
    let is_voltage = matches!(row.kind, Kind::PotActuator | Kind::PotSteering);
    let encoder = &mut specimen.axis.encoder;
    encoder.kind = if is_voltage { EncoderKind::Analog } else { EncoderKind::Pulse };
    encoder.noise_counts = draw.log(ABSOLUTE_NOISE_COUNTS);
    encoder.start_counts = draw.between(ABSOLUTE_START_COUNTS).floor() + 0.5;
    encoder.wraps = row.kind == Kind::Turntable;
    specimen
}

fn made(draw: &mut Draw, row: &KindRow, number: usize) -> Specimen {
    let qpps = draw.log(row.qpps);
    let tau_s = draw.log(row.tau_ms) * 1e-3;
    let stall_amps = row.stall_amps * draw.log((0.6, 1.6));
    let (coulomb, stiction) = (draw.log((0.015, 0.12)), draw.log((1.0, 1.6)));
    let viscous = draw.log((0.005, 0.06));
    let electrical_s = draw.log((0.0002, 0.003)).min(0.25 * tau_s);
    let drop = draw.log((0.02, 0.12));
    let limit = [0.4, 0.7, 1.2][draw.one_of(3)];
    let (resonance, damping) = (draw.log((35.0, 110.0)), draw.log((0.05, 0.20)));
    let filter_s = match draw.uniform() {
        x if x < 0.5 => 0.0,
        x if x < 0.8 => 0.004,
        _ => 0.010,
    };
    let extra_tick = draw.uniform() < 0.5;
    let two_mass = draw.uniform() < row.two_mass;
    let load_side = draw.uniform() < row.load_side;
    let load_share = draw.between((0.2, 0.6));
    let backlash_turns = if row.backlash_turns.1 > 0.0 { draw.log(row.backlash_turns) } else { 0.0 };
    let side = if load_side { ShaftSide::Load } else { ShaftSide::Motor };
    let turns_per_s = qpps / row.counts_per_turn * if load_side { row.ratio } else { 1.0 };
    let sheet = Datasheet {
        volts: row.volts,
        no_load_radians_per_second: turns_per_s * std::f64::consts::TAU,
        stall_amps,
        mechanical_time_constant_s: tau_s,
        electrical_time_constant_s: electrical_s,
        coulomb_share: coulomb,
        stiction_ratio: stiction,
        viscous_share: viscous,
        load_share: if two_mass { load_share } else { 0.0 },
    };
    let gear = GearParams {
        ratio: row.ratio,
        backlash_radians: if two_mass { backlash_turns * std::f64::consts::TAU } else { 0.0 },
    };
    let encoder = EncoderParams {
        kind: EncoderKind::Quadrature,
        counts_per_turn: row.counts_per_turn,
        side,
        start_counts: 0.0,
        wraps: false,
        noise_counts: 0.0,
    };
    let mut axis = sheet.axis(gear, encoder);
    if two_mass {
        axis.load.coupling = Some(CouplingParams::with_resonance(&axis, resonance, damping));
    }
    let supply = SupplyParams {
        open_circuit_volts: row.volts,
        internal_ohms: drop * row.volts / stall_amps,
        ..SupplyParams::default()
    };
    let velocity_estimate = if filter_s > 0.0 {
        VelocityEstimate::LowPass { time_constant_s: filter_s }
    } else {
        VelocityEstimate::LastTick
    };
    let law =
        ControlLaw { velocity_estimate, output_delay_ticks: u8::from(extra_tick), ..ControlLaw::default() };
    let link = LinkParams {
        poll_s: draw.log((0.010, 0.020)),
        jitter_s: draw.log((0.0005, 0.003)),
        latency_s: draw.log((0.0003, 0.0015)),
        loss: draw.between((0.0, 0.02)),
        seed: draw.0.next_u64(),
    };
    Specimen { number, kind: row.kind, axis, supply, law, current_limit_amps: limit * stall_amps, link }
}

/// Draws from ranges.
pub(crate) struct Draw(pub ChaCha8Rng);

impl Draw {
    /// 0 to 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, (low, high): (f64, f64)) -> f64 {
        low + (high - low) * self.uniform()
    }

    pub(crate) fn log(&mut self, (low, high): (f64, f64)) -> f64 {
        low * (high / low).powf(self.uniform())
    }

    pub(crate) fn one_of(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n - 1)
    }

    /// Standard normal.
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
