//! The Velocity screen against a simulated controller, in virtual time, by what a person reads and presses.

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_gui::model::screen::Screen;
use brushwork_plant::machine::Machine as _;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::Key;
use egui_kittest::kittest::NodeT as _;

/// The window on the Velocity screen of a connected controller whose settings it has read.
fn opened() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    bench
}

/// The window that drives motor 1 at 8000 counts/s.
fn driving() -> Bench {
    let mut bench = opened();
    bench.arm_on("Velocity Settings");
    bench.enter("M1 speed exact", "8000");
    bench.pass_ms(3000);
    assert!((real_speed(&mut bench, Motor::M1) - 8000.0).abs() < 400.0);
    bench
}

/// Counts per second that a motor really turns at, by the machine's own count over a second.
fn real_speed(bench: &mut Bench, motor: Motor) -> f64 {
    let count = |bench: &Bench| bench.truth().axes[motor.index()].encoder_counts;
    let before = count(bench);
    bench.pass_ms(1000);
    (count(bench) - before) as f64
}

/// P of the velocity loop in the controller's RAM, as it stands on the wire.
fn held_p_raw(bench: &Bench, motor: Motor) -> u32 {
    bench.line.with(|bus| bus.controllers()[0].settings().motors[motor.index()].motion.velocity_p_raw)
}

fn assert_stopped_and_disarmed(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert_eq!(bench.model().front.velocity.setpoints.values, [0.0; 2]);
}

#[test]
fn opening_the_screen_reads_the_settings_and_moves_nothing() {
    let mut bench = opened();
    assert!(bench.sees("As the controller holds them."));
    for name in ["M1 Velocity P", "M2 Velocity I", "M1 Velocity D", "M2 QPPS", "M1 L", "M2 R"] {
        assert!(bench.sees(name), "{name}");
    }
    assert_eq!(
        bench.model().front.settings.unit().and_then(|unit| unit.held(Motor::M1, "velocity.p")),
        Some(1.0)
    );
    assert_eq!(bench.model().front.settings.unit().and_then(|unit| unit.qpps(Motor::M2)), Some(44_000.0));
    assert!(bench.button("M1 speed").accesskit_node().is_disabled());
    assert!(bench.both_stand());
}

#[test]
fn the_screen_is_read_when_the_controller_comes_after_it() {
    let mut bench = Bench::new();
    bench.press("Velocity Settings");
    assert!(bench.sees("Start"));
    bench.connect();
    bench.pass_ms(1000);
    bench.open_tab("Velocity loop");
    assert!(bench.sees("As the controller holds them."));
}

#[test]
fn an_armed_slider_brings_its_motor_to_the_speed_asked_for() {
    let mut bench = driving();
    assert_eq!(bench.real_duty(Motor::M2), 0.0);
    bench.enter("M1 speed exact", "-5000");
    bench.pass_ms(3000);
    let speed = real_speed(&mut bench, Motor::M1);
    assert!((speed + 5000.0).abs() < 250.0, "{speed}");
    bench.press("Sync motors");
    bench.enter("M2 speed exact", "6000");
    bench.pass_ms(3000);
    let speed = real_speed(&mut bench, Motor::M1);
    assert!((speed - 6000.0).abs() < 300.0, "{speed}");
    assert!(bench.real_duty(Motor::M2) > 0.0);
}

#[test]
fn the_speed_follows_the_slider_at_the_acceleration_that_was_set() {
    let mut bench = opened();
    bench.arm_on("Velocity Settings");
    bench.enter("Acceleration", "2000");
    bench.enter("M1 speed exact", "8000");
    bench.pass_ms(500);
    let speed = real_speed(&mut bench, Motor::M1);
    assert!(
        (800.0..4500.0).contains(&speed),
        "{speed} counts/s in the second after about 0.8 s at 2000 counts/s²"
    );
}

#[test]
fn space_escape_and_the_arm_switch_stop_and_disarm() {
    let mut bench = driving();
    bench.key(Key::Space);
    assert_stopped_and_disarmed(&mut bench);
    bench.pass_ms(3000);
    assert_stopped_and_disarmed(&mut bench);
    let mut bench = driving();
    bench.key(Key::Escape);
    assert_stopped_and_disarmed(&mut bench);
    let mut bench = driving();
    bench.press("Arm");
    bench.pass_ms(200);
    assert_stopped_and_disarmed(&mut bench);
}

