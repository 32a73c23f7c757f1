//! What `brushwork status` asks an MCP or RoboClaw besides its readings, and why its motors do not run.

use brushwork_link::Wire;
use brushwork_link::device::Identity;
use brushwork_mcp_client::TypedWire as _;
use brushwork_mcp_client::diagnosis::{Evidence, Measured, PinEnd, diagnose, homed};
use brushwork_mcp_wire::packet_serial::{commands, name};
use serde_json::json;

use crate::family::{Judged, Said};
use crate::readings::Readings;

/// Where the input pins stand, in the raw percent of command 147. A RoboClaw does not know the command; its status word has bits of
/// its own.
pub fn read_inputs(wire: &mut dyn Wire) -> Option<Vec<i64>> {
    let values = wire.ask(commands::READ_SIGNAL_VALUES, &[]).ok()?;
    Some(values.records().map(|record| record.int(name::PERCENT)).collect())
}

/// Why the motors do not run, once the unit has reported anything, and which of them a pin holds.
pub fn judge(identity: &Identity, readings: &Readings) -> Judged {
    let settings = readings.settings.as_ref();
    let of_percent = |percent_raw: &i64| PinEnd::of_percent(*percent_raw);
    let pins = readings.inputs.as_ref().map(|inputs| inputs.iter().map(of_percent).collect::<Vec<_>>());
    let diagnosis = readings.status.as_ref().map(|status| {
        let evidence = Evidence {
            settings,
            pins: pins.as_deref(),
            stream: readings.stream,
            measured: Measured::of(|channel| readings.get(channel)),
            ..Evidence::of(status, identity)
        };
        let diagnosis = diagnose(&evidence);
        Said { sentence: diagnosis.sentence(), data: json!(diagnosis.findings) }
    });
    Judged { diagnosis, homed: settings.zip(pins.as_deref()).map(|(settings, pins)| homed(settings, pins)) }
}
