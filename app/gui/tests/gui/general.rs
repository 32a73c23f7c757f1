//! The General Settings screen against a simulated controller, in virtual time, by role and label.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_gui::model::general::{Section, Sheet, sections};
use brushwork_gui::model::link::Arming;
use brushwork_gui::model::message::Gravity;
use brushwork_gui::model::screen::Screen;
use brushwork_link::settings::Group;
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::number;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

const MAX_VOLTS: &str = "Main battery maximum";

/// Connected, with the screen opened and everything read.
fn opened() -> Bench {
    opened_in(Bench::new())
}

fn opened_in(mut bench: Bench) -> Bench {
    bench.connect();
    open(&mut bench);
    bench
}

fn open(bench: &mut Bench) {
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3000);
    assert_eq!(bench.model().screen, Screen::GeneralSettings);
    assert!(bench.model().front.settings.running().is_none());
}

/// What the controller works with.
fn truth(bench: &Bench) -> Settings {
    bench.line.with(|bus| bus.controllers()[0].settings())
}

/// What it has in EEPROM.
fn stored(bench: &Bench) -> Settings {
    bench.line.with(|bus| bus.controllers()[0].stored_settings())
}

/// Types a value into a field, with the keyboard alone.
fn enter(bench: &mut Bench, title: &str, text: &str) {
    bench.harness.get_by_role_and_label(Role::TextInput, title).focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, title).type_text(text);
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.pass_ms(100);
}

/// Opens the write sheet and writes.
fn write(bench: &mut Bench) {
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(3000);
}

#[test]
fn opening_the_screen_reads_every_setting_and_changes_none() {
    let mut bench = Bench::new();
    bench.connect();
    let before = truth(&bench);
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(300);
    open(&mut bench);
    assert!(bench.sees("Edits: none"));
    assert!(bench.sees("EEPROM: not known"));
    bench.press("Section Voltage limits");
    assert!(bench.sees(&format!("{MAX_VOLTS} on the controller: 60.0 V")), "{before:?}");
    assert!(bench.sees("Main battery minimum default: 10.0 V"));
    assert_eq!(truth(&bench), before);
    assert!(bench.both_stand());
    let unit = bench.model().front.settings.unit().unwrap();
    let unread: Vec<_> =
        unit.table().rows().iter().filter(|row| unit.on_controller(&row.key).is_none()).collect();
    assert!(unread.is_empty(), "{unread:?}");
}

#[test]
fn a_limit_is_changed_written_and_read_back() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    assert!(bench.sees("Edits: 1 not written"));
    assert!(bench.sees(&format!("{MAX_VOLTS} is changed")));
    assert_ne!(truth(&bench).battery.main_max_tenths, 335, "typing alone writes nothing");
    bench.press("Write settings");
    assert!(bench.sees(&format!("{MAX_VOLTS}: 60.0 V -> 33.5 V")), "the sheet lists old and new");
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert_eq!(truth(&bench).battery.main_max_tenths, 335);
    assert!(bench.sees("Edits: none"));
    assert!(bench.sees(&format!("{MAX_VOLTS} on the controller: 33.5 V")));
    assert!(bench.sees("EEPROM: 1 written, not saved"));
    assert_ne!(stored(&bench).battery.main_max_tenths, 335, "nothing goes to EEPROM without being asked for");
}

#[test]
fn saving_puts_it_into_eeprom_and_is_read_back_from_there() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5 V");
    write(&mut bench);
    bench.press("Save to EEPROM");
    assert!(bench.sees_part("loads them back and compares"));
    assert_ne!(stored(&bench).battery.main_max_tenths, 335, "the sheet asks first");
    bench.press("Save");
    bench.pass_ms(10_000);
    assert_eq!(stored(&bench).battery.main_max_tenths, 335);
    assert!(bench.sees("EEPROM: saved"), "{:?}", bench.model().messages.shown);
    enter(&mut bench, MAX_VOLTS, "30");
    write(&mut bench);
    assert!(bench.sees("EEPROM: 1 not saved"));
}

