//! Settings against the simulated controller, end to end in virtual time: everything written and read back,
//! saved, kept over a power cycle, and what is told when a byte, a save or the power is lost.

use std::sync::Arc;
use std::time::Duration;

use brushwork_link::settings::{
    Carrier, Kind, Row, RowState, SaveVerdict, SettingValue, SettingsImage, SettingsTable, WriteOptions,
    diff, read_all, reload, restore_defaults, save_eeprom, write,
};
use brushwork_link::{Stream, Wire};
use brushwork_mcp_client::TypedWire;
use brushwork_mcp_client::packet::PacketWire;
use brushwork_mcp_client::settings::SignalShape;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::{Address, Generation, commands, name, number};
use brushwork_plant::faults::{Fault, Faulty};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_tests::virtual_line::{HiddenOf, VirtualLine};

const OPTIONS: WriteOptions = WriteOptions { own_stream: Some(Stream::Usb), simulated: true, as_read: false };

fn config(model: &'static Model, generation: Generation) -> ControllerConfig {
    ControllerConfig { model, generation, ..ControllerConfig::default() }
}

fn model(key: &str) -> &'static Model {
    brushwork::install();
    models::lookup(key).expect("the tests name models of the list")
}

/// A simulated unit on USB, and a client that may set what has no wire form.
fn unit(model: &'static Model, generation: Generation) -> (VirtualLine<Bus>, PacketWire, SettingsTable) {
    let controller = Controller::new(config(model, generation)).expect("the default world is sound");
    let line = VirtualLine::new(Bus::single(controller, StreamIndex::Usb), StreamIndex::Usb);
    let wire = line.wire(Address::DEFAULT, generation, true).with_hidden(Arc::new(HiddenOf(line.clone())));
    (line, wire, SettingsTable::new(brushwork_mcp_client::subject(model, generation)))
}

/// Every row that this program can change without cutting its own line, with a value that is not the default.
fn everything_changed(table: &SettingsTable) -> SettingsImage {
    let ours = |row: &&Row| row.locked(true).is_none() && row.key != "stream.usb.type";
    table.rows().iter().filter(ours).map(|row| (row.key.clone(), another_value(row))).collect()
}

/// A value in range that is not the default. What is called a minimum stays below what is called a maximum.
fn another_value(row: &Row) -> SettingValue {
    match row.kind {
        Kind::Bool => SettingValue::Bool(row.default != SettingValue::Bool(true)),
        // A digital pin has no other type, so the pins keep to the first one that is not the default.
        Kind::Choice(codes) if row.pattern == "pin.{n}.type" => SettingValue::Choice(codes[0].key),
        Kind::Choice(codes) => {
            let other = codes.iter().rev().find(|code| row.default != SettingValue::Choice(code.key));
            SettingValue::Choice(other.expect("a list has more than one value").key)
        }
        Kind::Int | Kind::Fixed { .. } => {
            let share = if row.key.contains("min") { 0.25 } else { 0.75 };
            let number = row.range.min + (row.range.max - row.range.min) * share;
            match row.kind {
                Kind::Int => SettingValue::Int(number as i64),
                _ => row.settle(SettingValue::Number(number)),
            }
        }
    }
}

fn switch(line: &VirtualLine<Bus>, on: bool) {
    line.with(|bus| bus.controllers_mut()[0].apply(&WorldAction::Power { on })).expect("it has a switch");
}

fn describe(table: &SettingsTable, left: &SettingsImage, right: &SettingsImage) -> Vec<String> {
    let row = |key: &str| table.row(key).expect("differences come from the table");
    diff(table, left, right)
        .iter()
        .map(|change| format!("{} ({})", change.describe(row(&change.key)), change.key))
        .collect()
}

#[test]
fn a_unit_from_the_factory_holds_the_defaults_of_the_table() {
    for model in models::MODELS {
        for generation in Generation::ALL {
            let (_, mut wire, table) = unit(model, generation);
            let report = read_all(&mut wire, *table.subject()).unwrap_or_else(|failure| panic!("{failure}"));
            assert!(report.failures.is_empty(), "{} {generation}: {:?}", model.key, report.failures);
            let reported = describe(&table, &table.default_image(), &report.image);
            assert_eq!(reported, [""; 0], "{} {generation}", model.key);
            assert_eq!(report.table.subject(), table.subject());
        }
    }
}

