//! The settings of MCP and RoboClaw controllers: the table of rows, and what is particular in writing, keeping and judging them.

mod check;
mod convert;
mod fit;
mod memory;
mod pins;
mod plan;
mod reference;
mod roboclaw;
pub(crate) mod rows;
mod template;

pub use check::{SHORTEST_AUTORUN_MS, conflicts};
pub use pins::{
    Behind, Conflict, ConflictKind, PinMode, SignalShape, change_mode, function_text, modes, open_range,
};
pub use reference::{ReferenceForm, ReferenceRow, reference, reference_text};

use crate::messages::McpSettingsMessage;
use crate::model_of;
use brushwork_link::exchange::ExchangeError;
use brushwork_link::settings::{
    Argument, Conversion, FamilySettings, Fit, Group, Lists, PlanContext, Planned, ReadReport, Row,
    SaveReport, SettingValue, SettingsImage, SettingsTable, Stage, Step, Subject, WriteOptions,
};
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::wire::Wire;
use brushwork_link::{Failure, Message};
use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{lookup, number};
use brushwork_values::Values;

/// The settings as the engine sees them.
#[derive(Debug)]
pub struct McpSettings;

/// The row that names the input of an encoder by its number in the pin list.
const ENCODER_PIN: &str = "motor{n}.encoder.pin";

impl FamilySettings for McpSettings {
    fn rows(&self, subject: &Subject) -> Vec<Row> {
        rows::templates().flat_map(|template| template.expand(subject)).collect()
    }

    /// The pin behind an encoder input number, as far as we assume it.
    fn note(&self, table: &SettingsTable, row: &Row, value: SettingValue) -> Option<Message> {
        let number = value.int().filter(|_| row.pattern == ENCODER_PIN)?;
        if number == ENCODER_PIN_NONE {
            return Some(McpSettingsMessage::NoPin.into());
        }
        let index = usize::try_from(number).ok().filter(|index| *index < table.subject().pins)?;
        Some(McpSettingsMessage::PinInList { pin: table.subject().pin_name(index) }.into())
    }

    fn lists(&self, subject: &Subject) -> Option<Lists> {
        let is_mcp = model_of(subject).is_some_and(|model| model.family == Family::Mcp);
        is_mcp.then_some(Lists {
            pins: number::READ_SIGNALS,
            streams: number::READ_STREAMS,
            douts: number::READ_DOUT_ACTIONS,
        })
    }

    fn is_there(&self, wire: &mut dyn Wire) -> Result<Values, ExchangeError> {
        wire.transact(number::READ_VERSION, &[])
    }

    fn read_title(&self, command: u8) -> &'static str {
        lookup(command).map_or("an unknown command", |command| command.title)
    }

    fn arguments(&self, planned: &Planned<'_>) -> Result<Vec<Argument>, Message> {
        plan::arguments(planned)
    }

    fn stage(&self, planned: &Planned<'_>) -> Stage {
        plan::stage(planned)
    }

    fn warnings(&self, context: &PlanContext<'_>, steps: &[Step]) -> Vec<Message> {
        plan::warnings(context, steps)
    }

    fn ordered_pairs(&self) -> &'static [(&'static str, &'static str)] {
        check::ORDERED_PAIRS
    }

    fn dangers(&self, table: &SettingsTable, after: &SettingsImage, changes: &SettingsImage) -> Vec<Message> {
        check::dangers(table, after, changes)
    }

    fn conflicts(
        &self,
        table: &SettingsTable,
        after: &SettingsImage,
        changes: &SettingsImage,
    ) -> Vec<Message> {
        plan::new_conflicts(table, after, changes)
    }

    fn step_bytes(
        &self,
        step: &Step,
        address: UnitAddress,
        generation: FirmwareGeneration,
    ) -> Result<Vec<u8>, Message> {
        plan::step_bytes(step, (address, generation))
    }

    fn step_words(&self, step: &Step, address: UnitAddress, generation: FirmwareGeneration) -> String {
        plan::step_words(step, (address, generation))
    }

    fn step_title(&self, step: &Step) -> String {
        self.read_phrase(step.command)
    }

    fn address_keys(&self) -> &'static [&'static str] {
        plan::ADDRESS_KEYS
    }

    fn new_address(&self, step: &Step) -> Option<u8> {
        plan::new_address(step)
    }

    fn save(
        &self,
        wire: &mut dyn Wire,
        before: &ReadReport,
        options: WriteOptions,
    ) -> Result<SaveReport, Failure> {
        memory::save(wire, before, options)
    }

    fn reload(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        memory::reload(wire)
    }

    fn restore(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        memory::restore(wire)
    }

    fn key_there(&self, fit: &Fit<'_>, row: &Row) -> Option<String> {
        match (&row.instance, row.group) {
            (Some(instance), Group::PINS) => {
                let pin = fit::pin_place(fit, instance.number - 1)?;
                Some(row.pattern.replace("{n}", &(pin + 1).to_string()))
            }
            _ => Some(row.key.clone()),
        }
    }

    fn value_there(&self, fit: &Fit<'_>, row: &Row, value: SettingValue) -> Option<SettingValue> {
        if row.pattern == ENCODER_PIN { fit::encoder_pin(fit, value) } else { Some(value) }
    }

    fn impossible_there(
        &self,
        fit: &Fit<'_>,
        there: &Row,
        value: SettingValue,
    ) -> Option<(SettingValue, Message)> {
        if let Some(why) = convert::impossible_reset(there, value) {
            return Some((SettingValue::Choice("hardware"), why));
        }
        fit::impossible_type(fit, there, value).map(|why| (SettingValue::Choice("none"), why))
    }

    fn conversions(&self, fit: &Fit<'_>) -> Vec<Conversion> {
        convert::conversions(fit)
    }

    fn without(&self, row: &Row) -> Option<Message> {
        convert::without(row)
    }
}
