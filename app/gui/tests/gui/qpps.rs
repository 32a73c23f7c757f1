//! The guided measurement of QPPS against simulated motors of known top speed, and against what can be wrong with a
//! machine. Whatever happens, the motors stand afterwards and nothing is armed.

use std::time::Duration;

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::presets;
use brushwork_plant::world::{World, WorldAction};
use brushwork_values::Motor;
use egui::Key;

fn config(preset: &str) -> ControllerConfig {
    let axis = presets::lookup(preset).expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    ControllerConfig { world, ..default }
}

/// Counts per second of motor 1 at full duty, by the plant alone, `settle_s` after it was switched on.
fn true_speed(preset: &str, duty: f64, settle_s: u32) -> f64 {
    let mut world = World::new(&config(preset).world, 0).expect("the preset is sound");
    let mut run = |seconds: u32| {
        for _ in 0..seconds * 1000 {
            world.advance([BridgeOutput::Duty(duty), BridgeOutput::Brake], 0.001);
        }
        world.view(Duration::ZERO).axes[0].encoder_counts
    };
    let before = run(settle_s);
    (run(1) - before) as f64
}

/// The armed PWM screen with the measurement open.
fn armed(preset: &str) -> Bench {
    let mut bench = Bench::of(Controller::new(config(preset)).expect("the preset is sound"));
    bench.connect();
    bench.arm_on("PWM Settings");
    bench.press("Measure QPPS");
    bench
}

/// A measurement that has begun; it is in its forward run after about two seconds.
fn measuring(preset: &str) -> Bench {
    let mut bench = armed(preset);
    bench.press("Measure M1");
    assert!(bench.model().front.qpps.job.is_running());
    bench
}

/// A measurement whose motor runs at full duty, forward.
fn at_full_duty(preset: &str) -> Bench {
    let mut bench = measuring(preset);
    for _ in 0..100 {
        if bench.real_duty(Motor::M1) > 0.999 {
            return bench;
        }
        bench.pass_ms(100);
    }
    panic!("never at full duty: {:?}", bench.model().front.qpps.refusal);
}

fn finish(bench: &mut Bench) {
    for _ in 0..120 {
        if !bench.model().front.qpps.job.is_running() {
            break;
        }
        bench.pass_ms(1000);
    }
    assert!(!bench.model().front.qpps.job.is_running(), "it ends by itself");
    bench.pass_ms(300);
    assert_at_rest(bench);
}

fn assert_at_rest(bench: &mut Bench) {
    assert!(bench.both_stand(), "{} {}", bench.real_duty(Motor::M1), bench.real_duty(Motor::M2));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
}

/// Why nothing was found.
fn refusal(bench: &mut Bench) -> String {
    assert_eq!(bench.model().front.qpps.measured, None);
    bench.model().front.qpps.refusal.clone().expect("it says why").to_string()
}

#[track_caller]
fn assert_finds(preset: &str, settle_s: u32, travel_limit: &str) {
    let mut bench = armed(preset);
    bench.enter("Travel limit", travel_limit);
    bench.press("Measure M1");
    finish(&mut bench);
    let found = bench.model().front.qpps.measured;
    let found = found.unwrap_or_else(|| panic!("{:?}", bench.model().front.qpps.refusal));
    for (run, duty) in [(found.forward, 1.0), (found.reverse, -1.0)] {
        let truth = true_speed(preset, duty, settle_s);
        let error = run.speed.counts_per_s / truth - 1.0;
        assert!(error.abs() < 0.02, "{preset}: {run:?}, not {truth}");
    }
    assert!(found.spread() < 0.02, "{found:?}");
    let volts = presets::lookup(preset).expect("a preset").supply.open_circuit_volts;
    assert!((found.rest_volts - volts).abs() < 0.3, "{found:?}");
    assert!(found.forward.power.volts <= found.rest_volts + 0.05, "{found:?}");
}

#[test]
fn the_speed_of_a_small_gearmotor_is_found_within_two_percent() {
    assert_finds("small-gearmotor", 5, "2000000");
}

#[test]
fn the_speed_of_a_large_gearmotor_is_found_within_two_percent() {
    assert_finds("large-gearmotor", 10, "2000000");
}

