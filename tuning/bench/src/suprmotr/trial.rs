//! Gains tried on the true plant: the simulated board itself, its registers written past the wire.

use super::population::{BoardSetup, command_unit};
use crate::trial::{Outcome, motion_of, position_outcome};
use crate::unit::UnderTest;
use brushwork_plant::world::WorldAction;
use brushwork_suprmotr_axis::law::{DRIVE_STEPS, SuprMotrRegisters, quickest};
use brushwork_suprmotr_sim::SuprMotr;
use brushwork_suprmotr_sim::assumed::TICK;
use brushwork_tuning::score::{LOAD_STEP_DUTY, horizon_s, position_step};
use brushwork_values::Motor;

pub(super) struct Machine<'a> {
    under_test: &'a UnderTest<BoardSetup>,
    unit: SuprMotr,
}

impl<'a> Machine<'a> {
    pub(super) fn new(under_test: &'a UnderTest<BoardSetup>, registers: &SuprMotrRegisters) -> Self {
        let mut unit = under_test.fresh.clone();
        let SuprMotrRegisters { p, i, d, integral_limit } = registers;
        command_unit(&mut unit, &format!("DP{p},DI{i},DD{d},DL{integral_limit},SM32767"));
        let pace = quickest();
        command_unit(&mut unit, &format!("DV{},DA{}", pace.velocity, pace.acceleration));
        Self { under_test, unit }
    }

    /// One turn of the loop; the true place of the shaft that the encoder sits on in counts, and the duty.
    fn tick(&mut self) -> (f64, f64) {
        self.unit.advance(self.unit.now() + TICK);
        let (_, position) = motion_of(&self.under_test.specimen.axis, &self.unit.truth());
        (position, self.unit.drive() as f64 / DRIVE_STEPS)
    }

    fn errors(&mut self, goal: f64) -> (Vec<f64>, Vec<f64>) {
        let ticks = (horizon_s(self.under_test.truth.tau_s) / TICK.as_secs_f64()) as usize;
        let error = |machine: &mut Self| {
            let (position, duty) = machine.tick();
            (goal - position, duty)
        };
        (0..ticks).map(|_| error(self)).unzip()
    }

    /// A step of a third of a time constant's travel, as quick as DV and DA may be, then the load.
    pub(super) fn position(mut self) -> Outcome {
        let truth = &self.under_test.truth;
        let step = position_step(truth.gain_counts_per_s, truth.tau_s);
        self.tick();
        command_unit(&mut self.unit, &format!("MA{step}"));
        let (after_step, duties) = self.errors(step);
        let newton_metres = self.under_test.specimen.load_torque(LOAD_STEP_DUTY);
        self.unit.apply(&WorldAction::SetLoadTorque { motor: Motor::M1, newton_metres });
        let (after_load, _) = self.errors(step);
        position_outcome((&after_step, &after_load), &duties, TICK.as_secs_f64(), step)
    }
}
