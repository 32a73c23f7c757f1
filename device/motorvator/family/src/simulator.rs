//! A simulated MotorVator as a program serves it.

use crate::sim_spec::MotorvatorSpec;
use brushwork_family::{Simulator, SimulatorError, Started};
use brushwork_link::{FamilyRef, Stream};
use brushwork_motorvator_client::{Half, MOTORVATOR, unit_address};
use brushwork_motorvator_sim::DrivenMotorvator;
use brushwork_plant::machine::Machine;
use brushwork_plant::server::ServerOptions;
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;
use std::any::Any;
use std::sync::Arc;

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
        let program = spec.program().map_err(SimulatorError::Spec)?;
        Ok(Started {
            machine: Box::new(spec.board(program)?),
            addresses: Half::ALL.map(unit_address).to_vec(),
            nodes: Vec::new(),
            can_form: None,
            index: ServerOptions::default().stream,
            stream: Stream::Rs232,
            seed: spec.seed,
        })
    }

    fn debug(
        &self,
        machine: &mut dyn Machine,
        _unit: usize,
        requests: Vec<Request>,
        wanted: &Wanted,
    ) -> Option<View> {
        Some(board(machine)?.debug(requests, wanted))
    }

    fn runs(&self, language: Language) -> bool {
        language == Language::Mecc
    }

    fn run_program(&self, machine: &mut dyn Machine, _unit: usize, program: Arc<Program>) {
        if let Some(board) = board(machine) {
            board.board_mut().load(program);
            board.board_mut().start();
        }
    }
}

fn board(machine: &mut dyn Machine) -> Option<&mut DrivenMotorvator> {
    let machine: &mut dyn Any = machine;
    machine.downcast_mut()
}
