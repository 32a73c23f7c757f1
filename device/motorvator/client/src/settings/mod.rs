//! The settings of half a board: how its stepper is configured. The host library keeps them; nothing on the board does over a restart.

mod rows;

use crate::controller::values::{CONFIGURATION, STEPPER_FIELDS, order_of};
use crate::family::Half;
use crate::messages::{
    MotorvatorActMessage, MotorvatorCauseMessage, MotorvatorRemedyMessage, MotorvatorSettingsMessage,
};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::settings::{
    Argument, FamilySettings, PlanContext, Planned, ReadReport, Row, SaveReport, SettingValue, SettingsImage,
    SettingsTable, Stage, Step, Subject, WriteOptions,
};
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::wire::Wire;
use brushwork_link::{Failure, Message};
use brushwork_motorvator_wire::host::HostOrder;
use brushwork_values::Values;

pub use rows::KEYS as STEPPER_KEYS;

/// The settings as the engine sees them.
#[derive(Debug)]
pub struct MotorvatorSettings;

impl FamilySettings for MotorvatorSettings {
    fn rows(&self, _subject: &Subject) -> Vec<Row> {
        rows::rows()
    }

    fn is_there(&self, wire: &mut dyn Wire) -> Result<Values, ExchangeError> {
        wire.transact(CONFIGURATION, &[])
    }

    fn read_title(&self, _command: u8) -> &'static str {
        "stepper configuration"
    }

    fn read_phrase(&self, _command: u8) -> String {
        "read how the stepper is configured".to_owned()
    }

    fn arguments(&self, _planned: &Planned<'_>) -> Result<Vec<Argument>, Message> {
        Ok(STEPPER_FIELDS.iter().map(|field| Argument::Field(field.name)).collect())
    }

    fn stage(&self, _planned: &Planned<'_>) -> Stage {
        Stage::Motors
    }

    fn warnings(&self, _context: &PlanContext<'_>, steps: &[Step]) -> Vec<Message> {
        let is_any = !steps.is_empty();
        is_any.then_some(MotorvatorSettingsMessage::Volatile).into_iter().map(Message::from).collect()
    }

    fn ordered_pairs(&self) -> &'static [(&'static str, &'static str)] {
        &[(rows::KEYS[0], rows::KEYS[1])]
    }

    fn dangers(
        &self,
        _table: &SettingsTable,
        _after: &SettingsImage,
        changes: &SettingsImage,
    ) -> Vec<Message> {
        match changes.get(rows::KEYS[2]) {
            Some(SettingValue::Int(percent)) if percent > rows::WARM_PERCENT => {
                vec![MotorvatorSettingsMessage::HoldHeats { percent }.into()]
            }
            Some(_) | None => Vec::new(),
        }
    }

    fn step_bytes(
        &self,
        step: &Step,
        address: UnitAddress,
        _generation: FirmwareGeneration,
    ) -> Result<Vec<u8>, Message> {
        Ok(order(step, address)?.line(0))
    }

    fn step_words(&self, step: &Step, address: UnitAddress, _generation: FirmwareGeneration) -> String {
        order(step, address).map_or_else(|why| why.to_string(), |order| order.to_string())
    }

    fn step_title(&self, _step: &Step) -> String {
        "configure the stepper".to_owned()
    }

    fn new_address(&self, _step: &Step) -> Option<u8> {
        None
    }

    fn save(
        &self,
        wire: &mut dyn Wire,
        _before: &ReadReport,
        _options: WriteOptions,
    ) -> Result<SaveReport, Failure> {
        Err(no_memory(wire, MotorvatorActMessage::Save, MotorvatorRemedyMessage::WriteIntoProgram))
    }

    fn reload(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        Err(no_memory(wire, MotorvatorActMessage::Reload, MotorvatorRemedyMessage::StartAnew))
    }

    /// Writes what the library begins with.
    fn restore(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        let values: Vec<i64> = rows::rows().iter().filter_map(|row| row.encode(row.default)).collect();
        match wire.transact(crate::controller::values::CONFIGURE, &values) {
            Ok(_) => Ok(()),
            Err(error) => Err(error.failure(MotorvatorActMessage::Restore, wire.describe())),
        }
    }
}

fn no_memory(wire: &dyn Wire, tried: MotorvatorActMessage, remedy: MotorvatorRemedyMessage) -> Failure {
    Failure::new(tried, wire.describe(), MotorvatorCauseMessage::NoMemory, remedy)
}

fn order(step: &Step, address: UnitAddress) -> Result<HostOrder, MotorvatorSettingsMessage> {
    let half = Half::of(address.get()).ok_or(MotorvatorSettingsMessage::NoAddress { address })?;
    order_of(half, step.command, &step.values()).ok_or(MotorvatorSettingsMessage::ValuesDoNotFit)
}
