//! The traffic panel: the log with its filter, the composer with its gates, and the bytes before they are sent.

use crate::support::bench::Bench;
use brushwork_core::keep::UnitId;
use brushwork_gui::model::traffic::Tab;
use brushwork_link::settings::SettingValue;
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::Motor;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// Connected, with the panel open.
fn open() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::T);
    bench.pass_ms(1000);
    assert!(bench.sees_part("Traffic") || bench.sees("Log"));
    bench
}

fn type_into(bench: &mut Bench, field: &str, text: &str) {
    bench.harness.get_by_role_and_label(Role::TextInput, field).focus();
    bench.pass_ms(100);
    bench.harness.get_by_role_and_label(Role::TextInput, field).type_text(text);
    bench.pass_ms(200);
}

#[test]
fn every_transaction_is_listed_in_words_and_bytes_while_the_panel_is_open() {
    let mut bench = open();
    assert!(bench.sees_part("OK: "), "rows are read out with their outcome");
    let log = &bench.model().front.traffic.log;
    assert!(log.len() > 20, "{}", log.len());
    let first = log.shown(0).expect("there are some");
    assert!(first.duration.is_some() && !first.sent.is_empty() && !first.received.is_empty());
    assert!(!first.request.is_empty() && !first.reply.is_empty());
    bench.press("Close");
    let kept = bench.model().front.traffic.log.len();
    bench.pass_ms(1000);
    assert!(bench.model().front.traffic.log.len() <= kept + 1, "a hidden panel records nothing");
}

#[test]
fn the_log_can_be_filtered_paused_cleared_and_copied() {
    let mut bench = open();
    type_into(&mut bench, "Filter traffic", "battery");
    let log = &bench.model().front.traffic.log;
    assert!(log.shown_len() > 0 && log.shown_len() < log.len() / 2);
    assert!(
        (0..log.shown_len()).all(|index| log.shown(index).is_some_and(|one| one.words().contains("battery")))
    );
    bench.press("Copy log");
    assert!(bench.sees_part("Copied"));
    bench.press("Pause log");
    let held = bench.model().front.traffic.log.len();
    bench.pass_ms(1000);
    assert_eq!(bench.model().front.traffic.log.len(), held);
    assert!(bench.sees_part("not recorded while paused"));
    bench.press("Clear log");
    assert!(bench.sees_part("Paused. Press Record again to go on."));
    bench.press("Record again");
    bench.pass_ms(500);
    assert!(!bench.model().front.traffic.log.is_empty());
}

#[test]
fn only_failures_shows_what_was_damaged_or_not_answered() {
    let mut bench = open();
    bench.harness.get_by_role_and_label(Role::CheckBox, "Only failures").click();
    bench.pass_ms(300);
    assert!(bench.sees_part("Nothing passes the filter."));
    bench.line.swallow(number::READ_STATUS, &[]);
    bench.pass_ms(600);
    assert!(bench.sees_part("no answer: "));
}

#[test]
fn the_log_is_saved_to_a_file_and_a_failure_is_a_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("traffic.txt");
    let mut bench = open();
    bench.press("Save log…");
    bench.model().front.traffic.saving = Some(folder.path().join("no/such/folder.txt").display().to_string());
    bench.press("Save traffic");
    assert!(bench.sees_part("Could not save the traffic to"));
    bench.press("Dismiss");
    bench.model().front.traffic.saving = Some(file.display().to_string());
    bench.press("Save traffic");
    let text = std::fs::read_to_string(&file).expect("it was saved");
    assert!(text.starts_with("time s\t") && text.lines().count() > 20, "{text}");
    assert!(text.contains("80 5A | ") || text.contains("80 4E | "), "{text}");
    // A path that is typed replaces nothing; one that the desktop's dialog gave was asked about there.
    std::fs::write(&file, "something else").expect("it is ours");
    bench.press("Save log…");
    bench.model().front.traffic.saving = Some(file.display().to_string());
    bench.press("Save traffic");
    assert!(bench.sees_part("Could not save the traffic to"));
    bench.model().front.traffic.asked_about = Some(file.display().to_string());
    bench.press("Save traffic");
    assert!(std::fs::read_to_string(&file).expect("it is there").starts_with("time s\t"));
}

#[test]
fn a_command_is_shown_as_bytes_then_sent_and_answered() {
    let mut bench = open();
    bench.press("Send a command");
    type_into(&mut bench, "Find a command", "read main battery");
    bench.press("24 read main battery");
    assert!(bench.sees_part("Bytes: 80 18"));
    bench.press("Send these bytes");
    bench.pass_ms(300);
    assert!(bench.sees_part("Answer: ") && bench.sees_part("24.0 V"));
}

