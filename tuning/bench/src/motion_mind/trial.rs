//! Gains tried on the true plant: the simulated Motion Mind itself, its registers written past the wire.

use super::population::{MindSetup, command_unit};
use crate::trial::{Outcome, motion_of, position_outcome, velocity_outcome};
use crate::unit::UnderTest;
use brushwork_motion_mind_axis::law::{LOOPS_PER_S, MotionMindRegisters, SPEED_STEP_COUNTS_PER_S};
use brushwork_motion_mind_sim::MotionMind;
use brushwork_motion_mind_wire::Command;
use brushwork_plant::world::WorldAction;
use brushwork_tuning::score::{LOAD_STEP_DUTY, VELOCITY_STEP, horizon_s, position_step};
use brushwork_values::Motor;
use std::time::Duration;

/// A loop of the unit.
pub(super) const TICK: Duration = Duration::from_micros(1_000_000 / LOOPS_PER_S as u64);

pub(super) struct Machine<'a> {
    under_test: &'a UnderTest<MindSetup>,
    unit: MotionMind,
    tick_s: f64,
}

impl<'a> Machine<'a> {
    pub(super) fn new(under_test: &'a UnderTest<MindSetup>, registers: &MotionMindRegisters) -> Self {
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
        Self { under_test, unit, tick_s: TICK.as_secs_f64() }
    }

    fn ticks(&self) -> usize {
        (horizon_s(self.under_test.truth.tau_s) / self.tick_s) as usize
    }

    /// One loop; true speed and position of the shaft that the encoder sits on in counts, and the duty.
    fn tick(&mut self) -> (f64, f64, f64) {
        self.unit.advance(self.unit.now() + TICK);
        let (speed, position) = motion_of(&self.under_test.specimen.axis, &self.unit.truth());
        (speed, position, self.unit.duty())
    }

    fn load(&mut self) {
        let newton_metres = self.under_test.specimen.load_torque(LOAD_STEP_DUTY);
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
    pub(super) fn velocity(mut self) -> Outcome {
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
    pub(super) fn position(mut self) -> Outcome {
        let step = position_step(self.under_test.truth.gain_counts_per_s, self.under_test.truth.tau_s);
        self.tick();
        command_unit(&mut self.unit, &Command::MoveToAbsolute(step as i32));
        let (after_step, duties) = self.errors(step, false);
        self.load();
        let (after_load, _) = self.errors(step, false);
        position_outcome((&after_step, &after_load), &duties, self.tick_s, step)
    }
}
