//! Simulated Motion Minds as a program serves them.

use crate::sim_spec::MotionMindSpec;
use brushwork_family::examine::Examination;
use brushwork_family::{Simulator, SimulatorError, Started};
use brushwork_link::FamilyRef;
use brushwork_motion_mind_client::{MOTION_MIND, unit_address};

/// What makes them.
#[derive(Clone, Copy, Debug)]
pub struct MotionMindSimulator;

impl Simulator for MotionMindSimulator {
    fn family(&self) -> FamilyRef {
        MOTION_MIND
    }

    fn is_asked_for(&self, text: &str) -> bool {
        MotionMindSpec::is_asked_for(text)
    }

    fn start(&self, text: &str) -> Result<Started, SimulatorError> {
        let spec = MotionMindSpec::parse(text).map_err(SimulatorError::Spec)?;
        let addresses = spec.addresses.iter().filter_map(|address| unit_address(address.get())).collect();
        Ok(Started::on_a_line(Box::new(spec.bus()?), addresses, spec.seed))
    }

    fn like(&self, examination: &Examination) -> Result<(Started, Vec<String>), SimulatorError> {
        let (spec, unlike) = MotionMindSpec::like(examination).map_err(SimulatorError::Spec)?;
        let addresses = spec.addresses.iter().filter_map(|address| unit_address(address.get())).collect();
        Ok((Started::on_a_line(Box::new(spec.bus()?), addresses, spec.seed), unlike))
    }
}
