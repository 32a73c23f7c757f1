//! Gains tried on the true plant: the simulator's own loop and machine, without a wire between them.

use crate::trial::{Outcome, motion_of, position_outcome, velocity_outcome};
use crate::unit::UnderTest;
use brushwork_mcp_axis::McpRegisters;
use brushwork_mcp_sim::motion::{
    Buffering, Channel, Conditions, ControlLaw, EncoderInput, Measured, MotionCommand, MotionSettings,
    PositionMove, PositionTarget,
};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::{World, WorldAction};
use brushwork_plant::{EncoderKind, EncoderReading};
use brushwork_tuning::score::{LOAD_STEP_DUTY, VELOCITY_STEP, horizon_s, position_step};
use brushwork_values::Motor;

/// The true plant under one channel.
struct Machine {
    world: World,
    channel: Channel,
    settings: MotionSettings,
    conditions: Conditions,
    tick_s: f64,
}

impl Machine {
    fn new(under_test: &UnderTest<ControlLaw>, registers: &McpRegisters) -> Self {
        let config = &under_test.fresh;
        let world = World::new(&config.world, 0).expect("every drawn figure is in its range");
        let mut settings =
            config.settings.as_ref().expect("the bench sets them").motors[Motor::M1.index()].motion;
        let v = registers.velocity.unwrap_or_default();
        (settings.velocity_p_raw, settings.velocity_i_raw, settings.velocity_d_raw) = (v.p, v.i, v.d);
        settings.qpps = v.qpps;
        if let Some(p) = registers.position {
            (settings.position_p_raw, settings.position_i_raw, settings.position_d_raw) = (p.p, p.i, p.d);
            settings.position_max_i = p.max_i;
            settings.position_deadzone_counts = p.deadzone;
            (settings.position_min_counts, settings.position_max_counts) = (p.min, p.max);
        }
        let law = &under_test.specimen.unit;
        Self {
            world,
            channel: Channel::new(law),
            settings,
            conditions: Conditions::default(),
            tick_s: 1.0 / f64::from(law.rate_hz),
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

    fn load(&mut self, newton_metres: f64) {
        self.world.apply(&WorldAction::SetLoadTorque { motor: Motor::M1, newton_metres });
    }

    /// Runs and gives `goal` less what `of` picks, and the duties.
    fn errors(&mut self, ticks: usize, goal: f64, of: fn((f64, f64)) -> f64) -> (Vec<f64>, Vec<f64>) {
        (0..ticks)
            .map(|_| {
                let duty = self.tick();
                let truth = self.world.truth(Motor::M1);
                (goal - of(motion_of(self.world.axis_params(Motor::M1), &truth)), duty)
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
pub(super) fn velocity_trial(under_test: &UnderTest<ControlLaw>, registers: &McpRegisters) -> Outcome {
    let (specimen, truth) = (&under_test.specimen, &under_test.truth);
    let mut machine = Machine::new(under_test, registers);
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

/// The position test: a step of a third of a time constant's travel, then the load.
pub(super) fn position_trial(under_test: &UnderTest<ControlLaw>, registers: &McpRegisters) -> Outcome {
    let (specimen, truth) = (&under_test.specimen, &under_test.truth);
    let mut machine = Machine::new(under_test, registers);
    let ticks = (horizon_s(truth.tau_s) / machine.tick_s) as usize;
    let step = position_step(truth.gain_counts_per_s, truth.tau_s);
    let start = specimen.axis.encoder.start_counts;
    for _ in 0..3 {
        machine.tick();
    }
    machine.command(MotionCommand::Position(
        PositionMove {
            acceleration: Some(0),
            speed_counts_per_s: Some(machine.settings.qpps),
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
