//! The settings of a unit: read, written, stored, loaded and brought back.

use super::bench::{Link, Unit};
use crate::messages::SuprMotrActMessage;
use brushwork_link::device::JobContext;
use brushwork_link::settings::{SaveVerdict, plan, read_all, reload, save_eeprom, write};
use brushwork_link::{Failure, Job, SettingValue, SettingsImage, SettingsTable, WriteOptions};
use brushwork_suprmotr_wire::{Line, Mnemonic, Radix, parse_line};
use std::time::Duration;

/// Does something with the wire of a job.
fn on_wire<T: Send + 'static>(
    link: &mut Link,
    mut work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
) -> Result<T, String> {
    let did = move |context: &mut JobContext<'_>| Ok(work(context).map_err(|failure| failure.to_string()));
    let job = Job::new(SuprMotrActMessage::Save, Duration::from_secs(60), did);
    let ticket = link.handle.start(job).unwrap();
    link.run_for(Duration::from_secs(20));
    ticket.take().expect("the job has ended")
}

fn read(link: &mut Link) -> SettingsImage {
    on_wire(link, |wire| read_all(wire, crate::subject()).map(|report| report.image)).unwrap()
}

fn line(text: &str) -> Line {
    parse_line(text.as_bytes(), Radix::Decimal).line
}

#[test]
fn settings_are_read_as_the_numbers_that_they_are() {
    let mut link = Link::to(Unit::new(0));
    let image = read(&mut link);
    let numbers = [
        ("loop.p", 75),
        ("loop.i", 0),
        ("loop.d", 0),
        ("loop.integral_limit", 100),
        ("motion.velocity", 20_000),
        ("motion.acceleration", 200_000),
        ("unit.address", 0),
    ];
    for (key, raw) in numbers {
        assert_eq!(image.get(key), Some(SettingValue::Int(raw)), "{key}");
    }
    for (key, is_on) in [("limits.enabled", true), ("limits.active_high", false), ("line.echo", true)] {
        assert_eq!(image.get(key), Some(SettingValue::Bool(is_on)), "{key}");
    }
    assert_eq!(image.get("limits.following_error"), None, "no command tells it");
}

#[test]
fn a_write_goes_out_as_one_command_each_and_is_read_back() {
    let mut link = Link::to(Unit::new(0));
    let ram = read(&mut link);
    link.forget();
    let changes: SettingsImage = [
        ("loop.p".to_owned(), SettingValue::Int(90)),
        ("limits.following_error".to_owned(), SettingValue::Int(2000)),
        ("limits.enabled".to_owned(), SettingValue::Bool(false)),
        ("line.echo".to_owned(), SettingValue::Bool(false)),
    ]
    .into_iter()
    .collect();
    let table = SettingsTable::new(crate::subject());
    let wanted = changes.clone();
    let report = on_wire(&mut link, move |wire| {
        let table = SettingsTable::new(crate::subject());
        Ok(write(wire, &table, &wanted, WriteOptions::default()).map_err(|error| error.to_string()))
    });
    let report = report.unwrap().unwrap();
    assert!(report.is_complete(), "{:?}", report.sentences(&table));
    let written: Vec<_> = link.lines().into_iter().filter(|line| !["GP"].contains(&line.as_str())).collect();
    assert_eq!(written, ["SM2000", "LF", "DP90", "EF"], "limits first, the line last");
    assert_eq!(link.bus().units[0].parameters[&Mnemonic::DP], 90);
    assert_eq!(
        read(&mut link).get("limits.following_error"),
        Some(SettingValue::Int(2000)),
        "as it was set here"
    );

    let steps = plan(&table, &ram, &changes, WriteOptions::default()).unwrap();
    let told: Vec<_> = steps.warnings.iter().map(ToString::to_string).collect();
    assert!(told.iter().any(|warning| warning.contains("No command tells this limit")), "{told:?}");
    assert!(told.iter().any(|warning| warning.contains("nothing ends a move but its target")), "{told:?}");
    let address = crate::unit_address(11).unwrap();
    let step = steps.steps.iter().find(|step| step.keys == ["loop.p"]).unwrap();
    let generation = crate::subject().generation;
    assert_eq!(step.bytes(address, generation).unwrap(), b"\x01BDP90\r");
    assert_eq!(
        (step.words(address, generation), step.title()),
        ("unit B: Define P-Term 90".to_owned(), "write DP".to_owned())
    );
}

#[test]
fn a_value_beyond_its_range_is_refused_before_anything_is_sent() {
    let table = SettingsTable::new(crate::subject());
    let changes: SettingsImage = [("loop.p".to_owned(), SettingValue::Int(256))].into_iter().collect();
    let refused = plan(&table, &table.default_image(), &changes, WriteOptions::default()).unwrap_err();
    assert!(refused[0].sentence.to_string().contains("255"), "{}", refused[0].sentence);
}

#[test]
fn a_unit_is_followed_to_its_new_address() {
    let mut link = Link::to(Unit::new(0));
    let changes: SettingsImage = [("unit.address".to_owned(), SettingValue::Int(11))].into_iter().collect();
    let report = on_wire(&mut link, move |wire| {
        let table = SettingsTable::new(crate::subject());
        Ok(write(wire, &table, &changes, WriteOptions::default()).map_err(|error| error.to_string()))
    });
    assert!(report.unwrap().unwrap().is_complete());
    assert!(link.bus().written.ends_with(b"\x01BTB\r"), "{:?}", String::from_utf8_lossy(&link.bus().written));
}

#[test]
fn a_save_is_update_and_a_restart_is_refused_where_a_macro_would_run() {
    let mut link = Link::to(Unit::new(0));
    let table = || SettingsTable::new(crate::subject());
    let saved = on_wire(&mut link, move |wire| save_eeprom(wire, &table(), WriteOptions::default())).unwrap();
    assert_eq!(saved.verdict, SaveVerdict::Stored);
    assert!(link.lines().contains(&"UD".to_owned()));

    link.bus().units[0].macros.push(line("MD0,MR500"));
    let refused = on_wire(&mut link, move |wire| reload(wire, &table())).unwrap_err();
    assert!(refused.contains("macro 0 is defined, and a restart (RT) would run it"), "{refused}");
    assert_eq!(link.bus().units[0].restarts, 0);

    link.bus().units[0].macros.clear();
    let loaded = on_wire(&mut link, move |wire| reload(wire, &table())).unwrap();
    assert!(loaded.is_whole() && link.bus().units[0].restarts == 1);
}

#[test]
fn the_factory_values_are_those_of_the_manual() {
    let mut link = Link::to(Unit::new(0));
    link.bus().units[0].parameters.insert(Mnemonic::DP, 200);
    link.bus().units[0].limits = 0;
    link.forget();
    let done = on_wire(&mut link, |wire| {
        crate::SUPRMOTR.settings().restore(wire)?;
        Ok(())
    });
    done.unwrap();
    let mut written = link.lines();
    written.sort();
    let mut factory = vec!["DA200000", "DD0", "DI0", "DL100", "DP75", "DV20000", "EN", "LL", "LN", "SM10000"];
    factory.sort_unstable();
    assert_eq!(written, factory);
}
