//! A controller of a few lines for tests: it holds one raw number per row, finds rows by the commands that
//! carry them, and can be told to misbehave. It proves how the code around it copes, not what a controller
//! does.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;
use std::time::Duration;

use brushwork_mcp_wire::packet_serial::{Address, Form, Reply, lookup, number};
use brushwork_values::{Field, Kind, Value, Values};

use brushwork_link::exchange::{ExchangeError, Interruption, Tries};
use brushwork_link::settings::{Carrier, Row, SettingsImage, SettingsTable, Source};
use brushwork_link::transport::TransportError;
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::wire::{HiddenSettings, Wire};

/// What a command is answered with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mishap {
    /// Carried out, and the acknowledgement is lost.
    DoneUnanswered,
    /// Neither carried out nor answered.
    Silence,
    /// The port is gone from here on.
    LinkLost,
    /// Someone pressed Stop; everything fails from here on.
    Stopped,
}

pub(super) struct FakeUnit {
    table: SettingsTable,
    pub(super) ram: BTreeMap<String, i64>,
    pub(super) eeprom: BTreeMap<String, i64>,
    pub(super) hidden: Hidden,
    /// Where the unit answers; commands to other addresses are met with silence.
    pub(super) unit_address: UnitAddress,
    wire_address: UnitAddress,
    pub(super) simulated: bool,
    pub(super) can_follow: bool,
    /// Commands that are never answered.
    pub(super) silent: BTreeSet<u8>,
    /// Rows that acknowledge a write and keep what they had.
    pub(super) stubborn: BTreeSet<String>,
    /// By the number of a command in the log, from 0.
    pub(super) mishaps: BTreeMap<usize, Mishap>,
    /// What is wrong with the wire for good.
    broken: Option<Mishap>,
    /// Every command with its arguments.
    pub(super) log: Vec<(u8, Vec<i64>)>,
    /// The unit restarts after a save: until then it does not answer, and RAM is loaded from EEPROM.
    pub(super) restart_time: Option<Duration>,
    silent_until: Duration,
    /// A save is acknowledged and not done.
    pub(super) ignores_save: bool,
    now: Duration,
}

/// Settings without a wire form. The trait asks for `Sync`; these tests have one thread.
#[derive(Debug, Default)]
pub(super) struct Hidden(Mutex<BTreeMap<String, i64>>);

impl HiddenSettings for Hidden {
    fn get(&self, _address: UnitAddress, key: &str) -> Option<i64> {
        self.0.lock().expect("one thread").get(key).copied()
    }

    fn set(&self, _address: UnitAddress, key: &str, raw: i64) -> Result<(), String> {
        self.0.lock().expect("one thread").insert(key.to_owned(), raw);
        Ok(())
    }
}

impl FakeUnit {
    pub(super) fn new(table: &SettingsTable) -> Self {
        let raw = |row: &Row| (row.key.clone(), row.encode(row.default).expect("defaults have a wire form"));
        let (carried, hidden): (Vec<&Row>, Vec<&Row>) =
            table.rows().iter().partition(|row| row.has_wire_form());
        let ram: BTreeMap<String, i64> = carried.into_iter().map(raw).collect();
        let past_the_wire = Hidden::default();
        for row in hidden {
            let (key, raw) = raw(row);
            past_the_wire.set(crate::unit_address(Address::DEFAULT), &key, raw).expect("it takes all");
        }
        Self {
            table: table.clone(),
            eeprom: ram.clone(),
            ram,
            hidden: past_the_wire,
            unit_address: UnitAddress::factory(crate::MCP),
            wire_address: UnitAddress::factory(crate::MCP),
            simulated: true,
            can_follow: true,
            silent: BTreeSet::new(),
            stubborn: BTreeSet::new(),
            mishaps: BTreeMap::new(),
            broken: None,
            log: Vec::new(),
            restart_time: None,
            silent_until: Duration::ZERO,
            ignores_save: false,
            now: Duration::ZERO,
        }
    }

    pub(super) fn image(&self) -> SettingsImage {
        let decode = |(key, raw): (&String, &i64)| {
            (key.clone(), self.table.row(key).expect("the keys come from the table").decode(*raw))
        };
        self.ram.iter().map(decode).collect()
    }

    pub(super) fn set(&mut self, key: &str, text: &str) {
        let row = self.table.row(key).unwrap_or_else(|| panic!("{key} is missing"));
        let raw = row.parse(text).ok().and_then(|value| row.encode(value));
        self.ram.insert(key.to_owned(), raw.unwrap_or_else(|| panic!("{key}: {text}")));
    }

    pub(super) fn count(&self, command: u8) -> usize {
        self.log.iter().filter(|(logged, _)| *logged == command).count()
    }

    fn fail(&mut self, mishap: Mishap) -> ExchangeError {
        match mishap {
            Mishap::DoneUnanswered | Mishap::Silence => {
                self.now += Duration::from_millis(60);
                ExchangeError::TimedOut { waited: Duration::from_millis(20), tries: Tries(3), heard: 0 }
            }
            Mishap::LinkLost => {
                self.broken = Some(mishap);
                TransportError::Gone { detail: "no such device".to_owned() }.into()
            }
            Mishap::Stopped => {
                self.broken = Some(mishap);
                ExchangeError::Interrupted { cause: Interruption::Stop }
            }
        }
    }

