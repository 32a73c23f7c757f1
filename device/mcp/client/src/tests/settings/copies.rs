//! The copies of one controller's settings: what is known of each, and what differs.

use brushwork_mcp_wire::packet_serial::Generation;

use crate::tests::settings::table;
use brushwork_link::settings::{Copies, Copy, SettingValue};

#[test]
fn nothing_is_claimed_of_a_copy_that_was_not_read() {
    let table = table("mcp266", Generation::Gen1);
    let mut copies = Copies::default();
    assert_eq!(copies.diff(&table, Copy::Ram, Copy::Eeprom), None);
    copies.note_ram(table.default_image());
    assert_eq!(copies.diff(&table, Copy::Ram, Copy::Eeprom), None);
    assert_eq!(copies.diff(&table, Copy::Ram, Copy::Default), Some(Vec::new()));
}

#[test]
fn what_differs_between_two_copies_is_told_in_screen_order() {
    let table = table("mcp266", Generation::Gen1);
    let mut copies = Copies::default();
    copies.note_reloaded(table.default_image());
    let mut ram = table.default_image();
    ram.set("pin.10.deadband", SettingValue::Int(5));
    ram.set("pin.2.deadband", SettingValue::Int(5));
    ram.set("unit.mixing", SettingValue::Bool(true));
    copies.note_ram(ram.clone());
    let differences = copies.diff(&table, Copy::Eeprom, Copy::Ram).expect("both are known");
    let reported: Vec<String> = differences
        .iter()
        .map(|difference| difference.describe(table.row(&difference.key).expect("a row")))
        .collect();
    assert_eq!(
        reported,
        [
            "Control mixing: no -> yes",
            "DIN2/AN2/P2/RX3: deadband: 0 -> 5",
            "DIN10/AN10/P10/ENC2B: deadband: 0 -> 5",
        ]
    );
    copies.note_profile(Some(ram));
    assert_eq!(copies.diff(&table, Copy::Ram, Copy::Profile), Some(Vec::new()));
    copies.forget_eeprom();
    assert_eq!(copies.get(Copy::Eeprom, &table), None);
}
