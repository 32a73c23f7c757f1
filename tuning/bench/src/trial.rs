//! Gains tried on the true plant: the simulator's own loop and machine, without a wire between them.

use crate::population::Specimen;
use crate::truth::Truth;
use brushwork_mcp_axis::{
    PositionRegisters, VelocityRegisters, gains_of, position_registers, velocity_registers,
};
use brushwork_mcp_sim::motion::{
    Buffering, Channel, Conditions, EncoderInput, Measured, MotionCommand, MotionSettings, PositionMove,
    PositionTarget,
};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::{World, WorldAction};
use brushwork_plant::{EncoderKind, EncoderReading, ShaftSide};
use brushwork_tuning::linear::{LoopPlant, Margins};
use brushwork_tuning::model::Gains;
use brushwork_tuning::score::{LOAD_STEP_DUTY, Score, VELOCITY_STEP, horizon_s, position_step};
use brushwork_values::Motor;

/// Registers to be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registers {
    /// Velocity loop.
    pub velocity: VelocityRegisters,
    /// Position loop; `None` for a velocity test.
    pub position: Option<PositionRegisters>,
}

impl Registers {
    /// The registers of gains under the true law.
    #[must_use]
    pub fn of(gains: &Gains, qpps: f64, truth: &Truth) -> Self {
        let wide = (-2_000_000_000, 2_000_000_000);
        Self {
            velocity: velocity_registers(&gains.velocity, qpps, &truth.law),
            position: gains.position.map(|_| position_registers(gains, &truth.law, wide)),
        }
    }

    /// The gains they stand for under the true law.
    #[must_use]
    pub fn gains(&self, truth: &Truth) -> Gains {
        let gains = gains_of(&self.velocity, &self.position.unwrap_or_default(), &truth.law);
        Gains { position: self.position.and(gains.position), ..gains }
    }
}

/// What a trial showed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// The response.
    pub score: Score,
    /// Duty on the settled plateau, root mean square about its mean.
    pub duty_rms: f64,
    /// Whether it goes on oscillating, in a limit cycle, when it should be settled.
    pub hunting: bool,
    /// Deviation of the settled speed over the step (velocity), or peak to peak of the oscillation over the step (position).
    pub ripple: f64,
    /// How often it oscillates, Hz.
    pub ripple_hz: f64,
}

/// Linear judgement of registers on the true plant.
#[must_use]
pub fn linear(plant: &LoopPlant, truth: &Truth, registers: &Registers) -> (Margins, f64) {
    let gains = registers.gains(truth);
    let qpps = f64::from(registers.velocity.qpps).max(1.0);
    (plant.margins(&gains, qpps), plant.spectral_radius(&gains, qpps))
}

/// The true plant under one channel.
struct Machine {
    world: World,
    channel: Channel,
    settings: MotionSettings,
    conditions: Conditions,
    per_motor_radian: f64,
    per_load_radian: Option<f64>,
    tick_s: f64,
}

impl Machine {
    fn new(specimen: &Specimen, registers: &Registers) -> Self {
        let config = specimen.controller_config();
        let world = World::new(&config.world, 0).expect("every drawn figure is in its range");
        let mut settings = config.settings.expect("the bench sets them").motors[Motor::M1.index()].motion;
        let v = registers.velocity;
        (settings.velocity_p_raw, settings.velocity_i_raw, settings.velocity_d_raw) = (v.p, v.i, v.d);
        settings.qpps = v.qpps;
        if let Some(p) = registers.position {
            (settings.position_p_raw, settings.position_i_raw, settings.position_d_raw) = (p.p, p.i, p.d);
            settings.position_max_i = p.max_i;
            settings.position_deadzone_counts = p.deadzone;
            (settings.position_min_counts, settings.position_max_counts) = (p.min, p.max);
        }
        let encoder = &specimen.axis.encoder;
        let load_side = encoder.side == ShaftSide::Load;
        Self {
            world,
            channel: Channel::new(&specimen.law),
            settings,
            conditions: Conditions::default(),
            per_motor_radian: specimen.axis.counts_per_motor_radian(),
            per_load_radian: load_side.then(|| encoder.counts_per_turn / std::f64::consts::TAU),
            tick_s: 1.0 / f64::from(specimen.law.rate_hz),
        }
    }

    fn command(&mut self, command: MotionCommand) {
        let _ = self.channel.command(command, &self.settings);
    }

    /// One tick; the duty that was held in it.
    fn tick(&mut self) -> f64 {
        let channel = &mut self.channel;
        let mut first = true;
        self.world.advance_with(self.tick_s, |motor, sense| {
            if motor != Motor::M1 {
                BridgeOutput::Coast
            } else if std::mem::take(&mut first) {
                channel.output()
            } else {
                channel.refine(sense.amps, sense.bus_volts, sense.step_s)
            }
        });
        let measured = Measured {
            encoder: input_of(self.world.encoder(Motor::M1)),
            current_amps: self.world.measured_amps(Motor::M1),
            bus_volts: self.world.bus_volts(),
        };
        channel.tick(&measured, &self.conditions, &self.settings).duty()
    }

    /// True speed and position of the shaft that the encoder sits on, in counts.
    fn motion(&self) -> (f64, f64) {
        let truth = self.world.truth(Motor::M1);
        match self.per_load_radian {
            Some(per) => (truth.load_radians_per_second * per, truth.load_radians * per),
            None => (
                truth.motor_radians_per_second * self.per_motor_radian,
                truth.motor_radians * self.per_motor_radian,
            ),
        }
    }