    fn reply(&self, command: u8, form: &Form) -> Values {
        let Reply::Data(fields) = form.reply else { return Values::default() };
        if command == number::READ_VERSION {
            return Values::new(fields, vec![Value::from("MCP266 2x60A v1.0.0")]);
        }
        let value = |field: &Field| match field.kind {
            Kind::Counted(inner) => Value::Records(
                (0..)
                    .map_while(|index| {
                        inner.iter().map(|field| self.word(command, Some(index), field.name)).collect()
                    })
                    .collect(),
            ),
            _ => Value::Int(self.word(command, None, field.name).unwrap_or(0)),
        };
        Values::new(fields, fields.iter().map(value).collect())
    }

    /// The number of a reply field, its bits put together.
    fn word(&self, command: u8, record: Option<usize>, name: &str) -> Option<i64> {
        let mut word = None;
        for row in self.table.rows() {
            let Carrier::Wire { read: Source::Reply { command: from, place, record: at }, write } =
                row.carrier
            else {
                continue;
            };
            if (from, place.field, at) == (command, name, record) && write.is_some() {
                let raw = self.ram[&row.key];
                word = Some(place.bits.map_or(raw, |bits| bits.insert(word.unwrap_or(0), raw)));
            }
        }
        word
    }

    fn store(&mut self, command: u8, form: &Form, arguments: &[i64]) {
        let indexed = form.request.first().is_some_and(|field| field.name == "index");
        let index = indexed.then(|| u8::try_from(arguments[0]).expect("an index is a byte"));
        for (field, value) in form.request.iter().zip(arguments) {
            for row in self.table.rows() {
                let Some(sink) = row.sink() else { continue };
                let ours = (sink.command, sink.index, sink.place.field) == (command, index, field.name);
                if ours && !self.stubborn.contains(&row.key) {
                    let raw = sink.place.bits.map_or(*value, |bits| bits.extract(*value));
                    self.ram.insert(row.key.clone(), raw);
                }
            }
        }
        if command == number::SET_ADDRESS_MIXED
            && let Some(address) = u8::try_from(self.ram["unit.address"]).ok().and_then(Address::new)
        {
            self.unit_address = crate::unit_address(address);
        }
    }

    fn carry_out(&mut self, command: u8, form: &Form, arguments: &[i64]) -> Values {
        match command {
            number::SAVE_SETTINGS => {
                if !self.ignores_save {
                    self.eeprom = self.ram.clone();
                }
                if let Some(time) = self.restart_time {
                    self.silent_until = self.now + time;
                    self.ram = self.eeprom.clone();
                }
            }
            number::RELOAD_SETTINGS => self.ram = self.eeprom.clone(),
            number::RESTORE_DEFAULTS => {
                let raw = |row: &Row| {
                    (row.key.clone(), row.encode(row.default).expect("defaults have a wire form"))
                };
                self.ram = self.table.rows().iter().filter(|row| row.has_wire_form()).map(raw).collect();
                self.unit_address = UnitAddress::factory(crate::MCP);
            }
            _ => self.store(command, form, arguments),
        }
        self.reply(command, form)
    }
}

impl Wire for FakeUnit {
    fn transact_values(&mut self, command: u8, values: Vec<Value>) -> Result<Values, ExchangeError> {
        if let Some(mishap) = self.broken {
            return Err(self.fail(mishap));
        }
        let arguments: Vec<i64> = values.iter().filter_map(Value::as_int).collect();
        let turn = self.log.len();
        self.log.push((command, arguments.clone()));
        self.now += Duration::from_millis(1);
        let form = lookup(command)
            .and_then(|row| row.form(crate::layout_of(self.generation())))
            .expect("only commands that it has");
        let away = self.wire_address != self.unit_address || self.now < self.silent_until;
        if away || self.silent.contains(&command) {
            return Err(self.fail(Mishap::Silence));
        }
        match self.mishaps.get(&turn).copied() {
            None => Ok(self.carry_out(command, form, &arguments)),
            Some(mishap) => {
                if mishap == Mishap::DoneUnanswered {
                    self.carry_out(command, form, &arguments);
                }
                Err(self.fail(mishap))
            }
        }
    }

    fn address(&self) -> UnitAddress {
        self.wire_address
    }

    fn generation(&self) -> FirmwareGeneration {
        self.table.subject().generation
    }

    fn is_simulated(&self) -> bool {
        self.simulated
    }

    fn now(&self) -> Duration {
        self.now
    }

    fn sleep(&mut self, time: Duration) -> Result<(), ExchangeError> {
        self.now += time;
        match self.broken {
            Some(mishap) => Err(self.fail(mishap)),
            None => Ok(()),
        }
    }

    fn port(&self) -> String {
        "the test".to_owned()
    }

    fn set_address(&mut self, address: UnitAddress) -> bool {
        if let Some(address) = crate::packet_address(address)
            && self.can_follow
        {
            self.wire_address = crate::unit_address(address);
        }
        self.can_follow
    }

    fn hidden_settings(&self) -> Option<&dyn HiddenSettings> {
        self.simulated.then_some(&self.hidden as &dyn HiddenSettings)
    }
}
