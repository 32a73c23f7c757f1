//! The axis of a Motion Mind that the bench tunes.

use super::line::MindLine;
use super::population::MindSpecimen;
use brushwork_motion_mind_axis::MindAxis;
use brushwork_motion_mind_axis::law::MotionMindLaw;
use brushwork_motion_mind_sim::Mode;

/// What a run is asked for.
pub type Request = brushwork_tuning::tune::Request<MotionMindLaw>;
/// The report of a run.
pub type Report = brushwork_tuning::report::Report<MotionMindLaw>;
/// An axis over the simulated unit.
pub type SimulatedMind = MindAxis<MindLine>;

/// The axis of a plant.
#[must_use]
pub fn axis_of(specimen: &MindSpecimen) -> SimulatedMind {
    MindAxis::new(MindLine::new(specimen))
}

/// The axis of a plant whose unit is set to another mode.
#[must_use]
pub fn axis_in(specimen: &MindSpecimen, mode: Mode) -> SimulatedMind {
    MindAxis::new(MindLine::of(specimen.unit_in(mode), specimen))
}
