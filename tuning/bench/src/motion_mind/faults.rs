//! Faults on a Motion Mind: the classes of the other family, but for the battery, whose voltage its wire does not carry.

use super::axis::{SimulatedMind, axis_of};
use super::plant_under_test::MindPlantUnderTest;
use super::population::MindSpecimen;
use crate::faults::{FaultRow, FaultyPlant, rows_of};
use crate::line::SimulatedLine;
use crate::population::Specimen;
use crate::truth::Truth;
use brushwork_motion_mind_axis::law::MotionMindLaw;
use brushwork_motion_mind_sim::MotionMind;
use brushwork_tuning::tune::Method;

impl FaultyPlant for MindSpecimen {
    type Law = MotionMindLaw;
    type Axis = SimulatedMind;
    type Unit = MotionMind;
    const WHOLE: [Method; 2] = [Method::Velocity, Method::Pd];
    const REPORTS_VOLTS: bool = false;
    /// The unit has no time-out: the motor runs up to the fence, half a second of it at its speed.
    const LINK_DEADLINE_S: f64 = 1.0;

    fn plant(&self) -> &Specimen {
        &self.plant
    }

    fn plant_mut(&mut self) -> &mut Specimen {
        &mut self.plant
    }

    fn truth(&self) -> Truth<MotionMindLaw> {
        MindPlantUnderTest::new(self.clone()).truth
    }

    fn axis(&self) -> SimulatedMind {
        axis_of(self)
    }

    fn line(axis: &mut SimulatedMind) -> &mut SimulatedLine<MotionMind> {
        &mut axis.carrier.line
    }
}

/// Every class on every plant, or those named only.
#[must_use]
pub fn fault_rows(plants: &[MindSpecimen], names: &[&str]) -> Vec<FaultRow> {
    rows_of(plants, names)
}
