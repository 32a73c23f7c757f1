//! Whatever registers a unit holds, out of range and without a meaning too, a profile of it brings back to the last bit, in
//! virtual time: random states of every model and generation, exported, compared, and written to a unit from the factory.

use brushwork_link::Message;
use brushwork_tests::said::Said;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use brushwork_link::FamilyChoice;
use brushwork_link::device::{Addresses, DeviceOptions, Job, JobContext, JobEnding};
use brushwork_link::settings::{
    Place, Profile, Row, SettingsImage, SettingsTable, Sink, Subject, WriteOptions, diff, plan, read_all,
    restore_defaults, write,
};
use brushwork_link::{Failure, Stream, UnitAddress, Wire};
use brushwork_mcp_client::packet::PacketWire;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::{Address, Generation, lookup};
use brushwork_motion_mind_sim::{MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_motion_mind_wire::{Address as MindAddress, Mode, Protocol, REGISTERS, Register};
use brushwork_plant::machine::StreamIndex;
use brushwork_tests::virtual_line::{HiddenOf, VirtualLine};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Kind;

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

/// Where a row may not be anything: what would cut the way to the unit, and the sign of the minimum current, which units report
/// either way and this program writes as the generation wants it.
fn raw_of(random: &mut Random, generation: Generation, sink: Sink, kind: Kind, now: i64) -> i64 {
    let (low, high) = kind.limits().expect("settings are numbers");
    match (sink.command, sink.place.field) {
        (141, "address") | (145, "index") => now,
        (145, "type") if sink.index == Some(0) => now,
        (133 | 134, "min") if generation < Generation::Gen3 => random.raw(low + 1, 0),
        (133 | 134, "min") => random.raw(0, i64::from(i32::MAX)),
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
                    raw_of(random, generation, sink, field.kind, now)
                }
            };
            arguments.push(value);
        }
        wire.transact(command, &arguments).unwrap_or_else(|error| panic!("{command}: {error}"));
    }
    let address = wire.address();
    for row in table.rows().iter().filter(|row| !row.has_wire_form()) {
        let hidden = wire.hidden_settings().expect("it is simulated");
        hidden.set(address, &row.key, random.raw(0, 0xFFFF_FFFF)).expect("the key is the table's");
    }
}

fn unit(model: &'static Model, generation: Generation) -> (VirtualLine<Bus>, PacketWire, SettingsTable) {
    let config = ControllerConfig { model, generation, ..ControllerConfig::default() };
    let controller = Controller::new(config).expect("the default world is sound");
    let line = VirtualLine::new(Bus::single(controller, StreamIndex::Usb), StreamIndex::Usb);
    let wire = line.wire(Address::DEFAULT, generation, true).with_hidden(Arc::new(HiddenOf(line.clone())));
    (line, wire, SettingsTable::new(brushwork_mcp_client::subject(model, generation)))
}

fn settings(line: &VirtualLine<Bus>) -> Settings {
    line.with(|bus| bus.controllers()[0].settings())
}

