//! What `brushwork status` asks an MCP or RoboClaw besides its readings, and why its motors do not run.

use brushwork_link::Wire;
use brushwork_link::settings::SettingsImage;
use brushwork_mcp_client::TypedWire as _;
use brushwork_mcp_client::diagnosis::{self, Evidence, Measured, PinEnd};
use brushwork_mcp_wire::packet_serial::{commands, name};
use serde_json::json;

use crate::family::{Known, Said};

/// Where the input pins stand, in the raw percent of command 147. A RoboClaw does not know the command; its status word has bits of
/// its own.
pub fn read_inputs(wire: &mut dyn Wire) -> Option<Vec<i64>> {
    let values = wire.ask(commands::READ_SIGNAL_VALUES, &[]).ok()?;
    Some(values.records().map(|record| record.int(name::PERCENT)).collect())
}

fn ends(inputs: &[i64]) -> Vec<PinEnd> {
    inputs.iter().map(|percent_raw| PinEnd::of_percent(*percent_raw)).collect()
}

/// Which motors a pin holds at home or at a limit.
pub fn homed(settings: &SettingsImage, inputs: &[i64]) -> [bool; 2] {
    diagnosis::homed(settings, &ends(inputs))
}

/// Why the motors do not run, once the unit has reported anything.
pub fn diagnose(known: &Known<'_>) -> Option<Said> {
    let ends = known.inputs.map(ends);
    let diagnosis = diagnosis::diagnose(&Evidence {
        settings: known.settings,
        pins: ends.as_deref(),
        stream: known.stream,
        measured: Measured::of(|channel| known.newest.get(channel)),
        ..Evidence::of(known.status?, known.identity)
    });
    Some(Said { sentence: diagnosis.sentence(), data: json!(diagnosis.findings) })
}
