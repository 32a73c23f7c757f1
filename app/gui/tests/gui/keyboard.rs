//! Everything by keys alone: connect, change a limit, write, save, arm, drive, stop.

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_gui::model::screen::Screen;
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_values::Motor;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// Times that Tab is pressed before a widget counts as out of reach.
const MOST_TABS: usize = 300;

/// What has the keyboard focus, by its name.
fn focused(bench: &Bench) -> Option<String> {
    let mut nodes = bench.harness.root().children_recursive();
    let node = nodes.find(|node| node.accesskit_node().is_focused())?;
    node.accesskit_node().label()
}

/// Presses Tab until a widget of that name has the focus.
#[track_caller]
fn tab_to(bench: &mut Bench, name: &str) {
    let mut passed = Vec::new();
    for _ in 0..MOST_TABS {
        if focused(bench).is_some_and(|label| label == name) {
            return;
        }
        bench.harness.key_press(Key::Tab);
        bench.harness.step();
        bench.harness.step();
        passed.extend(focused(bench));
    }
    passed.dedup();
    panic!("Tab never reaches {name:?}, only {passed:#?}");
}

/// Goes to a widget with Tab and presses Enter on it.
#[track_caller]
fn press(bench: &mut Bench, name: &str) {
    tab_to(bench, name);
    bench.key(Key::Enter);
    bench.pass_ms(300);
}

/// Goes to a field with Tab, replaces what it holds and presses Enter.
#[track_caller]
fn enter(bench: &mut Bench, field: &str, text: &str) {
    tab_to(bench, field);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.harness.event(egui::Event::Text(text.to_owned()));
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.pass_ms(300);
}

fn connected() -> Bench {
    let mut bench = Bench::new();
    bench.pass_ms(200);
    press(&mut bench, "Connect");
    bench.pass_ms(1_500);
    assert!(bench.model().is_connected());
    bench
}

#[test]
fn connect_change_a_limit_write_save_arm_drive_and_stop_by_keys_alone() {
    let mut bench = connected();
    bench.key_with(Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3_000);
    press(&mut bench, "Section Voltage limits");
    enter(&mut bench, "Main battery maximum", "30");
    press(&mut bench, "Write settings");
    press(&mut bench, "Write to controller");
    bench.pass_ms(3_000);
    let battery =
        |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings().battery.main_max_tenths);
    assert_eq!(battery(&bench), 300);
    press(&mut bench, "Save to EEPROM");
    // The sheet that asks has put the focus on its own button.
    assert_eq!(focused(&bench).as_deref(), Some("Save"));
    press(&mut bench, "Save");
    bench.pass_ms(5_000);
    let stored = bench.line.with(|bus| bus.controllers()[0].stored_settings().battery.main_max_tenths);
    assert_eq!(stored, 300);

    bench.key_with(Modifiers::COMMAND, Key::Num3);
    assert_eq!(bench.model().screen, Screen::Pwm);
    press(&mut bench, "Arm");
    bench.pass_ms(500);
    assert!(matches!(bench.model().front.link.arming, Arming::Armed { .. }));
    enter(&mut bench, "M1 duty exact", "40");
    bench.pass_ms(1_500);
    assert!((bench.real_duty(Motor::M1) - 0.4).abs() < 0.01, "{}", bench.real_duty(Motor::M1));
    bench.key(Key::Space);
    bench.pass_ms(500);
    assert!(bench.both_stand());
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

#[test]
fn a_motion_mind_is_connected_changed_armed_tuned_and_stopped_by_keys_alone() {
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(Mode::SerialPid)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    press(&mut bench, "Connect");
    bench.pass_ms(3_000);
    assert!(bench.model().is_connected());
    bench.key_with(Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(2_000);
    enter(&mut bench, "P", "6500");
    press(&mut bench, "Write settings");
    press(&mut bench, "Write to controller");
    bench.pass_ms(4_000);
    let pterm = |bench: &Bench| bench.minds.with(|bus| bus.motion_minds()[0].read_one(4));
    assert_eq!(pterm(&bench), 6_500);

    bench.key_with(Modifiers::COMMAND, Key::Num4);
    assert_eq!(bench.model().screen, Screen::Velocity);
    press(&mut bench, "Arm");
    bench.pass_ms(500);
    press(&mut bench, "Tune");
    press(&mut bench, "Tune M1");
    bench.pass_ms(1_500);
    assert!(bench.model().front.tune.is_running());
    bench.key(Key::Space);
    bench.pass_ms(4_000);
    assert!(!bench.model().front.tune.is_running());
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert_eq!(pterm(&bench), 6_500, "the old gains are back");
}

#[test]
fn the_slider_is_moved_by_arrow_keys() {
    let mut bench = connected();
    bench.key_with(Modifiers::COMMAND, Key::Num3);
    press(&mut bench, "Arm");
    bench.pass_ms(500);
    tab_to(&mut bench, "M2 duty");
    for _ in 0..20 {
        bench.key(Key::ArrowRight);
    }
    bench.pass_ms(1_500);
    let duty = bench.real_duty(Motor::M2);
    assert!(duty > 0.01, "{duty}");
    bench.key(Key::Escape);
    bench.pass_ms(500);
    assert!(bench.both_stand());
}

#[test]
fn a_command_is_composed_and_the_history_cleared_by_keys_alone() {
    let mut bench = connected();
    press(&mut bench, "Clear history");
    assert!(bench.model().front.history.is_empty());
    bench.key_with(Modifiers::COMMAND, Key::T);
    bench.pass_ms(300);
    press(&mut bench, "Send a command");
    enter(&mut bench, "Find a command", "read main battery");
    press(&mut bench, "24 read main battery");
    press(&mut bench, "Send these bytes");
    bench.pass_ms(300);
    assert!(bench.harness.query_all_by_label_contains("Answer: ").next().is_some());
    press(&mut bench, "Close");
    assert!(!bench.model().front.traffic.open);
}

#[test]
fn every_screen_has_a_key_and_the_panels_too() {
    let mut bench = connected();
    let keys = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];
    for (key, screen) in keys.into_iter().zip(Screen::USUAL) {
        bench.key_with(Modifiers::COMMAND, key);
        bench.pass_ms(300);
        assert_eq!(bench.model().screen, screen);
    }
    bench.key_with(Modifiers::COMMAND, Key::B);
    assert!(bench.model().front.world.open);
}