    fn load(&mut self, newton_metres: f64) {
        self.world.apply(&WorldAction::SetLoadTorque { motor: Motor::M1, newton_metres });
    }

    /// Runs and gives `goal` less what `of` picks, and the duties.
    fn errors(&mut self, ticks: usize, goal: f64, of: fn((f64, f64)) -> f64) -> (Vec<f64>, Vec<f64>) {
        (0..ticks)
            .map(|_| {
                let duty = self.tick();
                (goal - of(self.motion()), duty)
            })
            .unzip()
    }
}

fn input_of(reading: EncoderReading) -> EncoderInput {
    match reading.kind {
        EncoderKind::Quadrature => EncoderInput::Quadrature(reading.counts),
        EncoderKind::Analog | EncoderKind::Pulse => EncoderInput::Absolute(reading.counts as i32),
    }
}

/// The velocity test: 0.15 to 0.45 of full speed, then a load of 15 % of the stall torque.
#[must_use]
pub fn velocity_trial(specimen: &Specimen, truth: &Truth, registers: &Registers) -> Outcome {
    let mut machine = Machine::new(specimen, registers);
    let ticks = (horizon_s(truth.tau_s) / machine.tick_s) as usize;
    let top = truth.gain_counts_per_s;
    let (low, high) = ((VELOCITY_STEP.0 * top).round(), (VELOCITY_STEP.1 * top).round());
    let speed = |counts: f64| MotionCommand::Speed { speed_counts_per_s: counts as i32, acceleration: None };
    machine.tick();
    machine.command(speed(low));
    for _ in 0..ticks * 7 / 10 {
        machine.tick();
    }
    machine.command(speed(high));
    let (after_step, duties) = machine.errors(ticks, high, |motion| motion.0);
    machine.load(specimen.load_torque(LOAD_STEP_DUTY));
    let (after_load, _) = machine.errors(ticks, high, |motion| motion.0);
    velocity_outcome((&after_step, &after_load), &duties, machine.tick_s, high - low)
}

/// What the errors of a velocity test after its step and after its load, and the duties of the first, are worth.
pub(crate) fn velocity_outcome(
    (after_step, after_load): (&[f64], &[f64]),
    duties: &[f64],
    tick_s: f64,
    step: f64,
) -> Outcome {
    let score = Score::of(after_step, after_load, tick_s, step, 0.05);
    let late = after_step.len() * 7 / 10;
    // Ripple beyond what a tick's rounding makes visible at all.
    let ripple = deviation(&after_step[late..]) / step;
    Outcome {
        score,
        duty_rms: deviation(&duties[late..]),
        hunting: ripple > 0.05,
        ripple,
        ripple_hz: crossings(&after_step[late..]) / (2.0 * (after_step.len() - late).max(1) as f64 * tick_s),
    }
}

/// The position test: a step of a third of a time constant's travel, then the load.
#[must_use]
pub fn position_trial(specimen: &Specimen, truth: &Truth, registers: &Registers) -> Outcome {
    let mut machine = Machine::new(specimen, registers);
    let ticks = (horizon_s(truth.tau_s) / machine.tick_s) as usize;
    let step = position_step(truth.gain_counts_per_s, truth.tau_s);
    let start = specimen.axis.encoder.start_counts;
    for _ in 0..3 {
        machine.tick();
    }
    machine.command(MotionCommand::Position(
        PositionMove {
            acceleration: Some(0),
            speed_counts_per_s: Some(registers.velocity.qpps),
            deceleration: Some(0),
            target: PositionTarget::Counts(start.floor() as i32 + step as i32),
        },
        Buffering::Immediate,
    ));
    let (after_step, duties) = machine.errors(ticks, step, |motion| motion.1);
    machine.load(specimen.load_torque(LOAD_STEP_DUTY));
    let (after_load, _) = machine.errors(ticks, step, |motion| motion.1);
    position_outcome((&after_step, &after_load), &duties, machine.tick_s, step)
}

/// The same of a position test.
pub(crate) fn position_outcome(
    (after_step, after_load): (&[f64], &[f64]),
    duties: &[f64],
    tick_s: f64,
    step: f64,
) -> Outcome {
    let score = Score::of(after_step, after_load, tick_s, step, 0.02_f64.max(3.0 / step));
    let late = after_step.len() * 7 / 10;
    let peak_to_peak = |errors: &[f64]| {
        let (l, h) =
            errors.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(*e), h.max(*e)));
        let turns = errors.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
        (h - l, turns)
    };
    let hunts = |errors: &[f64]| {
        let (height, turns) = peak_to_peak(&errors[late..]);
        height > (0.02 * step).max(4.0) && turns >= 2
    };
    let hunting = hunts(after_step) || hunts(after_load);
    let ripple = peak_to_peak(&after_step[late..]).0.max(peak_to_peak(&after_load[late..]).0) / step;
    let ripple_hz = crossings(&after_step[late..]) / (2.0 * (after_step.len() - late).max(1) as f64 * tick_s);
    Outcome { score, duty_rms: deviation(&duties[late..]), hunting, ripple, ripple_hz }
}

fn deviation(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// How often the values pass their mean.
fn crossings(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.windows(2).filter(|pair| (pair[0] - mean) * (pair[1] - mean) < 0.0).count() as f64
}
