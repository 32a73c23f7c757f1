//! Gains tried on the true plant: the simulated Motion Mind itself, its registers written past the wire.

use super::population::{MindSpecimen, command_unit};
use crate::oracle::PlantUnderTest;
use crate::trial::{Outcome, position_outcome, velocity_outcome};
use crate::truth::{Truth, full_speed, truth_under};
use brushwork_motion_mind_axis::law::{
    LOOPS_PER_S, MotionMindLaw, MotionMindRegisters, SPEED_STEP_COUNTS_PER_S,
};
use brushwork_motion_mind_sim::MotionMind;
use brushwork_motion_mind_wire::Command;
use brushwork_plant::ShaftSide;
use brushwork_plant::world::WorldAction;
use brushwork_tuning::model::{Gains, Lag};
use brushwork_tuning::score::{LOAD_STEP_DUTY, VELOCITY_STEP, horizon_s, position_step};
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;
use std::time::Duration;

/// Registers of a fresh unit that the gains do not touch.
const FACTORY: MotionMindRegisters = MotionMindRegisters {
    pterm: 6000,
    iterm: 35,
    dterm: 0,
    pidscalar: 14,
    velocity_ff: 128,
    deadband: 15,
    function: 0,
    function2: 0,
    virtual_limits: (-100_000, 100_000),
};

/// A plant under a Motion Mind.
#[derive(Debug)]
pub struct MindPlantUnderTest {
    /// The plant.
    pub specimen: MindSpecimen,
    /// Its truth.
    pub truth: Truth<MotionMindLaw>,
    fresh: MotionMind,
}

impl MindPlantUnderTest {
    /// This plant under test.
    #[must_use]
    pub fn new(specimen: MindSpecimen) -> Self {
        let qpps = full_speed(&specimen.plant);
        let truth = truth_under(&specimen.plant, MotionMindLaw::of_qpps(qpps), Lag::default());
        let mut fresh = specimen.unit();
        // To the beginning of a loop, so that every trial counts the same ones.
        fresh.advance(fresh.now() + TICK);
        Self { truth, fresh, specimen }
    }

    /// The factory's gains.
    #[must_use]
    pub fn factory(&self, method: Method) -> MotionMindRegisters {
        let gains = FACTORY.gains(self.truth.qpps, method != Method::Velocity);
        FACTORY.with(
            &gains,
            self.truth.qpps,
            MotionMindLaw { velocity_ff: FACTORY.velocity_ff, amps_limit: 0 },
        )
    }

    /// Gains as registers of a fresh unit.
    #[must_use]
    pub fn registers(&self, gains: &Gains, qpps: f64) -> MotionMindRegisters {
        FACTORY.with(gains, qpps, MotionMindLaw::of_qpps(qpps))
    }

    /// A trial of registers.
    #[must_use]
    pub fn trial(&self, method: Method, registers: &MotionMindRegisters) -> Outcome {
        let machine = Machine::new(self, registers);
        if method == Method::Velocity { machine.velocity() } else { machine.position() }
    }
}

impl PlantUnderTest for MindPlantUnderTest {
    type Law = MotionMindLaw;

    fn truth(&self) -> &Truth<MotionMindLaw> {
        &self.truth
    }

    fn rounded(&self, gains: &Gains) -> Gains {
        let qpps = self.truth.qpps;
        self.registers(gains, qpps).gains(qpps, gains.position.is_some())
    }

    fn outcome(&self, method: Method, gains: &Gains) -> Outcome {
        self.trial(method, &self.registers(gains, self.truth.qpps))
    }
}

/// A loop of the unit.
const TICK: Duration = Duration::from_micros(1_000_000 / LOOPS_PER_S as u64);

struct Machine<'a> {
    under_test: &'a MindPlantUnderTest,
    unit: MotionMind,
    per_motor_radian: f64,
    per_load_radian: Option<f64>,
    tick_s: f64,
}