#[test]
fn what_did_not_take_is_named_with_both_values_and_stays_an_edit() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    // Acknowledged with 0xFF and not carried out.
    bench.line.swallow(number::SET_MAIN_VOLTAGES, &[0xFF]);
    write(&mut bench);
    assert!(bench.sees_part(&format!("{MAX_VOLTS} was to be 33.5 V and is 60.0 V")));
    assert_eq!(bench.model().messages.shown.as_ref().unwrap().gravity, Gravity::Error);
    bench.press("Back");
    assert!(bench.sees("Edits: 1 not written"), "the edit is kept");
    assert!(bench.sees_part(&format!("{MAX_VOLTS}: {MAX_VOLTS} was to be 33.5 V")), "its row says why");
}

#[test]
fn an_edit_made_while_a_write_runs_stays() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    bench.press("Write settings");
    bench.button("Write to controller").click();
    bench.harness.step();
    assert!(bench.model().front.settings.running().is_some());
    let min_volts = brushwork_link::settings::SettingValue::Number(12.0);
    bench.model().front.settings.unit_mut().unwrap().set("limits.main_battery.min_volts", min_volts);
    bench.pass_ms(3000);
    assert_eq!(truth(&bench).battery.main_max_tenths, 335);
    assert_ne!(truth(&bench).battery.main_min_tenths, 120, "it was made after the list was shown");
    assert!(bench.sees("Edits: 1 not written"));
    write(&mut bench);
    assert_eq!(truth(&bench).battery.main_min_tenths, 120);
}

#[test]
fn an_edit_is_reverted_by_its_row_and_all_by_one_button() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    enter(&mut bench, "Main battery minimum", "12");
    bench.press(&format!("Revert {MAX_VOLTS}"));
    assert!(bench.sees("Edits: 1 not written"));
    bench.press("Revert all");
    assert!(bench.sees("Edits: none"));
    assert!(bench.see("Write settings").accesskit_node().is_disabled());
    enter(&mut bench, MAX_VOLTS, "60");
    assert!(bench.sees("Edits: none"), "the controller's own value is no change");
}

#[test]
fn a_value_out_of_range_is_refused_in_a_sentence_and_not_written() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "99");
    assert!(bench.sees_part(&format!("{MAX_VOLTS} 99.0 V is above the MCP266's 60.0 V")));
    assert!(bench.see("Write settings").accesskit_node().is_disabled());
    enter(&mut bench, MAX_VOLTS, "9");
    enter(&mut bench, MAX_VOLTS, "nonsense");
    assert!(bench.sees("Edits: none"));
    enter(&mut bench, MAX_VOLTS, "20");
    enter(&mut bench, "Main battery minimum", "25");
    bench.press("Write settings");
    assert!(bench.sees_part("Main battery minimum 25.0 V would be above"), "pairs are judged together");
    assert!(bench.see("Write to controller").accesskit_node().is_disabled());
}

#[test]
fn search_and_only_changed_pick_rows_from_all_sections() {
    let mut bench = opened();
    bench.harness.get_by_role_and_label(Role::TextInput, "Search settings").focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, "Search settings").type_text("battery max");
    bench.pass_ms(200);
    let shown = bench.model().front.general_view().shown();
    assert_eq!(shown, ["limits.main_battery.max_volts", "limits.logic_battery.max_volts"]);
    assert!(bench.sees_part("2 of "));
    enter(&mut bench, MAX_VOLTS, "33.5");
    bench.press("Section Unit settings");
    assert_eq!(bench.model().front.general.search, "", "choosing a section ends the search");
    assert!(!bench.sees(&format!("{MAX_VOLTS} on the controller: 60.0 V")));
    bench.press("Only changed");
    assert!(bench.sees(&format!("{MAX_VOLTS} on the controller: 60.0 V")));
    assert!(bench.sees_part("1 of "));
}

