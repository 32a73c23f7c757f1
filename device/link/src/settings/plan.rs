//! From wanted values to the fewest commands that write them, in an order in which nothing dangerous happens
//! in between.
//!
//! A plan is all or nothing: one value that cannot be written refuses the whole. No command is sent here.

use std::collections::BTreeMap;

use brushwork_mcp_wire::packet_serial::name::{INDEX, Name};
use brushwork_mcp_wire::packet_serial::{Request, describe_request, lookup, number};
use serde::Serialize;

use super::check::{dangers, wrong_pairs};
use super::image::SettingsImage;
use super::motion_mind::steps as motion_mind;
use super::pins::{Conflict, conflicts};
use super::row::{Carrier, Place, Row, Sink, Source};
use super::step::{Refusal, Stage, Step};
use super::table::SettingsTable;
use super::value::SettingValue;
use crate::transport::Stream;
use crate::unit::{FirmwareGeneration, UnitAddress};

/// What writing has to know besides the values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// The controller's stream that this program is connected through, where known. Its settings are written
    /// last.
    pub own_stream: Option<Stream>,
    /// Whether the controller is simulated, so that settings without a public wire form can be set.
    pub simulated: bool,
    /// Whether the values were read from such a unit once, so that one that nobody may choose there, out of range or without a
    /// name, is written as it was, with a warning.
    pub as_read: bool,
}

/// The commands that bring about some changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Settings that are set past the wire of a simulated controller: key and raw value.
    pub hidden: Vec<(String, i64)>,
    /// The commands, in the order in which they are sent.
    pub steps: Vec<Step>,
    /// What the user should know before it is done, a sentence each.
    pub warnings: Vec<String>,
}

impl Step {
    /// The bytes that it puts on the wire of packet serial, or a Motion Mind in its binary protocol; an error is a clause.
    pub fn bytes(&self, address: UnitAddress, generation: FirmwareGeneration) -> Result<Vec<u8>, String> {
        let (Some(address), Some(generation)) = (address.packets(), generation.packet_serial()) else {
            return motion_mind::step_bytes(self, address);
        };
        Request::new(address, self.command, &self.values())
            .encode(generation)
            .map_err(|error| error.to_string())
    }

    /// The raw arguments in wire order.
    pub fn values(&self) -> Vec<i64> {
        self.arguments.iter().map(|(_, raw)| *raw).collect()
    }

    /// Whether the controller's command has room for the values; an error is a clause.
    fn fits(&self, table: &SettingsTable) -> Result<(), String> {
        let mind = UnitAddress::new(1).filter(|_| table.is_motion_mind());
        let address = mind.unwrap_or(UnitAddress::DEFAULT);
        self.bytes(address, table.subject().generation).map(drop)
    }

    /// What it says, in words: the command and its values.
    pub fn words(&self, address: UnitAddress, generation: FirmwareGeneration) -> String {
        let (Some(address), Some(generation)) = (address.packets(), generation.packet_serial()) else {
            return motion_mind::step_words(self, address);
        };
        describe_request(&Request::new(address, self.command, &self.values()), generation)
    }

    /// What the command does: "M1 velocity PID (28)".
    pub fn title(&self) -> String {
        if self.keys.first().is_some_and(|key| key.starts_with("register.") || key.starts_with("function")) {
            return motion_mind::step_title(self);
        }
        format!("{} ({})", super::read::title(self.command), self.command)
    }
}

