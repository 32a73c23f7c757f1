//! Settings that cannot be lost, in the window: backups, comparisons, copies, and what was cut short, by role and label.

use crate::support::bench::Bench;
use brushwork_core::keep::UnitId;
use brushwork_gui::model::general::{Sheet, Side};
use brushwork_gui::model::loop_settings;
use brushwork_gui::model::loop_settings::key;
use brushwork_gui::model::screen::Screen;
use brushwork_link::settings::{Act, SettingValue};
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::number;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// Connected, with the screen opened and everything read.
fn opened() -> Bench {
    let mut bench = Bench::new();
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

fn unit(bench: &mut Bench) -> UnitId {
    UnitId::new(bench.model().front.link.identity().expect("it is connected"), &[])
}

fn want(bench: &mut Bench, changes: &[(&str, SettingValue)]) {
    for (key, value) in changes {
        bench.model().front.settings.unit_mut().expect("it is looked at").set(key, *value);
    }
    bench.pass_ms(200);
}

fn write(bench: &mut Bench) {
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(3000);
}

fn edits(bench: &mut Bench) -> usize {
    bench.model().front.settings.unit().expect("it is looked at").edits().len()
}

const P: &str = "motor1.velocity.p";
const TITLE: &str = "Motor 1: velocity P";

fn number(value: f64) -> SettingValue {
    SettingValue::Number(value)
}

#[test]
fn without_a_backup_the_list_says_when_there_will_be_one() {
    let mut bench = opened();
    bench.press("Backups");
    assert!(bench.sees_part("There is no backup of this controller yet"));
}

#[test]
fn the_list_of_backups_compares_and_restores() {
    let mut bench = opened();
    want(&mut bench, &[(P, number(2.5))]);
    write(&mut bench);
    let unit = unit(&mut bench);
    let backups = bench.store().backups(Some(&unit));
    assert_eq!(backups.len(), 1);
    assert!(backups[0].name.ends_with(&format!("before-{}", Act::Write.label())));
    assert_eq!(backups[0].open().unwrap().profile.settings.get(P), Some(number(1.0)));
    let title = backups[0].title();
    bench.press("Backups");
    bench.press(&format!("Compare backup {title}"));
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Compare));
    assert!(bench.sees(&format!("{TITLE}: 2.500 -> 1.000")));
    bench.press("Backups");
    bench.press(&format!("Restore backup {title}"));
    assert_eq!(
        bench.model().front.general.sheet.as_ref(),
        Some(&Sheet::Write),
        "what it changes is shown first"
    );
    assert!(bench.sees(&format!("{TITLE}: 2.500 -> 1.000")));
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert_eq!(bench.model().front.settings.unit().unwrap().on_controller(P), Some(number(1.0)));
    assert_eq!(bench.store().backups(Some(&unit)).len(), 2, "restoring is a write and leaves a backup too");
}

#[test]
fn what_a_unit_had_out_of_range_is_restored_with_a_warning_and_typed_it_is_refused() {
    const MIN: &str = "limits.main_battery.min_volts";
    let mut config = ControllerConfig::default();
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.battery.main_min_tenths = 84;
    config.settings = Some(settings);
    let mut bench = Bench::of(Controller::new(config).expect("the preset is valid"));
    bench.connect();
    open(&mut bench);
    want(&mut bench, &[(MIN, number(12.0))]);
    write(&mut bench);
    let unit = unit(&mut bench);
    let title = bench.store().backups(Some(&unit))[0].title();
    bench.press("Backups");
    bench.press(&format!("Restore backup {title}"));
    assert!(
        bench.sees_part(
            "Main battery minimum 8.4 V is below the MCP266's 10.0 V. It is written as it was read."
        )
    );
    // Chosen beside what is taken over, a value has to be right.
    want(&mut bench, &[(MIN, number(8.2))]);
    let refused = bench.model().front.settings.unit().unwrap().plan(None).unwrap_err();
    assert!(refused[0].sentence.to_string().contains("8.2 V is below the MCP266's 10.0 V."), "{refused:?}");
    write(&mut bench);
    let controller = |bench: &mut Bench| bench.model().front.settings.unit().unwrap().on_controller(MIN);
    assert_eq!(controller(&mut bench), Some(number(12.0)));

    bench.press("Backups");
    bench.press(&format!("Restore backup {title}"));
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert_eq!(controller(&mut bench), Some(number(8.4)));
}

