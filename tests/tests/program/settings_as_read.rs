//! Whatever registers a unit holds, out of range, without a meaning and of either sign too, a profile of it brings back to the last
//! bit, in virtual time: random states of every model and generation, exported to a file, compared, imported to another unit of the
//! same kind that holds other ones, and that unit's own brought back from the backup that was made then.

use brushwork_tests::said::Said;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use brushwork_core::keep::{Keeping, Store, UnitId};
use brushwork_link::FamilyChoice;
use brushwork_link::device::{Addresses, DeviceOptions, Job, JobContext, JobEnding};
use brushwork_link::settings::{
    Place, Profile, Row, SettingsImage, SettingsTable, Sink, Strictness, Subject, WriteOptions, WriteReport,
    diff, plan, read_all, write_kept,
};
use brushwork_link::{Failure, FamilyRef, Stream, UnitAddress, Wire};
use brushwork_mcp_client::packet::PacketWire;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::{Address, Generation, lookup};
use brushwork_mcp_wire::roboclaw::ConfigWord;
use brushwork_motion_mind_sim::{MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_motion_mind_wire::{Address as MindAddress, Mode, Protocol, REGISTERS, Register};
use brushwork_plant::machine::StreamIndex;
use brushwork_tests::virtual_line::{HiddenOf, VirtualLine};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Field;
use tempfile::TempDir;

/// Random states of each model and generation.
const STATES: u64 = 3;
const AS_READ: WriteOptions = WriteOptions { own_stream: Some(Stream::Usb), simulated: true, as_read: true };

/// A small generator of our own: the same numbers in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    /// One of the ends, a small number or any number of a range.
    fn raw(&mut self, low: i64, high: i64) -> i64 {
        let span = high - low;
        match self.next() % 5 {
            0 => low,
            1 => high,
            2 => low.max(0) + self.next() as i64 % (high - low.max(0)).clamp(1, 12),
            _ => low + (((self.next() << 31) ^ self.next()) % (span as u64 + 1)) as i64,
        }
    }
}

/// Past this program's ranges and within what the unit takes: a value beyond its valid range is not acknowledged. What would cut the way
/// to the unit is left as it is. The minimum current has either sign, the lowest number of its field too, which has no magnitude there, and
/// one of few magnitudes half the time, so that two units often hold the same.
fn raw_of(random: &mut Random, sink: Sink, field: &Field, now: i64) -> i64 {
    let (low, high) = field.raw_range.or(field.kind.limits()).expect("settings are numbers");
    let is_joined = ["min_action", "max_action"].contains(&field.name);
    match (sink.command, sink.place.field) {
        (141, "address") | (145, "index") => now,
        (145, "type") if sink.index == Some(0) => now,
        (133 | 134, "min") if random.next().is_multiple_of(2) => [100, -100, low][random.raw(0, 2) as usize],
        _ if !field.codes.is_empty() && !is_joined => {
            field.codes[random.raw(0, field.codes.len() as i64 - 1) as usize].raw
        }
        _ => random.raw(low, high),
    }
}

/// Gives every register a random value past this program's ranges; of settings without a wire form what the unit takes.
fn randomise(wire: &mut PacketWire, table: &SettingsTable, generation: Generation, random: &mut Random) {
    let sinks: BTreeSet<(u8, Option<u8>)> =
        table.rows().iter().filter_map(Row::sink).map(|sink| (sink.command, sink.index)).collect();
    let before = read_all(wire, *table.subject()).expect("it answers").image;
    let now = |command: u8, index: Option<u8>, field: &str| {
        let row = table.rows().iter().find(|row| {
            row.sink()
                .is_some_and(|sink| (sink.command, sink.index, sink.place.field) == (command, index, field))
        })?;
        row.encode(before.get(&row.key)?)
    };
    // First, since a pin that is given another type is no digital input any more.
    let address = wire.address();
    for row in table.rows().iter().filter(|row| !row.has_wire_form()) {
        let hidden = wire.hidden_settings().expect("it is simulated");
        hidden.set(address, &row.key, random.raw(0, 0xFFFF_FFFF)).expect("the key is the table's");
    }
    for (command, index) in sinks {
        let form = lookup(command).and_then(|command| command.form(generation)).expect("it is in the table");
        let mut arguments = Vec::new();
        for field in form.request.iter().filter(|field| field.fixed.is_none()) {
            let value = match index {
                Some(index) if field.name == "index" => i64::from(index),
                _ => {
                    let place = Place { field: field.name, bits: None };
                    let sink = Sink { command, place, index };
                    let now = now(command, index, field.name).unwrap_or_default();
                    raw_of(random, sink, field, now)
                }
            };
            arguments.push(value);
        }
        wire.transact(command, &arguments).unwrap_or_else(|error| panic!("{command}: {error}"));
    }
}