#[test]
fn each_pin_has_its_own_settings_and_those_that_do_not_apply_are_locked_with_the_reason() {
    let mut bench = opened_in(Bench::sized([1280.0, 1000.0], egui::Theme::Dark));
    bench.press("Section DIN3/AN3");
    let type_of_pin = || brushwork_link::settings::SettingValue::Choice("none");
    let unit = bench.model().front.settings.unit_mut().unwrap();
    let pin = unit.table().rows().iter().find(|row| {
        row.pattern == "pin.{n}.type" && row.instance.as_ref().is_some_and(|it| it.name == "DIN3/AN3")
    });
    let key = pin.unwrap().key.clone();
    unit.set(&key, type_of_pin());
    bench.pass_ms(200);
    assert!(bench.sees_part("deadband is locked: Not applicable: this pin measures nothing"));
    let field = bench.harness.get_by_role_and_label(Role::TextInput, "DIN3/AN3: deadband");
    assert!(field.accesskit_node().is_disabled());
}

#[test]
fn a_setting_without_a_wire_form_is_changed_on_the_simulated_controller_alone() {
    let mut bench = opened();
    assert!(!truth(&bench).unit.bridged);
    bench.press("Bridge channels");
    write(&mut bench);
    assert!(truth(&bench).unit.bridged);
    // The same unit, as if it were a real one.
    let mut identity = bench.model().front.link.units[0].clone();
    identity.simulated = false;
    identity.port = "/dev/ttyACM0".to_owned();
    bench.model().front.link.units[0] = identity;
    bench.pass_ms(3000);
    assert!(bench.sees_part("Bridge channels is locked: No packet serial command"));
}

#[test]
fn what_could_not_be_read_says_why_in_its_row() {
    let mut bench = Bench::new();
    // No answer at all to this one command.
    bench.line.swallow(number::READ_MAIN_VOLTAGES, &[]);
    bench.connect();
    open(&mut bench);
    bench.press("Section Voltage limits");
    assert!(bench.sees(&format!("{MAX_VOLTS} on the controller: –")));
    assert!(bench.sees_part(&format!("{MAX_VOLTS}: Could not read")));
    assert!(bench.sees("Logic battery maximum on the controller: 15.0 V"), "the rest is read all the same");
    assert!(bench.sees_part("this firmware does not have it"), "all else was answered");
    bench.press("Read settings");
    bench.press("Read");
    bench.pass_ms(3000);
    assert!(bench.sees_part("This firmware does not have 2 settings."));
}

#[test]
fn edits_stay_when_the_screen_is_left_and_when_the_cable_is_pulled() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    bench.press("Device Status");
    open(&mut bench);
    assert!(bench.sees("Edits: 1 not written"));
    bench.press("Disconnect");
    bench.pass_ms(500);
    bench.connect();
    bench.pass_ms(3000);
    assert!(bench.sees("Edits: 1 not written"));
    assert!(bench.sees("EEPROM: not known"));
    write(&mut bench);
    assert_eq!(truth(&bench).battery.main_max_tenths, 335);
}

#[test]
fn defaults_are_listed_before_they_are_restored() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    write(&mut bench);
    bench.press("Default settings");
    assert!(bench.sees(&format!("{MAX_VOLTS}: 33.5 V -> 60.0 V")));
    assert_eq!(truth(&bench).battery.main_max_tenths, 335);
    bench.press("Restore defaults");
    bench.pass_ms(6000);
    assert_eq!(truth(&bench).battery.main_max_tenths, 600);
    assert!(bench.sees(&format!("{MAX_VOLTS} on the controller: 60.0 V")));
}

#[test]
fn loading_from_eeprom_takes_back_what_was_not_saved() {
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    write(&mut bench);
    bench.press("Read settings");
    bench.press("Load from EEPROM");
    bench.pass_ms(6000);
    assert_eq!(truth(&bench).battery.main_max_tenths, 600);
    assert!(bench.sees("EEPROM: saved"));
}