#[test]
fn every_write_from_every_screen_that_drives_has_a_backup_of_what_was_there() {
    let mut bench = Bench::new();
    bench.connect();
    let unit = unit(&mut bench);
    let mut writes = 0;
    for ((screen, tab), field, (motor, column), values) in [
        (("PWM Settings", "L, R and QPPS"), "M1 L", (Motor::M1, "inductance_henries"), ["0.01", "0.02", "0"]),
        (
            ("Velocity Settings", "Velocity loop"),
            "M1 Velocity P",
            (Motor::M1, "velocity.p"),
            ["2", "3", "2.5"],
        ),
        (
            ("Velocity Settings", "Velocity loop"),
            "M2 QPPS",
            (Motor::M2, "velocity.qpps"),
            ["9000", "9500", "9000"],
        ),
        (("Position Settings", "Position loop"), "M2 Position P", (Motor::M2, "position.p"), ["7", "8", "9"]),
    ] {
        bench.press(screen);
        bench.pass_ms(1000);
        bench.open_tab(tab);
        for value in values {
            let before = bench
                .model()
                .front
                .settings
                .unit()
                .and_then(|unit| unit.held(motor, column))
                .expect("it was read");
            bench.enter(field, value);
            bench.press("Apply to RAM");
            bench.pass_ms(3000);
            writes += 1;
            assert!(bench.sees("As the controller holds them."), "{field} {value}");
            let backups = bench.store().backups(Some(&unit));
            assert_eq!(backups.len(), writes, "{field} {value}");
            let kept = backups[0].open().unwrap().profile.settings;
            let held = kept.get(&key(motor, column)).and_then(loop_settings::number);
            assert_eq!(held, Some(before), "before {field} {value}");
            assert_eq!(kept.len(), 242, "everything is in it");
            assert!(bench.store().open_journals(&unit).0.is_empty(), "it ended and was told");
        }
    }
}

#[test]
fn a_backup_tells_the_truth_after_the_controller_restarted_in_between() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    for value in ["2", "3"] {
        bench.enter("M1 Velocity P", value);
        bench.enter("M2 Velocity P", value);
        bench.press("Apply to RAM");
        bench.pass_ms(3000);
    }
    bench.act(&WorldAction::Power { on: false });
    bench.act(&WorldAction::Power { on: true });
    bench.pass_ms(1000);
    bench.enter("M1 Velocity P", "4");
    bench.press("Apply to RAM");
    bench.pass_ms(3000);
    let unit = unit(&mut bench);
    let kept = bench.store().backups(Some(&unit))[0].open().unwrap().profile.settings;
    assert_eq!((kept.get(P), kept.get("motor2.velocity.p")), (Some(number(1.0)), Some(number(1.0))));
}

#[test]
fn a_small_write_that_is_cut_is_told_at_the_next_connection() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    bench.enter("M1 Velocity P", "2");
    bench.enter("M2 Velocity P", "2");
    bench.press("Apply to RAM");
    bench.pass_ms(3000);
    bench.enter("M1 Velocity P", "3");
    bench.enter("M2 Velocity P", "3");
    bench.line.after(number::SET_VELOCITY_PID_M1, 1, WorldAction::Unplug { unplugged: true });
    bench.press("Apply to RAM");
    bench.pass_ms(3000);
    assert!(!bench.model().is_connected());
    put_back(&mut bench);
    open(&mut bench);
    assert!(bench.sees_part("The controller holds a mix: 1 new, 1 old."));
}

#[test]
fn any_two_copies_are_chosen_and_set_side_by_side() {
    let mut bench = opened();
    want(&mut bench, &[(P, number(2.5)), ("unit.mixing", SettingValue::Bool(true))]);
    write(&mut bench);
    bench.press("Compare settings");
    assert!(bench.sees_part("2 settings differ."), "controller and defaults at first");
    assert!(bench.sees(&format!("{TITLE}: 2.500 -> 1.000")));
    // By keyboard and mouse: the left side becomes EEPROM, which is not known.
    bench.harness.get_by_role_and_label(Role::ComboBox, "Left side").click();
    bench.pass_ms(300);
    bench.press("EEPROM (not known)");
    assert!(bench.sees_part("What the EEPROM holds is not known"));
    assert!(bench.see("Take over all").accesskit_node().is_disabled());
    bench.press("Save to EEPROM");
    bench.press("Save");
    bench.pass_ms(10_000);
    bench.press("Compare settings");
    assert!(bench.sees_part("2 settings differ."));
    bench.press("Swap sides");
    assert!(bench.sees(&format!("{TITLE}: 1.000 -> 2.500")));
    assert_eq!(bench.model().front.general.comparing.left, Side::Default);
    bench.harness.get_by_role_and_label(Role::ComboBox, "Left side").click();
    bench.pass_ms(300);
    bench.press("Controller (RAM)");
    assert!(bench.sees("Both sides have the same values."));
}

