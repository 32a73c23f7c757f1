//! The settings of SuprMotrs: the rows, and what is particular in writing and keeping them.

mod memory;
mod rows;

use crate::controller::values::{FOLLOWING_ERROR, command_of};
use crate::messages::SuprMotrSettingsMessage;
use brushwork_link::exchange::ExchangeError;
use brushwork_link::messages::PlanMessage;
use brushwork_link::settings::{
    Argument, FamilySettings, PlanContext, Planned, ReadReport, Row, SaveReport, SettingValue, SettingsImage,
    SettingsTable, Stage, Step, Subject, WriteOptions,
};
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::wire::Wire;
use brushwork_link::{Failure, Message};
use brushwork_suprmotr_wire::{Address, Command, Line, Mnemonic, Radix, Selection, describe_command};
use brushwork_values::Values;

/// The settings as the engine sees them.
#[derive(Debug)]
pub struct SuprMotrSettings;

impl FamilySettings for SuprMotrSettings {
    fn rows(&self, _subject: &Subject) -> Vec<Row> {
        rows::rows()
    }

    fn is_there(&self, wire: &mut dyn Wire) -> Result<Values, ExchangeError> {
        wire.transact(Mnemonic::TP.number(), &[])
    }

    fn read_title(&self, command: u8) -> &'static str {
        match Mnemonic::from_number(command) {
            Some(mnemonic) => mnemonic.row().title,
            None if command == FOLLOWING_ERROR => "following error limit",
            None => "settings",
        }
    }

    fn read_phrase(&self, command: u8) -> String {
        let title = self.read_title(command);
        match Mnemonic::from_number(command) {
            Some(mnemonic) => format!("read with {} ({title})", mnemonic.name()),
            None => format!("read the {title}"),
        }
    }

    fn arguments(&self, planned: &Planned<'_>) -> Result<Vec<Argument>, Message> {
        let name = planned.changed.first().and_then(|row| row.sink()).map_or("", |sink| sink.place.field);
        Ok(vec![Argument::Field(name)])
    }

    fn stage(&self, planned: &Planned<'_>) -> Stage {
        let key = planned.changed.first().map_or("", |row| row.pattern);
        match key {
            rows::ADDRESS => Stage::Address,
            rows::FOLLOWING_ERROR_KEY | rows::LIMITS_ON | rows::LIMITS_HIGH => Stage::Limits,
            "line.echo" => Stage::Ports,
            _ => Stage::Motors,
        }
    }

    fn warnings(&self, context: &PlanContext<'_>, steps: &[Step]) -> Vec<Message> {
        let changes = |key: &str| context.changes.get(key).is_some();
        let mut warnings = Vec::new();
        if steps.iter().any(|step| step.stage == Stage::Address) {
            warnings.push(PlanMessage::NewAddress.into());
        }
        if changes(rows::FOLLOWING_ERROR_KEY) {
            warnings.push(SuprMotrSettingsMessage::FollowingError.into());
        }
        warnings
    }

    fn dangers(
        &self,
        _table: &SettingsTable,
        _after: &SettingsImage,
        changes: &SettingsImage,
    ) -> Vec<Message> {
        let off = changes.get(rows::LIMITS_ON) == Some(SettingValue::Bool(false));
        let level = changes.get(rows::LIMITS_HIGH).is_some();
        let found = [
            off.then_some(SuprMotrSettingsMessage::LimitsOff),
            level.then_some(SuprMotrSettingsMessage::LimitLevel),
        ];
        found.into_iter().flatten().map(Message::from).collect()
    }

    fn step_bytes(
        &self,
        step: &Step,
        address: UnitAddress,
        _generation: FirmwareGeneration,
    ) -> Result<Vec<u8>, Message> {
        let (unit, command) = parts(step, address)?;
        let line = Line::of(command).encode(Radix::Decimal).map_err(Message::error)?;
        Ok([Selection::Unit(unit).bytes().as_slice(), &line].concat())
    }

    fn step_words(&self, step: &Step, address: UnitAddress, _generation: FirmwareGeneration) -> String {
        parts(step, address).map_or_else(
            |why| why.to_string(),
            |(unit, command)| format!("{unit}: {}", describe_command(&command)),
        )
    }

    fn step_title(&self, step: &Step) -> String {
        let name = step_command(step).map_or("a setting", |command| command.mnemonic.name());
        format!("write {name}")
    }

    fn address_keys(&self) -> &'static [&'static str] {
        &[rows::ADDRESS]
    }

    fn new_address(&self, step: &Step) -> Option<u8> {
        let command = step_command(step).filter(|command| command.mnemonic == Mnemonic::DB)?;
        u8::try_from(command.number?).ok()
    }

    fn save(
        &self,
        wire: &mut dyn Wire,
        before: &ReadReport,
        _options: WriteOptions,
    ) -> Result<SaveReport, Failure> {
        memory::save(wire, before)
    }

    fn reload(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        memory::reload(wire)
    }

    fn restore(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        memory::restore(wire)
    }
}

fn step_command(step: &Step) -> Option<Command> {
    command_of(step.command, &step.values())
}

fn parts(step: &Step, address: UnitAddress) -> Result<(Address, Command), SuprMotrSettingsMessage> {
    let unit = Address::new(address.get()).ok_or(SuprMotrSettingsMessage::NoAddress { address })?;
    let command = step_command(step).ok_or(SuprMotrSettingsMessage::ValuesDoNotFit)?;
    Ok((unit, command))
}
