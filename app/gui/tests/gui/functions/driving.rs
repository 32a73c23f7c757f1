//! Sliders and what belongs to them, against what the motors really do.

use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{Row, arm};
use crate::support::bench::Bench;

pub fn play(bench: &mut Bench, row: &Row, name: &str) {
    if row.section == "1.2.12" {
        // Gains that hold a speed with the motor that is simulated.
        for (field, value) in
            [("M1 QPPS", "10600"), ("M1 Velocity P", "1"), ("M1 Velocity I", "0.5"), ("M1 Velocity D", "0")]
        {
            bench.enter(field, value);
        }
        for field in ["M1 L", "M1 R"] {
            bench.enter(field, "0");
        }
        bench.press("Copy M1 to M2");
        bench.press("Apply to RAM");
        bench.pass_ms(1000);
    } else if row.section == "1.2.11" {
        for field in ["M1 L", "M2 R"] {
            bench.enter(field, "0");
        }
        if bench.sees_part("changed and not applied") {
            bench.press("Apply to RAM");
            bench.pass_ms(1000);
        }
    }
    arm(bench);
    scene(bench, row, name);
    bench.key(Key::Space);
    bench.pass_ms(2500);
    assert!(bench.both_stand(), "{row:?}");
    let synced = bench.harness.get_by_label("Sync motors").accesskit_node().toggled();
    if synced == Some(egui::accesskit::Toggled::True) {
        bench.press("Sync motors");
    }
}

fn scene(bench: &mut Bench, row: &Row, name: &str) {
    match name {
        "duty_m1" | "duty_m2" | "speed_m1" | "speed_m2" | "position_m1" | "position_m2" => slider(bench, row),
        "duty_exact" => {
            bench.enter(row.label, "12.3");
            bench.pass_ms(1500);
            assert!((bench.real_duty(Motor::M1) - 0.123).abs() < 0.002, "{}", bench.real_duty(Motor::M1));
        }
        "speed_exact" => {
            bench.enter(row.label, "4000");
            bench.pass_ms(3000);
            let speed = speed(bench, Motor::M1);
            assert!((speed - 4000.0).abs() < 800.0, "{speed}");
        }
        "position_exact" => {
            bench.enter(row.label, "3000");
            bench.pass_ms(5000);
            assert!((position(bench, Motor::M1) - 3000).abs() < 200, "{}", position(bench, Motor::M1));
        }
        "sync" => sync(bench),
        "duty_accel" => {
            bench.enter(row.label, "20");
            bench.set_duty(Motor::M1, "100");
            bench.pass_ms(1500);
            let duty = bench.real_duty(Motor::M1);
            assert!((0.2..0.5).contains(&duty), "at 20 %/s: {duty}");
        }
        "speed_accel" => {
            bench.enter(row.label, "1000");
            bench.enter("M1 speed exact", "8000");
            bench.pass_ms(2000);
            let speed = speed(bench, Motor::M1);
            assert!((1000.0..5000.0).contains(&speed), "at 1000 counts/s²: {speed}");
        }
        "on_release" => on_release(bench, row),
        "position_ramp" => {
            bench.enter(row.label, "2000");
            bench.enter("Travel speed", "8000");
            let start = position(bench, Motor::M1);
            let target = if start > 0 { -9000 } else { 9000 };
            bench.enter("M1 position exact", &target.to_string());
            bench.pass_ms(1000);
            let way = (position(bench, Motor::M1) - start).abs();
            bench.pass_ms(15_000);
            assert!((position(bench, Motor::M1) - target).abs() < 400, "{}", position(bench, Motor::M1));
            if row.label == "Acceleration" {
                assert!(way < 4000, "at 2000 counts/s² not {way} counts in a second and a bit");
            }
        }
        "position_speed" => {
            bench.enter(row.label, "1000");
            let start = position(bench, Motor::M1);
            bench.enter("M1 position exact", if start > 0 { "-9000" } else { "9000" });
            bench.pass_ms(2000);
            let way = (position(bench, Motor::M1) - start).abs();
            assert!((800..3200).contains(&way), "at 1000 counts/s: {way} counts in two seconds and a bit");
        }
        other => panic!("no such scene: {other}"),
    }
}

fn motor_of(row: &Row) -> Motor {
    if row.label.starts_with("M2") { Motor::M2 } else { Motor::M1 }
}

/// Moves a slider with the keyboard and looks at the motor.
fn slider(bench: &mut Bench, row: &Row) {
    let motor = motor_of(row);
    bench.harness.get_by_role_and_label(Role::Slider, row.label).focus();
    bench.pass_ms(200);
    let before = position(bench, motor);
    for _ in 0..3 {
        bench.key(Key::PageUp);
    }
    bench.pass_ms(2000);
    let moved = position(bench, motor) - before;
    assert!(moved > 300, "{row:?}: {moved} counts");
    let other = if motor == Motor::M1 { Motor::M2 } else { Motor::M1 };
    assert_eq!(bench.real_duty(other), 0.0, "the other motor stands");
}

fn sync(bench: &mut Bench) {
    bench.press("Sync motors");
    let field =
        ["M1 duty exact", "M1 speed exact", "M1 position exact"].into_iter().find(|field| bench.sees(field));
    let field = field.expect("one of the screens");
    let value = match field {
        "M1 duty exact" => "25",
        "M1 speed exact" => "3000",
        _ => "2500",
    };
    let before = Motor::BOTH.map(|motor| position(bench, motor));
    bench.enter(field, value);
    bench.pass_ms(3000);
    for motor in Motor::BOTH {
        let moved = position(bench, motor) - before[motor.index()];
        assert!(moved.abs() > 100, "{motor}: {moved} counts");
    }
}

/// While the slider is held nothing moves; the motor follows when it is let go.
fn on_release(bench: &mut Bench, row: &Row) {
    bench.press(row.label);
    let slider = if row.section == "1.2.12" { "M1 speed" } else { "M1 position" };
    let rail = bench.harness.get_by_role_and_label(Role::Slider, slider).rect();
    let at = pos2(rail.left() + rail.width() * 0.7, rail.center().y);
    let button = |bench: &mut Bench, pressed| {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        bench.harness.event(Event::PointerButton { pos: at, button, pressed, modifiers });
        bench.harness.step();
    };
    let before = position(bench, Motor::M1);
    bench.harness.hover_at(at);
    bench.harness.step();
    button(bench, true);
    bench.pass_ms(1000);
    let held = position(bench, Motor::M1) - before;
    button(bench, false);
    bench.pass_ms(3000);
    let released = position(bench, Motor::M1) - before;
    assert!(held.abs() < 100, "{held} counts while held");
    assert!(released.abs() > 500, "{released} counts after release");
    bench.press(row.label);
}

fn position(bench: &Bench, motor: Motor) -> i64 {
    bench.truth().axes[motor.index()].encoder_counts
}

/// Counts per second over half a second.
fn speed(bench: &mut Bench, motor: Motor) -> f64 {
    let before = position(bench, motor);
    bench.pass_ms(500);
    (position(bench, motor) - before) as f64 / 0.5
}