fn unit(model: &'static Model, generation: Generation) -> (VirtualLine<Bus>, PacketWire, SettingsTable) {
    brushwork::install();
    let config = ControllerConfig { model, generation, ..ControllerConfig::default() };
    let controller = Controller::new(config).expect("the default world is sound");
    let line = VirtualLine::new(Bus::single(controller, StreamIndex::Usb), StreamIndex::Usb);
    let wire = line.wire(Address::DEFAULT, generation, true).with_hidden(Arc::new(HiddenOf(line.clone())));
    (line, wire, SettingsTable::new(brushwork_mcp_client::subject(model, generation)))
}

/// What a unit holds. In R/C and analog mode a RoboClaw's configuration word has options where it has the address in the serial modes, so
/// that no write brings an address along.
fn settings(line: &VirtualLine<Bus>) -> Settings {
    let (mut settings, family) = line.with(|bus| {
        let unit = &bus.controllers()[0];
        (unit.settings(), unit.config().model.family)
    });
    if family == Family::RoboClaw && ConfigWord(settings.unit.config_word).address_number().is_none() {
        settings.unit.address = Address::DEFAULT.get();
    }
    settings
}

/// What a unit holds, by way of a file.
fn exported(folder: &TempDir, table: &SettingsTable, settings: &SettingsImage) -> Profile {
    let path = folder.path().join("exported.json");
    profile(*table.subject(), settings.clone()).save(&path).expect("the folder is the test's");
    let opened = Profile::open(&path, Strictness::Refuse).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((opened.upgraded, opened.corrected), (Vec::new(), Vec::new()));
    opened.profile
}

/// What keeps backups of the unit in a folder.
fn unit_id(table: &SettingsTable) -> UnitId {
    UnitId {
        model: table.subject().model.key.to_owned(),
        place: "the other one".to_owned(),
        has_serial_number: true,
        address: UnitAddress::factory(table.subject().family()).get(),
        is_simulated: false,
    }
}

/// The newest backup.
fn backup(store: &Store, table: &SettingsTable) -> Profile {
    let newest = store.backups(Some(&unit_id(table))).into_iter().next().expect("there is one");
    let opened = newest.open().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((opened.upgraded, opened.corrected), (Vec::new(), Vec::new()));
    opened.profile
}

/// Writes what a profile says as an import does, with a backup first; what is unusual is told, once each.
fn bring(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    stored: &Profile,
    options: WriteOptions,
    keeping: &Keeping,
) -> WriteReport {
    assert_eq!(stored.fitted_to(table).changes.len(), 0);
    let ram = read_all(wire, *table.subject()).expect("it answers").image;
    let wanted = stored.changes_for(table, &ram, options.simulated).expect("it fits").wanted;
    let planned = plan(table, &ram, &wanted, options).expect("it can be written");
    let reported =
        planned.warnings.iter().filter(|text| text.to_string().ends_with("It is written as it was read."));
    assert_eq!(reported.count(), unusual(table, &wanted), "{:#?}", planned.warnings);
    let mut keeper = keeping.keeper(unit_id(table), "");
    write_kept(wire, table, &wanted, options, &mut *keeper).unwrap_or_else(|error| panic!("{error}"))
}

fn profile(subject: Subject, settings: SettingsImage) -> Profile {
    let reported = String::new;
    let family: FamilyRef = subject.family();
    Profile {
        subject,
        firmware: reported(),
        address: UnitAddress::factory(family),
        date: reported(),
        unit: reported(),
        note: reported(),
        settings,
    }
}

/// How many of the values of a profile nobody may choose on that controller.
fn unusual(table: &SettingsTable, wanted: &SettingsImage) -> usize {
    let held = table.rows().iter().filter_map(|row| Some((row, wanted.get(&row.key)?)));
    held.filter(|(row, value)| row.check(*value).is_err()).count()
}

/// Whether two units hold the same minimum current of a motor, whose register the change of the maximum beside it writes too.
fn has_kept_sign(motor: usize, left: &Profile, right: &Profile) -> bool {
    let is_same = |end: &str| {
        let key = format!("motor{motor}.current.{end}_amps");
        left.settings.get(&key) == right.settings.get(&key)
    };
    is_same("min") && !is_same("max")
}

