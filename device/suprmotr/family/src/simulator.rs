//! Simulated SuprMotrs as a program serves them.

use crate::sim_spec::SuprMotrSpec;
use brushwork_family::{Simulator, SimulatorError, Started};
use brushwork_link::FamilyRef;
use brushwork_suprmotr_client::{SUPRMOTR, unit_address};

/// What makes them.
#[derive(Clone, Copy, Debug)]
pub struct SuprMotrSimulator;

impl Simulator for SuprMotrSimulator {
    fn family(&self) -> FamilyRef {
        SUPRMOTR
    }

    fn is_asked_for(&self, text: &str) -> bool {
        SuprMotrSpec::is_asked_for(text)
    }

    fn start(&self, text: &str) -> Result<Started, SimulatorError> {
        let spec = SuprMotrSpec::parse(text).map_err(SimulatorError::Spec)?;
        let addresses = spec.addresses.iter().filter_map(|address| unit_address(address.get())).collect();
        Ok(Started::on_a_line(Box::new(spec.bus()?), addresses, spec.seed))
    }
}
