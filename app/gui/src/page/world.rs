//! The world around a machine that the page turns.

use std::sync::Arc;

use brushwork_core::session::turned::Turned;
use brushwork_link::Failure;
use brushwork_plant::server::Pace;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;

use crate::parts::SimulatedWorld;

impl SimulatedWorld for Turned {
    fn apply(&self, unit: usize, action: WorldAction) -> Result<(), Failure> {
        Self::apply(self, unit, &action);
        Ok(())
    }

    fn views(&self) -> Option<Arc<Vec<WorldView>>> {
        Some(Arc::new(Self::views(self)))
    }

    fn unit_at(&self, address: u8) -> Option<usize> {
        self.unit_of(address)
    }

    fn debug(&self, unit: usize, requests: Vec<Request>, wanted: Wanted) -> Result<(), Failure> {
        Self::debug(self, unit, requests, &wanted);
        Ok(())
    }

    fn runs(&self, language: Language) -> bool {
        Self::runs(self, language)
    }

    fn run_program(&self, unit: usize, program: Arc<Program>) -> Result<(), Failure> {
        Self::run_program(self, unit, program);
        Ok(())
    }

    fn script(&self) -> Option<View> {
        Self::script(self)
    }

    fn pace(&self) -> Option<Pace> {
        Some(Self::pace(self))
    }

    fn set_pace(&self, pace: Pace) {
        Self::set_pace(self, pace);
    }
}