#[test]
fn rows_and_groups_are_taken_over_one_by_one() {
    let mut bench = opened();
    want(
        &mut bench,
        &[(P, number(2.5)), ("motor2.velocity.i", number(7.0)), ("unit.mixing", SettingValue::Bool(true))],
    );
    write(&mut bench);
    bench.press("Compare settings");
    bench.press("Take over Control mixing");
    assert!(bench.sees("taken over"));
    assert_eq!(edits(&mut bench), 1);
    bench.press("Take over group Velocity");
    assert_eq!(edits(&mut bench), 3);
    bench.press("Back");
    write(&mut bench);
    bench.press("Compare settings");
    assert!(bench.sees("Both sides have the same values."));
}

#[test]
fn a_motor_is_copied_to_the_other_one_with_what_stays_named() {
    let mut bench = opened();
    want(&mut bench, &[(P, number(2.5)), ("motor2.position.d", number(3.0))]);
    write(&mut bench);
    bench.press("Copy motor");
    assert!(bench.sees("Motor 2: velocity P: 1.000 -> 2.500"));
    assert!(bench.sees_part("each motor has an input of its own"));
    bench.press("Motor 2 to motor 1");
    assert!(bench.sees(&format!("{TITLE}: 2.500 -> 1.000")));
    bench.press("Motor 1 to motor 2");
    bench.press("Copy");
    assert_eq!(edits(&mut bench), 2);
    write(&mut bench);
    let unit = bench.model().front.settings.unit().unwrap();
    assert_eq!(unit.on_controller("motor2.velocity.p"), Some(number(2.5)));
    assert_eq!(unit.on_controller("motor2.position.d"), unit.on_controller("motor1.position.d"));
}

/// Eight settings on four commands; something happens after the second.
fn cut_write(bench: &mut Bench, action: WorldAction) {
    let mut changes = Vec::new();
    for motor in 1..=2 {
        for key in ["velocity.p", "velocity.i", "position.p", "position.i"] {
            changes.push((format!("motor{motor}.{key}"), number(7.0)));
        }
    }
    let changes: Vec<_> = changes.iter().map(|(key, value)| (key.as_str(), *value)).collect();
    want(bench, &changes);
    bench.line.after(number::SET_VELOCITY_PID_M2, 1, action);
    bench.press("Write settings");
    bench.press("Write to controller");
    bench.pass_ms(20_000);
}

fn put_back(bench: &mut Bench) {
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.act(&WorldAction::Power { on: true });
    bench.pass_ms(2000);
    if bench.model().is_connected() {
        bench.press("Disconnect");
        bench.pass_ms(3000);
    }
    bench.connect();
    bench.pass_ms(3000);
}

#[test]
fn after_a_pulled_plug_the_next_connection_tells_old_from_new_and_finishes_it() {
    let mut bench = opened();
    cut_write(&mut bench, WorldAction::Unplug { unplugged: true });
    assert!(!bench.model().is_connected());
    put_back(&mut bench);
    assert!(bench.sees_part("A write of settings begun"), "told at once, on whatever screen");
    open(&mut bench);
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Unfinished));
    assert!(bench.sees_part("The controller holds a mix: 4 new, 4 old."));
    assert!(bench.sees(&format!("{TITLE} holds the new value 7.000; it was 1.000 before.")));
    assert!(bench.sees("Motor 1: position P holds the old value 0.000; it was to become 7.000."));
    bench.press("Finish with the new values");
    assert_eq!(bench.model().front.general.sheet.as_ref(), Some(&Sheet::Write));
    bench.press("Write to controller");
    bench.pass_ms(3000);
    assert_eq!(edits(&mut bench), 0);
    let unit_id = unit(&mut bench);
    assert_eq!(bench.store().open_journals(&unit_id).0.len(), 0);
    assert!(!bench.sees("Unfinished"), "it is settled");
}

