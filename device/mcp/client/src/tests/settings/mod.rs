//! Tests of the settings over several files of the module: the table against the protocol, values, profiles.

mod conflicts;
mod consistency;
mod copies;
mod fake;
mod listing;
mod memory;
mod plan;
mod profile;
mod upgrade;
mod upgrade_matrix;
mod values;
mod writing;

use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;

use crate::subject;
use brushwork_link::settings::SettingsTable;

/// The table of one model and generation.
fn table(model: &str, generation: Generation) -> SettingsTable {
    brushwork_link::install(&[&crate::McpDriver]);
    let model = models::lookup(model).expect("the tests name models of the list");
    SettingsTable::new(subject(model, generation))
}

/// The tables of every model in every generation.
fn every_table() -> impl Iterator<Item = SettingsTable> {
    brushwork_link::install(&[&crate::McpDriver]);
    models::MODELS
        .iter()
        .flat_map(|model| Generation::ALL.map(|generation| SettingsTable::new(subject(model, generation))))
}
