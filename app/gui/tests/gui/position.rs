//! The Position screen against a simulated controller, in virtual time, by what a person reads and presses.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_mcp_wire::packet_serial::scale;
use brushwork_values::Motor;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// The window on the Position screen of a connected controller whose settings it has read.
fn opened() -> Bench {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("Position Settings");
    bench.pass_ms(1000);
    bench.open_tab("Position loop");
    bench
}

/// The same with a position loop that works, on both motors: cascaded, within -20 000 to 20 000 counts.
fn tuned() -> Bench {
    let mut bench = opened();
    bench.press("Velocity loop");
    bench.enter("M1 QPPS", "10600");
    bench.enter("M1 Velocity I", "0.05");
    bench.enter("M1 Velocity D", "0");
    bench.press("Copy M1 to M2");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    bench.press("Position loop");
    bench.enter("M1 Position P", "15");
    bench.enter("M1 Minimum position", "-20000");
    bench.enter("M1 Maximum position", "20000");
    bench.press("Copy M1 to M2");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    assert!(bench.sees("As the controller holds them."));
    bench
}

fn armed() -> Bench {
    let mut bench = tuned();
    bench.press("Arm");
    bench.pass_ms(500);
    assert!(matches!(bench.model().front.link.arming, Arming::Armed { .. }));
    bench
}

/// Where a motor really is, counts.
fn real_position(bench: &Bench, motor: Motor) -> i64 {
    bench.truth().axes[motor.index()].encoder_counts
}

fn assert_stopped_and_disarmed(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

#[test]
fn opening_the_screen_reads_the_settings_and_moves_nothing() {
    let mut bench = opened();
    assert!(bench.sees("As the controller holds them."));
    for label in ["P", "I", "D", "Max I", "Deadzone", "Min (counts)", "Max (counts)"] {
        assert!(bench.sees(label), "{label}");
    }
    for name in
        ["M1 Position P", "M2 Position I", "M1 Position D", "M2 Minimum position", "M1 Maximum position"]
    {
        assert!(bench.sees(name), "{name}");
    }
    bench.press("Velocity loop");
    for name in ["M1 Velocity P", "M2 Velocity I", "M1 Velocity D", "M2 QPPS", "M1 L", "M2 R"] {
        assert!(bench.sees(name), "{name}");
    }
    assert!(bench.both_stand());
}

#[test]
fn a_motor_without_travel_has_no_slider_and_says_what_to_set() {
    let mut bench = opened();
    bench.press("Arm");
    bench.pass_ms(500);
    assert!(bench.sees_part("No travel: set Min and Max below and apply them."));
    bench.hold("M1 jog forward");
    bench.pass_ms(500);
    assert!(bench.both_stand());
}

#[test]
fn every_setting_is_held_by_the_controller_once_it_was_applied() {
    let mut bench = opened();
    let fields = [
        ("Position P", "2000"),
        ("Position I", "1.5"),
        ("Position D", "20000"),
        ("Max I", "300"),
        ("Deadzone", "7"),
        ("Minimum position", "-2000000000"),
        ("Maximum position", "2000000000"),
    ];
    for (name, value) in fields {
        bench.enter(&format!("M2 {name}"), value);
    }
    assert!(bench.sees("7 settings changed and not applied yet."));
    assert!(bench.sees("Position loop *"));
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    let held = bench.line.with(|bus| bus.controllers()[0].settings().motors[1].motion);
    let raw = |gain: f64| (gain * scale::POSITION_GAIN) as u32;
    assert_eq!(
        (held.position_p_raw, held.position_i_raw, held.position_d_raw),
        (raw(2000.0), raw(1.5), raw(20_000.0))
    );
    assert_eq!((held.position_max_i, held.position_deadzone_counts), (300, 7));
    assert_eq!((held.position_min_counts, held.position_max_counts), (-2_000_000_000, 2_000_000_000));
    let other = bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion);
    assert_eq!((other.position_p_raw, other.position_max_counts), (0, 0));
}

#[test]
fn at_once_applies_each_change_without_a_button_and_a_refused_one_only_once() {
    let mut bench = opened();
    bench.press("At once");
    bench.enter("M1 Position P", "12");
    bench.pass_ms(1000);
    let held = |bench: &Bench| {
        bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion.position_p_raw)
    };
    assert_eq!(held(&bench), 12 * 1024);
    assert!(bench.sees("As the controller holds them."));
    // The controller never hears of the next one.
    bench.line.swallow(61, &[]);
    let errors = |bench: &mut Bench| {
        bench
            .model()
            .messages
            .past()
            .filter(|message| message.text.to_string().contains("osition P was to be"))
            .count()
    };
    let before = errors(&mut bench);
    bench.enter("M1 Position P", "13");
    bench.pass_ms(5000);
    assert_eq!(held(&bench), 12 * 1024);
    assert!(bench.sees("1 setting changed and not applied yet."));
    assert_eq!(errors(&mut bench), before + 1, "{:?}", bench.model().messages.past().collect::<Vec<_>>());
}

#[test]
fn an_armed_slider_brings_its_motor_to_the_position_asked_for() {
    let mut bench = armed();
    assert!(bench.both_stand());
    bench.enter("M1 position exact", "4000");
    bench.pass_ms(3000);
    let counts = real_position(&bench, Motor::M1);
    assert!((counts - 4000).abs() < 40, "{counts}");
    assert_eq!(real_position(&bench, Motor::M2), 0);
    bench.press("Sync motors");
    bench.enter("M2 position exact", "-2500");
    bench.pass_ms(4000);
    for motor in Motor::BOTH {
        let counts = real_position(&bench, motor);
        assert!((counts + 2500).abs() < 40, "{motor}: {counts}");
    }
}