#[test]
fn after_a_pulled_plug_the_old_values_come_back_or_all_stays_as_it_is() {
    for leave in [false, true] {
        let mut bench = opened();
        cut_write(&mut bench, WorldAction::Unplug { unplugged: true });
        put_back(&mut bench);
        // Edits made meanwhile stay, so they are put away first.
        open(&mut bench);
        bench.press("Revert all");
        bench.press("Unfinished");
        if leave {
            bench.press("Leave as it is");
        } else {
            bench.press("Go back to the old values");
            assert!(bench.sees(&format!("{TITLE}: 7.000 -> 1.000")));
            bench.press("Write to controller");
            bench.pass_ms(3000);
        }
        let on_controller = bench.model().front.settings.unit().unwrap().on_controller(P);
        assert_eq!(on_controller, Some(number(if leave { 7.0 } else { 1.0 })));
        let unit_id = unit(&mut bench);
        assert_eq!(bench.store().open_journals(&unit_id).0.len(), 0);
    }
}

#[test]
fn after_a_power_loss_in_a_write_every_setting_is_told_to_be_old() {
    let mut bench = opened();
    cut_write(&mut bench, WorldAction::Power { on: false });
    put_back(&mut bench);
    open(&mut bench);
    assert!(bench.sees_part("All 8 settings hold the old value."), "{:?}", bench.model().messages.shown);
    assert!(
        bench.see("Go back to the old values").accesskit_node().is_disabled(),
        "there is nothing to undo"
    );
}

#[test]
fn nothing_is_told_after_a_write_that_ended() {
    let mut bench = opened();
    want(&mut bench, &[(P, number(2.5))]);
    write(&mut bench);
    bench.press("Disconnect");
    bench.pass_ms(3000);
    bench.connect();
    open(&mut bench);
    assert!(!bench.sees_part("cut short") && !bench.sees("Unfinished"));
}

#[test]
fn saves_are_counted_and_a_worn_eeprom_is_told_before_the_save() {
    let mut bench = opened();
    bench.press("Save to EEPROM");
    assert!(bench.sees_part("No save to this EEPROM was counted yet."));
    bench.press("Save");
    bench.pass_ms(10_000);
    let unit = unit(&mut bench);
    assert_eq!(bench.store().wear(&unit).unwrap().saves, 1);
    bench.store().count_saves(&unit, 9_999, "2026-01-05").unwrap();
    bench.press("Save to EEPROM");
    assert!(bench.sees_part("may be worn out"));
    assert!(bench.sees_part("the port tells no serial number"));
}

#[test]
fn edits_made_while_a_write_runs_stay() {
    let mut bench = opened();
    want(&mut bench, &[(P, number(2.5))]);
    bench.press("Write settings");
    bench.button("Write to controller").click();
    bench.harness.step();
    bench.model().front.settings.unit_mut().unwrap().set("unit.mixing", SettingValue::Bool(true));
    bench.pass_ms(5000);
    assert_eq!(edits(&mut bench), 1);
    assert!(bench.sees("Edits: 1 not written"));
}

#[test]
fn notes_on_a_unit_are_kept_beside_its_backups_and_are_there_again() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    bench.press("General Settings");
    bench.pass_ms(1000);
    bench.press("Backups");
    bench.harness.get_by_label("Notes on this unit").focus();
    bench.pass_ms(200);
    bench.harness.get_by_label("Notes on this unit").type_text("Left arm, gearbox replaced in May");
    bench.pass_ms(300);
    bench.press("Disconnect");
    bench.pass_ms(1000);
    bench.connect();
    bench.pass_ms(3000);
    assert_eq!(bench.model().front.settings.notes_mut(), "Left arm, gearbox replaced in May");
}

#[test]
fn a_value_and_a_row_are_copied_from_the_explanation() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    bench.press("General Settings");
    bench.pass_ms(1000);
    bench.press("Section Voltage limits");
    bench.model().front.general.explained = Some("limits.main_battery.max_volts".to_owned());
    bench.pass_ms(200);
    let copied = |bench: &mut Bench, name: &str| {
        bench.button(name).click();
        bench.harness.step();
        let commands = bench.harness.output().platform_output.commands.clone();
        commands.into_iter().find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text),
            _ => None,
        })
    };
    let value = copied(&mut bench, "Copy value").expect("it is copied");
    assert!(value.ends_with(" V"), "{value}");
    let row = copied(&mut bench, "Copy row").expect("it is copied");
    let cells: Vec<&str> = row.split('\t').collect();
    assert_eq!(
        (cells[0], cells[1], cells[4]),
        ("Main battery maximum", value.as_str(), "limits.main_battery.max_volts")
    );
}