#[test]
fn any_registers_come_back_to_the_last_bit_in_every_model_and_generation() {
    let folder = TempDir::new().expect("a temporary folder can be made");
    let keeping = Keeping::new(Store::at(folder.path()));
    let (mut strange, mut odd_signs, mut kept_signs) = (0, 0, 0);
    for (index, model) in models::MODELS.iter().enumerate() {
        for generation in Generation::ALL {
            for state in 0..STATES {
                let seed = 1_000 * index as u64 + 10 * u64::from(generation.number()) + state;
                println!("{} {generation}, seed {seed}", model.key);
                let (line, mut wire, table) = unit(model, generation);
                randomise(&mut wire, &table, generation, &mut Random(seed));
                let held = settings(&line);
                let image = read_all(&mut wire, *table.subject()).expect("it answers").image;
                strange += unusual(&table, &image);
                let stored = exported(&folder, &table, &image);
                assert_eq!(diff(&table, &stored.settings, &image), []);

                let (other, mut wire, _) = unit(model, generation);
                randomise(&mut wire, &table, generation, &mut Random(seed + 500_000));
                let own = settings(&other);
                assert_ne!(own, held);
                let report = bring(&mut wire, &table, &stored, AS_READ, &keeping);
                assert!(report.is_complete(), "{:#?}", report.sentences(&table));
                assert_eq!(settings(&other), held);
                let now = read_all(&mut wire, *table.subject()).expect("it answers").image;
                assert_eq!(diff(&table, &stored.settings, &now), []);

                let backup = backup(keeping.store(), &table);
                odd_signs += diff(&table, &backup.settings, &stored.settings)
                    .iter()
                    .filter(|change| change.key.ends_with(".min_amps"))
                    .count();
                kept_signs += (1..=2).filter(|motor| has_kept_sign(*motor, &stored, &backup)).count();
                let report = bring(&mut wire, &table, &backup, AS_READ, &keeping);
                assert!(report.is_complete(), "{:#?}", report.sentences(&table));
                assert_eq!(settings(&other), own);
            }
        }
    }
    assert!(
        strange > 1_000 && odd_signs > 100 && kept_signs > 30,
        "{strange} strange values, {odd_signs} changed signs, {kept_signs} kept ones"
    );
}

type MindLink = VirtualLink<MotionMindBus>;

fn mind(protocol: Protocol) -> MindLink {
    let address = MindAddress::unit(1).expect("an address of a unit");
    let config = MotionMindConfig { address, protocol, ..MotionMindConfig::new(Mode::SerialPid) };
    let unit = MotionMind::new(config).expect("the default motor is sound");
    let options = DeviceOptions {
        addresses: Addresses::Only(1),
        family: FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
        ..DeviceOptions::default()
    };
    let mut link = VirtualLink::over(MotionMindBus::new(vec![unit]), options, Vec::new(), 1);
    link.run_for(Duration::from_millis(1_500));
    link
}

fn job<T: Send + 'static>(
    link: &mut MindLink,
    work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
) -> T {
    let limit = Duration::from_secs(60);
    match link.finish(Job::new(Said::Work, limit, work), limit) {
        Some(JobEnding::Done(value)) => value,
        other => panic!("{other:?}: {:?}", link.events),
    }
}

/// The registers that are settings, but for the address.
fn mind_settings() -> impl Iterator<Item = &'static Register> {
    REGISTERS.iter().filter(|row| row.is_writable() && !matches!(row.name, "POSITION" | "ADDRESS"))
}

fn mind_registers(link: &MindLink) -> Vec<(&'static str, i64)> {
    link.bus(|bus| {
        let unit = &bus.motion_minds()[0];
        mind_settings().map(|row| (row.name, unit.read_one(row.number))).collect()
    })
}

/// Gives every register a random value, and says what they then hold.
fn randomise_mind(link: &mut MindLink, seed: u64) -> Vec<(&'static str, i64)> {
    let mut random = Random(seed);
    let values: Vec<(u8, i64)> = mind_settings()
        .map(|row| {
            let range = row.kind.range();
            (row.number, random.raw(*range.start(), *range.end()))
        })
        .collect();
    job(link, move |wire| {
        for (number, value) in &values {
            let written = wire.transact(0x18, &[(*number).into(), *value]);
            written.map_err(|error| error.failure(Said::Write, "it"))?;
        }
        Ok(())
    });
    mind_registers(link)
}

#[test]
fn any_registers_of_a_motion_mind_come_back_to_the_last_bit_in_both_protocols() {
    let folder = TempDir::new().expect("a temporary folder can be made");
    let keeping = Keeping::new(Store::at(folder.path()));
    for protocol in Protocol::ALL {
        for seed in 0..10 {
            println!("{protocol}, seed {seed}");
            let mut link = mind(protocol);
            let held = randomise_mind(&mut link, seed);
            let revision = link.bus(|bus| bus.motion_minds()[0].read_one(17)) as u8;
            let subject = brushwork_motion_mind_client::subject(revision);
            let table = SettingsTable::new(subject);
            let image = job(&mut link, move |wire| read_all(wire, subject)).image;

            let stored = exported(&folder, &table, &image);
            assert_eq!(diff(&table, &stored.settings, &image), []);

            let mut other = mind(protocol);
            let own = randomise_mind(&mut other, seed + 500);
            assert_ne!(own, held);
            let options = WriteOptions { own_stream: None, simulated: false, as_read: true };
            for wanted in [&held, &own] {
                let profile = if wanted == &held { stored.clone() } else { backup(keeping.store(), &table) };
                let (table, keeping) = (table.clone(), keeping.clone());
                let told = table.clone();
                let report =
                    job(&mut other, move |wire| Ok(bring(wire, &table, &profile, options, &keeping)));
                assert!(report.is_complete(), "{:#?}", report.sentences(&told));
                assert_eq!(&mind_registers(&other), wanted);
            }
        }
    }
}
