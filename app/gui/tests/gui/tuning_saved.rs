//! What stays of guided tuning: its report, its gains in RAM and in EEPROM.

use crate::support::bench::Bench;
use crate::support::tuning::{held, press_below, run, running, timeout_ms, timeout_of_factory, tuned};
use brushwork_core::tune::law::Report;
use brushwork_gui::model::settings::SettingsAction;
use brushwork_gui::tune::Loop;
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::Key;
use egui_kittest::kittest::Queryable as _;

#[test]
fn a_report_is_saved_as_the_command_line_writes_it_and_opened_again() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let verdict_top = |bench: &Bench, run: usize| {
        bench.harness.get_by_label_contains(&format!("· run {run} ·")).rect().top()
    };
    let top = verdict_top(&bench, 1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("run.json");
    bench.model().front.tune.path = path.display().to_string();
    press_below(&mut bench, "Save report");
    let saved: Report =
        serde_json::from_str(&std::fs::read_to_string(&path).expect("written")).expect("a report");
    assert_eq!(saved, run(&mut bench, Loop::Velocity).report);
    assert_eq!(saved.replay().expect("the record belongs to it"), saved, "the same to the last bit");
    std::fs::write(&path, "precious").expect("it can be written");
    press_below(&mut bench, "Save report");
    assert_eq!(
        std::fs::read_to_string(&path).expect("it is there"),
        "precious",
        "nothing is replaced unasked"
    );
    assert!(bench.said().iter().any(|text| text.contains("already")), "{:?}", bench.said());
    std::fs::remove_file(&path).expect("it is there");
    press_below(&mut bench, "Save report");
    assert!(verdict_top(&bench, 1) < top, "its end was looked at");
    press_below(&mut bench, "Open report");
    bench.pass_ms(300);
    assert_eq!(bench.model().front.tune.front(Loop::Velocity).runs.len(), 2);
    assert_eq!(verdict_top(&bench, 2), top, "a new result is seen from its verdict on");
    assert_eq!(run(&mut bench, Loop::Velocity).report, saved);
}

#[test]
fn saving_while_a_run_is_at_work_waits_for_its_end_and_saves_the_users_values() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    bench.pass_ms(1500);
    assert_ne!(timeout_ms(&bench), timeout_of_factory(), "the run has shortened it");
    bench.model().front.tune.waiting = Some(SettingsAction::Save);
    bench.pass_ms(300);
    assert_eq!(bench.model().front.tune.waiting, Some(SettingsAction::Save), "it waits");
    bench.key(Key::Escape);
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.model().front.is_idle() && bench.model().front.tune.waiting.is_none() {
            break;
        }
    }
    bench.act(&WorldAction::Power { on: false });
    bench.pass_ms(500);
    bench.act(&WorldAction::Power { on: true });
    bench.pass_ms(1500);
    assert_eq!(timeout_ms(&bench), timeout_of_factory(), "EEPROM holds the user's time-out");
    assert_eq!(held(&bench, Motor::M1), before);
}

/// What EEPROM holds for motor 1.
fn stored(bench: &Bench) -> MotionSettings {
    bench.line.with(|bus| bus.controllers()[0].stored_settings().motors[0].motion)
}

fn save(bench: &mut Bench) {
    bench.press("Save…");
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.sees("Save") {
            break;
        }
    }
    bench.press("Save");
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.model().front.is_idle() {
            break;
        }
    }
}

#[test]
fn saved_gains_stay_in_eeprom_when_they_are_undone_in_ram_and_undo_outlives_the_link() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    let before = held(&bench, Motor::M1);
    bench.press("Apply (RAM)");
    bench.pass_ms(4000);
    let applied = held(&bench, Motor::M1);
    assert_ne!(applied, before);
    save(&mut bench);
    assert_eq!(stored(&bench), applied, "{:?}", bench.said());
    // The cable is out and in again: the run, its picture and Undo are still there.
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(1500);
    bench.act(&WorldAction::Unplug { unplugged: false });
    bench.press("Connect");
    bench.pass_ms(5000);
    bench.press("Velocity Settings");
    bench.pass_ms(2000);
    bench.press("Undo");
    bench.pass_ms(3000);
    assert_eq!(held(&bench, Motor::M1), before);
    assert_eq!(stored(&bench), applied, "EEPROM is written by Save alone");
}

#[test]
fn the_settings_screen_saves_after_the_run_that_it_ended_and_what_it_saves_is_the_users() {
    let (mut bench, before) = running("small-gearmotor", "Velocity Settings");
    bench.pass_ms(1500);
    assert_ne!(timeout_ms(&bench), timeout_of_factory(), "the run has shortened it");
    bench.press("General Settings");
    bench.pass_ms(300);
    bench.press("Save to EEPROM");
    for _ in 0..40 {
        bench.pass_ms(500);
        if bench.sees("Save") {
            break;
        }
    }
    bench.press("Save");
    for _ in 0..60 {
        bench.pass_ms(500);
        if bench.model().front.is_idle() && bench.model().front.tune.waiting.is_none() {
            break;
        }
    }
    let of_stream = bench.line.with(|bus| bus.controllers()[0].stored_settings().streams[0].timeout_ms);
    assert_eq!((of_stream, timeout_ms(&bench)), (timeout_of_factory(), timeout_of_factory()));
    assert_eq!((stored(&bench), held(&bench, Motor::M1)), (before, before));
}

#[test]
fn applied_gains_are_known_to_every_screen() {
    let mut bench = tuned("Velocity Settings", Loop::Velocity);
    press_below(&mut bench, "Apply (RAM)");
    bench.pass_ms(8000);
    let held = held(&bench, Motor::M1).velocity_p_raw;
    let unit = bench.model().front.settings.unit().expect("it is connected");
    assert_eq!(unit.held(Motor::M1, "velocity.p"), Some(f64::from(held) / 65_536.0));
    assert!(unit.is_read() && unit.confirmed("motor1.velocity.p").is_some());
    assert!(unit.edits().is_empty());
}
