//! What is particular in a plan: when each command is sent, what its user should know, and how a step looks on the wire.

use super::check::conflicts;
use super::pins::Conflict;
use crate::messages::McpSettingsMessage;
use crate::{layout_of, packet_address};
use brushwork_link::Message;
use brushwork_link::messages::PlanMessage;
use brushwork_link::settings::{
    Argument, Carrier, PlanContext, Planned, SettingValue, SettingsImage, SettingsTable, Source, Stage, Step,
};
use brushwork_link::transport::Stream;
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_mcp_wire::packet_serial::name::{ADDRESS, CONFIG, INDEX, Name};
use brushwork_mcp_wire::packet_serial::{Address, Request, describe_request, lookup, number};
use brushwork_mcp_wire::roboclaw::ConfigWord;

/// What the command of these rows takes: its fields in wire order, without keys that never change.
pub fn arguments(planned: &Planned<'_>) -> Result<Vec<Argument>, Message> {
    let layout = layout_of(planned.context.table.subject().generation);
    let form = lookup(planned.command).and_then(|command| command.form(layout));
    let form = form.ok_or(McpSettingsMessage::NoCommand { command: planned.command })?;
    let argument = |name| match planned.index {
        Some(index) if name == INDEX::TEXT => Argument::Given(name, i64::from(index)),
        _ => Argument::Field(name),
    };
    let fields = form.request.iter().filter(|field| field.fixed.is_none());
    Ok(fields.map(|field| argument(field.name)).collect())
}

/// The row of the address in the configuration word.
const CONFIG_ADDRESS: &str = "roboclaw.config.address";
/// An MCP's address by its own command, a RoboClaw's as a part of the configuration word.
pub const ADDRESS_KEYS: &[&str] = &["unit.address", CONFIG_ADDRESS];

/// Where a unit answers once it has taken the step, if that moves it.
pub fn new_address(step: &Step) -> Option<u8> {
    let given = |name: &str| step.arguments.iter().find(|(field, _)| *field == name).map(|(_, raw)| *raw);
    if let Some(address) = given(ADDRESS::TEXT) {
        return u8::try_from(address).ok();
    }
    let word = ConfigWord(u16::try_from(given(CONFIG::TEXT)?).ok()?);
    Some(Address::FIRST.get() + word.address_number()?)
}

/// When a command is sent: limits before what they limit, what could cut this link off last.
pub fn stage(planned: &Planned<'_>) -> Stage {
    let (index, changed) = (planned.index, planned.changed);
    let own = |stream: Stream| index.is_some_and(|index| usize::from(index) == stream.index());
    match planned.command {
        number::SET_ADDRESS_MIXED if changed.iter().any(|row| row.key == "unit.address") => Stage::Address,
        number::SET_STREAM if planned.context.options.own_stream.is_some_and(own) => Stage::OwnPort,
        // An address moves at once, the rest with the next power-up.
        number::SET_CONFIG if changed.iter().any(|row| row.key == CONFIG_ADDRESS) => Stage::Address,
        number::SET_CONFIG => Stage::OwnPort,
        number::SET_MAIN_VOLTAGES
        | number::SET_LOGIC_VOLTAGES
        | number::SET_VOLTAGE_OFFSETS
        | number::SET_CURRENT_LIMITS_M1
        | number::SET_CURRENT_LIMITS_M2
        | number::SET_SPEED_ERROR_LIMITS
        | number::SET_POSITION_ERROR_LIMITS
        | number::SET_SERIAL_TIMEOUT => Stage::Limits,
        number::SET_DOUT_ACTION => Stage::Outputs,
        number::SET_SIGNAL
        | number::SET_PIN_FUNCTIONS
        | number::SET_CONTROL_SETTINGS
        | number::SET_CONTROL_LIMITS => Stage::Pins,
        number::SET_STREAM | number::SET_NODE_ID => Stage::Ports,
        number::SET_PRIORITIES => Stage::Priorities,
        number::SET_SCRIPT_AUTORUN | number::SET_ESTOP_LOCK => Stage::Autonomy,
        _ => Stage::Motors,
    }
}