#[test]
fn reading_can_be_cancelled_and_says_so() {
    let mut bench = opened();
    bench.press("Read settings");
    bench.button("Read").click();
    // One frame for the command to go out, one to show it: nothing is read yet.
    bench.harness.step();
    bench.harness.step();
    assert!(bench.sees_part("Progress: read the settings"));
    bench.button("Cancel").click();
    bench.harness.step();
    bench.pass_ms(1000);
    assert!(bench.sees_part("Did not read the settings: it was cancelled"));
    bench.press("Read settings");
    bench.press("Read");
    bench.pass_ms(3000);
    assert!(bench.sees("Edits: none") && bench.sees_part("settings read."));
}

/// The mark at the bottom of every screen.
fn mark(bench: &Bench) -> String {
    let marks = bench.harness.query_all_by_label_contains("Settings: ");
    marks.filter_map(|node| node.accesskit_node().label()).next().expect("it is always there")
}

#[test]
fn after_connecting_the_settings_are_known_on_every_screen_without_a_word() {
    let mut bench = Bench::new();
    let before = truth(&bench);
    bench.connect();
    bench.pass_ms(3000);
    assert_eq!(bench.model().screen, Screen::DeviceStatus);
    assert_eq!(mark(&bench), "Settings: EEPROM not known, no profile open");
    assert!(bench.sees_part("Connected to MCP266"), "what is said is of the connection");
    assert_eq!(truth(&bench), before);
    // What a screen that drives writes is known here too.
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    bench.open_tab("Velocity loop");
    bench.enter("M1 Velocity P", "2.5");
    bench.press("Apply to RAM");
    bench.pass_ms(2000);
    assert_eq!(mark(&bench), "Settings: RAM: 1 written, not saved, no profile open");
    open(&mut bench);
    bench.press("Save to EEPROM");
    bench.press("Save");
    bench.pass_ms(10_000);
    assert_eq!(mark(&bench), "Settings: RAM is saved in EEPROM, no profile open");
    bench.press("Disconnect");
    bench.pass_ms(500);
    bench.connect();
    bench.pass_ms(3000);
    assert_eq!(mark(&bench), "Settings: RAM is as saved last, no profile open");
}

#[test]
fn reading_that_nobody_asked_for_delays_nothing_and_is_begun_again() {
    let mut bench = Bench::new();
    // Without an answer to these commands reading takes its time, until it is known that the firmware lacks them.
    for command in [
        number::READ_MAIN_VOLTAGES,
        number::READ_LOGIC_VOLTAGES,
        number::READ_CURRENT_LIMITS_M1,
        number::READ_CURRENT_LIMITS_M2,
    ] {
        bench.line.swallow(command, &[]);
    }
    bench.press("Connect");
    for _ in 0..500 {
        if bench.model().front.settings.is_reading_quietly() {
            break;
        }
        bench.pass_frame(Duration::from_millis(5));
    }
    assert!(bench.model().front.settings.is_reading_quietly());
    bench.button("Zero M1 encoder").click();
    bench.pass_frame(Duration::from_millis(5));
    assert!(!bench.model().front.settings.is_reading_quietly(), "it gives way at once");
    bench.arm();
    assert!(matches!(bench.model().front.link.arming, Arming::Armed { .. }));
    assert!(!bench.model().front.settings.unit().unwrap().is_read());
    assert!(!bench.sees_part("cancelled"), "nobody called anything off");
    bench.pass_ms(2000);
    assert!(bench.model().front.settings.running().is_none(), "nothing is begun while armed");
    bench.press("Arm");
    bench.pass_ms(3000);
    assert!(bench.model().front.settings.unit().unwrap().is_read());
}

#[test]
fn the_stop_key_stops_and_closes_the_sheet_while_one_is_open() {
    let mut bench = opened();
    bench.press("Save to EEPROM");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Save));
    assert!(bench.sees("Stop All"), "no sheet covers it");
    bench.key(Key::Escape);
    assert_eq!(bench.model().front.general.sheet.as_ref(), None);
    bench.pass_ms(300);
    assert!(bench.sees_part("Stopped."));
}

