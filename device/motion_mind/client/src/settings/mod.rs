//! The settings of Motion Minds: the rows, and what is particular in writing and keeping them.

mod memory;
mod rows;
mod steps;

use brushwork_link::exchange::ExchangeError;
use brushwork_link::settings::{
    Argument, FamilySettings, PlanContext, Planned, ReadReport, Row, SaveReport, SettingsImage, Stage, Step,
    Subject, WriteOptions,
};
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::wire::Wire;
use brushwork_link::{Failure, Message};
use brushwork_motion_mind_wire::{Register, numbers, register, register_named, register_number};
use brushwork_values::Values;

/// The settings as the engine sees them.
#[derive(Debug)]
pub struct MotionMindSettings;

impl FamilySettings for MotionMindSettings {
    fn rows(&self, _subject: &Subject) -> Vec<Row> {
        rows::rows()
    }

    fn is_there(&self, wire: &mut dyn Wire) -> Result<Values, ExchangeError> {
        wire.transact(numbers::READ_REGISTER, &[i64::from(register_number::REVISION)])
    }

    fn read_title(&self, _command: u8) -> &'static str {
        "read the registers"
    }

    fn read_phrase(&self, command: u8) -> String {
        self.read_title(command).to_owned()
    }

    fn learned_number(&self, _command: u8, field: &str) -> Option<u8> {
        register_named(field).map(|row| row.number)
    }

    fn learned_title(&self, number: u8) -> &'static str {
        register(number).map_or("", |row| row.name)
    }

    fn arguments(&self, planned: &Planned<'_>) -> Result<Vec<Argument>, Message> {
        let name = planned.changed.first().and_then(|row| row.sink()).map_or("", |sink| sink.place.field);
        let number = planned.index.unwrap_or_default();
        Ok(vec![Argument::Given(steps::INDEX, i64::from(number)), Argument::Field(name)])
    }

    fn stage(&self, planned: &Planned<'_>) -> Stage {
        steps::stage(planned.index.unwrap_or_default())
    }

    fn order(&self, steps: &mut [Step], ram: &SettingsImage) {
        steps::weaken_first(steps, ram);
    }

    fn warnings(&self, _context: &PlanContext<'_>, steps: &[Step]) -> Vec<Message> {
        steps::warnings(steps)
    }

    fn step_bytes(
        &self,
        step: &Step,
        address: UnitAddress,
        _generation: FirmwareGeneration,
    ) -> Result<Vec<u8>, Message> {
        steps::step_bytes(step, address)
    }

    fn step_words(&self, step: &Step, address: UnitAddress, _generation: FirmwareGeneration) -> String {
        steps::step_words(step, address)
    }

    fn step_title(&self, step: &Step) -> String {
        steps::step_title(step)
    }

    fn address_keys(&self) -> &'static [&'static str] {
        &["register.address"]
    }

    fn new_address(&self, step: &Step) -> Option<u8> {
        let given = step.arguments.iter().find(|(name, _)| *name == "ADDRESS")?;
        u8::try_from(given.1).ok()
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

    fn restores_eeprom(&self) -> bool {
        true
    }
}

/// The register behind a row.
fn register_of(row: &Row) -> Option<&'static Register> {
    register(row.register?)
}
