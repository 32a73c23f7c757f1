//! A node's objects: those of communication, and one for each packet serial command.

use super::super::object::{Outcome, number};
use crate::controller::Controller;
use brushwork_canopen::NodeId;
use brushwork_canopen::nmt::objects as standard;
use brushwork_canopen::sdo::{Abort, Dictionary};
use brushwork_mcp_wire::canopen::objects::{
    LIST_CONTROL, Shape, TEXT, TRIGGER, bytes_of, command_of, raw_of, shape,
};
use brushwork_mcp_wire::canopen::{VENDOR, product_of};
use brushwork_values::{Field, Value};
use std::collections::BTreeMap;
use std::time::Duration;

/// Time between two heartbeats of a node that has just started. Assumed.
const PRODUCER_MS: u16 = 1000;

/// What a node keeps about its communication, and about accesses that take several frames.
#[derive(Clone, Debug)]
pub(super) struct Communication {
    producer_ms: u16,
    consumer: u32,
    pub error_register: u8,
    /// Arguments written so far, by command.
    staged: BTreeMap<u8, Vec<Option<i64>>>,
    /// Values that belong together, read when the first of them was.
    snapshots: BTreeMap<u8, Vec<i64>>,
    /// The record of a list that is chosen.
    chosen: BTreeMap<u8, usize>,
}

impl Default for Communication {
    fn default() -> Self {
        Self {
            producer_ms: PRODUCER_MS,
            consumer: 0,
            error_register: 0,
            staged: BTreeMap::new(),
            snapshots: BTreeMap::new(),
            chosen: BTreeMap::new(),
        }
    }
}

impl Communication {
    /// How often it sends its heartbeat.
    pub fn producer(&self) -> Option<Duration> {
        (self.producer_ms > 0).then(|| Duration::from_millis(self.producer_ms.into()))
    }

    /// Sets how often it sends its heartbeat.
    pub fn set_producer(&mut self, milliseconds: u16) {
        self.producer_ms = milliseconds;
    }

    /// Whose heartbeat it listens for, and how long that may be away.
    pub fn consumer(&self) -> Option<(NodeId, Duration)> {
        let [low, high, node, _] = self.consumer.to_le_bytes();
        let time_ms = u16::from_le_bytes([low, high]);
        (time_ms > 0).then_some((NodeId::new(node)?, Duration::from_millis(time_ms.into())))
    }
}

/// All objects of a node for one access.
pub(super) struct Objects<'a> {
    pub communication: &'a mut Communication,
    pub unit: &'a mut Controller,
}

impl Dictionary for Objects<'_> {
    fn read(&mut self, index: u16, subindex: u8) -> Result<Vec<u8>, Abort> {
        match command_of(index) {
            Some(command) => self.read_command(command, subindex),
            None => self.read_standard(index, subindex),
        }
    }

    fn write(&mut self, index: u16, subindex: u8, value: &[u8]) -> Result<(), Abort> {
        match command_of(index) {
            Some(command) => self.write_command(command, subindex, value),
            None => self.write_standard(index, subindex, value),
        }
    }
}