#[test]
fn every_section_can_be_drawn_at_the_smallest_size_and_the_screen_looks_as_it_did() {
    let mut bench = opened_in(Bench::sized([1024.0, 700.0], egui::Theme::Light));
    let unit = bench.model().front.settings.unit().unwrap();
    let sections: Vec<_> = sections(unit.table()).into_iter().map(|(section, _)| section).collect();
    assert!(sections.len() > 20, "{sections:?}");
    for section in sections {
        bench.model().front.general.section = section;
        bench.harness.step();
        assert!(!bench.model().front.general_view().shown().is_empty(), "{section:?}");
    }
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    enter(&mut bench, "Main battery minimum", "99");
    bench.harness.set_render_cursor(false);
    // Figures of the link and of noisy signals are not what this picture is about.
    bench.model().front.link.statistics = brushwork_link::exchange::LinkStatistics::default();
    bench.model().front.link.readings = brushwork_gui::model::readings::Readings::default();
    bench.harness.step();
    bench.harness.snapshot("general");
}

#[test]
fn a_profile_is_saved_opened_compared_and_taken_over_by_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.json").display().to_string();
    let mut bench = opened();
    bench.press("Section Voltage limits");
    enter(&mut bench, MAX_VOLTS, "33.5");
    enter(&mut bench, "Main battery minimum", "12");
    write(&mut bench);
    bench.press("Save profile");
    assert!(bench.harness.get_all_by_label("Save profile").any(|node| node.accesskit_node().is_disabled()));
    bench.model().front.general.profiles.path = path.clone();
    bench.pass_ms(200);
    bench.harness.get_all_by_label("Save profile").last().unwrap().click();
    bench.pass_ms(300);
    assert!(bench.sees_part("242 settings are in"));
    bench.harness.get_all_by_label("Save profile").last().unwrap().click();
    bench.pass_ms(300);
    assert!(bench.sees_part("is there already, and is not replaced"));
    bench.press("Replace the file");
    bench.pass_ms(300);
    assert!(bench.sees_part("242 settings are in"));
    let saved = brushwork_link::settings::Profile::load(path.as_ref()).unwrap();
    let wanted = brushwork_link::settings::SettingValue::Number(33.5);
    assert_eq!(saved.settings.get("limits.main_battery.max_volts"), Some(wanted));
    bench.press("Default settings");
    bench.press("Restore defaults");
    bench.pass_ms(6000);
    bench.press("Open profile");
    bench.press("Open");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Compare));
    assert!(bench.sees(&format!("{MAX_VOLTS}: 60.0 V -> 33.5 V")));
    assert!(bench.sees("Main battery minimum: 10.0 V -> 12.0 V"));
    bench.press(&format!("Take over {MAX_VOLTS}"));
    assert!(bench.sees("taken over") && bench.sees("Edits: 1 not written"));
    assert_eq!(truth(&bench).battery.main_max_tenths, 600, "taking over writes nothing");
    bench.press("Back");
    write(&mut bench);
    assert_eq!(truth(&bench).battery.main_max_tenths, 335);
    assert_eq!(truth(&bench).battery.main_min_tenths, 100, "what was not taken over stays");
    bench.press("Compare settings");
    bench.press("Take over all");
    write(&mut bench);
    assert_eq!(truth(&bench).battery.main_min_tenths, 120);
    bench.press("Compare settings");
    assert!(bench.sees("Both sides have the same values."));
}