#[test]
fn the_way_is_gone_at_the_speed_that_was_set() {
    let mut bench = armed();
    bench.enter("Travel speed", "1000");
    bench.enter("M1 position exact", "10000");
    bench.pass_ms(1000);
    let before = real_position(&bench, Motor::M1);
    bench.pass_ms(2000);
    let speed = (real_position(&bench, Motor::M1) - before) / 2;
    assert!((speed - 1000).abs() < 60, "{speed}");
}

#[test]
fn the_slider_begins_where_the_motor_is_and_a_key_moves_it_one_step_from_there() {
    let mut bench = armed();
    bench.enter("M1 position exact", "3000");
    bench.pass_ms(3000);
    bench.press("Arm");
    bench.pass_ms(500);
    let stands = real_position(&bench, Motor::M1);
    bench.press("Arm");
    bench.pass_ms(500);
    let shown = bench.model().front.position.setpoints.values[0];
    assert!((shown - stands as f64).abs() <= 2.0, "{shown} {stands}");
    assert!(bench.both_stand(), "arming moves nothing");
    bench.harness.get_by_role_and_label(Role::Slider, "M1 position").focus();
    bench.pass_ms(200);
    bench.key(Key::ArrowRight);
    bench.pass_ms(1000);
    let counts = real_position(&bench, Motor::M1);
    assert!((counts - stands).abs() < 40, "one step, not a jump to zero: {counts} from {stands}");
    // A tenth of what is between zero and an end.
    bench.key(Key::PageUp);
    bench.pass_ms(3000);
    let counts = real_position(&bench, Motor::M1);
    assert!((counts - stands - 2000).abs() < 60, "{counts} from {stands}");
}

#[test]
fn on_release_the_motor_waits_for_the_hand_to_let_go() {
    let mut bench = armed();
    bench.press("On release");
    let rail = bench.harness.get_by_role_and_label(Role::Slider, "M1 position").rect();
    let at = rail.center() + egui::vec2(rail.width() / 8.0, 0.0);
    bench.harness.hover_at(at);
    bench.harness.step();
    let button = |pressed| egui::Event::PointerButton {
        pos: at,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    bench.harness.event(button(true));
    bench.pass_ms(1000);
    assert!(bench.model().front.position.setpoints.values[0] > 1000.0);
    assert!(bench.both_stand());
    bench.harness.event(button(false));
    bench.pass_ms(3000);
    let counts = real_position(&bench, Motor::M1);
    assert!(counts > 1000, "{counts}");
}

#[test]
fn a_jog_goes_on_while_it_is_held_and_stops_without_coming_back() {
    let mut bench = armed();
    bench.hold("M1 jog forward");
    bench.pass_ms(1000);
    let on_the_way = real_position(&bench, Motor::M1);
    assert!(on_the_way > 1500, "{on_the_way}");
    bench.let_go("M1 jog forward");
    let mut furthest = 0;
    for _ in 0..20 {
        bench.pass_ms(100);
        furthest = furthest.max(real_position(&bench, Motor::M1));
    }
    let stands = real_position(&bench, Motor::M1);
    bench.pass_ms(1000);
    assert_eq!(real_position(&bench, Motor::M1), stands, "it is held there");
    assert!(furthest - stands < 80, "it went to {furthest} and came back to {stands}");
    // 5000 counts/s, 20 000 counts/s²: 625 counts of braking, and what the delay adds.
    assert!(stands < on_the_way + 2200, "{on_the_way} to {stands}");
}

#[test]
fn space_escape_and_the_arm_switch_stop_and_disarm() {
    for stop in ["space", "escape", "switch", "screen"] {
        let mut bench = armed();
        bench.enter("M1 position exact", "15000");
        bench.pass_ms(500);
        assert!(bench.real_duty(Motor::M1) > 0.2);
        match stop {
            "space" => bench.key(Key::Space),
            "escape" => bench.key(Key::Escape),
            "switch" => bench.press("Arm"),
            _ => bench.press("Velocity Settings"),
        }
        bench.pass_ms(200);
        assert_stopped_and_disarmed(&mut bench);
        bench.pass_ms(2000);
        assert_stopped_and_disarmed(&mut bench);
    }
}

#[test]
fn a_frozen_window_stops_a_move() {
    let mut bench = armed();
    bench.enter("M1 position exact", "15000");
    bench.pass_ms(500);
    bench.freeze(Duration::from_millis(300));
    assert!(bench.both_stand(), "{}", bench.real_duty(Motor::M1));
}

#[test]
fn the_graph_begins_with_positions() {
    let bench = opened();
    assert!(bench.sees_part("M1 Setpoint, M1 Velocity, M1 Position, M2 Setpoint, M2 Velocity, M2 Position"));
}

#[test]
fn a_disarmed_slider_moves_nothing() {
    let mut bench = tuned();
    assert!(bench.button("M1 position").accesskit_node().is_disabled());
    assert!(bench.button("M1 jog forward").accesskit_node().is_disabled());
    bench.hold("M1 jog forward");
    bench.pass_ms(500);
    assert!(bench.both_stand());
}