#[test]
fn the_speed_of_a_direct_drive_is_found_within_two_percent() {
    assert_finds("direct-drive", 5, "2000000");
}

#[test]
fn the_speed_of_a_flywheel_is_found_within_two_percent() {
    assert_finds("flywheel", 30, "2000000");
}

#[test]
fn the_speed_on_a_coarse_encoder_is_found_within_two_percent() {
    assert_finds("coarse-encoder", 5, "2000000");
}

#[test]
fn the_speed_of_an_actuator_is_found_within_its_travel() {
    // It stands in the middle of 4095 counts, with end stops.
    assert_finds("linear-actuator", 2, "1500");
}

#[test]
fn what_was_found_goes_into_the_settings_when_it_is_wanted() {
    let mut bench = measuring("small-gearmotor");
    let held = |bench: &Bench| bench.line.with(|bus| bus.controllers()[0].settings().motors[0].motion.qpps);
    let before = held(&bench);
    finish(&mut bench);
    assert!(bench.sees_part("M1: QPPS"));
    assert!(bench.sees_part("Battery"));
    assert_eq!(held(&bench), before, "nothing is written by itself");
    bench.press("Set QPPS of M1");
    assert!(bench.sees("1 setting changed and not applied yet."));
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    let truth = true_speed("small-gearmotor", 1.0, 5);
    assert!((f64::from(held(&bench)) / truth - 1.0).abs() < 0.02, "{} {truth}", held(&bench));
}

#[test]
fn the_second_motor_is_measured_too_and_the_first_stands() {
    let mut bench = armed("small-gearmotor");
    bench.press("M2");
    bench.press("Measure M2");
    for _ in 0..15 {
        bench.pass_ms(100);
        assert_eq!(bench.real_duty(Motor::M1), 0.0);
    }
    assert!(bench.real_duty(Motor::M2) > 0.5);
    finish(&mut bench);
    assert_eq!(bench.model().front.qpps.measured.expect("it was measured").motor, Motor::M2);
}

#[test]
fn it_needs_an_armed_screen() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    bench.press("Measure QPPS");
    bench.press("Measure M1");
    bench.pass_ms(2000);
    assert!(!bench.model().front.qpps.job.is_running());
    assert!(bench.both_stand());
}

#[test]
fn a_reversed_encoder_is_refused_with_what_to_do_before_the_motor_is_fast() {
    for wrong in [
        WorldAction::ReverseEncoder { motor: Motor::M1, on: true },
        WorldAction::ReverseLeads { motor: Motor::M1, on: true },
    ] {
        let mut bench = armed("small-gearmotor");
        bench.act(&wrong);
        bench.press("Measure M1");
        finish(&mut bench);
        let why = refusal(&mut bench);
        assert!(why.contains("counts down") && why.contains("Change round the two motor leads"), "{why}");
        assert!(bench.sees_part("counts down at"), "it is said on the screen");
        let turned = bench.truth().axes[0].encoder_counts.abs();
        assert!(turned < 500, "{turned}");
    }
}

#[test]
fn a_lost_encoder_a_blocked_shaft_and_an_open_lead_are_told_apart() {
    for (wrong, word) in [
        (WorldAction::LoseEncoder { motor: Motor::M1, on: true }, "its encoder is not seen"),
        (WorldAction::LockShaft { motor: Motor::M1, on: true }, "as a motor does that is blocked"),
        (WorldAction::OpenLead { motor: Motor::M1, on: true }, "no current"),
    ] {
        for preset in ["small-gearmotor", "large-gearmotor", "coarse-encoder"] {
            let mut bench = armed(preset);
            bench.act(&wrong);
            bench.press("Measure M1");
            finish(&mut bench);
            let why = refusal(&mut bench);
            assert!(why.contains(word), "{preset}, {wrong:?}: {why}");
        }
    }
}