#[test]
fn a_faulty_profile_is_refused_and_one_of_another_controller_is_upgraded_when_that_is_agreed_to() {
    let folder = tempfile::tempdir().unwrap();
    let mut bench = opened();
    bench.press("Open profile");
    bench.model().front.general.profiles.path = folder.path().join("none.json").display().to_string();
    bench.pass_ms(200);
    bench.press("Open");
    assert!(bench.sees_part("Reading the profile"));
    let path = folder.path().join("other.json");
    let model = brushwork_mcp_wire::models::lookup("mcp236").unwrap();
    let subject = brushwork_mcp_client::subject(model, brushwork_mcp_wire::packet_serial::Generation::Gen2);
    let other = brushwork_link::settings::Profile {
        subject,
        firmware: "MCP236 2x30A v1.0.0".to_owned(),
        address: brushwork_link::UnitAddress::factory(brushwork_mcp_client::MCP),
        date: "2025-01-01T00:00:00Z".to_owned(),
        unit: String::new(),
        note: String::new(),
        settings: brushwork_link::settings::SettingsTable::new(subject).default_image(),
    };
    other.save(&path).unwrap();
    bench.model().front.general.profiles.path = path.display().to_string();
    bench.pass_ms(200);
    bench.press("Open");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Upgrade));
    assert!(bench.sees_part("The profile was made for the MCP236"));
    assert!(bench.sees_part("The settings of input DIN3/AN3/P3/ENC1A/TX2 go to DIN7/AN7/P7/ENC1A."));
    assert!(
        bench.model().front.general.profiles.opened.is_none(),
        "nothing is used before that is agreed to"
    );
    bench.press("Use with these changes");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Compare));
    assert!(bench.sees("Motor 1: maximum current: 60.00 A -> 30.00 A"));
    bench.press("Take over group Current limits");
    assert!(bench.sees("Edits: 4 not written"), "{:?}", bench.model().front.settings.unit().unwrap().edits());
    bench.press("Revert all");
    // One value that is no number: refused at first, opened without it on request.
    let mut broken = other.to_json();
    broken = broken.replacen("128", "\"9999\"", 1);
    std::fs::write(&path, broken).unwrap();
    bench.press("Open profile");
    bench.press("Open");
    assert!(bench.sees_part("Expected a whole number, got a text"));
    bench.press("Open without what is wrong");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Upgrade));
}

#[test]
fn a_unit_that_was_given_another_address_keeps_its_edits_here() {
    let mut bench = opened();
    enter(&mut bench, "Packet serial address", "130");
    bench.press("Write settings");
    assert!(bench.sees_part("answers to its new address"), "the plan's warning is shown first");
    bench.button("Write to controller").click();
    bench.harness.step();
    let mixing = brushwork_link::settings::SettingValue::Bool(true);
    bench.model().front.settings.unit_mut().unwrap().set("unit.mixing", mixing);
    bench.pass_ms(6000);
    assert_eq!(truth(&bench).unit.address, 130);
    let units: Vec<u8> = bench.model().front.link.units.iter().map(|unit| unit.address).collect();
    assert_eq!(units, [130], "it is one unit, wherever it answers");
    assert!(!bench.sees("Units on this link"));
    assert!(bench.sees("Edits: 1 not written"), "{:?}", bench.model().messages.shown);
    assert!(bench.sees("Packet serial address on the controller: 130"));
    write(&mut bench);
    assert_eq!((truth(&bench).unit.address, truth(&bench).unit.mixed), (130, 1));
}

#[test]
fn beside_the_simulated_world_in_the_smallest_window_nothing_is_cut_off() {
    let mut bench = Bench::sized([1024.0, 700.0], egui::Theme::Light);
    bench.connect();
    bench.press("General Settings");
    bench.pass_ms(4000);
    bench.press("Simulated world");
    bench.pass_ms(300);
    let edge = bench
        .see("What you could do to a real machine by hand. None of it goes over the wire.")
        .rect()
        .left();
    let help =
        bench.see("Point at a setting, or move the keyboard focus to it, to read what it does.").rect();
    assert!(help.right() <= edge, "{help:?} {edge}");
    for node in bench.harness.get_all_by_label("PWM mode") {
        assert!(node.rect().right() <= edge, "{:?} {edge}", node.rect());
    }
    // The sections unfold from a list instead.
    bench.press("Section");
    bench.press("Section Voltage limits");
    bench.pass_ms(300);
    let section = bench.model().front.general.section;
    assert_eq!(section, Section::Group(Group::VOLTAGE_LIMITS));
}