/// What the steps themselves bring about besides their values.
pub fn warnings(context: &PlanContext<'_>, steps: &[Step]) -> Vec<Message> {
    let mut warnings = Vec::new();
    for step in steps {
        match (step.command, step.stage) {
            (number::SET_ADDRESS_MIXED, Stage::Address) => {
                warnings.push(PlanMessage::NewAddress.into());
            }
            (number::SET_ADDRESS_MIXED, _) if address_is_unreadable(context) => {
                let address = context.ram.get("unit.address").and_then(SettingValue::int);
                let address = address.map_or_else(String::new, |byte| format!("0x{byte:02X}"));
                warnings.push(McpSettingsMessage::AddressWithMixing { address }.into());
            }
            (number::SET_STREAM, Stage::OwnPort) => warnings.extend(own_port_warnings(context)),
            (number::SET_CONFIG, _) => warnings.push(McpSettingsMessage::ConfigurationWord.into()),
            _ => {}
        }
    }
    warnings
}

fn address_is_unreadable(context: &PlanContext<'_>) -> bool {
    let row = context.table.row("unit.address");
    row.is_some_and(|row| matches!(row.carrier, Carrier::Wire { read: Source::LinkAddress, .. }))
}

fn own_port_warnings(context: &PlanContext<'_>) -> Vec<Message> {
    let Some(stream) = context.options.own_stream else { return Vec::new() };
    let change = |field: &str| {
        let key = format!("stream.{}.{field}", stream.key());
        let (row, value) = (context.table.row(&key)?, context.changes.get(&key)?);
        Some((row.format(value), value))
    };
    let mut warnings = Vec::new();
    if let Some((to, _)) = change("type") {
        warnings.push(McpSettingsMessage::OwnPortChanges { stream, to }.into());
    }
    if let (Some((to, _)), true) = (change("rate"), stream != Stream::Usb) {
        warnings.push(McpSettingsMessage::OwnPortRate { stream, to }.into());
    }
    if let Some((_, SettingValue::Int(0))) = change("timeout") {
        warnings.push(McpSettingsMessage::OwnPortTimeout { stream }.into());
    }
    warnings
}

/// The contradictions that some of the changes take part in.
pub fn new_conflicts(table: &SettingsTable, after: &SettingsImage, changes: &SettingsImage) -> Vec<Message> {
    let found = conflicts(table, &|key| after.get(key)).into_iter();
    // The type of a pin and whether it is digital are one choice for a person.
    let twin = |key: &str| key.strip_suffix(".type").map(|pin| format!("{pin}.digital"));
    let is_changed = |key: &String| {
        changes.get(key).is_some() || twin(key).is_some_and(|twin| changes.get(&twin).is_some())
    };
    let is_touched = |conflict: &Conflict| conflict.keys.iter().any(is_changed);
    found.filter(is_touched).map(|conflict| conflict.sentence).collect()
}

/// The bytes of a step.
pub fn step_bytes(step: &Step, unit: (UnitAddress, FirmwareGeneration)) -> Result<Vec<u8>, Message> {
    request(step, unit.0)?.encode(layout_of(unit.1)).map_err(Message::error)
}

/// A step in words.
pub fn step_words(step: &Step, unit: (UnitAddress, FirmwareGeneration)) -> String {
    request(step, unit.0)
        .map_or_else(|why| why.to_string(), |request| describe_request(&request, layout_of(unit.1)))
}

fn request(step: &Step, address: UnitAddress) -> Result<Request, McpSettingsMessage> {
    let address = packet_address(address).ok_or(McpSettingsMessage::NoAddress { address })?;
    Ok(Request::new(address, step.command, &step.values()))
}
