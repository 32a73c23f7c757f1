//! Saving, loading and restoring against a fake controller, and what may go wrong with each.

use std::time::Duration;

use brushwork_link::unit::UnitAddress;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};

use crate::tests::settings::fake::{FakeUnit, Mishap};
use crate::tests::settings::table;
use brushwork_link::settings::{
    SaveReport, SaveVerdict, SettingsTable, WriteOptions, reload, restore_defaults, save_eeprom,
};
use brushwork_link::wire::Wire;

const OPTIONS: WriteOptions = WriteOptions { own_stream: None, simulated: true, as_read: false };

fn changed_unit(table: &SettingsTable) -> FakeUnit {
    let mut unit = FakeUnit::new(table);
    unit.set("motor1.velocity.p", "2");
    unit
}

fn saved(unit: &mut FakeUnit, table: &SettingsTable) -> SaveReport {
    save_eeprom(unit, table, OPTIONS).unwrap_or_else(|failure| panic!("{failure}"))
}

/// The number in the log of the first command after `count` commands of a full reading.
fn turn_of_save(table: &SettingsTable) -> usize {
    let mut unit = FakeUnit::new(table);
    saved(&mut unit, table);
    unit.log.iter().position(|(command, _)| *command == number::SAVE_SETTINGS).expect("it was sent")
}

#[test]
fn a_save_is_proven_by_loading_it_back() {
    for generation in Generation::ALL {
        let table = table("mcp266", generation);
        let mut unit = changed_unit(&table);
        let report = saved(&mut unit, &table);
        assert_eq!(report.verdict, SaveVerdict::Verified);
        assert_eq!(report.sentence(), "The settings are saved; they were read back from EEPROM.");
        assert_eq!(unit.eeprom["motor1.velocity.p"], 0x20000);
        assert!(report.eeprom.is_some_and(|eeprom| eeprom.get("motor1.velocity.p").is_some()));
    }
}

#[test]
fn a_unit_that_restarts_is_waited_for() {
    let table = table("mcp266", Generation::Gen4);
    let mut unit = changed_unit(&table);
    unit.restart_time = Some(Duration::from_secs(3));
    assert_eq!(saved(&mut unit, &table).verdict, SaveVerdict::Verified);
}

#[test]
fn a_reload_that_times_out_is_no_failed_save() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = changed_unit(&table);
    unit.silent.insert(number::RELOAD_SETTINGS);
    let report = saved(&mut unit, &table);
    assert_eq!(report.verdict, SaveVerdict::Acknowledged);
    assert!(report.sentence().to_string().contains("that happens after good saves too"));
    assert_eq!(report.eeprom, None, "what was not read back is not known");
    assert_eq!(unit.count(number::RELOAD_SETTINGS), 3);
}

#[test]
fn a_save_that_does_nothing_is_found_out_and_ram_is_put_back() {
    for restart in [None, Some(Duration::from_secs(1))] {
        let table = table("mcp266", Generation::Gen1);
        let mut unit = changed_unit(&table);
        unit.ignores_save = true;
        unit.restart_time = restart;
        let report = saved(&mut unit, &table);
        assert_eq!(report.verdict, SaveVerdict::NotSaved);
        assert_eq!(report.differences.len(), 1);
        assert_eq!(
            report.sentence(),
            "The save did not take: 1 setting came back from EEPROM otherwise. The controller works on \
             with the settings that were to be saved."
        );
        assert_eq!(unit.ram["motor1.velocity.p"], 0x20000, "RAM is as it was");
        assert_eq!(unit.eeprom["motor1.velocity.p"], 0x10000);
    }
}

#[test]
fn without_an_acknowledgement_nothing_is_claimed_and_nothing_is_loaded() {
    let table = table("mcp266", Generation::Gen1);
    for mishap in [Mishap::Silence, Mishap::DoneUnanswered, Mishap::LinkLost, Mishap::Stopped] {
        let mut unit = changed_unit(&table);
        unit.mishaps.insert(turn_of_save(&table), mishap);
        let report = saved(&mut unit, &table);
        assert_eq!(report.verdict, SaveVerdict::Unknown, "{mishap:?}");
        assert!(
            report
                .sentence()
                .to_string()
                .starts_with("It is not known whether the settings are saved. Could not save")
        );
        // Loading EEPROM now could throw away what was to be saved.
        assert_eq!(unit.count(number::RELOAD_SETTINGS), 0);
        assert_eq!(unit.ram["motor1.velocity.p"], 0x20000);
    }
}

#[test]
fn a_unit_that_does_not_come_back_is_told() {
    let table = table("mcp266", Generation::Gen4);
    let mut unit = changed_unit(&table);
    unit.restart_time = Some(Duration::from_secs(3600));
    let report = saved(&mut unit, &table);
    assert_eq!(report.verdict, SaveVerdict::Unknown);
    assert!(report.sentence().to_string().contains("no answer for 6 s afterwards"), "{}", report.sentence());
}

#[test]
fn a_reload_throws_away_what_was_not_saved() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = changed_unit(&table);
    let report = reload(&mut unit, &table).expect("it answers");
    assert_eq!(report.image, table.default_image());
    unit.silent.insert(number::RELOAD_SETTINGS);
    let failure = reload(&mut unit, &table).expect_err("95 is silent");
    assert_eq!(
        failure.to_string(),
        "Could not load the settings from EEPROM (95) on 0x80 at the test: no acknowledgement in 3 tries. \
         Read the settings to see what the controller works with."
    );
}

#[test]
fn defaults_are_restored_and_the_unit_is_followed_to_its_factory_address() {
    for generation in Generation::ALL {
        let table = table("mcp266", generation);
        let mut unit = changed_unit(&table);
        unit.set("unit.address", "0x84");
        let moved = UnitAddress::new(crate::MCP, 0x84).expect("an address");
        unit.unit_address = moved;
        assert!(unit.set_address(moved));
        let report =
            restore_defaults(&mut unit, *table.subject()).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(report.differences, []);
        assert_eq!(report.address, crate::unit_address(Address::DEFAULT));
    }
}

#[test]
fn defaults_that_differ_from_the_table_are_told() {
    let table = table("mcp266", Generation::Gen1);
    let mut unit = changed_unit(&table);
    unit.mishaps.insert(0, Mishap::Silence);
    let report = restore_defaults(&mut unit, *table.subject()).expect("the unit is there");
    let reported: Vec<String> = report
        .differences
        .iter()
        .map(|difference| difference.describe(table.row(&difference.key).expect("a row")))
        .collect();
    assert_eq!(reported, ["Motor 1: velocity P: 1.000 -> 2.000"]);
}