/// The commands that turn `ram` into `ram` with `changes`. Fields that share a command with a change keep the
/// value they have in `ram`. Refuses, with every reason, when one change cannot be written.
pub fn plan(
    table: &SettingsTable,
    ram: &SettingsImage,
    changes: &SettingsImage,
    options: WriteOptions,
) -> Result<Plan, Vec<Refusal>> {
    let mut refusals: Vec<Refusal> =
        changes.iter().filter_map(|(key, value)| refusal(table, key, value, options)).collect();
    let mut after = ram.clone();
    after.merge(changes);
    let pairs = wrong_pairs(table, &after, changes);
    let planner = Planner { table, ram, changes, options };
    let (steps, missing) = planner.steps();
    refusals.extend(missing);
    let mut warnings = planner.unusual();
    match options.as_read {
        true => {
            warnings.extend(pairs.into_iter().map(|pair| format!("{} {AS_READ_PAIR}", pair.sentence)));
        }
        false => refusals.extend(pairs),
    }
    if !refusals.is_empty() {
        return Err(refusals);
    }
    warnings.extend(planner.warnings(&steps));
    warnings.extend(dangers(table, &after, changes));
    warnings.extend(new_conflicts(table, &after, changes));
    Ok(Plan { hidden: planner.hidden(), steps, warnings })
}

const AS_READ_PAIR: &str = "Both are written as they were read.";

/// The contradictions that some of the changes take part in.
fn new_conflicts(table: &SettingsTable, after: &SettingsImage, changes: &SettingsImage) -> Vec<String> {
    let found = conflicts(table, &|key| after.get(key)).into_iter();
    // The type of a pin and whether it is digital are one choice for a person.
    let twin = |key: &str| key.strip_suffix(".type").map(|pin| format!("{pin}.digital"));
    let is_changed = |key: &String| {
        changes.get(key).is_some() || twin(key).is_some_and(|twin| changes.get(&twin).is_some())
    };
    let is_touched = |conflict: &Conflict| conflict.keys.iter().any(is_changed);
    found.filter(is_touched).map(|conflict| conflict.sentence).collect()
}

/// The rows whose values a change of `keys` needs: those themselves, and those that share a command with
/// them.
pub(super) fn rows_involved<'t>(table: &'t SettingsTable, keys: &[&str]) -> Vec<&'t Row> {
    let sinks: Vec<Sink> = keys.iter().filter_map(|key| table.row(key)?.sink()).collect();
    let shares = |row: &Row| {
        row.sink().is_some_and(|own| {
            sinks.iter().any(|sink| (sink.command, sink.index) == (own.command, own.index))
        }) || whole_word_of(row).is_some_and(|place| sinks.iter().any(|sink| sink.place.field == place))
    };
    table.rows().iter().filter(|row| keys.contains(&row.key.as_str()) || shares(row)).collect()
}

/// The field that a read-only row shows whole while other rows write its bits.
fn whole_word_of(row: &Row) -> Option<&'static str> {
    match row.carrier {
        Carrier::Wire { read: Source::Reply { place, .. }, write: None } => Some(place.field),
        _ => None,
    }
}

fn refusal(table: &SettingsTable, key: &str, value: SettingValue, options: WriteOptions) -> Option<Refusal> {
    let sentence = match table.row(key) {
        None => Some(format!(
            "The {} with firmware {} has no setting {key}.",
            table.subject().model.name,
            table.subject().generation
        )),
        Some(row) => match row.locked(options.simulated) {
            Some(reason) => Some(format!("{} is not written. {reason}", row.title())),
            None if options.as_read => row.check_as_read(value).err(),
            None => row.check(value).err(),
        },
    };
    sentence.map(|sentence| Refusal { key: key.to_owned(), sentence })
}

struct Planner<'p> {
    table: &'p SettingsTable,
    ram: &'p SettingsImage,
    changes: &'p SettingsImage,
    options: WriteOptions,
}