impl Objects<'_> {
    fn read_standard(&self, index: u16, subindex: u8) -> Result<Vec<u8>, Abort> {
        let model = self.unit.config().model;
        let text = |text: &str| Ok(text.as_bytes().to_vec());
        match (index, subindex) {
            (standard::DEVICE_TYPE, 0) => Ok(vec![0; 4]),
            (standard::ERROR_REGISTER, 0) => Ok(vec![self.communication.error_register]),
            (standard::DEVICE_NAME, 0) => text(model.title),
            (standard::SOFTWARE_VERSION, 0) => {
                let version = self.unit.unit().map_or(String::new(), |unit| unit.version_text());
                text(version.rsplit(' ').next().unwrap_or_default())
            }
            (standard::CONSUMER_HEARTBEAT, 0) => Ok(vec![1]),
            (standard::CONSUMER_HEARTBEAT, 1) => Ok(self.communication.consumer.to_le_bytes().to_vec()),
            (standard::PRODUCER_HEARTBEAT, 0) => Ok(self.communication.producer_ms.to_le_bytes().to_vec()),
            (standard::IDENTITY, 0) => Ok(vec![4]),
            (standard::IDENTITY, 1) => Ok(VENDOR.to_le_bytes().to_vec()),
            (standard::IDENTITY, 2) => Ok(product_of(model.name).to_le_bytes().to_vec()),
            (standard::IDENTITY, 3) => Ok(u32::from(self.unit.generation().number()).to_le_bytes().to_vec()),
            (standard::IDENTITY, 4) => Ok((self.unit.config().seed as u32).to_le_bytes().to_vec()),
            (
                standard::DEVICE_TYPE
                | standard::ERROR_REGISTER
                | standard::DEVICE_NAME
                | standard::SOFTWARE_VERSION
                | standard::CONSUMER_HEARTBEAT
                | standard::PRODUCER_HEARTBEAT
                | standard::IDENTITY,
                _,
            ) => Err(Abort::NO_SUBINDEX),
            _ => Err(Abort::NO_OBJECT),
        }
    }

    fn write_standard(&mut self, index: u16, subindex: u8, value: &[u8]) -> Result<(), Abort> {
        match (index, subindex) {
            (standard::PRODUCER_HEARTBEAT, 0) => {
                self.communication.producer_ms =
                    u16::from_le_bytes(value.try_into().map_err(|_| Abort::LENGTH)?);
                Ok(())
            }
            (standard::CONSUMER_HEARTBEAT, 1) => {
                self.communication.consumer =
                    u32::from_le_bytes(value.try_into().map_err(|_| Abort::LENGTH)?);
                Ok(())
            }
            _ => Err(self.read_standard(index, subindex).err().unwrap_or(Abort::READ_ONLY)),
        }
    }

    fn read_command(&mut self, command: u8, subindex: u8) -> Result<Vec<u8>, Abort> {
        match self.shape_of(command)? {
            (Shape::Trigger, _) => Err(Abort::WRITE_ONLY),
            (Shape::Single(_) | Shape::Several(_), false) if subindex > 0 => Err(Abort::WRITE_ONLY),
            (Shape::Several(fields), _) if subindex == 0 => Ok(vec![count_byte(fields.len())]),
            (Shape::Single(_), false) => Err(Abort::WRITE_ONLY),
            (Shape::Single(field), _) if subindex == 0 => {
                let values = self.values(command)?;
                bytes_of(field, number(&values, field.name).unwrap_or(0)).ok_or(Abort::GENERAL)
            }
            (Shape::Several(fields), _) => self.read_several(command, fields, subindex),
            (Shape::Text, _) if subindex == 0 => Ok(vec![TEXT]),
            (Shape::Text, _) if subindex == TEXT => self.read_text(command),
            (Shape::List(fields), _) => self.read_list(command, fields, subindex),
            (Shape::Single(_) | Shape::Text, _) => Err(Abort::NO_SUBINDEX),
        }
    }

    fn write_command(&mut self, command: u8, subindex: u8, value: &[u8]) -> Result<(), Abort> {
        match self.shape_of(command)? {
            (Shape::Trigger, _) if subindex == 0 && value == TRIGGER => self.act(command, &[]),
            (Shape::Trigger, _) if subindex == 0 => Err(Abort::VALUE),
            (Shape::Single(field), false) if subindex == 0 => {
                let raw = raw_of(field, value).ok_or(Abort::LENGTH)?;
                self.act(command, &[raw])
            }
            (Shape::Several(fields), false) if subindex > 0 => {
                self.write_several(command, fields, subindex, value)
            }
            (Shape::List(_), _) if subindex == LIST_CONTROL => {
                let [record] = value else { return Err(Abort::LENGTH) };
                self.communication.chosen.insert(command, usize::from(*record));
                Ok(())
            }
            (Shape::Single(_) | Shape::Several(_), true) => Err(Abort::READ_ONLY),
            (Shape::Text | Shape::List(_), _) => Err(Abort::READ_ONLY),
            (Shape::Trigger | Shape::Single(_) | Shape::Several(_), _) => Err(Abort::NO_SUBINDEX),
        }
    }

    /// The shape of a command's object, and whether it is read.
    fn shape_of(&self, command: u8) -> Result<(Shape, bool), Abort> {
        use brushwork_mcp_wire::packet_serial::Direction;
        let form = self.unit.form_of(command).ok_or(Abort::NO_OBJECT)?;
        Ok((shape(form).ok_or(Abort::NO_OBJECT)?, form.direction == Direction::Read))
    }

    fn values(&mut self, command: u8) -> Result<Vec<(&'static str, Value)>, Abort> {
        match self.unit.carry_out(command, &[]) {
            Outcome::Values(values) => Ok(values),
            Outcome::Done | Outcome::Refused => Err(Abort::DEVICE_STATE),
        }
    }

    fn read_several(
        &mut self,
        command: u8,
        fields: &'static [Field],
        subindex: u8,
    ) -> Result<Vec<u8>, Abort> {
        let at = usize::from(subindex) - 1;
        let field = fields.get(at).ok_or(Abort::NO_SUBINDEX)?;
        if at == 0 || !self.communication.snapshots.contains_key(&command) {
            let values = self.values(command)?;
            let raws = fields.iter().map(|field| number(&values, field.name).unwrap_or(0)).collect();
            self.communication.snapshots.insert(command, raws);
        }
        let raw = self.communication.snapshots.get(&command).and_then(|raws| raws.get(at)).copied();
        bytes_of(field, raw.ok_or(Abort::NO_DATA)?).ok_or(Abort::GENERAL)
    }

    fn read_text(&mut self, command: u8) -> Result<Vec<u8>, Abort> {
        let values = self.values(command)?;
        let text = values.into_iter().find_map(|(_, value)| match value {
            Value::Text(text) => Some(text),
            Value::Int(_) | Value::Bytes(_) | Value::Records(_) => None,
        });
        Ok(text.ok_or(Abort::NO_DATA)?.into_bytes())
    }

    fn read_list(&mut self, command: u8, fields: &'static [Field], subindex: u8) -> Result<Vec<u8>, Abort> {
        let values = self.values(command)?;
        let records = values.into_iter().find_map(|(_, value)| match value {
            Value::Records(records) => Some(records),
            Value::Int(_) | Value::Text(_) | Value::Bytes(_) => None,
        });
        let records = records.ok_or(Abort::NO_DATA)?;
        match subindex {
            0 => Ok(vec![count_byte(fields.len() + 1)]),
            LIST_CONTROL => Ok(vec![count_byte(records.len())]),
            _ => {
                let field = fields.get(usize::from(subindex) - 2).ok_or(Abort::NO_SUBINDEX)?;
                let chosen = self.communication.chosen.get(&command).copied().unwrap_or(0);
                let record = records.get(chosen).ok_or(Abort::VALUE)?;
                let raw = record.get(usize::from(subindex) - 2).copied().ok_or(Abort::NO_DATA)?;
                bytes_of(field, raw).ok_or(Abort::GENERAL)
            }
        }
    }

    /// Keeps an argument, and acts when the last one is written and all are there.
    fn write_several(
        &mut self,
        command: u8,
        fields: &'static [Field],
        subindex: u8,
        value: &[u8],
    ) -> Result<(), Abort> {
        let at = usize::from(subindex) - 1;
        let raw = raw_of(fields.get(at).ok_or(Abort::NO_SUBINDEX)?, value).ok_or(Abort::LENGTH)?;
        let staged = self.communication.staged.entry(command).or_default();
        staged.resize(fields.len(), None);
        staged[at] = Some(raw);
        if at + 1 < fields.len() {
            return Ok(());
        }
        let complete: Option<Vec<i64>> = staged.iter().copied().collect();
        self.communication.staged.remove(&command);
        self.act(command, &complete.ok_or(Abort::DEVICE_STATE)?)
    }

    fn act(&mut self, command: u8, args: &[i64]) -> Result<(), Abort> {
        match self.unit.carry_out(command, args) {
            Outcome::Done | Outcome::Values(_) => Ok(()),
            Outcome::Refused => Err(Abort::DEVICE_STATE),
        }
    }
}

fn count_byte(count: usize) -> u8 {
    u8::try_from(count).unwrap_or(u8::MAX)
}