impl<'a> Machine<'a> {
    fn new(under_test: &'a MindPlantUnderTest, registers: &MotionMindRegisters) -> Self {
        let axis = &under_test.specimen.plant.axis;
        let mut unit = under_test.fresh.clone();
        let values = [
            (2, i64::from(registers.velocity_ff)),
            (3, i64::from(registers.function)),
            (4, i64::from(registers.pterm)),
            (5, i64::from(registers.iterm)),
            (6, i64::from(registers.dterm)),
            (8, i64::from(registers.pidscalar)),
            (26, i64::from(registers.deadband)),
        ];
        for (register, value) in values {
            command_unit(&mut unit, &Command::Write { register, value });
        }
        let load_side = axis.encoder.side == ShaftSide::Load;
        Self {
            under_test,
            unit,
            per_motor_radian: axis.counts_per_motor_radian(),
            per_load_radian: load_side.then(|| axis.encoder.counts_per_turn / std::f64::consts::TAU),
            tick_s: TICK.as_secs_f64(),
        }
    }

    fn ticks(&self) -> usize {
        (horizon_s(self.under_test.truth.tau_s) / self.tick_s) as usize
    }

    /// One loop; true speed and position of the shaft that the encoder sits on in counts, and the duty.
    fn tick(&mut self) -> (f64, f64, f64) {
        self.unit.advance(self.unit.now() + TICK);
        let truth = self.unit.truth();
        let (speed, position) = match self.per_load_radian {
            Some(per) => (truth.load_radians_per_second * per, truth.load_radians * per),
            None => (
                truth.motor_radians_per_second * self.per_motor_radian,
                truth.motor_radians * self.per_motor_radian,
            ),
        };
        (speed, position, self.unit.duty())
    }

    fn load(&mut self) {
        let newton_metres = self.under_test.specimen.plant.load_torque(LOAD_STEP_DUTY);
        self.unit.apply(&WorldAction::SetLoadTorque { motor: Motor::M1, newton_metres });
    }

    fn errors(&mut self, goal: f64, is_velocity: bool) -> (Vec<f64>, Vec<f64>) {
        (0..self.ticks())
            .map(|_| {
                let (speed, position, duty) = self.tick();
                (goal - if is_velocity { speed } else { position }, duty)
            })
            .unzip()
    }

    /// 0.15 to 0.45 of full speed in whole counts for each loop, then the load.
    fn velocity(mut self) -> Outcome {
        let top = self.under_test.truth.gain_counts_per_s / SPEED_STEP_COUNTS_PER_S;
        let (low, high) = ((VELOCITY_STEP.0 * top).round(), (VELOCITY_STEP.1 * top).round());
        let tell_speed =
            |unit: &mut MotionMind, counts: f64| command_unit(unit, &Command::MoveAtVelocity(counts as i16));
        tell_speed(&mut self.unit, low);
        for _ in 0..self.ticks() * 7 / 10 {
            self.tick();
        }
        tell_speed(&mut self.unit, high);
        let (low, high) = (low * SPEED_STEP_COUNTS_PER_S, high * SPEED_STEP_COUNTS_PER_S);
        let (after_step, duties) = self.errors(high, true);
        self.load();
        let (after_load, _) = self.errors(high, true);
        velocity_outcome((&after_step, &after_load), &duties, self.tick_s, high - low)
    }

    /// A step of a third of a time constant's travel, then the load.
    fn position(mut self) -> Outcome {
        let step = position_step(self.under_test.truth.gain_counts_per_s, self.under_test.truth.tau_s);
        self.tick();
        command_unit(&mut self.unit, &Command::MoveToAbsolute(step as i32));
        let (after_step, duties) = self.errors(step, false);
        self.load();
        let (after_load, _) = self.errors(step, false);
        position_outcome((&after_step, &after_load), &duties, self.tick_s, step)
    }
}