#[test]
fn everything_written_is_read_back_saved_and_kept_over_a_power_cycle() {
    for key in ["mcp233", "mcp266", "mcp2166", "roboclaw-2x7a"] {
        for generation in Generation::ALL {
            let (line, mut wire, table) = unit(model(key), generation);
            let wanted = everything_changed(&table);
            let report =
                write(&mut wire, &table, &wanted, OPTIONS).unwrap_or_else(|error| panic!("{key}: {error}"));
            assert!(report.is_complete(), "{key} {generation}: {:#?}", report.sentences(&table));

            let saved = save_eeprom(&mut wire, &table, OPTIONS).unwrap_or_else(|failure| panic!("{failure}"));
            assert_eq!(saved.verdict, SaveVerdict::Verified, "{key} {generation}: {}", saved.sentence());
            let before = read_all(&mut wire, *table.subject()).expect("it answers").image;

            switch(&line, false);
            line.pass(Duration::from_secs(2));
            switch(&line, true);
            line.pass(Duration::from_secs(2));

            let after = read_all(&mut wire, *table.subject()).expect("it answers").image;
            assert_eq!(describe(&table, &before, &after), [""; 0], "{key} {generation}");
            for (key, value) in wanted.iter() {
                assert_eq!(after.get(key), Some(value), "{key} {generation}");
            }
        }
    }
}

#[test]
fn what_was_not_saved_is_gone_after_a_reload() {
    for generation in Generation::ALL {
        let (_, mut wire, table) = unit(model("mcp266"), generation);
        let mut wanted = everything_changed(&table);
        // USB answers to every address, and generation 1 does not report its own: whether it went back cannot
        // be read.
        if generation == Generation::Gen1 {
            wanted.remove("unit.address");
        }
        assert!(write(&mut wire, &table, &wanted, OPTIONS).expect("it answers").is_complete());
        let report = reload(&mut wire, &table).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(describe(&table, &table.default_image(), &report.image), [""; 0], "{generation}");
    }
}

#[test]
fn defaults_are_restored_in_ram_and_eeprom_keeps_what_it_had() {
    for generation in Generation::ALL {
        let (line, mut wire, table) = unit(model("mcp266"), generation);
        let mut wanted = everything_changed(&table);
        wanted.remove("unit.address");
        assert!(write(&mut wire, &table, &wanted, OPTIONS).expect("it answers").is_complete());
        assert_eq!(
            save_eeprom(&mut wire, &table, OPTIONS).expect("it answers").verdict,
            SaveVerdict::Verified
        );
        let stored = line.with(|bus| bus.controllers()[0].stored_settings());
        let report =
            restore_defaults(&mut wire, *table.subject()).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(report.differences, [], "{generation}");
        assert_eq!(line.with(|bus| bus.controllers()[0].stored_settings()), stored);
    }
}

#[test]
fn a_save_cut_by_a_power_loss_is_found_out() {
    let (line, mut wire, table) = unit(model("mcp266"), Generation::Gen1);
    let mut wanted = everything_changed(&table);
    wanted.remove("unit.address");
    assert!(write(&mut wire, &table, &wanted, OPTIONS).expect("it answers").is_complete());
    let ram = read_all(&mut wire, *table.subject()).expect("it answers").image;
    wire.transact(number::SAVE_SETTINGS, &[]).expect("it acknowledges before it has written");
    switch(&line, false);
    line.pass(Duration::from_secs(1));
    switch(&line, true);
    line.pass(Duration::from_secs(2));
    let mixed = read_all(&mut wire, *table.subject()).expect("it answers").image;
    assert!(!diff(&table, &ram, &mixed).is_empty(), "nothing of the save may have been written");
}

#[test]
fn a_full_write_under_one_percent_of_byte_loss_ends_right_or_says_what_is_not() {
    let (mut complete, mut reported) = (0, 0);
    for seed in 1..=20 {
        let (model, generation) = (model("mcp233"), Generation::Gen1);
        let controller = Controller::new(config(model, generation)).expect("the default world is sound");
        let faults: Vec<Fault> = vec!["drop=1%".parse().expect("it is a fault")];
        let machine = Faulty::new(Bus::single(controller, StreamIndex::Usb), faults, seed);
        let line = VirtualLine::new(machine, StreamIndex::Usb);
        let mut wire = line.wire(Address::DEFAULT, generation, true);
        let table = SettingsTable::new(brushwork_mcp_client::subject(model, generation));
        let wanted: SettingsImage = everything_changed(&table)
            .iter()
            .filter(|(key, _)| table.row(key).is_some_and(Row::has_wire_form) && *key != "unit.address")
            .map(|(key, value)| (key.to_owned(), value))
            .collect();
        let Ok(report) = write(&mut wire, &table, &wanted, OPTIONS) else {
            reported += 1;
            continue;
        };
        let truth = truth(&line, &table, generation);
        for row in &report.rows {
            let holds = truth.get(&row.key) == Some(row.wanted);
            match row.state {
                RowState::Taken => assert!(holds, "seed {seed}: {row:?}"),
                RowState::DidNotTake { .. } => assert!(!holds, "seed {seed}: {row:?}"),
                RowState::NotSent { .. } => {
                    assert_eq!(truth.get(&row.key), row.before, "seed {seed}: {row:?}");
                }
                RowState::Unverified { .. } => {}
            }
        }
        if report.is_complete() { complete += 1 } else { reported += 1 }
    }
    assert_eq!(complete + reported, 20);
    assert!(complete > 0 && reported > 0, "both ends are seen: {complete} right, {reported} told");
}

