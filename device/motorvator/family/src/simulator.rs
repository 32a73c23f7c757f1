//! A simulated MotorVator as a program serves it.

use crate::sim_spec::{MotorvatorSpec, library};
use brushwork_family::{Simulator, SimulatorError, Started};
use brushwork_link::{FamilyRef, Stream};
use brushwork_motorvator_client::{Half, MOTORVATOR, unit_address};
use brushwork_plant::server::ServerOptions;

/// What makes one.
#[derive(Clone, Copy, Debug)]
pub struct MotorvatorSimulator;

impl Simulator for MotorvatorSimulator {
    fn family(&self) -> FamilyRef {
        MOTORVATOR
    }

    fn is_asked_for(&self, text: &str) -> bool {
        MotorvatorSpec::is_asked_for(text)
    }

    fn start(&self, text: &str) -> Result<Started, SimulatorError> {
        let spec = MotorvatorSpec::parse(text).map_err(SimulatorError::Spec)?;
        Ok(Started {
            machine: Box::new(spec.board(library())?),
            addresses: Half::ALL.map(unit_address).to_vec(),
            nodes: Vec::new(),
            can_form: None,
            index: ServerOptions::default().stream,
            stream: Stream::Rs232,
            seed: spec.seed,
        })
    }
}
