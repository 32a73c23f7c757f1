//! The motors of the benchmark: kinds of machines, their figures drawn log-uniformly from the ranges that a family gives.

use brushwork_plant::world::{Wiring, WorldParams};
use brushwork_plant::{
    AxisParams, BoardParams, CouplingParams, Datasheet, EncoderKind, EncoderParams, GearParams, ShaftSide,
    SupplyParams,
};
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
    /// Steering with the encoder behind the backlash.
    Steering,
    /// Arm joint, springy and with backlash.
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

/// One plant of the population, under a unit of some family.
#[derive(Clone, Debug)]
pub struct Specimen<U> {
    /// Its number, from 0.
    pub number: usize,
    /// Its kind.
    pub kind: Kind,
    /// Motor, gear, load, encoder.
    pub axis: AxisParams,
    /// Supply.
    pub supply: SupplyParams,
    /// How its controller is built or set up.
    pub unit: U,
    /// Current limit, A.
    pub current_limit_amps: f64,
    /// The link.
    pub link: LinkParams,
}

impl<U> Specimen<U> {
    /// The nominal battery voltage.
    #[must_use]
    pub fn volts(&self) -> f64 {
        self.supply.open_circuit_volts
    }

    /// The world of a controller with this motor on channel 1 and what `base` has on channel 2.
    #[must_use]
    pub fn world(&self, base: &WorldParams) -> WorldParams {
        WorldParams {
            axes: [self.axis.clone(), base.axes[1].clone()],
            supply: self.supply,
            board: BoardParams::default(),
            wiring: Wiring::default(),
            ..base.clone()
        }
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

/// What is drawn of a controller's firmware: its filter of the speed, s, and whether its output comes a tick late.
pub(crate) type FirmwareDraw = (f64, bool);

/// The draws of plant `number` of a seed.
pub(crate) fn draw_of(seed: u64, number: usize, stream: u64) -> Draw {
    let seed = seed.wrapping_mul(1_000_003).wrapping_add(number as u64);
    Draw(ChaCha8Rng::seed_from_u64(seed ^ stream))
}

/// Plant `number`, its kind and ranges from `kinds`, and its unit as the firmware that was drawn makes it.
pub(crate) fn drawn<U>(
    draw: &mut Draw,
    kinds: &[KindRow],
    number: usize,
    unit: impl FnOnce(FirmwareDraw) -> U,
) -> Specimen<U> {
    let row = &kinds[number % kinds.len()];
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
    let link = LinkParams {
        poll_s: draw.log((0.010, 0.020)),
        jitter_s: draw.log((0.0005, 0.003)),
        latency_s: draw.log((0.0003, 0.0015)),
        loss: draw.between((0.0, 0.02)),
        seed: draw.0.next_u64(),
    };
    let unit = unit((filter_s, extra_tick));
    Specimen { number, kind: row.kind, axis, supply, unit, current_limit_amps: limit * stall_amps, link }
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