#[test]
fn an_encoder_lost_or_a_shaft_caught_at_full_speed_ends_it_at_once() {
    for wrong in [
        WorldAction::LoseEncoder { motor: Motor::M1, on: true },
        WorldAction::LockShaft { motor: Motor::M1, on: true },
    ] {
        let mut bench = at_full_duty("flywheel");
        bench.pass_ms(1500);
        bench.act(&wrong);
        bench.pass_ms(1000);
        assert_at_rest(&mut bench);
        let why = refusal(&mut bench);
        assert!(why.contains("Look whether the shaft is blocked"), "{why}");
    }
}

#[test]
fn limits_of_travel_and_time_end_it_and_are_named() {
    let mut bench = armed("flywheel");
    bench.enter("Travel limit", "20000");
    bench.press("Measure M1");
    finish(&mut bench);
    let why = refusal(&mut bench);
    assert!(why.contains("the travel limit of 20000 counts was reached"), "{why}");
    let mut bench = armed("flywheel");
    bench.enter("Time limit", "2");
    bench.press("Measure M1");
    finish(&mut bench);
    let why = refusal(&mut bench);
    assert!(why.contains("the time limit of 2 s was reached"), "{why}");
}

#[test]
fn in_torque_control_there_is_no_full_duty_to_measure_at() {
    let mut bench = armed("small-gearmotor");
    bench.press("L, R and QPPS");
    bench.enter("M1 L", "0.004");
    bench.enter("M1 R", "8");
    bench.press("Apply to RAM");
    bench.pass_ms(1000);
    bench.press("Measure QPPS");
    bench.press("Measure M1");
    finish(&mut bench);
    let why = refusal(&mut bench);
    assert!(why.contains("L and R of M1 are both set"), "{why}");
}

#[test]
fn a_controller_that_holds_back_is_not_taken_for_a_slow_motor() {
    let mut config = config("large-gearmotor");
    let controller = Controller::new(config.clone()).expect("the preset is sound");
    let mut settings = controller.stored_settings();
    // 2.7 A: enough to break away, less than the motor draws at full speed.
    settings.motors[0].motion.max_current_raw = 270;
    config.settings = Some(settings);
    let mut bench = Bench::of(Controller::new(config).expect("the configuration is sound"));
    bench.connect();
    bench.arm_on("PWM Settings");
    bench.press("Measure QPPS");
    bench.press("Measure M1");
    finish(&mut bench);
    let why = refusal(&mut bench);
    // Its limiter may keep the speed from ever settling.
    assert!(why.contains("the controller gives only") || why.contains("had not settled"), "{why}");
}

#[test]
fn stop_cancel_disarming_leaving_and_unplugging_in_the_middle_stand_the_motors() {
    type End = fn(&mut Bench);
    let ends: [(&str, End); 6] = [
        ("Stop was pressed", |bench| bench.key(Key::Space)),
        ("Stop was pressed", |bench| bench.press("Stop All")),
        ("it was cancelled", |bench| bench.press("Cancel")),
        ("it was disarmed", |bench| bench.press("Arm")),
        ("it was disarmed", |bench| bench.press("Device Status")),
        ("cable was pulled out", |bench| bench.act(&WorldAction::Unplug { unplugged: true })),
    ];
    for (word, end) in ends {
        for after_ms in [300, 2500, 6000] {
            let mut bench = measuring("flywheel");
            bench.pass_ms(after_ms);
            assert!(bench.model().front.qpps.job.is_running());
            end(&mut bench);
            // Unplugged, the controller's own time-out of one second stops them.
            bench.pass_ms(1500);
            assert_at_rest(&mut bench);
            assert!(!bench.model().front.qpps.job.is_running());
            let said = bench.model().messages.past().any(|message| message.text.to_string().contains(word));
            assert!(said, "{word}: {:?}", bench.model().messages.past().collect::<Vec<_>>());
            bench.pass_ms(2000);
            assert_at_rest(&mut bench);
        }
    }
}

#[test]
fn a_frozen_window_ends_it_within_a_quarter_second() {
    let mut bench = at_full_duty("flywheel");
    // 250 ms, and 50 ms that full duty takes to go to 0 at the highest deceleration.
    bench.freeze(Duration::from_millis(310));
    assert!(bench.both_stand(), "{}", bench.real_duty(Motor::M1));
    bench.pass_ms(500);
    assert_at_rest(&mut bench);
}