impl Planner<'_> {
    /// One step for each command and index that carries a change, in stage order.
    fn steps(&self) -> (Vec<Step>, Vec<Refusal>) {
        let mut groups: BTreeMap<(u8, Option<u8>), Vec<&Row>> = BTreeMap::new();
        for row in self.table.rows().iter().filter(|row| self.changes.get(&row.key).is_some()) {
            if let Some(sink) = row.sink() {
                groups.entry((sink.command, sink.index)).or_default().push(row);
            }
        }
        let mut steps = Vec::new();
        let mut refusals = Vec::new();
        for ((command, index), changed) in groups {
            match self.arguments(command, index, &changed) {
                Ok(arguments) => {
                    let step = Step {
                        command,
                        arguments,
                        keys: changed.iter().map(|row| row.key.clone()).collect(),
                        stage: self.stage(command, index, &changed),
                    };
                    match step.fits(self.table) {
                        Ok(()) => steps.push(step),
                        Err(why) => refusals.push(no_room(&changed, &why)),
                    }
                }
                Err(refusal) => refusals.push(refusal),
            }
        }
        steps.sort_by_key(|step| step.stage);
        if self.table.is_motion_mind() {
            motion_mind::weaken_first(&mut steps, self.ram);
        }
        (steps, refusals)
    }

    fn arguments(
        &self,
        command: u8,
        index: Option<u8>,
        changed: &[&Row],
    ) -> Result<Vec<(&'static str, i64)>, Refusal> {
        if self.table.is_motion_mind() {
            let name = changed.first().and_then(|row| row.sink()).map_or("", |sink| sink.place.field);
            let number = index.unwrap_or_default();
            let word = self.field_value(Sink { command, index, place: place(name) }, changed)?;
            return Ok(motion_mind::arguments(number, name, word));
        }
        let form = lookup(command).and_then(|command| command.form(self.table.subject().generation.layout()));
        let Some(form) = form else {
            return Err(refuse(changed, format!("This firmware has no command {command}.")));
        };
        let mut arguments = Vec::with_capacity(form.request.len());
        for field in form.request.iter().filter(|field| field.fixed.is_none()) {
            let value = match index {
                Some(index) if field.name == INDEX::TEXT => i64::from(index),
                _ => self.field_value(Sink { command, index, place: place(field.name) }, changed)?,
            };
            arguments.push((field.name, value));
        }
        Ok(arguments)
    }

    /// The raw number of one field of a command: the changed value, or what the controller holds, bits put
    /// together.
    fn field_value(&self, field: Sink, changed: &[&Row]) -> Result<i64, Refusal> {
        let of_field = |row: &&Row| {
            row.sink().is_some_and(|sink| {
                (sink.command, sink.index, sink.place.field)
                    == (field.command, field.index, field.place.field)
            })
        };
        let base = self.whole_word(field);
        let mut word = base.unwrap_or(0);
        for row in self.table.rows().iter().filter(of_field) {
            let change = self.changes.get(&row.key);
            // With the whole word known, only the bits that change are touched; the rest of it is kept as it
            // is.
            if base.is_some() && change.is_none() {
                continue;
            }
            let value = change.or_else(|| self.ram.get(&row.key));
            let raw =
                value.and_then(|value| row.encode(value)).ok_or_else(|| unknown_neighbour(row, changed))?;
            word = match row.sink().and_then(|sink| sink.place.bits) {
                Some(bits) if bits.extract(bits.insert(0, raw)) != raw => {
                    return Err(no_room(&[row], &format!("{raw} takes more than {} bits", bits.width)));
                }
                Some(bits) => bits.insert(word, raw),
                None => raw,
            };
        }
        Ok(word)
    }

    /// What the controller holds of a field whose bits are rows of their own, if a row shows it whole.
    fn whole_word(&self, field: Sink) -> Option<i64> {
        let row = self.table.rows().iter().find(|row| whole_word_of(row) == Some(field.place.field))?;
        row.encode(self.ram.get(&row.key)?)
    }

    fn stage(&self, command: u8, index: Option<u8>, changed: &[&Row]) -> Stage {
        if self.table.is_motion_mind() {
            return motion_mind::stage(index.unwrap_or_default());
        }
        let own = |stream: Stream| index.is_some_and(|index| usize::from(index) == stream.index());
        match command {
            number::SET_ADDRESS_MIXED if changed.iter().any(|row| row.key == "unit.address") => {
                Stage::Address
            }
            number::SET_STREAM if self.options.own_stream.is_some_and(own) => Stage::OwnPort,
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

    fn hidden(&self) -> Vec<(String, i64)> {
        let hidden = self.table.rows().iter().filter(|row| !row.has_wire_form());
        hidden.filter_map(|row| Some((row.key.clone(), row.encode(self.changes.get(&row.key)?)?))).collect()
    }

    /// Values that nobody may choose and that are written as they were read.
    fn unusual(&self) -> Vec<String> {
        let changed = self.table.rows().iter().filter_map(|row| Some((row, self.changes.get(&row.key)?)));
        changed.filter_map(|(row, value)| row.check_as_read(value).ok()?).collect()
    }

    /// What the steps themselves bring about besides their values.
    fn warnings(&self, steps: &[Step]) -> Vec<String> {
        if self.table.is_motion_mind() {
            return motion_mind::warnings(steps);
        }
        let mut warnings = Vec::new();
        for step in steps {
            match (step.command, step.stage) {
                (number::SET_ADDRESS_MIXED, Stage::Address) => warnings.push(
                    "The controller answers to its new address from then on; save it, or a power cycle \
                     brings the old one back."
                        .to_owned(),
                ),
                (number::SET_ADDRESS_MIXED, _) if self.address_is_unreadable() => warnings.push(format!(
                    "Mixing is written together with the address, which this firmware does not report: {} \
                     is written, the address this link speaks to. Over USB a unit answers to every \
                     address, so check it first.",
                    self.ram.get("unit.address").map_or_else(String::new, |address| match address {
                        SettingValue::Int(byte) => format!("0x{byte:02X}"),
                        _ => String::new(),
                    })
                )),
                (number::SET_STREAM, Stage::OwnPort) => warnings.extend(self.own_port_warnings()),
                (number::SET_CONFIG, _) => warnings.push(
                    "The configuration word takes effect at once and can move the controller to another \
                     address, baud rate or control mode: the link may be lost."
                        .to_owned(),
                ),
                _ => {}
            }
        }
        warnings
    }

    fn address_is_unreadable(&self) -> bool {
        let row = self.table.row("unit.address");
        row.is_some_and(|row| matches!(row.carrier, Carrier::Wire { read: Source::LinkAddress, .. }))
    }

    fn own_port_warnings(&self) -> Vec<String> {
        let Some(stream) = self.options.own_stream else { return Vec::new() };
        let change = |field: &str| {
            let key = format!("stream.{}.{field}", stream.key());
            let (row, value) = (self.table.row(&key)?, self.changes.get(&key)?);
            Some((row.format(value), value))
        };
        let mut warnings = Vec::new();
        if let Some((to, _)) = change("type") {
            warnings.push(format!(
                "This program is connected through {stream}, which becomes \"{to}\": the link is lost then."
            ));
        }
        if let (Some((to, _)), true) = (change("rate"), stream != Stream::Usb) {
            warnings.push(format!(
                "This program is connected through {stream}, which changes to {to}: connect again at that \
                 rate."
            ));
        }
        if let Some((_, SettingValue::Int(0))) = change("timeout") {
            warnings.push(format!(
                "{stream} has no time-out then: the motors would go on if this program died, so it cannot \
                 be armed."
            ));
        }
        warnings
    }
}

fn place(field: &'static str) -> Place {
    Place { field, bits: None }
}

fn refuse(changed: &[&Row], sentence: String) -> Refusal {
    Refusal { key: changed.first().map_or_else(String::new, |row| row.key.clone()), sentence }
}

/// A value that the fields of its command cannot hold: no unit has ever had it.
fn no_room(changed: &[&Row], why: &str) -> Refusal {
    let titles: Vec<String> = changed.iter().map(|row| row.title()).collect();
    refuse(changed, format!("{} cannot be written: {why}.", titles.join(", ")))
}

fn unknown_neighbour(row: &Row, changed: &[&Row]) -> Refusal {
    let wanted = changed.first().map_or_else(String::new, |row| row.title());
    refuse(
        changed,
        format!(
            "{wanted} cannot be written, since {} shares its command and its value is not known.",
            row.title()
        ),
    )
}