#[test]
fn a_command_that_changes_settings_is_sent_once_a_backup_of_them_is_kept() {
    let mut bench = open();
    bench.press("Send a command");
    let generation = brushwork_mcp_wire::packet_serial::Generation::Gen1;
    let unit = UnitId::new(bench.model().front.link.identity().unwrap(), &[]);
    let composer = &mut bench.model().front.mcp_mut().composer;
    composer.choose(number::SET_VELOCITY_PID_M1, generation);
    // D, P, I and QPPS (MCP manual 2.4.1).
    composer.arguments = ["0", "131072", "0", "9000"].map(str::to_owned).to_vec();
    bench.pass_ms(200);
    bench.press("Send these bytes");
    bench.pass_ms(2000);
    assert!(bench.sees_part("Answer: "));
    let held = bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion.qpps);
    assert_eq!(held, 9000);
    let backups = bench.store().backups(Some(&unit));
    assert_eq!(backups.len(), 1);
    let kept = backups[0].open().unwrap().profile.settings;
    assert_eq!(kept.get("motor1.velocity.qpps"), Some(SettingValue::Int(44_000)), "what was there before");
    // A save counts as one.
    assert_eq!(bench.store().wear(&unit).unwrap().saves, 0);
    bench.model().front.mcp_mut().composer.choose(number::SAVE_SETTINGS, generation);
    bench.pass_ms(200);
    bench.press("Send these bytes");
    bench.pass_ms(3000);
    assert_eq!((bench.store().backups(Some(&unit)).len(), bench.store().wear(&unit).unwrap().saves), (2, 1));
    assert!(bench.store().open_journals(&unit).0.is_empty());
    // What only reads has none.
    bench.model().front.mcp_mut().composer.choose(number::READ_MAIN_BATTERY, generation);
    bench.pass_ms(200);
    bench.press("Send these bytes");
    bench.pass_ms(1000);
    assert_eq!(bench.store().backups(Some(&unit)).len(), 2);
}

#[test]
fn a_motion_command_is_refused_until_a_screen_is_armed_and_space_stops_it() {
    let mut bench = open();
    bench.press("Send a command");
    let generation = brushwork_mcp_wire::packet_serial::Generation::Gen1;
    let composer = &mut bench.model().front.mcp_mut().composer;
    composer.choose(number::DUTY_M1, generation);
    composer.arguments = vec!["8000".to_owned()];
    bench.pass_ms(200);
    // 0x80, command 32, duty 8000 = 0x1F40, CRC.
    assert!(bench.sees_part("Bytes: 80 20 1F 40"));
    assert!(bench.sees_part("Not sent: "));
    assert!(bench.see("Send these bytes").accesskit_node().is_disabled());
    bench.arm();
    assert!(!bench.see("Send these bytes").accesskit_node().is_disabled());
    bench.press("Send these bytes");
    bench.pass_ms(800);
    assert!((bench.real_duty(Motor::M1) - 8000.0 / 32_767.0).abs() < 0.01, "{}", bench.real_duty(Motor::M1));
    bench.key(Key::Space);
    bench.pass_ms(300);
    assert!(bench.both_stand());
    assert!(bench.see("Send these bytes").accesskit_node().is_disabled(), "Stop disarms");
}

#[test]
fn the_bytes_of_edited_settings_and_of_the_sliders_are_shown_before_they_are_sent() {
    let mut bench = open();
    bench.model().front.traffic.tab = Tab::Pending;
    bench.pass_ms(200);
    assert!(bench.sees_part("Nothing waits to be sent"));
    bench.press("PWM Settings");
    bench.model().front.pwm.setpoints.show(Motor::M1, 50.0);
    bench.pass_ms(200);
    assert!(bench.sees_part("Drive: what the sliders stand for: 0x80"));
    bench.press("General Settings");
    bench.pass_ms(1500);
    let unit = bench.model().front.settings.unit_mut().expect("it is connected");
    unit.set("motor1.velocity.qpps", SettingValue::Int(12_345));
    bench.pass_ms(300);
    assert!(bench.sees_part("Write: ") && bench.sees_part("12345"));
    bench.press("Write settings");
    bench.press("Show the bytes");
    bench.pass_ms(300);
    assert!(bench.harness.query_all_by_label_contains("80 1C ").next().is_some(), "command 28 in bytes");
    let sent = |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion.qpps);
    assert_eq!(sent(&bench), 44_000, "showing sends nothing");
}
