//! What shared commands ask of an MCP or RoboClaw: where its inputs stand, why its motors do not run, how fast they are.

use crate::messages::CliLinkMessage;
use brushwork_link::{DeviceHandle, Event, Identity, Request, Wire};
use brushwork_mcp_client::TypedWire as _;
use brushwork_mcp_client::diagnosis::{Evidence, Measured, PinEnd, diagnose, homed};
use brushwork_mcp_wire::packet_serial::{commands, name};
use brushwork_values::Motor;
use serde_json::json;

use crate::client::{ask, wait};
use crate::family::{Judged, Said};
use crate::{Exit, Interrupt, Readings};

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
        Said { sentence: diagnosis.sentence().to_string(), data: json!(diagnosis.findings) }
    });
    Judged { diagnosis, homed: settings.zip(pins.as_deref()).map(|(settings, pins)| homed(settings, pins)) }
}

/// The motor's own full speed: of both motors, the slower one's.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn qpps(motors: &[Motor], device: &DeviceHandle, interrupt: &Interrupt) -> Result<u32, Exit> {
    let mut slowest = u32::MAX;
    for motor in motors {
        let command = match motor {
            Motor::M1 => commands::READ_VELOCITY_PID_M1,
            Motor::M2 => commands::READ_VELOCITY_PID_M2,
        };
        let request = Request::Transact {
            id: u64::from(command.number()),
            command: command.number(),
            values: Vec::new(),
        };
        ask(device, request)?;
        let values = wait(device, interrupt, |event| match event {
            Event::Transacted { result, .. } => Some(result),
            _ => None,
        })?
        .map_err(|failure| Exit::Refused.saying(failure))?;
        let reply = command.reply(values).ok_or(Exit::Refused)?;
        slowest = slowest.min(u32::try_from(reply.int(name::QPPS)).unwrap_or(0));
    }
    if slowest == 0 {
        return Err(Exit::Refused.saying(CliLinkMessage::NoQpps));
    }
    Ok(slowest)
}