#[test]
fn leaving_the_screen_disarms_and_stops() {
    for screen in ["Device Status", "PWM Settings"] {
        let mut bench = driving();
        bench.press(screen);
        bench.pass_ms(200);
        assert_stopped_and_disarmed(&mut bench);
        bench.press("Velocity Settings");
        bench.pass_ms(1000);
        assert_stopped_and_disarmed(&mut bench);
    }
}

#[test]
fn a_frozen_window_stops_the_motor() {
    let mut bench = driving();
    bench.freeze(std::time::Duration::from_millis(300));
    assert!(bench.both_stand(), "{}", bench.real_duty(Motor::M1));
}

#[test]
fn a_gain_is_held_by_the_controller_once_it_was_applied() {
    let mut bench = opened();
    bench.enter("M1 Velocity P", "2.5");
    assert!(bench.sees("1 setting changed and not applied yet."));
    assert_eq!(held_p_raw(&bench, Motor::M1), 0x1_0000, "nothing is written before the button");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    assert_eq!(held_p_raw(&bench, Motor::M1), 0x2_8000);
    assert_eq!(held_p_raw(&bench, Motor::M2), 0x1_0000);
    assert!(bench.sees("As the controller holds them."));
    assert!(bench.sees_part("Applied and read back: 1 setting"));
}

#[test]
fn settings_are_copied_to_the_other_motor_and_reverted() {
    let mut bench = opened();
    bench.enter("M1 Velocity P", "3");
    bench.press("Copy M1 to M2");
    assert!(bench.sees("2 settings changed and not applied yet."));
    bench.press("Revert");
    assert!(bench.sees("As the controller holds them."));
    bench.enter("M1 Velocity P", "3");
    bench.press("Copy M1 to M2");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    assert_eq!(Motor::BOTH.map(|motor| held_p_raw(&bench, motor)), [0x3_0000; 2]);
}

#[test]
fn what_could_not_be_applied_is_told_and_the_edit_stays() {
    let mut bench = opened();
    bench.enter("M1 Velocity P", "2.5");
    bench.act(&WorldAction::Power { on: false });
    bench.press("Apply to RAM");
    bench.pass_ms(300);
    assert!(bench.line.with(|bus| !bus.views()[0].powered));
    bench.pass_ms(5000);
    assert!(bench.sees_part("Error:"));
    assert_eq!(held_p_raw(&bench, Motor::M1), 0x1_0000);
}

#[test]
fn l_and_r_together_are_warned_of() {
    let mut bench = opened();
    bench.enter("M1 L", "0.001");
    assert!(!bench.sees_part("current (torque) control"));
    bench.enter("M1 R", "0.5");
    assert!(bench.sees_part("Motor 1: with L and R both other than 0"));
}

#[test]
fn passing_through_a_field_does_not_change_it() {
    let mut bench = opened();
    bench.enter("M1 Velocity P", "1.23456");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    let held = held_p_raw(&bench, Motor::M1);
    bench.focus_label("M1 Velocity P");
    bench.focus_label("M1 Velocity I");
    assert_eq!(
        bench
            .model()
            .front
            .settings
            .unit()
            .map(|unit| unit.loop_edits(brushwork_gui::model::loop_settings::VELOCITY).len()),
        Some(0)
    );
    assert_eq!(held_p_raw(&bench, Motor::M1), held);
}

#[test]
fn the_graph_begins_with_speeds_and_each_screen_keeps_its_choice() {
    let mut bench = opened();
    let seen =
        |bench: &Bench| bench.sees_part("M1 Setpoint, M1 PWM, M1 Velocity, M2 Setpoint, M2 PWM, M2 Velocity");
    assert!(seen(&bench));
    bench.press("PWM Settings");
    assert!(bench.sees_part("M1 PWM, M1 Velocity, M1 Current"));
    bench.press("Device Status");
    bench.press("Velocity Settings");
    assert_eq!(bench.model().screen, Screen::Velocity);
    assert!(seen(&bench));
}