/// What the unit really holds, read over a line of its own without faults.
fn truth(line: &VirtualLine<Faulty<Bus>>, table: &SettingsTable, generation: Generation) -> SettingsImage {
    let copy = line.with(|machine| machine.inner_mut().clone());
    let quiet = VirtualLine::new(copy, StreamIndex::Usb);
    let mut wire = quiet.wire(Address::DEFAULT, generation, true);
    read_all(&mut wire, *table.subject()).expect("nothing disturbs this line").image
}

#[test]
fn nothing_is_left_out_but_what_this_line_needs_and_what_cannot_be_written() {
    for generation in Generation::ALL {
        let table = SettingsTable::new(brushwork_mcp_client::subject(model("mcp266"), generation));
        let wanted = everything_changed(&table);
        let left_out: Vec<&str> =
            table.rows().iter().map(|row| row.key.as_str()).filter(|key| wanted.get(key).is_none()).collect();
        assert_eq!(left_out, ["stream.usb.type"], "{generation}");
        let roboclaw = SettingsTable::new(brushwork_mcp_client::subject(model("roboclaw-2x7a"), generation));
        assert_eq!(
            brushwork_mcp_client::model_of(roboclaw.subject()).map(|model| model.family),
            Some(Family::RoboClaw)
        );
        let wanted = everything_changed(&roboclaw);
        let read_only: Vec<&str> = roboclaw
            .rows()
            .iter()
            .map(|row| row.key.as_str())
            .filter(|key| wanted.get(key).is_none())
            .collect();
        let whole = ["motor1.encoder.mode", "motor2.encoder.mode", "roboclaw.config.word"];
        assert_eq!(read_only, whole, "{generation}");
        assert!(roboclaw.rows().iter().all(|row| matches!(row.carrier, Carrier::Wire { .. })));
    }
}

#[test]
fn the_signal_graph_draws_what_the_controller_makes_of_an_input() {
    let (line, mut wire, table) = unit(model("mcp266"), Generation::Gen2);
    let fields = ["min", "center", "max", "deadband", "power_exp", "power_min", "min_output", "max_output"];
    let shapes = [
        [0.0, 2048.0, 4095.0, 0.0, 0.0, 0.0, -32_767.0, 32_767.0],
        [300.0, 2100.0, 3800.0, 60.0, 0.0, 0.0, -32_767.0, 32_767.0],
        [0.0, 2048.0, 4095.0, 100.0, 1.5, 200.0, -10_000.0, 20_000.0],
        [500.0, 1000.0, 3500.0, 20.0, -2.0, 0.0, -32_767.0, 32_767.0],
    ];
    for shape in shapes {
        let named = |(field, number): (&str, f64)| {
            let row = table.row(&format!("pin.3.{field}")).expect("it is a pin");
            let value = match row.kind {
                Kind::Int => SettingValue::Int(number as i64),
                _ => row.settle(SettingValue::Number(number)),
            };
            (row.key.clone(), value)
        };
        let mut wanted: SettingsImage = fields.into_iter().zip(shape).map(named).collect();
        wanted.set("pin.3.type", SettingValue::Choice("analog"));
        write(&mut wire, &table, &wanted, OPTIONS).expect("a sound shape can be written");
        let drawn = SignalShape::of(&|key| wanted.get(key), 3).expect("all values are there");
        for reading in (0..=4095).step_by(37) {
            // Full scale is 5.1 V.
            let volts = f64::from(reading) / 4095.0 * 5.1;
            let action = WorldAction::SetPin { pin: 2, signal: PinSignal::Volts { volts } };
            line.with(|bus| bus.controllers_mut()[0].apply(&action)).expect("it has that pin");
            line.pass(Duration::from_millis(10));
            let values = wire.ask(commands::READ_SIGNAL_VALUES, &[]).expect("the line is sound");
            let record = values.records().nth(2).expect("it has ten pins");
            let reading = f64::from(reading);
            assert_eq!(record.int(name::POSITION), drawn.position(reading) as i64, "{shape:?} at {reading}");
            let command = record.int(name::COMMAND) as f64;
            assert!((command - drawn.command(reading)).abs() <= 1.0, "{shape:?} at {reading}: {command}");
        }
    }
}
