//! Simulated units of a family, as the server in a program drives them, and the list of families that have some.

use crate::examine::Examination;
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_link::{FamilyRef, Stream, UnitAddress};
use brushwork_plant::ParamsError;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::ServerOptions;
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;
use std::sync::{Arc, PoisonError, RwLock};

/// Units that were made, and the line that they are on.
pub struct Started {
    /// The units.
    pub machine: Box<dyn Machine>,
    /// Their addresses.
    pub addresses: Vec<UnitAddress>,
    /// Their node ids, where the line is the adapter of a CAN bus.
    pub nodes: Vec<NodeId>,
    /// How that adapter writes frames.
    pub can_form: Option<Form>,
    /// The stream of the machine that is served.
    pub index: StreamIndex,
    /// The stream of the controller that its line is on.
    pub stream: Stream,
    /// Seed of noise and faults.
    pub seed: u64,
}

impl Started {
    /// Units of a family that has one serial line and no other.
    #[must_use]
    pub fn on_a_line(machine: Box<dyn Machine>, addresses: Vec<UnitAddress>, seed: u64) -> Self {
        Self {
            machine,
            addresses,
            nodes: Vec::new(),
            can_form: None,
            index: ServerOptions::default().stream,
            stream: Stream::Rs232,
            seed,
        }
    }
}

/// Why units cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum SimulatorError {
    /// The text describes none; a clause.
    #[error("{0}")]
    Spec(String),
    /// Figures of a preset that make no sense.
    #[error(transparent)]
    Params(#[from] ParamsError),
    /// They do not fit on the line together; a clause.
    #[error("{0}")]
    Line(String),
}

/// What makes the simulated units of a family.
pub trait Simulator: Send + Sync {
    /// The family.
    fn family(&self) -> FamilyRef;

    /// Whether the text behind `sim:` asks for units of this family.
    fn is_asked_for(&self, text: &str) -> bool;

    /// Makes what the text behind `sim:` describes.
    ///
    /// # Errors
    /// A clause that names the part at fault and what may stand there.
    fn start(&self, text: &str) -> Result<Started, SimulatorError>;

    /// Makes a unit that behaves as an examination says, and says what of that it cannot imitate, a sentence each.
    ///
    /// # Errors
    /// A clause: no unit can be made.
    fn like(&self, _examination: &Examination) -> Result<(Started, Vec<String>), SimulatorError> {
        Err(SimulatorError::Spec("the simulator of this family cannot imitate a unit yet".to_owned()))
    }

    /// A setting of a unit, counted from 0, that has no public way over the wire.
    fn hidden(&self, _machine: &mut dyn Machine, _unit: usize, _key: &str) -> Option<i64> {
        None
    }

    /// Sets one.
    ///
    /// # Errors
    /// A sentence: there is none of that key.
    fn set_hidden(
        &self,
        _machine: &mut dyn Machine,
        _unit: usize,
        _key: &str,
        _value: i64,
    ) -> Result<(), String> {
        Err("This simulated controller has no settings past the wire.".to_owned())
    }

    /// Asks the debugger of a unit's script for something, and for a look at it; `None` without scripts.
    fn debug(
        &self,
        _machine: &mut dyn Machine,
        _unit: usize,
        _requests: Vec<Request>,
        _wanted: &Wanted,
    ) -> Option<View> {
        None
    }

    /// Whether its units run programs of a language that are put into their memory past the wire.
    fn runs(&self, _language: Language) -> bool {
        false
    }

    /// Puts such a program into a unit's memory and starts it.
    fn run_program(&self, _machine: &mut dyn Machine, _unit: usize, _program: Arc<Program>) {}
}

static SIMULATORS: RwLock<Vec<&'static dyn Simulator>> = RwLock::new(Vec::new());

/// Names the simulators that this program has. What no other asks for is the first one's.
pub fn install(simulators: &[&'static dyn Simulator]) {
    let mut known = SIMULATORS.write().unwrap_or_else(PoisonError::into_inner);
    for simulator in simulators {
        if !known.iter().any(|known| known.family() == simulator.family()) {
            known.push(*simulator);
        }
    }
}

/// The simulator of a family; `None` where it has none.
#[must_use]
pub fn of(family: FamilyRef) -> Option<&'static dyn Simulator> {
    let known = SIMULATORS.read().unwrap_or_else(PoisonError::into_inner);
    known.iter().find(|simulator| simulator.family() == family).copied()
}

/// The simulator whose units the text behind `sim:` asks for; `None` in a program without any.
#[must_use]
pub fn asked_for(text: &str) -> Option<&'static dyn Simulator> {
    let known = SIMULATORS.read().unwrap_or_else(PoisonError::into_inner);
    known.iter().find(|simulator| simulator.is_asked_for(text)).or(known.first()).copied()
}
