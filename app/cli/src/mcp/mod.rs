//! MCP and RoboClaw on the command line: firmware, scripts, the language of scripts, and their part of the shared commands.

pub mod decoder;
mod eds;
mod firmware;
mod mcl;
mod protocol;
mod script;
mod sim;
mod unit;

use brushwork_link::family::Model;
use brushwork_link::{DeviceHandle, FamilyRef, Identity, SettingsImage, SettingsTable, Wire};
use brushwork_mcp_client::{MCP, settings};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_values::Motor;
use clap::ArgMatches;
use serde_json::json;

use super::{Exit, Family, Interrupt, Page, Readings, Simulated};
use crate::family::{Examples, Judged, Said, SimulatedModel};
use crate::monitor::follower::Follower;
use crate::tool::Tool;
use crate::units;
use decoder::Decoder;
use firmware::args::FirmwareArgs;
use script::args::ScriptArgs;

/// MCP and RoboClaw as commands see them.
#[derive(Debug)]
pub struct McpCommands;

impl Family for McpCommands {
    fn family(&self) -> FamilyRef {
        MCP
    }

    fn commands(&self) -> Vec<Tool> {
        let firmware = "Show what firmware is installed, and update it from a file of yours";
        let script = "Download, start and stop a controller's script";
        let eds = "Write the electronic data sheet (EDS) of a controller as a CANopen node";
        let mcl = "Check, build, run, list and format MCL scripts; print the language reference";
        vec![
            units::tool::<FirmwareArgs>("firmware", 10, firmware),
            units::tool::<ScriptArgs>("script", 11, script),
            Tool::new("mcl", 40, mcl, mcl::run),
            Tool::new("eds", 33, eds, eds::run),
        ]
    }

    fn examples(&self) -> Examples {
        Examples {
            model: "mcp266",
            options: "[,generation=4,preset=NAME]",
            lines: &["sim --model mcp2166 --generation 4 --preset flywheel --tcp 127.0.0.1:7000"],
            typed: "",
        }
    }

    fn simulated(&self, model: &Model) -> SimulatedModel {
        let assumed = models::lookup(model.key).map_or("", |model| model.assumed);
        SimulatedModel { rating: model.rating, assumed }
    }

    fn simulate(&self, sim: &ArgMatches) -> Result<Simulated, Exit> {
        sim::simulate(sim)
    }

    fn protocol(&self, names: &[String]) -> Result<Page, String> {
        protocol::page(names)
    }

    fn settings_reference(&self) -> Option<Page> {
        Some(Page::new(&settings::reference_text(), &settings::reference()))
    }

    fn conflicts(&self, table: &SettingsTable, image: &SettingsImage) -> Vec<Said> {
        let conflicts = settings::conflicts(table, &|key| image.get(key)).into_iter();
        conflicts
            .map(|conflict| Said { data: json!(conflict), sentence: conflict.sentence.to_string() })
            .collect()
    }

    fn follower(&self, generation: Option<u8>) -> Box<dyn Follower> {
        Box::new(Decoder::new(generation.and_then(Generation::from_number)))
    }

    fn full_speed(
        &self,
        motors: &[Motor],
        device: &DeviceHandle,
        interrupt: &Interrupt,
    ) -> Result<u32, Exit> {
        unit::qpps(motors, device, interrupt)
    }

    fn read_inputs(&self, wire: &mut dyn Wire) -> Option<Vec<i64>> {
        unit::read_inputs(wire)
    }

    fn judge(&self, identity: &Identity, readings: &Readings) -> Judged {
        unit::judge(identity, readings)
    }

    fn stopped_addresses(&self) -> Vec<u8> {
        Address::ALL.map(Address::get).to_vec()
    }
}