fn profile(subject: Subject, settings: SettingsImage) -> Profile {
    let reported = String::new;
    Profile {
        subject,
        firmware: reported(),
        address: UnitAddress::factory(brushwork_mcp_client::MCP),
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

#[test]
fn any_registers_come_back_to_the_last_bit_in_every_model_and_generation() {
    for (index, model) in models::MODELS.iter().enumerate() {
        for generation in Generation::ALL {
            for state in 0..STATES {
                let seed = 1_000 * index as u64 + 10 * u64::from(generation.number()) + state;
                let what = format!("{} {generation}, seed {seed}", model.key);
                println!("{what}");
                let (line, mut wire, table) = unit(model, generation);
                randomise(&mut wire, &table, generation, &mut Random(seed));
                let held = settings(&line);
                let image = read_all(&mut wire, *table.subject()).expect("it answers").image;

                let text = profile(*table.subject(), image.clone()).to_json();
                let stored = Profile::parse(&text).unwrap_or_else(|error| panic!("{what}: {error}"));
                assert_eq!(diff(&table, &stored.settings, &image), [], "{what}");
                assert_eq!(stored.fitted_to(&table).changes, [""; 0], "{what}");

                restore_defaults(&mut wire, *table.subject()).unwrap_or_else(|failure| panic!("{failure}"));
                assert_ne!(settings(&line), held, "{what}");
                let ram = read_all(&mut wire, *table.subject()).expect("it answers").image;
                let asked =
                    stored.changes_for(&table, &ram, true).unwrap_or_else(|error| panic!("{what}: {error}"));
                let planned = plan(&table, &ram, &asked.wanted, AS_READ).expect("it can be written");
                let reported = planned
                    .warnings
                    .iter()
                    .filter(|text| text.to_string().ends_with("It is written as it was read."));
                let unusual = unusual(&table, &asked.wanted);
                assert!(unusual > 0, "{what}: the state is not strange enough");
                assert_eq!(reported.count(), unusual, "{what}: {:#?}", planned.warnings);
                let report = write(&mut wire, &table, &asked.wanted, AS_READ)
                    .unwrap_or_else(|error| panic!("{what}: {error}"));
                assert!(report.is_complete(), "{what}: {:#?}", report.sentences(&table));
                assert_eq!(settings(&line), held, "{what}");
            }
        }
    }
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

#[test]
fn any_registers_of_a_motion_mind_come_back_to_the_last_bit_in_both_protocols() {
    for protocol in Protocol::ALL {
        for seed in 0..10 {
            let what = format!("{protocol}, seed {seed}");
            println!("{what}");
            let mut link = mind(protocol);
            let mut random = Random(seed);
            let values: Vec<(u8, i64)> = mind_settings()
                .map(|row| {
                    let range = row.kind.range();
                    (row.number, random.raw(*range.start(), *range.end()))
                })
                .collect();
            job(&mut link, move |wire| {
                for (number, value) in &values {
                    let written = wire.transact(0x18, &[(*number).into(), *value]);
                    written.map_err(|error| error.failure(Said::Write, "it"))?;
                }
                Ok(())
            });
            let held = mind_registers(&link);
            let revision = link.bus(|bus| bus.motion_minds()[0].read_one(17)) as u8;
            let subject = brushwork_motion_mind_client::subject(revision);
            let table = SettingsTable::new(subject);
            let image = job(&mut link, move |wire| read_all(wire, subject)).image;

            let mut exported = profile(subject, image.clone());
            exported.address = brushwork_motion_mind_client::unit_address(1).expect("an address");
            let stored =
                Profile::parse(&exported.to_json()).unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_eq!(diff(&table, &stored.settings, &image), [], "{what}");
            job(&mut link, move |wire| restore_defaults(wire, subject));
            assert_ne!(mind_registers(&link), held, "{what}");
            let ram = job(&mut link, move |wire| read_all(wire, subject)).image;
            let wanted = stored.changes_for(&table, &ram, false).expect("it fits").wanted;
            let options = WriteOptions { own_stream: None, simulated: false, as_read: true };
            let planned = plan(&table, &ram, &wanted, options).expect("it can be written");
            let reported = planned
                .warnings
                .iter()
                .filter(|text| text.to_string().ends_with("It is written as it was read."));
            assert_eq!(reported.count(), unusual(&table, &wanted), "{what}: {:#?}", planned.warnings);
            let (copy, on) = (table.clone(), wanted.clone());
            let report = job(&mut link, move |wire| {
                let written = write(wire, &copy, &on, options);
                written.map_err(|error| Failure::new(Said::Write, "it", Message::error(error), Said::Look))
            });
            assert!(report.is_complete(), "{what}: {:#?}", report.sentences(&table));
            assert_eq!(mind_registers(&link), held, "{what}");
        }
    }
}