#[test]
fn after_a_click_no_ring_stands_round_the_heading_and_after_a_key_one_does() {
    let mut bench = connected();
    let shows = |bench: &Bench| brushwork_gui::focus::shows_ring(&bench.harness.ctx);
    bench.press("Velocity Settings");
    bench.pass_ms(300);
    assert_eq!(focused(&bench).as_deref(), Some("Velocity Settings"), "the keyboard is there all the same");
    assert!(!shows(&bench));
    bench.key_with(Modifiers::COMMAND, Key::Num3);
    bench.pass_ms(300);
    assert_eq!(focused(&bench).as_deref(), Some("PWM Settings"));
    assert!(shows(&bench));
}

#[test]
fn edits_are_taken_back_and_done_again_by_keys_step_by_step() {
    let mut bench = connected();
    bench.key_with(Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3_000);
    press(&mut bench, "Section Voltage limits");
    enter(&mut bench, "Main battery maximum", "30");
    enter(&mut bench, "Main battery maximum", "29");
    let wanted = |bench: &mut Bench| {
        let unit = bench.model().front.settings.unit().expect("it is there");
        unit.edits().get("limits.main_battery.max_volts").and_then(brushwork_link::SettingValue::number)
    };
    assert_eq!(wanted(&mut bench), Some(29.0));
    // A field for text keeps these keys for itself.
    press(&mut bench, "Section Current limits");
    bench.key_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(wanted(&mut bench), Some(30.0));
    bench.key_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(wanted(&mut bench), None);
    bench.key_with(Modifiers::COMMAND, Key::Y);
    assert_eq!(wanted(&mut bench), Some(30.0));
    press(&mut bench, "Undo edit of settings");
    assert_eq!(wanted(&mut bench), None);
    press(&mut bench, "Redo edit of settings");
    press(&mut bench, "Write settings");
    press(&mut bench, "Write to controller");
    bench.pass_ms(3_000);
    let unit = bench.model().front.settings.unit().expect("it is there");
    assert!(!unit.can_undo() && !unit.can_redo(), "what was written is not gone back behind");
}

/// Keys from the opening of a screen to a button, with F6 for each region that is passed over.
fn keys_to(bench: &mut Bench, regions: usize, name: &str, most_tabs: usize) -> usize {
    for _ in 0..regions {
        bench.key(Key::F6);
    }
    for tabs in 0..=most_tabs {
        if focused(bench).is_some_and(|label| label == name) {
            return regions + tabs;
        }
        bench.key(Key::Tab);
    }
    panic!("{name:?} is further than {most_tabs} times Tab from region {regions}: {:?}", focused(bench));
}

#[test]
fn apply_and_write_are_within_eight_keys_of_their_screens() {
    let mut bench = connected();
    let report = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reports/tuned.json");
    let report = brushwork_core::tune::file::read(std::path::Path::new(report)).expect("a report");
    let which = brushwork_gui::tune::files::loop_of(&report);
    bench.model().front.tune.panel_mut(which, Motor::M1).add(report);
    let screen = if which.screen() == Screen::Velocity { Key::Num4 } else { Key::Num5 };
    bench.key_with(Modifiers::COMMAND, screen);
    bench.open_tab("Tune");
    bench.key_with(Modifiers::COMMAND, Key::Num1);
    bench.pass_ms(500);
    bench.key_with(Modifiers::COMMAND, screen);
    bench.pass_ms(500);
    let keys = 1 + keys_to(&mut bench, 2, "Apply (RAM)", 6) + 1;
    println!("Apply: {keys} keys");
    assert!(keys <= 8, "{keys}");
    bench.key_with(Modifiers::COMMAND, Key::Num2);
    bench.pass_ms(3_000);
    press(&mut bench, "Section Voltage limits");
    enter(&mut bench, "Main battery maximum", "30");
    // F9 opens the sheet, Enter presses its first button.
    bench.key(Key::F9);
    bench.pass_ms(300);
    assert_eq!(focused(&bench).as_deref(), Some("Write to controller"));
    bench.key(Key::Enter);
    bench.pass_ms(3_000);
    let max = bench.line.with(|bus| bus.controllers()[0].settings().battery.main_max_tenths);
    assert_eq!(max, 300);
}
