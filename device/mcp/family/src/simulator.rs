//! Simulated MCP and RoboClaw controllers as a program serves them.

use crate::config::config_of;
use crate::like::config_like;
use crate::sim_spec::SimSpec;
use brushwork_canopen::NodeId;
use brushwork_family::examine::Examination;
use brushwork_family::{Simulator, SimulatorError, Started};
use brushwork_link::{FamilyRef, Stream};
use brushwork_mcp_client::script::CHECKSUM_KEY;
use brushwork_mcp_client::{MCP, unit_address};
use brushwork_mcp_sim::controller::{Bus, Controller};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::models;
use brushwork_plant::ParamsError;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_script::debug::{Request, View, Wanted};
use std::any::Any;

/// What makes them.
#[derive(Clone, Copy, Debug)]
pub struct McpSimulator;

impl Simulator for McpSimulator {
    fn family(&self) -> FamilyRef {
        MCP
    }

    fn is_asked_for(&self, text: &str) -> bool {
        let model = text.split(',').next().unwrap_or_default().trim();
        model.is_empty() || models::lookup(model).is_some()
    }

    fn start(&self, text: &str) -> Result<Started, SimulatorError> {
        let spec = SimSpec::parse(text).map_err(|error| SimulatorError::Spec(error.to_string()))?;
        // Several units can only share a TTL wire; one alone hangs on USB.
        let (index, stream) = match spec.units.len() {
            _ if spec.can.is_some() => (StreamIndex::Usb, Stream::Usb),
            1 => (StreamIndex::Usb, Stream::Usb),
            _ => (StreamIndex::Uart1, Stream::Ttl1),
        };
        Ok(Started {
            machine: Box::new(bus_of(&spec, index)?),
            addresses: spec.units.iter().map(|unit| unit_address(unit.address)).collect(),
            nodes: spec.units.iter().map(|unit| unit.node).collect(),
            can_form: spec.can,
            index,
            stream,
            seed: spec.seed,
        })
    }

    fn like(&self, examination: &Examination) -> Result<(Started, Vec<String>), SimulatorError> {
        let (config, unlike) = config_like(examination).map_err(SimulatorError::Spec)?;
        let address = config.address;
        let seed = config.seed;
        let index = StreamIndex::Usb;
        let unit = Controller::new(config)?;
        let bus = Bus::new(vec![unit], index).map_err(|error| SimulatorError::Line(error.to_string()))?;
        let started = Started {
            machine: Box::new(bus),
            addresses: vec![unit_address(address)],
            nodes: vec![NodeId::DEFAULT],
            can_form: None,
            index,
            stream: Stream::Usb,
            seed,
        };
        Ok((started, unlike))
    }

    fn hidden(&self, machine: &mut dyn Machine, unit: usize, key: &str) -> Option<i64> {
        let controller = controllers(machine)?.get(unit)?;
        if key == CHECKSUM_KEY {
            return Some(i64::from(crc16_xmodem(controller.script_image())));
        }
        controller.settings().hidden(key).ok()
    }

    fn set_hidden(
        &self,
        machine: &mut dyn Machine,
        unit: usize,
        key: &str,
        value: i64,
    ) -> Result<(), String> {
        let controller = controllers(machine).and_then(|all| all.get_mut(unit));
        let Some(controller) = controller else {
            return Err("This simulated controller has no settings past the wire.".to_owned());
        };
        let action = WorldAction::SetHidden { key: key.to_owned(), value };
        controller.apply(&action).map_err(|unknown| format!("{unknown}."))
    }

    fn debug(
        &self,
        machine: &mut dyn Machine,
        unit: usize,
        requests: Vec<Request>,
        wanted: &Wanted,
    ) -> Option<View> {
        Some(controllers(machine)?.get_mut(unit)?.debug(requests, wanted))
    }
}

fn controllers(machine: &mut dyn Machine) -> Option<&mut [Controller]> {
    let machine: &mut dyn Any = machine;
    machine.downcast_mut::<Bus>().map(Bus::controllers_mut)
}

/// The machines that a description asks for, on one wire.
///
/// # Errors
/// Several units do not fit on this kind of wire.
pub fn bus_of(spec: &SimSpec, stream: StreamIndex) -> Result<Bus, SimulatorError> {
    let made = |unit| {
        let mut config = config_of(unit, spec.seed);
        if let Some(rate_bps) = spec.rate_bps {
            config.set_rate(stream, rate_bps);
        }
        Controller::new(config)
    };
    let units = spec.units.iter().map(made).collect::<Result<Vec<_>, ParamsError>>()?;
    let bus = match spec.can {
        Some(form) => Bus::on_can(units, form),
        None => Bus::new(units, stream),
    };
    bus.map_err(|error| SimulatorError::Line(error.to_string()))
}
